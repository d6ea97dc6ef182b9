// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/MeshParts.h"

#include "Mesh/Topology.h"
#include "Requests/SeamRequests.h"

#include <utility>

namespace quadrille
{
namespace
{

/// Names of vertices and faces inside their parts.
struct LocalNames
{
  std::vector<Index> vertex, face;
  Index halfEdge(Index h) const
  {
    return h == kInvalidIndex ? kInvalidIndex : 3 * face[Mesh::face(h)] + h % 3;
  }
};

void addFace(
  const Mesh& mesh, const CrossField& field, Index f, const LocalNames& local, MeshPart& part)
{
  part.face.push_back(f);
  part.field.angle.push_back(field.angle[f]);
  if (!field.stretch.empty())
  {
    part.field.stretch.push_back(field.stretch[f]);
  }
  if (!field.guides.empty())
  {
    part.field.guides.push_back(field.guides[f]);
  }
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    part.mesh.origin.push_back(local.vertex[mesh.origin[h]]);
    part.mesh.twin.push_back(local.halfEdge(mesh.twin[h]));
    part.mesh.flags.push_back(mesh.flags[h]);
    part.field.matching.push_back(field.matching[h]);
    part.field.alignment.push_back(field.alignment[h]);
    part.field.sectorTurns.push_back(field.sectorTurns[h]);
  }
}

} // namespace

std::vector<MeshPart> splitIntoParts(const Mesh& mesh, const CrossField& field)
{
  Index count = 0;
  const std::vector<Index> component = faceComponents(mesh, count);
  std::vector<MeshPart> parts(count);
  std::vector<Index> componentOfVertex(mesh.vertexCount(), kInvalidIndex);
  LocalNames local{ std::vector<Index>(mesh.vertexCount()), std::vector<Index>(mesh.faceCount()) };
  std::vector<Index> faces(count, 0);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    local.face[f] = faces[component[f]]++;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      componentOfVertex[mesh.origin[h]] = component[f];
    }
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (componentOfVertex[v] == kInvalidIndex)
    {
      continue;
    }
    MeshPart& part = parts[componentOfVertex[v]];
    local.vertex[v] = static_cast<Index>(part.vertex.size());
    part.vertex.push_back(v);
    part.mesh.position.push_back(mesh.position[v]);
    if (!mesh.sizing.empty())
    {
      part.mesh.sizing.push_back(mesh.sizing[v]);
    }
    part.field.turns.push_back(field.turns[v]);
  }
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    addFace(mesh, field, f, local, parts[component[f]]);
  }
  for (SeamEdges seam : field.seams)
  {
    CrossField& part = parts[component[Mesh::face(seam.left.front())]].field;
    for (std::vector<Index>* edges : { &seam.left, &seam.right })
    {
      for (Index& h : *edges)
      {
        h = local.halfEdge(h);
      }
    }
    part.seams.push_back(std::move(seam));
  }
  return parts;
}

} // namespace quadrille

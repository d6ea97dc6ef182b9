// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/DecimationMesh.h"

#include "Base/LargeArray.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Mesh/Topology.h"

#include <utility>

namespace quadrille
{

DecimationMesh::DecimationMesh(const Mesh& fine, FeatureCurves featureCurves, int threads)
  : position(fine.position), sizing(fine.sizing), curves(std::move(featureCurves))
{
  // Each task fills arrays of its own.
  parallelFor(4, 1, threads,
    [&](std::size_t task, std::size_t)
    {
      switch (task)
      {
        case 0:
          outgoing = outgoingHalfEdges(fine);
          curveError.assign(fine.vertexCount(), 0.0F);
          break;
        case 1:
          countNeighbours(fine);
          break;
        case 2:
          copyLarge(fine.origin, origin);
          break;
        default:
          copyLarge(fine.twin, twin);
          copyLarge(fine.flags, flags);
      }
    });
}

void DecimationMesh::countNeighbours(const Mesh& fine)
{
  valence.assign(fine.vertexCount(), 0);
  for (Index h = 0; h < fine.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    ++valence[fine.origin[h]];
    if (fine.isBoundary(h))
    {
      ++valence[fine.target(h)]; // the last neighbour of its open fan has no half-edge from it
    }
  }
}

bool DecimationMesh::hasEdge(Index a, Index b) const
{
  const Index first = outgoing[a];
  Index h = first;
  do
  {
    if (origin[Mesh::next(h)] == b)
    {
      return true;
    }
    const Index incoming = Mesh::previous(h);
    if (twin[incoming] == kInvalidIndex)
    {
      return origin[incoming] == b;
    }
    h = twin[incoming];
  } while (h != first);
  return false;
}

Index DecimationMesh::nextOnCurve(Index v, Index from) const
{
  Index found = kInvalidIndex;
  int others = 0;
  const auto consider = [&](Index w)
  {
    if (w != from)
    {
      found = w;
      ++others;
    }
  };
  const Index first = outgoing[v];
  Index h = first;
  do
  {
    if (isConstrained(h))
    {
      consider(target(h));
    }
    const Index incoming = Mesh::previous(h);
    if (twin[incoming] == kInvalidIndex)
    {
      consider(origin[incoming]);
    }
    h = twin[incoming];
  } while (h != first && h != kInvalidIndex);
  return others == 1 ? found : kInvalidIndex;
}

void DecimationMesh::link(Index h, Index g, std::uint8_t flag)
{
  twin[h] = g;
  flags[h] = flag;
  if (g != kInvalidIndex)
  {
    twin[g] = h;
    flags[g] = flag;
  }
}

void DecimationMesh::collapse(const CollapseRecord& record)
{
  const auto slot = [&](int i) { return record.slot[static_cast<std::size_t>(i)]; };
  const int first = record.firstSurvivor();
  const int last = record.lastSurvivor();
  const Index vertex = record.kind == CollapseKind::BoundaryLast
    ? origin[Mesh::previous(slot(record.faces - 1))]
    : origin[Mesh::next(slot(0))];
  for (int i = first; i <= last; ++i)
  {
    origin[slot(i)] = vertex;
  }
  if (first == 1)
  {
    const Index ringEdge = Mesh::next(slot(0));
    link(slot(1), twin[ringEdge], flags[ringEdge]);
    origin[slot(0) / 3 * 3] = kInvalidIndex;
  }
  if (last == record.faces - 2)
  {
    const Index ringEdge = Mesh::next(slot(record.faces - 1));
    link(Mesh::previous(slot(last)), twin[ringEdge], flags[ringEdge]);
    origin[slot(record.faces - 1) / 3 * 3] = kInvalidIndex;
  }
}

void DecimationMesh::flip(Index h)
{
  const Index g = twin[h];
  const Index nextH = Mesh::next(h);
  const Index nextG = Mesh::next(g);
  const Index c = origin[Mesh::previous(h)];
  const Index d = origin[Mesh::previous(g)];
  const Index twinAd = twin[nextG];
  const std::uint8_t flagAd = flags[nextG];
  link(g, twin[nextH], flags[nextH]);
  link(h, twinAd, flagAd);
  link(nextH, nextG, 0);
  origin[nextH] = d;
  origin[nextG] = c;
}

void DecimationMesh::refreshOutgoing(Index face)
{
  for (Index h = 3 * face; h < 3 * face + 3; ++h)
  {
    const Index v = origin[h];
    const Index current = outgoing[v];
    // A boundary half-edge always wins; any other one only replaces what is gone.
    if (isBoundary(h) || origin[current] != v || !isAlive(current / 3))
    {
      outgoing[v] = h;
    }
  }
}

Level DecimationMesh::extract() const
{
  Level level;
  std::vector<Index> newVertex(position.size(), kInvalidIndex);
  for (Index v = 0; v < static_cast<Index>(position.size()); ++v)
  {
    pollNowAndThen(v);
    if (outgoing[v] != kInvalidIndex)
    {
      newVertex[v] = static_cast<Index>(level.fineVertex.size());
      level.fineVertex.push_back(v);
      level.mesh.position.push_back(position[v]);
      if (!sizing.empty())
      {
        level.mesh.sizing.push_back(sizing[v]);
      }
    }
  }
  std::vector<Index> newFace(faceCount(), kInvalidIndex);
  for (Index f = 0; f < faceCount(); ++f)
  {
    pollNowAndThen(f);
    if (isAlive(f))
    {
      newFace[f] = static_cast<Index>(level.fineFace.size());
      level.fineFace.push_back(f);
    }
  }
  for (const Index f : level.fineFace)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      level.mesh.origin.push_back(newVertex[origin[h]]);
      level.mesh.twin.push_back(
        isBoundary(h) ? kInvalidIndex : 3 * newFace[twin[h] / 3] + twin[h] % 3);
      level.mesh.flags.push_back(flags[h]);
    }
  }
  return level;
}

} // namespace quadrille

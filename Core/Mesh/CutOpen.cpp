// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CutOpen.h"

#include "Mesh/Topology.h"

namespace quadrille
{

std::vector<Index> cutOpen(Mesh& mesh, const std::vector<std::uint8_t>& isCut)
{
  const std::vector<std::uint8_t> isOnCut = endsWhere(mesh, [&](Index h) { return isCut[h] != 0; });
  Index* twin = mesh.twin.edit();
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    twin[h] = isCut[h] != 0 ? kInvalidIndex : twin[h];
  }
  const Index vertices = mesh.vertexCount();
  const Grouped<> leaving(vertices,
    [&](const auto& visit)
    {
      for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
      {
        if (isOnCut[mesh.origin[h]] != 0)
        {
          visit(mesh.origin[h], h);
        }
      }
    });
  std::vector<Index> copied;
  std::vector<std::uint8_t> isDone(mesh.halfEdgeCount(), 0);
  for (Index v = 0; v < vertices; ++v)
  {
    bool isFirst = true;
    for (const Index* h = leaving.begin(v); h != leaving.end(v); ++h)
    {
      if (isDone[*h] != 0)
      {
        continue;
      }
      Index vertex = v;
      if (!isFirst)
      {
        vertex = mesh.vertexCount();
        mesh.position.push_back(Vector3(mesh.position[v]));
        if (!mesh.sizing.empty())
        {
          mesh.sizing.push_back(float{ mesh.sizing[v] });
        }
        copied.push_back(v);
      }
      isFirst = false;
      std::vector<Index> fan;
      forEachInFan(mesh, *h, [&](Index g) { fan.push_back(g); });
      for (const Index g : fan)
      {
        isDone[g] = 1;
        mesh.origin.edit()[g] = vertex;
      }
    }
  }
  return copied;
}

std::vector<Index> cutOpenAtFeatures(Mesh& mesh)
{
  std::vector<std::uint8_t> isFeature(mesh.halfEdgeCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    isFeature[h] = mesh.isFeature(h) ? 1 : 0;
  }
  return cutOpen(mesh, isFeature);
}

} // namespace quadrille

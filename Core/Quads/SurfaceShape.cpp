// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/SurfaceShape.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"

namespace quadrille
{
namespace
{

CurveGraph constrainedGraph(const Mesh& mesh, int threads)
{
  using Edges = std::vector<std::pair<Index, Index>>;
  Edges edges;
  for (const Edges& part : parallelParts<Edges>(mesh.halfEdgeCount(), kLightChunk, threads,
         [&](std::size_t begin, std::size_t end, Edges&found)
         {
           for (Index h = static_cast<Index>(begin); h < end; ++h)
           {
             if (mesh.isConstrained(h) && h < mesh.twin[h])
             {
               found.emplace_back(mesh.origin[h], mesh.target(h));
             }
           }
         }))
  {
    append(edges, part);
  }
  return { edges, mesh.position.size() };
}

} // namespace

CurveGraph::CurveGraph(const std::vector<std::pair<Index, Index>>& edges, std::size_t vertices)
{
  if (edges.empty())
  {
    return;
  }
  std::vector<int> degrees(vertices, 0);
  for (const auto& [a, b] : edges)
  {
    ++degrees[a];
    ++degrees[b];
  }
  cycles = static_cast<long long>(edges.size());
  for (const int degree : degrees)
  {
    cycles -= degree > 0 ? 1 : 0;
    if (degree != 0 && degree != 2)
    {
      ++nodes[degree];
    }
  }
}

SurfaceShape shapeOf(const Mesh& mesh, int threads)
{
  return { summarizeTopology(mesh, threads), constrainedGraph(mesh, threads) };
}

} // namespace quadrille

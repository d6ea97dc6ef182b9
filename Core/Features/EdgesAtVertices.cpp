// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/EdgesAtVertices.h"

#include "Base/Progress.h"

#include <numeric>

namespace quadrille
{

EdgesAtVertices edgesAtVertices(const Mesh& mesh, const std::vector<Index>& edges)
{
  EdgesAtVertices at;
  at.offset.assign(mesh.vertexCount() + 1, 0);
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    pollNowAndThen(i);
    ++at.offset[mesh.origin[edges[i]] + 1];
    ++at.offset[mesh.target(edges[i]) + 1];
  }
  std::partial_sum(at.offset.begin(), at.offset.end(), at.offset.begin());
  at.incident.resize(at.offset.back());
  std::vector<Index> fill(at.offset.begin(), at.offset.end() - 1);
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    pollNowAndThen(i);
    at.incident[fill[mesh.origin[edges[i]]]++] = edges[i];
    at.incident[fill[mesh.target(edges[i])]++] = edges[i];
  }
  return at;
}

} // namespace quadrille

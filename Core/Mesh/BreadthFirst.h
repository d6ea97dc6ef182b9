// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Breadth first over a mesh: faces over their edges, vertices ring by ring.
#pragma once

#include "Base/Progress.h"
#include "Mesh/Mesh.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace quadrille
{

/// From the lowest face on that was not visited yet, which begin(face) is told, over the half-edges that enter(h) lets
/// through to faces that were not visited yet. twin: #H. Returns the faces in the order of the visit.
template <typename Twins, typename Begin, typename Enter>
std::vector<Index> visitFaces(const Twins& twin, const Begin& begin, const Enter& enter)
{
  const auto count = static_cast<Index>(twin.size() / 3);
  std::vector<Index> order;
  order.reserve(count);
  std::vector<std::uint8_t> isReached(count, 0);
  for (Index seed = 0; seed < count; ++seed)
  {
    if (isReached[seed] != 0)
    {
      continue;
    }
    isReached[seed] = 1;
    begin(seed);
    order.push_back(seed);
    for (std::size_t i = order.size() - 1; i < order.size(); ++i)
    {
      pollNowAndThen(i);
      const Index f = order[i];
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        const Index g = twin[h];
        if (g != kInvalidIndex && isReached[Mesh::face(g)] == 0 && enter(h))
        {
          isReached[Mesh::face(g)] = 1;
          order.push_back(Mesh::face(g));
        }
      }
    }
  }
  return order;
}

/// #V: how many edges lead to the nearest one of some vertices; most + 1 where that is farther than `most`.
inline std::vector<int> ringsFrom(const Mesh& mesh, const std::vector<Index>& vertices, int most)
{
  std::vector<int> ring(mesh.vertexCount(), most + 1);
  for (const Index v : vertices)
  {
    ring[v] = 0;
  }
  for (int r = 0; r < most; ++r)
  {
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      pollNowAndThen(f);
      const Index* v = &mesh.origin[3 * f];
      for (int i = 0; i < 3 && std::min({ ring[v[0]], ring[v[1]], ring[v[2]] }) == r; ++i)
      {
        ring[v[i]] = std::min(ring[v[i]], r + 1);
      }
    }
  }
  return ring;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Loops on a surface that part two of its vertices.
#pragma once

#include "Mesh/Mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <queue>
#include <unordered_set>
#include <utility>
#include <vector>

namespace quadrille
{

/// Faces that a search on the surface looks at: the way across a loop shorter than a quad is shorter.
constexpr std::size_t kMostFacesNear = 200000;

/// What a search goes on from, the nearest first.
using Near = std::pair<double, Index>; ///< distance, what is there
using NearFirst = std::priority_queue<Near, std::vector<Near>, std::greater<>>;

/// Loops along inner edges that part two vertices: those that cross a row of faces between them an odd number of times.
class PartingLoops
{
public:
  PartingLoops(const Mesh& mesh, const std::vector<Index>& outgoing);

  /// False where the vertices are too far apart.
  bool setApart(Index one, Index other);

  /// The half-edges of the shortest loop through the root, each of which ends where the next one begins; empty where
  /// none is shorter than the bound. What it would go to and fro is left out.
  std::vector<Index> shortest(Index root, double& bound) const;

  /// The loop of the shortest ways between three vertices, as short as the bound together; else empty.
  std::vector<Index> through(const std::array<Index, 3>& corners, double bound) const;

private:
  /// The half-edges of the shortest way below the bound, which becomes its length. odd: of those that cross the row an
  /// odd number of times.
  std::vector<Index> wayTo(Index from, Index to, bool odd, double& bound) const;

  template <typename Iterator>
  bool isOdd(Iterator begin, Iterator end) const
  {
    return std::count_if(begin, end, [&](Index h) { return crossed_.count(h) != 0; }) % 2 == 1;
  }

  bool isInner(Index v) const;

  /// Of a closed walk that crosses the row an odd number of times, a part without double vertices that does so.
  std::vector<Index> simple(std::vector<Index> walk) const;

  const Mesh& mesh_;
  const std::vector<Index>& outgoing_;
  std::unordered_set<Index> crossed_; ///< half-edges
};

} // namespace quadrille

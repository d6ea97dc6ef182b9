// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Chains of edges that run straight through a quad mesh: what an isoline of the map becomes in it.
///
///    + --- + --- + --- +      at a vertex that a chain passes, two quads lie on its left and two on its right; at an
///    |     |     |     |      irregular one it is straight on one side only
///    a ==> v ==> w ==> b
///    |     |     |     |
#pragma once

#include "Base/Lists.h"
#include "Quads/QuadMesh.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille
{

enum class ChainSide
{
  Left,
  Right
};

class QuadChains
{
public:
  /// The mesh must outlive the chains and be manifold.
  explicit QuadChains(const QuadMesh& quads);

  /// Points of the chain that leaves a and passes regular vertices only, up to b. The shortest of several; empty where
  /// none leads there.
  std::vector<Index> between(Index a, Index b) const;
  /// Goes along each chain that leaves a and calls visit(chain) at each of its points, which says whether to go on;
  /// chains pass regular points only.
  template <typename Visit>
  void followAll(Index a, Visit visit) const;
  /// Closed chains, straight on one side everywhere, whose points all lie within the distance from the closed polyline;
  /// the first point stands at the end again.
  std::vector<std::vector<Index>> closedNear(
    const std::vector<Vector3>& polyline, double distance) const;

private:
  std::optional<Index> straightOn(Index h, ChainSide side) const;
  bool isPassed(Index point) const;
  Index end(Index h) const;
  std::vector<Index> closedFrom(Index first, ChainSide side, const std::vector<double>& away,
    double distance, std::vector<std::uint8_t>& passed) const;

  const QuadMesh& quads_;
  std::vector<Index> twin_; ///< #H, see QuadMesh.h
  Grouped<> leaving_;       ///< half-edges by the point that they leave
};

template <typename Visit>
void QuadChains::followAll(Index a, Visit visit) const
{
  for (const Index* first = leaving_.begin(a); first != leaving_.end(a); ++first)
  {
    std::vector<Index> chain{ a };
    std::optional<Index> h = *first;
    while (h && chain.size() <= quads_.points.size())
    {
      chain.push_back(end(*h));
      const bool goesOn = visit(chain) && isPassed(chain.back());
      h = goesOn ? straightOn(*h, ChainSide::Left) : std::nullopt;
    }
  }
}

} // namespace quadrille

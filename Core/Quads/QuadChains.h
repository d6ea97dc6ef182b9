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
  /// The chain from a to the first point of the boundary or of a feature (of the mesh's lines) that lies within the
  /// distance from the place; empty where there is none.
  std::vector<Index> toLine(Index a, const Vector3& place, double distance) const;
  /// A closed chain, straight on one side everywhere, whose points all lie within the distance from the closed
  /// polyline, and that comes as near to each of its corners; the first one stands at the end again. The nearest on
  /// average; empty where there is none.
  std::vector<Index> closedNear(const std::vector<Vector3>& polyline, double distance) const;
  /// The point nearest to a place.
  Index nearestPoint(const Vector3& place) const;
  /// The irregular point nearest to a place, which smoothing may have moved; none where there is none.
  std::optional<Index> nearestIrregular(const Vector3& place) const;

private:
  std::optional<Index> straightOn(Index h, ChainSide side) const;
  bool isPassed(Index point) const;
  template <typename Visit>
  void followAll(Index a, Visit visit) const;
  Index end(Index h) const;
  std::vector<Index> closedFrom(Index first, ChainSide side, const std::vector<double>& away,
    double distance, std::vector<std::uint8_t>& passed) const;

  const QuadMesh& quads_;
  std::vector<Index> twin_; ///< #H, see QuadMesh.h
  Grouped<> leaving_;       ///< half-edges by the point that they leave
};

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What connections and cycles became in the quads: straight chains of edges.
#pragma once

#include "Integers/CurveIsolines.h"
#include "Quads/QuadChains.h"
#include "Requests/DrawnConstraints.h"

#include <utility>
#include <vector>

namespace quadrille
{

bool isLine(const PlacedConstraint& constraint);

class LinesInQuads
{
public:
  explicit LinesInQuads(const QuadMesh& mesh);

  /// The chain, whatever the map says of it; empty where there is none, or before there are outcomes.
  std::vector<Vector3> chainOf(
    const PlacedConstraint& constraint, const std::vector<CurveOutcome>& outcomes) const;
  std::vector<Vector3> chainOf(
    const PlacedConstraint& constraint, const CurveOutcome& outcome) const;
  double edgeLength() const { return edgeLength_; } ///< of the quads, on average

private:
  std::vector<Index> between(const Vector3& start, const Vector3& end, double reach) const;

  const QuadMesh& mesh_;
  QuadChains chains_;
  double edgeLength_ = 0;
};

/// Of the points of a chain the one farthest from a polyline, with its distance.
std::pair<double, Vector3> farthestFrom(
  const std::vector<Vector3>& polyline, const std::vector<Vector3>& chain);

} // namespace quadrille

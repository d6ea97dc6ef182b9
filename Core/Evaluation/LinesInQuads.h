// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What connections and cycles became in the quads: straight chains of edges. Looked for in the quads alone.
#pragma once

#include "Evaluation/QuadPlaces.h"
#include "Quads/QuadChains.h"
#include "Requests/DrawnConstraints.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille
{

/// Mean edge lengths by which chain and line may differ, and edge lengths of the quads there by which a connection may
/// end beside the end of its line.
constexpr double kMetLine = 0.5;
/// Edge lengths within which the ends of a connection are looked for: so far a line may end from what it joins.
constexpr double kReachOfEnds = 3;
/// Mean edge lengths within which a chain is told of.
constexpr double kNearLine = 6;

bool isLine(const PlacedConstraint& constraint);

/// A chain, and how it lies to the line that was drawn.
struct LineInQuads
{
  std::vector<Vector3> chain; ///< of a cycle its first point stands at the end again
  std::vector<Index> points;  ///< of the quads, the same
  double distance =
    0; ///< the largest from chain to line or from line to chain, in mean edge lengths
  Vector3 place = Vector3::Zero(); ///< where that is
  double ends =
    0; ///< of a connection: from the chain's end to the line's, in edge lengths; the larger
  Vector3 end = Vector3::Zero(); ///< of the chain, where that is

  bool isMet() const { return ends <= kMetLine && distance <= kMetLine; }
};

class LinesInQuads
{
public:
  /// Both stay as they are while this is used; nearest: of the mesh.
  LinesInQuads(const QuadMesh& mesh, const NearestQuads& nearest);

  /// Of all chains within kNearLine of the line the nearest one, those that are met first. None where there is none.
  /// A connection runs from a point that is irregular, on a feature or on the boundary to another one, each within
  /// three edge lengths of its end and on its side, and passes regular points only; a cycle closes once round.
  std::optional<LineInQuads> find(const PlacedConstraint& constraint) const;

private:
  std::optional<LineInQuads> findCycle(const std::vector<Vector3>& path) const;
  std::optional<LineInQuads> findConnection(const std::vector<Vector3>& path) const;
  LineInQuads lineOf(const std::vector<Index>& chain) const;

  const QuadMesh& mesh_;
  const NearestQuads& nearest_;
  QuadChains chains_;
  double edgeLength_ = 0;           ///< of the quads, on average
  std::vector<std::uint8_t> isEnd_; ///< #points: a connection may end there
};

} // namespace quadrille

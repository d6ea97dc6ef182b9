// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Straight chains of edges of quads: what connections and cycles are in the result. A chain leaves a regular vertex
/// opposite to where it came in.
#pragma once

#include "Extraction/Extraction.h"
#include "Extraction/QuadTopology.h"

#include <optional>
#include <vector>

namespace quadrille
{

class QuadChains
{
public:
  /// quads: stay as they are while this is used.
  explicit QuadChains(const QuadMesh& quads);

  /// Of the straight chains between what lies nearest to the ends of the line, irregular vertices or vertices of
  /// features and boundaries, the one that stays nearest to the line: its largest distance from it. None where there is
  /// no such chain.
  std::optional<double> connection(const std::vector<Vector3>& line) const;
  /// Of the straight chains that close, through vertices near the first point of the closed line: the largest distance
  /// of a point of the line from the chain, of the chain where that is least. None where it is above a tenth of the
  /// line's length: that chain runs elsewhere.
  std::optional<double> cycle(const std::vector<Vector3>& line) const;

private:
  enum class Stop
  {
    Closed,
    Ended
  };
  bool isIrregular(Index p) const;
  bool isEnd(Index p) const { return isIrregular(p) || onCurve_[p] != 0; }
  /// Vertices from that of h on, until `stop(vertex)` says so, an irregular or boundary vertex comes, or it closes.
  template <class StopAt>
  Stop walk(Index h, std::vector<Index>& chain, const StopAt& stop) const;
  template <class Among>
  Index nearest(const Vector3& p, const Among& among) const;

  const QuadMesh& quads_;
  QuadTopology topology_;
  std::vector<std::uint8_t> onCurve_;       ///< per point: features and boundaries
  std::vector<std::vector<Index>> leaving_; ///< per point: half-edges
};

} // namespace quadrille

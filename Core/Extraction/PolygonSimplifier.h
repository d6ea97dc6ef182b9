// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Polygons that follow the boundary with few corners.
#pragma once

#include "Base/FixedPoint.h"
#include "Extraction/FaceTrace.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille
{

/// Which stops of a face become corners of its polygon.
class PolygonSimplifier
{
public:
  PolygonSimplifier(const std::vector<Stop>& stops, const std::vector<std::uint8_t>& wanted);

  /// Keeps one more stop between a kept one and the next; false where there is none.
  bool keepBetween(Index a, Index b);

  /// Ascending; empty where no choice gives a simple polygon.
  std::vector<Index> run();

private:
  std::vector<Index> keptStops() const;

  Index after(Index i) const { return i + 1 == stops_.size() ? 0 : i + 1; }

  /// The stop strictly between a and b that is farthest from their line; none where there is none.
  Index farthest(Index a, Index b) const;

  /// A boundary that comes back to the isoline that it left must not be cut short to a part of it.
  void keepWhereFlat();

  /// Follows the boundary to within kPolygonTolerance [Douglas and Peucker 1973].
  void keepWhereFar();

  /// Of a stop from the line through two others, or from both where they are one; in quads.
  double distance(Index i, Index a, Index b) const;

  static bool onOneIsoline(const Stop& a, const Stop& b);

  bool isSimple(const std::vector<Index>& corners) const;

  FixedVec2 uv(const std::vector<Index>& corners, std::size_t i) const;

  /// Keeps one more stop between any two; false when there is none.
  bool refine(const std::vector<Index>& corners);

  Index lowest() const;

  const std::vector<Stop>& stops_;
  std::vector<std::uint8_t> kept_;
  std::vector<FixedVec2> place_; ///< against the first stop, in the fine unit
};

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sizes of quads that follow from the shape of the surface, as a user asks for them.
#pragma once

#include <optional>

namespace quadrille
{

/// All are wishes for the edge length at a place, kept within a range of the target edge length. Of these and of the
/// array of sizes the smallest counts: each says how large quads may be at most.
struct AdaptiveSizes
{
  /// By how much an edge between two points of the surface may lie off it, in units of the surface, > 0: edges of
  /// length h on a surface of normal curvature k lie off by h^2 k / 8. None: sizes do not depend on the curvature.
  std::optional<double> chordError;
  /// By how much the surface may turn along an edge, radians in (0, pi]: it is at most turn / k long. None: as above.
  std::optional<double> turn;
  /// So many edges go into the thickness of the solid, or into the gap to what is opposite outside, >= 0; 0: sizes do
  /// not depend on that.
  double gapQuads = 0;
  double smallest = 0.2; ///< of all, over the target edge length, in (0, 1]
  double largest =
    1; ///< the same, at least 1: more lets quads grow where the surface is flat and far from others

  bool byCurvature() const { return chordError.has_value() || turn.has_value(); }
  bool any() const { return byCurvature() || gapQuads > 0; }
};

/// Throws InvalidInput, naming the option, where one is out of its range.
void checkAdaptiveSizes(const AdaptiveSizes& sizes);

} // namespace quadrille

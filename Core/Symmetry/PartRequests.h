// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a user asks of a surface, asked of one of the parts that an isometry and its powers make it of.
#pragma once

#include "Mesh/Requests.h"
#include "Symmetry/ImageFit.h"
#include "Symmetry/PlaneCut.h"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

/// Of a point on the part's border beyond its quads: one of valence n + 2 has n quads there.
constexpr int kBesideQuads = 2;

struct PartTask
{
  const SearchedSurface& whole; ///< with its guides, valences and sizes
  const Isometry& isometry;
  double startAngle = 0; ///< of a wedge, see SurfacePart
  double tolerance = 0;  ///< within which places are in a plane, or on the axis
  double deviation = 0;  ///< of images from the surface, at most
  int threads = 0;
  bool midLine = false; ///< quads straddle the mirror plane, so that there is nothing of them in it

  /// How often the isometry has to be applied to a place for it to lie in the part, in [0, order).
  int stepsToPart(const Vector3& p) const;
};

/// Guides, valences and sizes of the part: its own, and, where it has none, the images of those of the others, by the
/// fewest steps; a size of 1 counts as none. Where both sides of a mirror plane ask for guides that differ by more than
/// ten degrees, those in front are followed. Of valences that come to the same point the part's own, else the first
/// one, is followed. A point that is its own image has a share of the quads asked for; a number that cannot be shared
/// is not asked. About a mirror plane with regularElsewhere valences behind it are asked only where there are none in
/// front. Returns what the user should know.
std::vector<std::string> askOfPart(const PartTask& task, SurfacePart& part);

/// Which connections and cycles of the whole are asked of the part, and which of their images.
struct PartCurves
{
  std::vector<CurveRequest> curves;
  std::vector<Index> ofWhole; ///< per curve: its place among those of the whole
  std::vector<int> steps;     ///< per curve: how often the isometry was applied to it
};
/// Those that lie in one part. One that crosses a cut has no place in it.
PartCurves askCurvesOfPart(const PartTask& task);
/// Outcomes of all curves of the whole, where they were drawn, from those of the part.
std::vector<CurveOutcome> outcomesOfWhole(
  const PartTask& task, const PartCurves& asked, const std::vector<CurveOutcome>& ofPart);

} // namespace quadrille

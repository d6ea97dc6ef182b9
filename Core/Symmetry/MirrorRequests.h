// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a user asks of a surface, asked of the half in front of a mirror plane.
#pragma once

#include "Integers/CurveIsolines.h"
#include "Symmetry/MirrorCut.h"
#include "Symmetry/MirrorFit.h"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

struct MirrorTask
{
  const SearchedSurface& whole; ///< with its guides, valences and sizes
  const MirrorPlane& plane;
  double tolerance = 0; ///< within which places are in the plane
  double deviation = 0; ///< of images from the surface, at most
  int threads = 0;
  bool midLine = false; ///< quads straddle the plane, so that there is nothing of them in it
};

/// Guides, valences and sizes of the half: its own, and, where it has none, the images of those behind the plane; a
/// size of 1 counts as none. Where both ask for guides that differ by more than ten degrees, or for different valences,
/// those in front are followed. In the plane a vertex of the half has half of the quads asked for; an odd number, which
/// has no image, is not asked. With regularElsewhere valences behind the plane are asked only where there are none in
/// front. Returns what the user should know.
std::vector<std::string> askOfHalf(const MirrorTask& task, MirrorHalf& half);

/// Which connections and cycles of the whole are asked of the half, and which of them as images.
struct HalfCurves
{
  std::vector<CurveRequest> curves;
  std::vector<Index> ofWhole;        ///< per curve: its place among those of the whole
  std::vector<std::uint8_t> isImage; ///< per curve: it lies behind the plane
};
/// Those that lie on one side. One that crosses the plane has no place in the half.
HalfCurves askCurvesOfHalf(const MirrorTask& task);
/// Outcomes of all curves of the whole, on their own side, from those of the half.
std::vector<CurveOutcome> outcomesOfWhole(
  const MirrorTask& task, const HalfCurves& asked, const std::vector<CurveOutcome>& half);

} // namespace quadrille

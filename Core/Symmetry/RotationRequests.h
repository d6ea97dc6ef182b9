// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a user asks of a surface, asked of one of its wedges round an axis.
#pragma once

#include "Integers/CurveIsolines.h"
#include "Symmetry/MirrorFit.h"
#include "Symmetry/RotationCut.h"
#include "Symmetry/Symmetry.h"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

struct RotationTask
{
  const SearchedSurface& whole; ///< with its guides, valences and sizes
  const MadeRotation& rotation;
  double startAngle = 0; ///< of the wedge, see SurfaceWedge
  double tolerance = 0;  ///< within which places are in a half plane, or on the axis
  double deviation = 0;  ///< of images from the surface, at most
  int threads = 0;

  /// By how many steps a place has to be turned to lie in the wedge, in [0, order).
  int stepsToWedge(const Vector3& p) const;
};

/// Guides, valences and sizes of the wedge: its own, and, where it has none, those of the other wedges turned into it,
/// by the fewest steps; a size of 1 counts as none. Where a valence cannot be asked, as points in a cut belong to two
/// wedges, a notice tells. On the axis the valence of a pole is that of the wedge times the order. Returns what the
/// user should know. input: that of the wedge.
std::vector<std::string> askOfWedge(
  const RotationTask& task, const SurfaceWedge& wedge, SurfaceInput& input);

/// Which connections and cycles of the whole are asked of the wedge, and by how many steps they are turned for it.
struct WedgeCurves
{
  std::vector<CurveRequest> curves;
  std::vector<Index> ofWhole; ///< per curve: its place among those of the whole
  std::vector<int> steps;     ///< per curve
};
/// Those that lie in one wedge. One that crosses a cut has no place in it.
WedgeCurves askCurvesOfWedge(const RotationTask& task);
/// Outcomes of all curves of the whole, where they were drawn, from those of the wedge.
std::vector<CurveOutcome> outcomesOfWhole(
  const RotationTask& task, const WedgeCurves& asked, const std::vector<CurveOutcome>& wedge);

} // namespace quadrille

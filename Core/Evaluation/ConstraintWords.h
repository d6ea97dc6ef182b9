// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A word on each constraint: whether the quads do what was asked for, by how much not, and why not.
#pragma once

#include "Evaluation/ArrayConstraints.h"
#include "Evaluation/ConstraintMeasures.h"
#include "Extraction/Extraction.h"
#include "Mesh/Requests.h"
#include "Requests/DrawnConstraints.h"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

/// All that was asked of one surface.
struct AskedConstraints
{
  ArrayConstraints arrays;
  std::vector<PlacedConstraint> placed;
  std::vector<CurveOutcome> curves; ///< of the run, see PlacedConstraint::curve; empty before
  double edgeLength = 0;            ///< of the run, see AskedSize
};

/// A row of the table.
struct ConstraintWord : ConstraintMeasure
{
  const char* kind = "";
  std::int64_t source = -1;
  bool isOffSurface = false; ///< one of its points; the remark says which
};

/// mesh: what was made, without quads where there are none. sizes: what was asked for at its points, #points, or empty.
/// In the order of the input: arrays of the surface (guides, curves, valences, sizes), then what was drawn.
std::vector<ConstraintWord> judgeConstraints(
  const AskedConstraints& asked, const QuadMesh& mesh, const std::vector<double>& sizes);

/// Of the words, those on what was drawn, in their order: whether it is met.
std::vector<bool> metOfDrawn(
  const std::vector<ConstraintWord>& words, const AskedConstraints& asked);

/// Of the words, those on points that lie farther than half an edge length off the surface, as sentences.
std::vector<std::string> offSurfaceNotices(const std::vector<ConstraintWord>& words);

/// Of the words, those on drawn valences, connections and cycles that the quads do not have, as sentences. Those that
/// were left out are told elsewhere.
std::vector<std::string> unmetNotices(
  const std::vector<ConstraintWord>& words, const AskedConstraints& asked);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads of sheets that meet at joints (see Assembly/JointSheets.h): along a joint all sheets get the same points.
///
/// A joint is cut into segments at its ends and branches, and where the quads of any sheet have a corner or a feature
/// ends. On each segment the sheet with the most edges says how many there are; the others get strips of quads from one
/// segment that lacks an edge to another one (see Quads/StripInsertion.h). As the boundary of a quad mesh has an
/// even number of edges, a sheet without boundary of its own must lack an even number; where it does not, some
/// segments get an edge more. Then points go to their places on the segments, and the inside is smoothed.
#pragma once

#include "Assembly/JointSheets.h"
#include "Pipeline/Pipeline.h"

#include <string>
#include <vector>

namespace quadrille
{

struct MetSheets
{
  Status status;           ///< where not ok, the quads are of no use
  std::vector<Index> same; ///< per point of the quads: the lowest one that is the same
  std::size_t segments = 0, strips = 0, inverted = 0;
};

/// result: of sheets.input, with quads; it comes back to the places that the sheets were moved from, without
/// framePositions. jointPoints: those of the joint surface. smoothingSteps: >= 0.
MetSheets meetAtJoints(RemeshResult& result, const JointSheets& sheets,
  const std::vector<Vector3>& jointPoints, int smoothingSteps, int threads);

} // namespace quadrille

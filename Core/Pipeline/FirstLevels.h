// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The levels that the first attempt of a run works on, and what quads of the size asked for cannot resolve there.
#pragma once

#include "Hierarchy/Hierarchy.h"
#include "Pipeline/Attempt.h"
#include "Pipeline/SizedSurface.h"
#include "Prepare/Frame.h"

#include <string>
#include <vector>

namespace quadrille
{

/// Fills run.shortLoops, which are told on the intermediate level of the surface before any plan.
void findShortLoops(RunContext& run, StageRecords& stages, std::vector<std::string>& reused);

/// What a stage filter hands on of the first attempt; bit for bit what remesh() works with there, unless small details
/// are simplified, which these levels leave in.
struct FirstLevels
{
  Hierarchy hierarchy;
  SmallParts smallParts; ///< lengths in the frame
  SizeWish sizes = SizeWish::None;
  std::vector<std::string> notices;
  StageRecords stages;
  std::vector<std::string> reused; ///< names of stages whose result the store had
};
/// The sized surface must be ok; it is as it was afterwards. store: what sizeSurface had, null: none.
FirstLevels makeFirstLevels(SizedSurface& sized, const Frame& frame, const RemeshOptions& options,
  ResultStore* store = nullptr);

} // namespace quadrille

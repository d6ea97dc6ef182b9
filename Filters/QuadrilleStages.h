// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the stage filters share with Pipeline's order of the stages.
#pragma once

#include "Base/Progress.h"
#include "Mesh/Sizing.h"
#include "Mesh/Surface.h"
#include "Pipeline/Pipeline.h"
#include "QuadrilleLog.h"

#include <string>
#include <vector>

namespace quadrille
{

/// Collects stage records; lap() closes the stage that began at the previous lap.
class StageClock
{
public:
  StageClock();
  void lap(const std::string& stage, std::size_t in, std::size_t out);
  void add(const std::string& stage, double seconds, std::size_t in, std::size_t out);
  std::vector<StageRecord> records;

private:
  double last_;
};

struct TargetSize
{
  double edgeLength = 0;
  std::size_t quads = 0;
};
/// The size that Pipeline would choose; surface and edge lengths in a frame (see Mesh/Frame.h). Throws InvalidInput for a size that is
/// not positive.
TargetSize chooseTarget(const PreparedSurface& surface, const RemeshOptions& options);
/// The number of quads of that edge length times the sizes of the surface.
std::size_t predictedQuads(const PreparedSurface& surface, double edgeLength);

PreparedSurface prepareFromRecipe(const SurfaceInput& input, const SurfaceRecipe& recipe,
  int threads, const ProgressCallback& progress, StageClock& clock);
/// Limits the growth of sizes, drops features that the size cannot resolve, refines.
SizingReport refineFromRecipe(PreparedSurface& surface, const SurfaceRecipe& recipe,
  const ProgressCallback& progress, StageClock& clock);

} // namespace quadrille

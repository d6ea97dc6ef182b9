// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The decimation log backwards on fixed-point uv: un-flip and un-collapse [Ebke et al. 2016, Appendix A].
///
/// Where we differ: transitions are not stored but follow exactly from the two images of an edge; a removed vertex
/// is rounded once and copied to its corners through exact transitions; where it would invert its star it
/// moves into the kernel of its ring's image (along its curve for a vertex of a constrained curve).
#pragma once

#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "Hierarchy/DecimationLog.h"

#include <vector>

namespace quadrille
{

struct ReplayCounts
{
  std::size_t invertedStars = 0; ///< interpolated vertices that inverted their star
  std::size_t movedToKernel = 0; ///< of these, mended by moving them
  std::size_t withoutKernel = 0; ///< of these, left as they were
  std::size_t lostTransitions =
    0; ///< edges of zero length or with images that no quarter turn joins

  void add(const ReplayCounts& other);
};

/// Part of a log: from the level that its first `from` rounds lead to, back to that of its first `to` rounds.
/// 0 is the finest level, DecimationLog::intermediateRounds the intermediate one, rounds.size() the coarse one.
struct ReplayRange
{
  std::size_t from = 0;
  std::size_t to = 0; ///< <= from
};

/// uv: #H of the finest mesh, set on the slots of the level `from`, and on those of level `to` afterwards; level 0
/// has all slots. Parts one after the other give what the whole log gives. Throws InvalidInput when the range is none
/// of the log or uv has not the size of the finest mesh.
ReplayCounts replayRounds(const DecimationLog& log, const ReplayRange& range,
  std::vector<FixedVec2>& uv, int threads, const ProgressCallback& progress);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// When a run ends by itself: bounds that follow from the size of the surface and the number of quads, in units of work
/// (see Base/WorkCount.h), so that they are the same on every machine. How they were measured is in
/// Documentation/Design/Recovery.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

namespace quadrille
{

struct WorkBound
{
  static constexpr std::size_t kNoBound = std::numeric_limits<std::size_t>::max();

  /// No attempt begins beyond it; where there are quads, or a map that they can be made of, one that is under way ends
  /// there, too.
  std::size_t work = kNoBound;
  /// What the map of one attempt may take where there is neither.
  std::size_t ofMap = kNoBound;
  std::size_t attempts = kNoBound; ///< that a run makes at most
  // Of these, for the attempt that is the last resort and those after it; work as many units more than was done before.
  std::size_t attemptsOfLastResort = 0;
  std::size_t workOfLastResort = 0;
  std::size_t ofAttempt =
    0; ///< what an attempt takes beside its map: levels, the way to the surface, quads
};

/// Attempts that a run makes at most.
constexpr std::size_t kMostAttempts = 20;

/// faces: of the surface that is mapped; quads: that the map is made for at first.
/// most: for a part of a surface that is divided, see leastOfPart.
inline WorkBound workBound(
  std::size_t faces, std::size_t quads, std::size_t most = WorkBound::kNoBound)
{
  // A coarse level has about so many faces, on which several maps are made.
  constexpr std::size_t kFacesOfCoarse = 2000;
  constexpr std::size_t kOfCoarseFace = 4000;
  constexpr std::size_t kOfFace = 4;
  constexpr std::size_t kOfQuad = 100;
  constexpr std::size_t kMapsOverRun = 2;
  constexpr std::size_t kAttemptsOfLastResort = 8;
  constexpr std::size_t kAttemptOfQuad = 20;
  WorkBound bound;
  bound.work = std::min(
    most, kOfCoarseFace * std::min(faces, kFacesOfCoarse) + kOfFace * faces + kOfQuad * quads);
  bound.ofMap = kMapsOverRun * bound.work;
  bound.attempts = kMostAttempts;
  bound.attemptsOfLastResort = kAttemptsOfLastResort;
  bound.workOfLastResort = bound.work / 2;
  bound.ofAttempt = faces + kAttemptOfQuad * quads;
  return bound;
}

/// What a part of a surface may take at least, however much others have taken: an eighth of what it could as a surface
/// of its own, which is a map or two.
inline std::size_t leastOfPart(std::size_t faces, std::size_t quads)
{
  constexpr std::size_t kPart = 8;
  return workBound(faces, quads).work / kPart;
}

} // namespace quadrille

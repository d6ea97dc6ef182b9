// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The map solved again, with the integers and irregular vertices that it has, on a finer level than the coarse one
/// [Ebke et al. 2016, Section 10].
#pragma once

#include "Base/FixedPoint.h"
#include "Evaluation/MapDistortion.h"
#include "GridMap/GridMap.h"
#include "GridMap/RelaxMap.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/Surface.h"

#include <string>
#include <vector>

namespace quadrille
{

enum class FinalQuality
{
  Coarse,       ///< the coarse map, carried to the input, is the result
  Intermediate, ///< it is carried to the intermediate level, solved again there, and carried on
  Input         ///< it is carried to the input and solved again there
};

struct FinalQualityOptions
{
  FinalQuality level = FinalQuality::Coarse;
  double edgeLength = 0;   ///< of the quads
  double maximumBytes = 0; ///< that may be taken
  std::size_t maximumNumberOfQuads = 10000000;
  int smoothingSteps = 5; ///< of the quads that the result is judged by
  int threads = 0;
  ProgressCallback progress;
};

/// What the re-solve did; measures are of the map on the input.
struct FinalQualityReport
{
  FinalQuality level = FinalQuality::Coarse;
  bool improved = false; ///< otherwise the carried map is the result, and `notice` says why
  MapDistortion before, after;
  int steps = 0; ///< of Newton's method
  int holds =
    0; ///< how often it was solved again with the carried map round quads that were inverted
  std::size_t elements = 0; ///< triangles of the level
  std::string notice;
};

/// A map on the input and what it is to keep.
struct SurfaceMap
{
  std::vector<FixedVec2> uv; ///< #H
  Certificate certificate;
};

/// Where the carried map comes from; for FinalQuality::Intermediate.
struct CoarseMap
{
  const Hierarchy* hierarchy = nullptr;
  const std::vector<FixedVec2>* uv = nullptr; ///< #H of the coarse level
};

/// `map` is replaced where the re-solve has a lower distortion, a certificate that is not worse in any count and not
/// more quads that are inverted; otherwise it stays as it is and the report's notice says why. Where the surface has
/// creases or pockets narrower than a quad, a map that follows them can turn a quad over that the coarse map drew
/// across them: there the carried map is held and the rest solved again. turns, integerVertex: #V of the surface, as
/// for certify().
FinalQualityReport improveMap(const PreparedSurface& surface, const std::vector<int>& turns,
  const std::vector<std::uint8_t>& integerVertex, const CoarseMap& coarse,
  const FinalQualityOptions& options, SurfaceMap& map);

} // namespace quadrille

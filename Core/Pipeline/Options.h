// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run is asked for.
#pragma once

#include "Base/Angles.h"
#include "Base/Progress.h"
#include "GridMap/GridMap.h"
#include "Hierarchy/Hierarchy.h"
#include "Pipeline/FinalQuality.h"
#include "Sizes/AdaptiveSizes.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace quadrille
{

/// Which edges above the feature angle are features.
enum class FeatureCriterion
{
  Creases, ///< those of curves that are creases as a whole, see keepCreases
  Angle    ///< all that stand out from their surroundings and that the edge length resolves
};

/// What becomes of handles and boundary loops that are shorter round than kQuadsOfLoop edge lengths.
enum class SmallDetails
{
  Automatic, ///< simplified below RemeshOptions::smallestDetail, or where all of them would take too many quads
  Resolve,  ///< quads are smaller there
  Simplify, ///< all of them: handles are cut and closed, boundary loops filled
  Keep ///< the surface and the size of the quads stay as they are, and a run fails where that is impossible
};

/// Exactly one of the three sizes is used: quads, else edgeLength, else relativeEdgeLength.
struct RemeshOptions
{
  std::optional<std::size_t> quads; ///< target number of quads, >= 1
  std::optional<double> edgeLength; ///< target edge length in units of the input, > 0
  double relativeEdgeLength = 0.02; ///< target edge length over the bounding-box diagonal, > 0
  /// With quads: these are the least, and more where the shape needs them, see QuadsOfShape.h.
  bool growsWithShape = false;
  std::optional<double> featureAngle = radians(40); ///< radians; none: no detection
  FeatureCriterion featureCriterion = FeatureCriterion::Creases;
  AdaptiveSizes
    sizes; ///< smaller quads where the surface is curved or thin; lengths in units of the input
  /// Where no guide is given, quads follow the principal curvature wherever its anisotropy, |k1 - k2| / (|k1| + |k2|)
  /// over about an edge length, is above this; in [0, 1); none: off.
  std::optional<double> curvatureGuides;
  MapMethod method = MapMethod::ScaleAware;
  /// The coarsest layout of quads in place of their size, see computeCoarsestMap; by the scale aware method only. The
  /// size asked for sets what the levels keep and how curves are followed.
  bool coarsestIntegers = false;
  Index coarseVertices = 1000; ///< budget of the coarse level; 0: as many as its curvature needs
  DecimationCost decimationCost =
    DecimationCost::Gaussian; ///< of phase 2; others are there to compare with
  /// What is smaller than so many target edge lengths is taken out of the surface, and of the features that quads
  /// follow, before the first map; >= 0. A larger one never brings a detail back. Handles and boundary loops are
  /// measured by their lengths; groups of features by the diagonal of their box, dangling ones by a quarter of their
  /// length, bands between two by a hundred times their width. Above 1 connected components, too, by the square root
  /// of their area; up to there they are blocks, see removeSmallComponents.
  double smallestDetail = 1;
  /// The methods that are not scale aware, and the coarsest integers, take Automatic as Resolve.
  SmallDetails smallDetails = SmallDetails::Automatic;
  /// Connected components with less area than the smallest block of quads has (six for a closed one without handles,
  /// see quadsOfBlock) go, unless all are such. Off: each becomes about that many quads. Both are told.
  bool removeSmallComponents = false;
  /// Connected components that have no map are left out where others have quads, see RemeshResult::failed. Off: the run
  /// has no quads then.
  bool leavesOutFailed = false;
  /// The ratio of the two stretches of a triangle of the coarse level from which on it is brought down where integers
  /// and irregular vertices let it, see GridMapOptions; >= 1, or 0: no limit. By the scale aware and the seamless
  /// method only; final quality does not know it.
  double anisotropyLimit = 0;
  /// The level on which the map is solved again with its integers, see improveMap.
  FinalQuality finalQuality = FinalQuality::Coarse;
  /// The shapes of coarse triangles, to which the map fits its quads, are those of the surface that they stand for: see
  /// measureStretch.
  bool distortionMetric = false;
  std::size_t maximumNumberOfQuads = 10000000;
  /// Quads of the intermediate level in place of those of the surface: the same map with the same integers, in a time
  /// that follows the number of quads. They tell nothing of the surface: no source faces, lines or attributes.
  bool preview = false;
  int smoothingSteps = 5; ///< of the quads on the surface, see ExtractionOptions
  /// Bytes that the run may take by the estimate; none: what the machine has free.
  std::optional<double> memoryLimit;
  /// Whether the vertices of RemeshResult::surface have positions; the quads do not depend on it.
  bool keepsPositions = true;
  bool mergeCharts =
    false; ///< of the map on the surface, for display; the quads do not depend on it
  /// RemeshResult::mapKey of a map that the caller still has with its charts merged: where it is the result again, that
  /// is not done another time.
  std::uint64_t knownMap = 0;
  int threads = 0; ///< 0: all; the result does not depend on it
  /// With a memory only: the map may start from that of the run before, so that the result may differ from one without
  /// memory. Off: the same bytes as without.
  bool warmStart = false;
  ProgressCallback progress;
};

/// Throws InvalidInput, naming the option, where one is out of its range or two contradict each other.
void checkOptions(const RemeshOptions& options);

/// Whether folds of the map are a property of the method, so that nothing is tried again for them.
bool isRounded(MapMethod method);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Clock.h"
#include "Mesh/Sizing.h"
#include "Pipeline/SizedSurface.h"
#include "Prepare/Frame.h"
#include "Prepare/Refine.h"
#include "Sizes/AdaptiveSizing.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <vector>

namespace quadrille
{
namespace
{

/// Above this share of the area what is left is not worth a word.
constexpr double kMostOfArea = 0.94;

/// How often the edge length is chosen anew where sizes that grow gradually make too many quads, and when it is good.
constexpr int kSizingRounds = 3;
constexpr double kSizedCountTolerance = 0.03;

std::vector<float> multiplied(std::vector<float> lengths, double factor)
{
  for (float& length : lengths)
  {
    length = static_cast<float>(length * factor);
  }
  return lengths;
}

std::string adaptiveSizesNotice(
  const Mesh& mesh, const std::vector<float>& lengths, double factor, double edgeLength)
{
  const auto [least, most] = std::minmax_element(mesh.sizing.begin(), mesh.sizing.end());
  std::ostringstream text;
  text << std::setprecision(2) << "quads get sizes from " << double{ *least } << " to "
       << double{ *most } << " times the target edge length";
  if (factor > kTellRefinement)
  {
    text << "; so few quads are longer than curvature and thickness ask for, by a factor of "
         << factor << ": ask for " << std::setprecision(2) << factor * factor
         << " times as many, or for a larger chord error";
  }
  const double share = shareOfLengthsMet(mesh, multiplied(lengths, factor), edgeLength);
  if (share < kMostOfArea)
  {
    text << "; on " << std::lround(100 * (1 - share))
         << " % of the area the smallest size keeps them longer than these ask for";
  }
  return text.str();
}

} // namespace

std::string adaptSizes(PreparedSurface& surface, const RemeshOptions& options, SizedSurface& sized)
{
  Mesh& mesh = surface.mesh;
  const AdaptiveSizes& sizes = options.sizes;
  const double start = secondsNow();
  // On faces no larger than quads, so that there are places to ask for sizes at.
  refineSurface(surface, sized.edgeLength, {}, options.threads);
  const double reach = options.quads ? sizes.largest / sizes.smallest : sizes.largest;
  const std::vector<float> asked = mesh.sizing;
  const std::vector<float> lengths = adaptiveLengths(mesh, sizes, sized.edgeLength, reach,
    options.threads, cornerCurvatures(surface, options.threads));
  const double target = options.quads ? static_cast<double>(*options.quads) : 0;
  double wanted = target, made = 0;
  DistributedSizes shared;
  for (int round = 0; round < kSizingRounds; ++round)
  {
    if (options.quads)
    {
      shared = distributeSizes(mesh, asked, lengths, sizes, wanted);
      sized.edgeLength = roundedLength(shared.edgeLength);
    }
    setAdaptiveSizes(
      mesh, asked, multiplied(lengths, shared.lengthFactor), sizes, sized.edgeLength);
    limitSizeGrowth(mesh, sized.edgeLength);
    made = sizedArea(mesh) / (sized.edgeLength * sized.edgeLength);
    if (!options.quads || std::abs(made / target - 1) < kSizedCountTolerance)
    {
      break;
    }
    wanted *= target / made; // sizes that grow gradually make more quads
  }
  if (!options.quads)
  {
    sized.targetQuads = predictedQuads(made, 1);
  }
  sized.stages.add("sizes", secondsNow() - start, mesh.faceCount(), mesh.faceCount());
  return adaptiveSizesNotice(mesh, lengths, shared.lengthFactor, sized.edgeLength);
}

} // namespace quadrille

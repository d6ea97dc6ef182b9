// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/PlaceText.h"
#include "Details/SmallComponents.h"
#include "Pipeline/PlannedSurface.h"
#include "Pipeline/SizedSurface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <sstream>
#include <vector>

namespace quadrille
{
namespace
{

/// What a sized surface has of components that are too small for a block of quads.
struct StoredSmallComponents
{
  SmallComponents small; ///< without its flags of faces
  double area = 0;       ///< of the whole surface, over the sizes
};

std::string smallComponentsText(const SmallComponents& small, std::size_t count, double edgeLength)
{
  std::ostringstream text;
  text << count << " of " << small.components
       << " connected components are smaller than a closed block of quads of this size, the "
          "largest with the area of "
       << std::setprecision(2) << small.largest / (edgeLength * edgeLength) << std::setprecision(6)
       << " quads near " << placeText(small.place);
  return text.str();
}

std::string specksText(const SmallComponents& small, double edgeLength)
{
  std::ostringstream text;
  text << small.count << " of " << small.components
       << " connected components have less area than a quad of this size, the largest "
       << std::setprecision(2) << small.largest / (edgeLength * edgeLength) << std::setprecision(6)
       << " of one near " << placeText(small.place)
       << ": left out, as the smallest blocks of quads for them, " << std::llround(small.quads)
       << " altogether, are more than was asked for; ask for more quads, or have them kept (Small "
          "Details Resolve, --small-details resolve)";
  return text.str();
}

template <class Text>
void noteComponents(const SmallComponents& small, double edgeLength, const Text& whatBecomes,
  std::vector<SmallDetail>& details)
{
  for (const SmallComponent& component : small.each)
  {
    details.push_back({ DetailKind::Component, DetailDecision::Simplify,
      std::sqrt(component.area) / edgeLength, component.place, whatBecomes(component) });
  }
}

StoredSmallComponents smallComponents(const SizedSurface& sized, int threads)
{
  StoredSmallComponents found{ findSmallComponents(
                                 *sized.surface, sized.edgeLength, kInfinity, threads),
    areaOverSizes(*sized.surface) };
  found.small.isSmall = {};
  return found;
}

} // namespace

std::string dropSmallComponents(
  PreparedSurface& surface, const RemeshOptions& options, SizedSurface& sized)
{
  const bool isAsked = options.removeSmallComponents;
  if (!isAsked && !maySimplify(options))
  {
    return {};
  }
  SmallComponents small =
    findSmallComponents(surface, sized.edgeLength, kInfinity, options.threads);
  const double smallest = options.smallestDetail;
  const bool areTooMany = small.quads > static_cast<double>(sized.targetQuads);
  if (!isAsked)
  {
    if (!areTooMany && smallest <= 1)
    {
      return {};
    }
    small = findSmallComponents(
      surface, sized.edgeLength, std::max(1.0, smallest * smallest), options.threads);
  }
  const std::size_t removed = removeSmallComponents(surface, small);
  if (removed == 0)
  {
    return {};
  }
  noteComponents(
    small, sized.edgeLength, [](const SmallComponent&) { return "left out"; }, sized.details);
  return isAsked
    ? smallComponentsText(small, removed, sized.edgeLength) + ": removed, as was asked for"
    : smallest > 1 ? smallComponentsText(small, removed, sized.edgeLength) +
      ": removed, as below the smallest detail"
                   : specksText(small, sized.edgeLength);
}

/// What of the surface is left after the removal, or becomes blocks, sets the number of quads where an edge length is
/// asked for.
void countBlocks(SizedSurface& sized, const RemeshOptions& options, ResultStore* store)
{
  const double quad = sized.edgeLength * sized.edgeLength;
  const auto known = findOrMake<StoredSmallComponents>(
    store, sized.key, [&] { return smallComponents(sized, options.threads); },
    [](const StoredSmallComponents&) { return sizeof(StoredSmallComponents); });
  const SmallComponents& small = known->small;
  sized.blocks.clear();
  sized.blocksNotice.clear();
  if (!options.quads)
  {
    const double quads = (known->area - small.area) / quad + small.quads;
    sized.targetQuads = predictedQuads(quads, 1);
  }
  if (small.count > 0)
  {
    noteComponents(
      small, sized.edgeLength,
      [](const SmallComponent& component) {
        return "made a block of about " + std::to_string(std::llround(component.block)) + " quads";
      },
      sized.blocks);
    sized.blocksNotice = smallComponentsText(small, small.count, sized.edgeLength) +
      ": each was made of about the smallest block of quads there is, " +
      std::to_string(std::llround(small.quads)) +
      " altogether; ask for more quads to resolve them, or have them removed (Small Components, "
      "--small-components remove)";
  }
}

} // namespace quadrille

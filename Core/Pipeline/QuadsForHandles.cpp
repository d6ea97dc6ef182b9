// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/DetailSteps.h"

#include "Base/PlaceText.h"
#include "Details/SmallComponents.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <sstream>

namespace quadrille
{
namespace
{

/// What the smallest block of a component may need, over the quads that its area is worth, so that maps are tried with
/// the handles that are left. Small components of few handles become blocks anyway.
constexpr double kMostBlockWorth = 3;
constexpr double kQuadsOfFewHandles = 64;
/// From 512 handles on, that of twice as many before any was cut, the exact equations of a map take minutes: only where
/// the area is worth the block.
constexpr double kLargeBlock = 8192;
constexpr double kWorthOfLargeBefore = 2;

/// Of a surface that has no component of more handles than quads go round: an edit does not count them again.
struct JudgedPossible
{
};

} // namespace

Status judgeHandles(const SizedSurface& sized, bool isCut, int threads, ResultStore* store)
{
  const ResultKey key =
    KeyMaker(sized.key).add(sized.edgeLength).add(std::uint64_t{ isCut ? 1U : 0U }).key();
  if (store != nullptr && store->find<JudgedPossible>(key))
  {
    return {};
  }
  const double quad = sized.edgeLength * sized.edgeLength;
  const SmallComponents small =
    findSmallComponents(*sized.surface, sized.edgeLength, kInfinity, threads);
  const auto found = std::find_if(small.each.begin(), small.each.end(),
    [&](const SmallComponent& component)
    {
      const double worth = component.area / quad;
      const double block = component.block;
      return block > kQuadsOfFewHandles &&
        (isCut ? block > kMostBlockWorth * worth || block > kLargeBlock
               : block > 2 * kLargeBlock && block > kWorthOfLargeBefore * worth);
    });
  if (found == small.each.end())
  {
    if (store != nullptr)
    {
      store->put(key, std::make_shared<JudgedPossible>(), sizeof(JudgedPossible));
    }
    return {};
  }
  std::ostringstream text;
  text << "ask for more quads, or simplify or wrap the surface (Surface Wrap): the handles and "
          "boundary loops of the component near "
       << placeText(found->place) << " need at least about " << std::llround(found->block)
       << " quads, but its area is that of " << std::llround(found->area / quad)
       << " of this size (Small Details Resolve, --small-details resolve, has it tried)";
  return { StatusCode::Infeasible, text.str() };
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/CoarsestMap.h"

#include "Base/TryCount.h"
#include "Extraction/Extraction.h"

#include <algorithm>
#include <utility>

namespace quadrille
{
namespace
{

constexpr double kFirstPull = 1.0 / 16;

bool hasSoundQuads(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  ExtractionOptions options;
  options.smoothingSteps = 0;
  options.threads = 1;
  return extractQuads(mesh, uv, options).status.ok();
}

} // namespace

GridMapResult computeCoarsestMap(const Mesh& mesh, GridMapOptions options)
{
  GridMapResult spent;
  for (double pull = 0;; pull = pull > 0 ? 2 * pull : kFirstPull)
  {
    options.pull = pull;
    countTry(Try::LargerPull, pull > 0 ? 1 : 0);
    GridMapResult map = computeGridMap(mesh, options);
    map.addWork(spent);
    // Without a seamless map, or any integers for it, there is nothing that other shares could change.
    const bool started = std::any_of(
      map.seamlessUv.begin(), map.seamlessUv.end(), [](FixedVec2 p) { return p != FixedVec2{}; });
    const bool last = pull >= 1 || (!map.status.ok() && !started);
    if (last || (map.status.ok() && hasSoundQuads(mesh, map.uv)))
    {
      countTryLed(Try::LargerPull, pull > 0 && map.status.ok() ? 1 : 0);
      return map;
    }
    spent = std::move(map);
  }
}

} // namespace quadrille

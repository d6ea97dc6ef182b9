// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Pipeline/Run.h"

#include <algorithm>
#include <string>

namespace quadrille
{
namespace
{

std::size_t countTriangles(const SurfaceInput& input)
{
  std::size_t triangles = 0;
  for (std::size_t i = 0; i + 1 < input.polygonOffsets.size(); ++i)
  {
    pollNowAndThen(i);
    const std::size_t corners = input.polygonOffsets[i + 1] - input.polygonOffsets[i];
    triangles += std::max<std::size_t>(corners, 2) - 2;
  }
  return triangles;
}

/// Says what the run will cost; not ok where the memory is not there.
Status estimate(std::size_t triangles, const RemeshOptions& options, RemeshResult& result)
{
  const double quads =
    static_cast<double>(std::min(options.quads.value_or(0), options.maximumNumberOfQuads));
  result.estimate = estimateRun(triangles, quads, options.threads);
  report(options.progress, 0,
    "Preparing: " + estimateText(result.estimate) + " for " + std::to_string(triangles) +
      " triangles");
  return memoryStatus(result.estimate, triangles, options);
}

/// Null where there is no room for both the run and the store.
ResultStore* storeIfRoom(
  ResultStore* store, std::size_t triangles, const RemeshOptions& options, RemeshResult& result)
{
  if (store == nullptr)
  {
    return nullptr;
  }
  const double needed = bytesToRemember(result.estimate, triangles, store->bytes());
  if (needed <= options.memoryLimit.value_or(freeMemory()))
  {
    return store;
  }
  store->clear();
  result.notices.push_back("stages are not remembered: the run and its memory would need " +
    bytesText(needed) + "; a change will start from the beginning");
  return nullptr;
}

} // namespace

RemeshResult guardedRun(
  const SurfaceInput& input, RemeshOptions options, ResultStore* store, const RunBody& run)
{
  checkOptions(options);
  RemeshResult result;
  // What is left to do after a stop that has kept quads is short, and does not ask again.
  const ProgressCallback asked = options.progress;
  PollScope poll(!asked ? ProgressCallback()
                        : [&](double fraction, const std::string& text)
      { return !result.stopped.empty() || asked(fraction, text); });
  options.progress = poll.callback();
  PlaceScope places;
  const TryScope tries;
  try
  {
    const std::size_t triangles = countTriangles(input);
    result.status = estimate(triangles, options, result);
    if (result.status.ok())
    {
      run(options, storeIfRoom(store, triangles, options, result), places, result);
    }
  }
  catch (const Cancelled&)
  {
    // What was under work is in the run's own coordinates, or half made.
    result.becomeStopped();
  }
  result.tries.add(tries.counts());
  return result;
}

RemeshOptions optionsInFrame(RemeshOptions options, const Frame& frame)
{
  if (options.edgeLength)
  {
    options.edgeLength = frame.lengthOf(*options.edgeLength);
  }
  if (options.sizes.chordError)
  {
    options.sizes.chordError = frame.lengthOf(*options.sizes.chordError);
  }
  return options;
}

} // namespace quadrille

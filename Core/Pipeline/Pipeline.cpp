// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Pipeline.h"

#include "Base/PlaceText.h"
#include "Pipeline/EnterFrame.h"
#include "Pipeline/Run.h"
#include "Pipeline/SizedSurface.h"

#include <utility>

namespace quadrille
{
namespace
{

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

/// What is in the frame already.
void runEntered(EnteredInput& entered, const RemeshOptions& given, bool quadsAlone,
  PlaceScope& places, RemeshResult& result)
{
  const Frame& frame = entered.framed.frame;
  places.set(frame.centre, frame.unit, frame.sign);
  RemeshOptions options = optionsInFrame(given, frame);
  options.mergeCharts = options.mergeCharts && !options.preview && !quadsAlone;
  SizedSurface sized = sizeSurface(entered.framed.input, options, entered.known);
  remeshSized(sized, frame, options, entered.known.store, quadsAlone, result);
  putOnUserSurface(sized, entered.framed, options, quadsAlone, result);
  if (given.edgeLength && !options.quads)
  {
    result.targetEdgeLength = *given.edgeLength; // with every bit
  }
}

RemeshResult remeshAll(SurfaceInput& input, const RemeshOptions& options, ResultStore* store)
{
  return guardedRun(input, options,
    [&](const RemeshOptions& asked, std::size_t triangles, PlaceScope& places, RemeshResult& result)
    {
      EnteredInput entered =
        enterFrame(std::move(input), asked, storeIfRoom(store, triangles, asked, result));
      runEntered(entered, asked, false, places, result);
    });
}

} // namespace

RemeshResult remesh(SurfaceInput input, const RemeshOptions& options)
{
  return remeshAll(input, options, nullptr);
}

RemeshResult remesh(SurfaceInput input, const RemeshOptions& options, ResultStore& store)
{
  return remeshAll(input, options, &store);
}

RemeshResult remeshQuads(SurfaceInput input, const RemeshOptions& options, ResultStore& store)
{
  return guardedRun(input, options,
    [&](const RemeshOptions& asked, std::size_t triangles, PlaceScope& places, RemeshResult& result)
    {
      EnteredInput entered =
        enterFrame(std::move(input), asked, storeIfRoom(&store, triangles, asked, result));
      runEntered(entered, asked, true, places, result);
    });
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/EnterFrame.h"

#include "Mesh/ContentHash.h"
#include "Prepare/Repair.h"

#include <memory>
#include <utility>

namespace quadrille
{
namespace
{

/// Of points and polygons that a run has put into their frame.
struct StoredFrame
{
  FramedInput framed;    ///< without arrays
  GeometryHash geometry; ///< in the frame
};

/// Enters the frame and leaves what it has found in the store.
EnteredInput enterAndKeep(
  SurfaceInput input, const RemeshOptions& options, ResultStore& store, ResultKey key)
{
  EnteredInput entered{ quadrille::enterFrame(std::move(input), options.threads), {} };
  const FramedInput& framed = entered.framed;
  auto stored = std::make_shared<StoredFrame>();
  stored->framed.frame = framed.frame;
  stored->framed.input.faceOrder = framed.input.faceOrder;
  stored->framed.input.precision = framed.input.precision;
  stored->geometry = geometryHash(framed.input, options.threads);
  entered.known = { &store, contentHash(stored->geometry, framed.input, options.threads) };
  store.put(key, std::move(stored), sizeof(StoredFrame));
  return entered;
}

} // namespace

EnteredInput enterFrame(SurfaceInput input, const RemeshOptions& options, ResultStore* store)
{
  if (store == nullptr)
  {
    return { quadrille::enterFrame(std::move(input), options.threads), {} };
  }
  const GeometryHash given = geometryHash(input, options.threads);
  const ResultKey key = KeyMaker(given.points).add(given.polygonOffsets, given.polygonPoints).key();
  if (const auto found = store->find<StoredFrame>(key))
  {
    const KnownInput known{ store, contentHash(found->geometry, input, options.threads) };
    if (isPrepared(known, options))
    {
      checkArrays(input);
      return { enterKnownFrame(std::move(input), found->framed), known };
    }
  }
  return enterAndKeep(std::move(input), options, *store, key);
}

} // namespace quadrille

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

class FrameFinder
{
public:
  FrameFinder(const SurfaceInput& input, const RemeshOptions& options, ResultStore* store)
    : options_(options), store_(store)
  {
    if (store_ == nullptr)
    {
      return;
    }
    const GeometryHash given = geometryHash(input, options_.threads);
    key_ = KeyMaker(given.points).add(given.polygonOffsets).add(given.polygonPoints).key();
    found_ = store_->find<StoredFrame>(key_);
    if (found_)
    {
      known_ = { store_, contentHash(found_->geometry, input, options_.threads) };
    }
  }

  /// Whether the store has all that is made of points and polygons.
  bool hasSurface() const { return found_ != nullptr && isPrepared(known_, options_); }

  /// input: has passed checkArrays.
  EnteredInput enterKnown(SurfaceInput input) const
  {
    return { enterKnownFrame(std::move(input), found_->framed), known_ };
  }

  EnteredInput enter(SurfaceInput input) const
  {
    EnteredInput entered{ quadrille::enterFrame(std::move(input), options_.threads), {} };
    if (store_ == nullptr)
    {
      return entered;
    }
    const FramedInput& framed = entered.framed;
    auto stored = std::make_shared<StoredFrame>();
    stored->framed.frame = framed.frame;
    stored->framed.input.faceOrder = framed.input.faceOrder;
    stored->framed.input.precision = framed.input.precision;
    stored->geometry = geometryHash(framed.input, options_.threads);
    entered.known = { store_, contentHash(stored->geometry, framed.input, options_.threads) };
    store_->put(key_, std::move(stored), sizeof(StoredFrame));
    return entered;
  }

private:
  const RemeshOptions& options_;
  ResultStore* store_;
  ResultKey key_ = 0; ///< of points and polygons as the user gave them
  std::shared_ptr<StoredFrame> found_;
  KnownInput known_;
};

} // namespace

EnteredInput enterFrame(SurfaceInput input, const RemeshOptions& options, ResultStore* store)
{
  const FrameFinder finder(input, options, store);
  if (finder.hasSurface())
  {
    checkArrays(input);
    return finder.enterKnown(std::move(input));
  }
  return finder.enter(std::move(input));
}

} // namespace quadrille

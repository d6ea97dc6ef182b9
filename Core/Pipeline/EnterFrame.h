// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The way of a run into its frame (see Mesh/Frame.h), which a store makes short: of points and polygons that it knows
/// no coordinate is looked at again.
#pragma once

#include "Mesh/Frame.h"
#include "Pipeline/SizedSurface.h"

namespace quadrille
{

struct EnteredInput
{
  FramedInput framed; ///< without points in the frame where the store has the prepared surface
  KnownInput known;   ///< for sizeSurface
};

/// Takes the input. Throws InvalidInput as checkInput does.
EnteredInput enterFrame(SurfaceInput& input, const RemeshOptions& options, ResultStore* store);

/// The same for an input that whoever holds it needs again: points and polygons are copied where the run takes them,
/// and else lent until the end of the loan; all else is taken.
class LentInput
{
public:
  LentInput(SurfaceInput& input, const RemeshOptions& options, ResultStore* store);
  ~LentInput();
  LentInput(const LentInput&) = delete;
  LentInput& operator=(const LentInput&) = delete;

  EnteredInput& entered() { return entered_; }

private:
  SurfaceInput& input_;
  std::vector<Index> polygonOffsets_, polygonPoints_; ///< set aside
  bool isLent_ = false;
  EnteredInput entered_;
};

} // namespace quadrille

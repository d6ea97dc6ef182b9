// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Below which lengths loops round handles and holes are simplified, and the loops of a surface that are.
#pragma once

#include "Details/Handles.h"
#include "Mesh/Surface.h"
#include "Pipeline/Attempt.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

/// So many handles are a crowd: resolved as a whole, or cut.
constexpr std::size_t kManyHandles = 24;

class DetailLimits
{
public:
  /// takesAll: what is shorter than kQuadsOfLoop edge lengths, whatever smaller quads could do. isRest: nothing else
  /// has led to quads.
  DetailLimits(double edgeLength, bool takesAll, bool isRest);

  double ofBoundaryLoops() const { return limit_; } ///< in units of the mesh
  double ofHandles() const { return handleLimit_; }

  /// The limit grows until smaller quads do for the loops that are at least as long. A crowd of handles is
  /// resolved as a whole or cut.
  void raise(RunContext& run);
  /// Whether a limit was raised since it was asked before.
  bool takeRaised();

private:
  std::vector<HandleLoop> loopsAbove(const RunContext& run, bool ofHandles) const;

  double edgeLength_;
  double limit_;
  double handleLimit_;
  bool isRaised_ = false;
};

/// Below the limit. Those of components with less area than a closed block of quads are left to them.
std::vector<HandleLoop> shortBoundaryLoops(
  const PreparedSurface& surface, double edgeLength, double limit, int threads);

/// With vertices of the surface. The run, whose short loops were found, knows those of up to kQuadsOfLoop edge lengths.
std::vector<HandleLoop> handlesBelow(RunContext& run, double edgeLength, double limit);

} // namespace quadrille

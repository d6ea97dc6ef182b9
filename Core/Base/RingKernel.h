// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where a vertex may lie so that every triangle it spans with the edges of its ring is positive.
#pragma once

#include "Base/FixedPoint.h"

#include <optional>

namespace quadrille
{

/// Corners that a ring may have. Vertices with more are never removed in decimation; their valence falls as their
/// neighbours go.
constexpr int kMaximumRing = 40;

/// Whether all triangles (p, ring[i], ring[i+1]) are counterclockwise; the last one (p, ring[n-1], ring[0]) only
/// for a closed ring, which then must wind round p once: next to a cone of valence 5 a ring can wind twice. Exact.
bool starIsPositive(const FixedVec2* ring, int count, bool closed, FixedVec2 p);

/// A grid point well inside the kernel of the ring polygon; none when it has none (or none that the clipping in
/// double precision finds).
std::optional<FixedVec2> kernelPoint(const FixedVec2* ring, int count, bool closed);

/// The same on the segment from a to b, both ends excluded. When the segment is parallel to an axis, the result has
/// exactly the same coordinate across it.
std::optional<FixedVec2> kernelPointOnSegment(
  const FixedVec2* ring, int count, bool closed, FixedVec2 a, FixedVec2 b);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Lines of a map that run along an axis of its charts.
#pragma once

#include "Base/FixedPoint.h"
#include "CrossField/CrossField.h"
#include "Integers/UvMesh.h"
#include "Integers/UvRays.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// How far a vector goes along an axis of its chart.
std::int64_t lengthAlong(FixedVec2 p, int axis);

/// Where a line ends that goes straight on through vertices that are not flagged.
struct LineStop
{
  Index vertex = kInvalidIndex; ///< the flagged one, or one on the boundary
  Index curve = kInvalidIndex;  ///< or the half-edge of a curve
  std::int64_t length = 0;      ///< to the vertex
};

/// Along an axis, through straight vertices, until one that is flagged or what ends every line: boundaries and, with
/// stopAtCurves, curves.
LineStop followThrough(const UvMesh& map, UvDirection direction, std::int64_t maximumLength,
  const std::vector<std::uint8_t>& flags, bool stopAtCurves = true);

/// Makes the line an edge, or several, through the vertices on its way. False where it meets something else.
bool lockParts(UvMesh& map, UvEditor& editor, UvDirection direction, std::int64_t length);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Polygons that follow the boundary with few corners.
#pragma once

#include "Extraction/FaceTrace.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace quadrille
{

/// Which stops of a face become corners of its polygon: those that are wanted, one more in each gap between two of them
/// that is named, and others as far as it takes. Ascending; empty where no choice gives a simple polygon.
std::vector<Index> simplePolygon(const std::vector<Stop>& stops, std::vector<std::uint8_t> wanted,
  const std::vector<std::pair<Index, Index>>& gaps = {});

} // namespace quadrille

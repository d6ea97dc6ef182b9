// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Period jumps along lines that a field has to follow. Whether the quads' edges can run along a line, and whether a
/// closed one closes, is a matter of the sum of these jumps only: it has to be the one with which the field keeps its
/// angle to the line's tangent. So they are set, and no quarter turn moves across the line.
#pragma once

#include "CrossField/CrossField.h"
#include "CrossField/FieldTopology.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// Sets the period jumps (#H) of the half-edges that lines cross to those with which the field's axis nearest to the
/// line goes on. Where two lines cross the same edge the earlier one counts; the other makes up for it elsewhere.
/// angle: #F. Returns flags of the topology's edges whose jumps may not change any more; empty without lines.
std::vector<std::uint8_t> holdJumps(const Mesh& mesh, const FieldTopology& topology,
  const std::vector<FieldLine>& lines, const std::vector<double>& angle, std::vector<int>& jump);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Whether curves between patches can have quads along them. Features and boundaries cut a surface into patches, whose
/// sides are their parts between corners. A strip of quads that comes into a patch over one side leaves it over one
/// that runs the other way in the map. Where a patch has irregular vertices, or a loop of its boundary turns, it may
/// leave over any. A side that no strip closes over has no length in any map with these turns, however it is computed.
/// Nor do the equations of patches tell any more, as each side is in two of them at most, with the signs 1 and -1.
///
///     +---<---+        a strip comes in over the side below, which runs along u with the patch on its left,
///     |   :   |        and leaves over the one above, which runs against u
///     +--->---+
///
/// A strip is a cycle of the graph of (patch, direction of the side that was crossed), with one node more for all where
/// it may go on anywhere, and for what is outside. So all of it lies in one strongly connected component.
#pragma once

#include "CrossField/FieldTopology.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille
{

/// A field, and what the choice of other turns goes by.
struct PatchStripsInput
{
  const Mesh& mesh;
  const FieldTopology& topology;
  const std::vector<int>& turns;             ///< per fan
  const std::vector<std::int8_t>& matching;  ///< #H, see CrossField
  const std::vector<std::int8_t>& alignment; ///< #H, see CrossField
  const std::vector<double>& natural;        ///< per fan, see naturalTurns
  double length = 0;                         ///< s
  /// Empty or #H: those that are not 0 stay, see CrossFieldOptions.
  const std::vector<int>& sectorTurns;
};

struct StripTurns
{
  std::size_t without = 0; ///< sides that no strip closes over
  /// #H, as CrossFieldOptions::sectorTurns: turns with which no side is without one; empty where none were found.
  std::vector<int> sectorTurns;
};

/// Quarter turns move from one corner of a patch to another, those first that make the turns of corners least
/// unnatural.
StripTurns stripTurns(const PatchStripsInput& input);

} // namespace quadrille

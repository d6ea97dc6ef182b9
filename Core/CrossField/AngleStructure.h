// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Can triangles carry the turns? A map without inverted triangles gives every corner a positive angle,
/// half a turn per triangle and `turns` quarter turns per fan. Whether such angles exist at all is a
/// transportation problem, solved exactly [Dinic 1970]; where not, its minimum cut shows the place. It finds more than
/// counting corners does: for example a chord whose ends lie on one straight border.
#pragma once

#include "CrossField/FieldTopology.h"

#include <vector>

namespace quadrille
{

struct AngleStructure
{
  bool feasible = true;
  /// #fans flags, disjoint: each group needs one turn less (more) at some of its fans.
  std::vector<std::uint8_t> tooMany;
  std::vector<std::uint8_t> tooFew;
};

AngleStructure findAngleStructure(
  const Mesh& mesh, const FieldTopology& topology, const std::vector<int>& turns);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Defragmentation of charts [Ebke et al. 2016, Section 6.5].
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

struct ChartCounts
{
  std::size_t charts =
    0; ///< parts without a seam between them; components where every edge has a transition
  std::size_t seamEdges = 0; ///< edges whose transition is not the identity
};

/// Carries every face into the chart of its neighbour, breadth first from the lowest face of each component, so that
/// one chart a component is left. What remains of seams is what the breadth-first tree does not cross and that
/// carries a rotation or a translation: paths between irregular vertices, corners and handles, none of which ends at a
/// regular vertex. Transitions change with the charts and stay exact; determinants, turns and isolines stay. Edges
/// whose images no quarter turn joins, or of zero length, are not crossed. uv: #H.
ChartCounts mergeCharts(const Mesh& mesh, std::vector<FixedVec2>& uv);

} // namespace quadrille

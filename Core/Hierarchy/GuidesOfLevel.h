// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Guides on the intermediate level of the hierarchy [Ebke et al. 2016, Section 5.2].
///
/// Where we differ: no phase looks at guides, so that a change of guides repeats none, and no vertex stays for the sake
/// of them. The triangles of the intermediate level, a little above s/2 long, take their guides from the finest level
/// by their barycentres; what falls between them (a stroke along a line of faces) reaches s/4 to each side. Parts of
/// regions that are thinner than 3/4 s to each side lead so far beside them, up to features. Those of the coarse level
/// are means of these, see gatherGuides() in Transfer/SurfaceStretch.h.
#pragma once

#include "Hierarchy/Hierarchy.h"
#include "Mesh/Requests.h"

#include <vector>

namespace quadrille
{

/// Guides of the faces of a level: that of the fine face at the barycentre. Guided fine faces that no triangle near by
/// has taken a guide from give theirs to triangles whose barycentre is within `reach`, those of thin parts within three
/// times that. The direction is rotated with the normal.
/// fineGuides: ascending by face. Empty when no face has one.
std::vector<Guide> guidesOfLevel(const Mesh& fine, const Level& level,
  const std::vector<FaceGuide>& fineGuides, double reach, int threads);

} // namespace quadrille

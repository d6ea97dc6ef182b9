// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is asked for at points and along paths of a surface, asked of one of the parts that an isometry makes it of.
#pragma once

#include "Symmetry/PartRequests.h"

#include <string>
#include <vector>

namespace quadrille
{

/// The requests of the part, and the images of those of the others: lines are cut where they leave a part. Where both
/// guide one place the part's own one is followed. A place that is its own image has a share of the quads asked for; a
/// number that cannot be shared is not asked. About a mirror plane with regularElsewhere valences behind it are asked
/// only where there are none in front. Adds what the user should know to notices.
DrawnRequests drawnOfPart(const PartTask& task, const SurfacePart& part, const DrawnRequests& drawn,
  std::vector<std::string>& notices);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/AskedValues.h"

#include "Base/Refuse.h"
#include "Requests/Guides.h"

#include <cmath>

namespace quadrille
{

void requireDirection(std::int64_t cell, const Vector3& direction)
{
  if (!direction.allFinite())
  {
    refuse("cell ", cell,
      " has a GuidingDirection that is not finite; correct it, or set it to zero to leave the cell "
      "free");
  }
}

void requireGuideWeight(std::int64_t cell, double weight)
{
  if (!(weight > 0 && weight <= 1))
  {
    refuse("cell ", cell, " has the GuidingWeight ", weight,
      ", but it must be above 0 and at most 1; set the direction to zero to leave the cell free");
  }
}

void requireValence(std::int64_t point, const Vector3& place, double valence)
{
  if (valence != 0 && !(valence >= kLeastValence && valence <= kMostValence))
  {
    refuse("point ", point, " at (", place.x(), ", ", place.y(), ", ", place.z(),
      ") has the TargetValence ", valence, ", but only 0 (free) and ", kLeastValence, " to ",
      kMostValence, " can be asked for");
  }
}

float requireSize(std::int64_t point, double size)
{
  const auto single = static_cast<float>(size);
  // Written so that NaN is refused as well, and what is 0 or infinite as a float.
  if (!(single > 0) || !std::isfinite(single))
  {
    refuse("point ", point, " has the Sizing ", size,
      ", but it must be positive and finite: 1 leaves the quads there as they are, 0.5 makes "
      "their edges half as long");
  }
  return single;
}

} // namespace quadrille

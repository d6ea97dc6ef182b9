// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/AskedValues.h"

#include "Base/InvalidElement.h"
#include "Requests/Guides.h"

#include <cmath>
#include <sstream>

namespace quadrille
{

namespace
{

/// The parts one after the other, after the name of the element.
template <class... Parts>
[[noreturn]] void refuseAt(InvalidElement::Kind kind, std::int64_t id, const Parts&... parts)
{
  std::ostringstream text;
  text << (kind == InvalidElement::Kind::Point ? "point " : "cell ") << id;
  (text << ... << parts);
  throw InvalidElement(text.str(), kind, id);
}

} // namespace

void requireDirection(std::int64_t cell, const Vector3& direction)
{
  if (!direction.allFinite())
  {
    refuseAt(InvalidElement::Kind::Cell, cell,
      " has a GuidingDirection that is not finite; correct it, or set it to zero to leave the cell "
      "free");
  }
}

void requireGuideWeight(std::int64_t cell, double weight)
{
  if (!(weight > 0 && weight <= 1))
  {
    refuseAt(InvalidElement::Kind::Cell, cell, " has the GuidingWeight ", weight,
      ", but it must be above 0 and at most 1; set the direction to zero to leave the cell free");
  }
}

void requireValence(std::int64_t point, const Vector3& place, double valence)
{
  if (valence != 0 && !(valence >= kLeastValence && valence <= kMostValence))
  {
    refuseAt(InvalidElement::Kind::Point, point, " at (", place.x(), ", ", place.y(), ", ",
      place.z(), ") has the TargetValence ", valence, ", but only 0 (free) and ", kLeastValence,
      " to ", kMostValence, " can be asked for");
  }
}

float requireSize(std::int64_t point, double size)
{
  const auto single = static_cast<float>(size);
  // Written so that NaN is refused as well, and what is 0 or infinite as a float.
  if (!(single > 0) || !std::isfinite(single))
  {
    refuseAt(InvalidElement::Kind::Point, point, " has the Sizing ", size,
      ", but it must be positive and finite: 1 leaves the quads there as they are, 0.5 makes "
      "their edges half as long");
  }
  return single;
}

} // namespace quadrille

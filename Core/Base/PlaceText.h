// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How messages name a place.
#pragma once

#include "Base/Types.h"

#include <sstream>
#include <string>

namespace quadrille
{

/// "(x, y, z)"
inline std::string placeText(const Vector3& p)
{
  std::ostringstream text;
  text << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
  return text.str();
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Refusing input in a sentence made of parts.
#pragma once

#include "Base/Error.h"

#include <sstream>

namespace quadrille
{

/// Throws InvalidInput with the parts one after the other, each as a stream writes it.
template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts)
{
  std::ostringstream text;
  (text << ... << parts);
  throw InvalidInput(text.str());
}

/// The same where the condition holds. The parts are asked for in any case: they must exist, and cost nothing.
template <class... Parts>
void refuseIf(bool condition, const Parts&... parts)
{
  if (condition)
  {
    refuse(parts...);
  }
}

} // namespace quadrille

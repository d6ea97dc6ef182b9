// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Progress and cancel are one callback.
#pragma once

#include "Base/Error.h"

#include <functional>
#include <string>

namespace quadrille
{

/// Called by a stage on the caller's thread with its own fraction in [0, 1] and a short text.
/// Returning false asks the stage to stop.
using ProgressCallback = std::function<bool(double fraction, const std::string& text)>;

/// Reports progress; throws Cancelled when the callback returns false. An empty callback never
/// cancels.
inline void report(const ProgressCallback& callback, double fraction, const std::string& text)
{
  if (callback && !callback(fraction, text))
  {
    throw Cancelled();
  }
}

} // namespace quadrille

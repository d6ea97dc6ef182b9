// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/ProgressPart.h"

#include <algorithm>

namespace quadrille
{

ProgressCallback progressPart(
  const ProgressCallback& progress, double begin, double end, const std::string& prefix)
{
  if (!progress)
  {
    return {};
  }
  return [=](double fraction, const std::string& text)
  { return progress(begin + (end - begin) * std::clamp(fraction, 0.0, 1.0), prefix + text); };
}

} // namespace quadrille

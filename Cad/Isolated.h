// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Work on data that may be damaged, in a process of its own. Only the sources of Cad include this.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace quadrille
{

/// What work() returns, which runs in a child process. What it throws (a std::exception) becomes InvalidInput with the
/// same text; where the process ends by a signal, or takes longer than so many seconds, InvalidInput says so and begins
/// with `what`. Open CASCADE ends, or never ends, on some damaged files, and no handler can mend that afterwards.
std::vector<std::uint8_t> isolated(
  const std::string& what, double seconds, const std::function<std::vector<std::uint8_t>()>& work);

} // namespace quadrille

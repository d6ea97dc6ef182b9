// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Calls of Open CASCADE: its failures and what it tells. Only the sources of Cad include this.
#pragma once

#include <functional>
#include <mutex>
#include <string>

namespace quadrille
{

/// Calls work(), one caller at a time: settings and messages of Open CASCADE are those of the process. A
/// Standard_Failure becomes InvalidInput. what: begins the message. Returns what Open CASCADE told of failures, one a
/// line.
std::string guarded(const std::string& what, const std::function<void()>& work);

/// What guarded() locks. A process is started under it, so that nobody else is in Open CASCADE there.
std::mutex& occtMutex();

} // namespace quadrille

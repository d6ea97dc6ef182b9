// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What goes into a session and comes out of it as JSON, for callers that do not speak C++. SessionJson.h says what is
/// in constraints and settings. What is read is checked, InvalidInput names what is wrong.
#pragma once

#include "Session/Session.h"

#include <string>

namespace quadrille
{

/// text: one constraint, without id.
ConstraintContent contentFromText(const std::string& text);
/// Changes what the text names; "threads" and "memory_limit" (bytes; null: none) may be among it.
void settingsFromText(const std::string& text, RemeshOptions& settings);
std::string settingsText(const RemeshOptions& settings);
/// The same of a session, with its threads and its limit of memory.
void changeSettings(Session& session, const std::string& text);

/// A list of the constraints with "id" and "revision"; what the session has made of irregular operations is left out.
std::string constraintsText(const Session& session);
/// {"ok", "status", "message", "stages": {name: seconds}, "reused", "runs", "seconds", "notices",
/// "constraints": [{"id", "kind", "text", "place", "met", "deviation", "deviation_95", "unit", "reason", "remark"}]};
/// null is what could not be measured.
std::string reportText(const SessionReport& report);
/// {"settings", "only_first", "only_second", "changed", "results": null or {"quads", "irregular": two each, "distance",
/// "unmatched"}}.
std::string comparisonText(const StateComparison& comparison);

} // namespace quadrille

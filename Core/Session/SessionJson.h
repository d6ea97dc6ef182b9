// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Constraints and settings as JSON, in which numbers keep every bit. The same for files, and for callers that do not
/// speak C++. What is read is checked: an unknown key, a missing one or a value of another kind is an InvalidInput that
/// names it.
///
/// A constraint: {"kind": see kindOf, and "points", "point", "polygons", "direction", "weight", "radius", "valence",
/// "factor", "operation" ("move", "split", "merge", "cancel", "add"), "valences", as its struct has them; what has a
/// default may be left out}. Settings: the options of a run that are the user's, see settingsToJson.
#pragma once

#include "Pipeline/Options.h"
#include "Session/Session.h"

#include <nlohmann/json.hpp>

#include <string>

namespace quadrille
{

using SessionJson = nlohmann::ordered_json;

SessionJson contentToJson(const ConstraintContent& content);
/// where: for messages, such as "constraint 3".
ConstraintContent contentFromJson(const SessionJson& json, const std::string& where);

/// With "id" and "revision", and of irregular operations what the session has made of them.
SessionJson constraintToJson(const SessionConstraint& constraint);
SessionConstraint constraintFromJson(const SessionJson& json, const std::string& where);

/// "quads" or "edge_length" or "relative_edge_length", "feature_angle" (radians; null: none),
/// "feature_criterion", "method", and so on, by
/// the names of Python's remesh(). Without threads, limits of memory and what only displays need.
SessionJson settingsToJson(const RemeshOptions& options);
/// Changes what the object names; a size takes the place of another one.
void settingsFromJson(const SessionJson& json, RemeshOptions& options, const std::string& where);

/// Throws InvalidInput, with where and the place in the text, for what is no JSON.
SessionJson parseJson(const std::string& text, const std::string& where);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What was changed about the user's surface, in sentences.
#pragma once

#include "Mesh/Surface.h"

#include <string>
#include <vector>

namespace quadrille
{

/// One sentence for each kind of change that was made, with its count, what it means for the quads and, where there is
/// something to do, what.
/// Empty when nothing changed.
std::vector<std::string> repairSentences(const RepairReport& report);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the Help menu opens: surfaces that lie beside the plugin, and what can be made of them.
#pragma once

#include <QString>

#include <cstddef>
#include <vector>

class pqPipelineSource;

namespace quadrille
{

std::vector<QString> exampleNames();

/// Opens the one of this number: its surface, a Quad Remesh with what it shows, and what follows that. As with a
/// state of ParaView that is loaded, there is nothing to undo afterwards.
void openExample(std::size_t number);

/// Opens the scan that the tutorial draws on, seen from its side. Null, with a word to the user, where its file is
/// not found.
pqPipelineSource* openScan();

} // namespace quadrille

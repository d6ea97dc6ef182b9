// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Thickness and axes of elements in a deck, see InpWriter.h.
#pragma once

#include "Export/InpWriter.h"
#include "Export/OutputFile.h"

namespace quadrille
{

/// Numbers in a line of a deck, at most 16; `first` and the ids count from 0.
void writeInpIds(OutputFile& file, const std::vector<Index>& ids);

/// Nothing where the mesh has neither. Returns what the user should know.
std::vector<std::string> writeInpSections(
  const ElementMesh& mesh, bool areShells, const InpOptions& options, OutputFile& file);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// From cell corners to the quad mesh: quads, points with their place on the input, feature lines.
#pragma once

#include "Extraction/Extraction.h"
#include "Extraction/GridTracing.h"
#include "Extraction/GridVertices.h"

namespace quadrille
{

struct AssemblyOptions
{
  bool folded = false; ///< the cells were traced as those of a map with folds
  int threads = 0;
};

/// Fills points, quads, sources and lines of the result's mesh, and the counts. Valence and
/// onBoundary are left to the topology check. Returns the point of each grid vertex; kInvalidIndex
/// where no quad has it.
std::vector<Index> assembleQuads(const ExactMap& map, const GridVertices& grid,
  const CellCorners& cells, const AssemblyOptions& options, ExtractionResult& result);

} // namespace quadrille

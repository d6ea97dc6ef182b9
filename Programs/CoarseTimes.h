// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How long field and map of the coarse level take.
#pragma once

#include "Base/Types.h"
#include "GridMap/GridMap.h"

#include <string>

namespace quadrille
{

struct CoarseTiming
{
  double quads = 2500;
  Index coarseVertices = 1000;
  MapMethod method = MapMethod::ScaleAware;
  long long repeat = 1;
};

/// Writes the header of printCoarse() to standard output.
void printCoarseHeader();
/// Makes the coarse level of the mesh and times its field and map, then again after each of three small edits, cold and
/// starting from the map before the edit. Writes, for each, a row of medians for the clock on the wall and one for the
/// processor's to standard output, as CSV. Throws as prepareMeshFile() does.
void printCoarse(const std::string& path, const CoarseTiming& request);

} // namespace quadrille

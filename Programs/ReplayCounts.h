// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the replay does to the triangles of a model.
#pragma once

#include <string>

namespace quadrille
{

/// Writes the header of printReplay() to standard output.
void printReplayHeader();
/// Remeshes the mesh and writes the counts of its last replay as a row of CSV, also where no quads come of it. Throws
/// as readMeshFile() and remesh() do.
void printReplay(const std::string& path, double quads, int threads);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Irregular vertices with and without decimation.
#pragma once

#include <string>

namespace quadrille
{

/// Writes the header of printFieldCounts() to standard output.
void printFieldCountsHeader();
/// Computes the cross field on all of the surface, remeshes the mesh and writes the irregular vertices of both as a row
/// of CSV. Throws as readMeshFile() and remesh() do, and InvalidInput where the refined surface has more than 500,000
/// faces.
void printFieldCounts(const std::string& path, double quads, int threads);

} // namespace quadrille

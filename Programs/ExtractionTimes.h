// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Times of the extraction of quads.
#pragma once

#include <string>

namespace quadrille
{

struct ExtractionTiming
{
  double quads = 5000;
  int threads = 0;   ///< beside one; 0: all
  int subdivide = 0; ///< times that each triangle of the mapped surface is cut into four
  long long repeat = 1;
};

/// Writes the header of printExtraction() to standard output.
void printExtractionHeader();
/// Remeshes the mesh and extracts the quads of its map, and of the map scaled by whole factors, by every path; writes
/// medians in seconds to standard output, as CSV. Returns false where the mesh gives no quads. Throws as readMeshFile()
/// and remesh() do.
bool printExtraction(const std::string& path, const ExtractionTiming& request);

} // namespace quadrille

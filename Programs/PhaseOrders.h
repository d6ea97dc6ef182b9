// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The orders of phase 1 against each other.
#pragma once

#include "Hierarchy/Hierarchy.h"
#include "Mesh/Surface.h"

#include <string>

namespace quadrille
{

/// A mesh file as phase 1 gets it, with the edge length for this number of quads. Throws as readMeshFile() and
/// prepareSurface() do.
PreparedSurface prepareMeshFile(const std::string& path, double quads, double& edgeLength);

struct OrderComparison
{
  double quads = 5000;
  int threads = 0; ///< of the sweeps; 0: all
  long long repeat = 1;
  RandomDraws draws;
};

/// Writes the header of printOrders() to standard output.
void printOrdersHeader();
/// Runs phase 1 on the mesh in every order and writes a row for each to standard output, as CSV.
void printOrders(const std::string& path, const OrderComparison& request);

} // namespace quadrille

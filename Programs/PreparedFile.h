// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Surfaces of files as the stages get them.
#pragma once

#include "Mesh/Surface.h"

#include <string>

namespace quadrille
{

/// A mesh file as phase 1 gets it, with the edge length for this number of quads. Throws as readMeshFile() and
/// prepareSurface() do.
PreparedSurface prepareMeshFile(const std::string& path, double quads, double& edgeLength);

} // namespace quadrille

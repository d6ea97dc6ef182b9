// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Surfaces that are made of the faces of cells: the outside of the voxels above a threshold, a label of a volume.
#pragma once

#include "Mesh/Mesh.h"

namespace quadrille
{

/// Whether all edges of the surface are a few vectors, each of them many times, as those of the faces of equal cells
/// are, in whatever direction these lie. Of surfaces of another kind it looks at a few dozen edges.
bool isMadeOfCells(const Mesh& mesh);

} // namespace quadrille

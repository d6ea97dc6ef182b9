// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A vertex of a map in the plane goes where all triangles round it are positive.
#pragma once

#include "Integers/UvMesh.h"

namespace quadrille
{

/// Moves the vertex at `corner` well inside the kernel of its star, if it has one: a vertex on an isoline or on the
/// boundary along that, up to its neighbours there. The vertex is none that has to lie at a whole point, so the star
/// makes a full turn round it, or half of one on the boundary. False, and nothing is moved, where there is no kernel,
/// or where the star touches itself. Looks for the star by twins alone, as `outgoing` is not kept where operations
/// are undone.
bool moveIntoKernel(UvMesh& mesh, Index corner);

} // namespace quadrille

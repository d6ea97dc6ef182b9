// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Better quads of a face: local changes of the connectivity that bring the number of quads at points nearer to what
/// fits there, and smoothing.
#pragma once

#include "Filling/QuadRelaxation.h"

namespace quadrille
{

/// Pins stay where they are, all other points on the face. The quads must be a manifold and remain one; points that
/// are of no use any more have no quads.
void cleanUpQuads(FaceQuads& mesh, const FaceGround& ground);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads that a face has by itself, made to meet those beside it: along its boundary they get as many edges as the
/// pins ask for, by strips of quads that are put in, and others that are taken out.
#pragma once

#include "Filling/QuadRelaxation.h"
#include "Quads/QuadMesh.h"

#include <optional>
#include <vector>

namespace quadrille
{

/// own: quads of the face whose boundary points lie on its boundary, loop by loop; of points and quads alone. Where one
/// of these points in a corner of the quads, with other than two of them, lies at a pin, it becomes that pin; between
/// two such pins there will be as many edges as the pins make. pins: as FaceGround has them, in the order that the
/// points of the result begin with.
/// None where no strips do so.
std::optional<FaceQuads> fitBoundary(
  QuadMesh own, const Mesh& face, const FaceGround& ground, const std::vector<Index>& pins);

} // namespace quadrille

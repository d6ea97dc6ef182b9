// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The quads of a face while they are made better, and the relaxation of the points inside.
#pragma once

#include "Filling/FaceGround.h"

#include <array>
#include <vector>

namespace quadrille
{

struct FaceQuads
{
  std::vector<Vector3> points;  ///< pins first
  std::vector<Vector3> normals; ///< per point: of the face there
  std::vector<double> fitting;  ///< per point: quads that fit there, 4 for those inside
  Index pinCount = 0;
  std::vector<std::array<Index, 4>> quads;
};

/// Of one quad, with respect to the face below it; see quadShape.
double shapeOfQuad(const FaceQuads& mesh, const std::array<Index, 4>& quad);

/// Moves points inside towards the mean of their neighbours, on the face, where the worst shape at them does not fall
/// below what is sound, or below what it is; and those that have a bad one to where the worst is best.
void relaxQuads(FaceQuads& mesh, const FaceGround& ground, int sweeps);

} // namespace quadrille

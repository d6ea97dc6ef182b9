// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Curvature over a distance, so that noise below it does not count: sums over edges of bend times length
/// [Cohen-Steiner and Morvan 2003], gathered in patches of the surface and averaged over the patches near by.
#pragma once

#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

/// A connected part of the surface in one cell of a grid; features end it.
struct SurfacePatch
{
  Vector3 centre = Vector3::Zero(); ///< of the area
  Vector3 normal = Vector3::Zero(); ///< mean, a unit vector; zero where there is none
  double area = 0;
  Index face = kInvalidIndex; ///< one of its faces, the one nearest to the centre
};

/// The patches of a surface, and which touch each other.
struct SurfacePatches
{
  std::vector<SurfacePatch> patches;
  std::vector<Index> patchOf; ///< #F
  std::vector<Index> first;   ///< #patches + 1 offsets into neighbours
  std::vector<Index> neighbours;

  /// The patches whose centre is within `radius` of that of p, reached over such ones; p comes first.
  void gather(Index p, double radius, std::vector<Index>& near) const;
};

/// cell: side of the grid's cells, in units of the mesh, > 0; half the radius over which curvatures are averaged. Large
/// faces are patches of their own. Throws InvalidInput unless cell is positive and finite. The result does not depend
/// on the number of threads.
SurfacePatches findPatches(const Mesh& mesh, double cell, int threads);

/// Of a patch and those round it.
struct PatchCurvature
{
  double largest = 0;  ///< principal curvature of the larger absolute value, > 0 where convex
  double smallest = 0; ///< the other one
  Vector3 direction =
    Vector3::Zero(); ///< unit vector in the surface along which it is `largest`; zero in a plane
  double curve = 0;  ///< of the features and boundaries in the patch, >= 0; their corners aside

  /// |k1 - k2| / (|k1| + |k2|); 0 in a plane.
  double anisotropy() const;
};

/// Curvatures averaged over patches within `radius` of each patch's centre, not across features. #patches.
std::vector<PatchCurvature> patchCurvatures(
  const Mesh& mesh, const SurfacePatches& patches, double radius, int threads);

/// The same of one place: over the faces whose middle is within `radius` of that of `face`, reached over such ones and
/// not across features; curves aside.
PatchCurvature curvatureRound(const Mesh& mesh, Index face, double radius);

} // namespace quadrille

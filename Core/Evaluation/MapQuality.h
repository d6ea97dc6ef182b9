// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sizing, anisotropy and shear of a map, face by face [Ebke et al. 2016, Section 8].
#pragma once

#include "Base/FixedPoint.h"
#include "Evaluation/Distribution.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

/// Of the linear map g of a face from the parameter domain, whose unit is a quad, to the surface; where the surface
/// asks for sizes, lengths on it are over them.
struct FaceMapQuality
{
  /// det(grad g) / s^2: the area of a quad there over that of a square of edge length s; 1 is wanted. Negative where
  /// the face is inverted.
  double sizing = 0;
  /// The larger singular value of grad g over the smaller one, >= 1; 1 where the map keeps angles.
  double anisotropy = 0;
  /// The arc sine of the scaled Jacobian of g, that is the angle between the isolines where it is at most a right one,
  /// else what it lacks to two right ones; radians in [-pi/2, pi/2], negative where the face is inverted.
  double shear = 0;
};

struct MapQuality
{
  std::vector<FaceMapQuality> faces; ///< #F; zeros for faces that are not counted
  std::vector<double> areas;         ///< #F; over the sizes; 0 for faces that are not counted
  WeightedDistribution sizing, anisotropy, shear; ///< over the areas, upright faces only
  std::size_t inverted = 0;                       ///< faces with an area and a negative determinant
  std::size_t degenerate = 0; ///< faces without an area on the surface or in the map
};

/// uv: #H. edgeLength: s > 0, in units of the mesh. Throws InvalidInput where sizes disagree or s is no such number.
MapQuality measureMapQuality(const Mesh& mesh, const std::vector<FixedVec2>& uv, double edgeLength);

/// #V: the quarter turns of the map round each inner vertex, its valence; round a boundary vertex those of a regular
/// one (2), as a boundary off the axes has no whole number of them. Exact where the images of edges agree up to quarter
/// turns. uv: #H. Throws InvalidInput where sizes disagree.
std::vector<int> turnsOfMap(const Mesh& mesh, const std::vector<FixedVec2>& uv);

/// Edges of the kQualityBins bins in which the three measures are drawn and compared: sizing from 1/4 to 4 in equal
/// ratios, anisotropy from 1 to 4.6 and shear from 0 to a right angle in equal steps. The paper does not give its own.
constexpr int kQualityBins = 36;
std::vector<double> sizingBins();
std::vector<double> anisotropyBins();
std::vector<double> shearBins();

/// Means are over the area of the triangles with a positive determinant and an area. With the singular values a, b of
/// the Jacobian:
struct MapDistortion
{
  double mean =
    0; ///< of (a^2 + b^2 + 1/a^2 + 1/b^2) / 4, the symmetric Dirichlet energy; 1 for an isometry
  double median =
    0; ///< of the same, over the area; and where nine tenths and 99 hundredths of the area lie below
  double p90 = 0;
  double p99 = 0;
  double angle = 0;     ///< mean of (a/b + b/a) / 2; 1 where the map keeps angles
  double size = 0;      ///< mean of |log2(a b)|; 0 where the map keeps areas
  std::size_t left = 0; ///< triangles that are not counted
};

/// uv: #H. The scale is that of the whole mapped area. Throws InvalidInput when sizes disagree.
MapDistortion measureDistortion(const Mesh& mesh, const std::vector<FixedVec2>& uv);

} // namespace quadrille

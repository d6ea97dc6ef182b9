// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Samples of a surface, for searches of symmetries.
#pragma once

#include "Mesh/NearestTriangle.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

struct SurfaceSample
{
  Vector3 point;
  Vector3 normal; ///< unit
};

struct SurfaceSampling
{
  std::vector<SurfaceSample> samples;                 ///< each of the same area
  Vector3 centre = Vector3::Zero();                   ///< of area
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< of inertia, columns, the longest first
  double size = 0;                                    ///< diagonal of the box
};

/// Half the cross product of two edges.
Vector3 areaVectorOf(const TriangleList& list, std::size_t t);

/// At equal steps of the area, in order of the triangles; places in triangles by the sequence R2 [Roberts 2018].
std::vector<SurfaceSample> sampleByArea(const TriangleList& list, std::size_t count);

SurfaceSampling sampleSurface(const TriangleList& list, std::size_t count);

/// Every so manyth triangle, so that about 50,000 stand for the surface.
TriangleList thinnedOut(const TriangleList& list);

/// Root of the mean square, and median, of the distances.
double rmsOf(const std::vector<NearestTriangle::Place>& places);
double medianOf(const std::vector<NearestTriangle::Place>& places);

/// Unit vectors: the axes, others between two of them, as where two moments are equal any could be the one asked for,
/// and some all round.
std::vector<Vector3> candidateDirections(const SurfaceSampling& sampling);

/// Of the two directions of a line the one whose first component that is not small is positive.
Vector3 withSign(const Vector3& direction);

} // namespace quadrille

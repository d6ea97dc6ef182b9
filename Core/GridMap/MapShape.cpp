// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/MapShape.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// Least height of a reference over its longest edge: the references of needles, or of triangles without
/// area, stay invertible.
constexpr double kLeastHeight = 1e-2;

/// The edges [p1 - p0, p2 - p0] of face f in a plane whose first axis is half-edge 3f.
Eigen::Matrix2d flatten(const Mesh& mesh, Index f)
{
  const Vector3 a = mesh.edgeVector(3 * f);
  const Vector3 b = -mesh.edgeVector(3 * f + 2);
  const double longest = std::max({ a.norm(), b.norm(), (b - a).norm() });
  const double width = std::max(a.norm(), kLeastHeight * longest);
  const double along = a.norm() > 0 ? a.dot(b) / a.norm() : 0;
  const double height = std::max(a.cross(b).norm() / width, kLeastHeight * longest);
  Eigen::Matrix2d result;
  result << width, along, 0, height;
  return result;
}

} // namespace

void addTriangle(UntangleProblem& problem, const std::array<Index, 3>& points, const Mesh& mesh,
  const CrossField& field, Index f, int quarterTurns, double edgeLength)
{
  const double turn = quarterTurns * std::acos(0.0) - field.angle[f];
  const Eigen::Matrix2d reference =
    Eigen::Rotation2Dd(turn).toRotationMatrix() * flatten(mesh, f) / edgeLength;
  problem.triangles.push_back(points);
  problem.inverseReference.push_back(reference.inverse());
  problem.weight.push_back(reference.determinant() / 2);
}

} // namespace quadrille

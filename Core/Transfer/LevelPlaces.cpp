// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/LevelPlaces.h"

#include "Numerics/IsotropicEnergy.h"
#include "Transfer/RingKernel.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace quadrille
{
namespace
{

/// Newton steps of a vertex that has come back, and of those round it.
constexpr int kStepsOfVertex = 4;
constexpr int kStepsOfRing = 2;

/// Of the star of a vertex.
struct StarTriangle
{
  Vector2 next, previous; ///< in the own chart of the vertex
  Eigen::Matrix2d inverse;
  double weight = 0;
};

Jacobian jacobianOf(const StarTriangle& t, const Vector2& x)
{
  Eigen::Matrix2d edges;
  edges << t.next - x, t.previous - x;
  const Eigen::Matrix2d j = edges * t.inverse;
  return Jacobian(j(0, 0), j(1, 0), j(0, 1), j(1, 1));
}

/// Symmetric Dirichlet energy; infinite where one is not positive.
double energyOf(const std::vector<StarTriangle>& triangles, const Vector2& x)
{
  double sum = 0;
  for (const StarTriangle& t : triangles)
  {
    const Jacobian j = jacobianOf(t, x);
    const double d = determinantOf(j);
    if (!(d > 0))
    {
      return std::numeric_limits<double>::infinity();
    }
    sum += t.weight * j.squaredNorm() * (1 + 1 / (d * d));
  }
  return sum;
}

/// Adds the derivatives of the energy.
void derive(const std::vector<StarTriangle>& triangles, const Vector2& x, Vector2& gradient,
  Eigen::Matrix2d& hessian)
{
  for (const StarTriangle& t : triangles)
  {
    const Jacobian j = jacobianOf(t, x);
    const double d = determinantOf(j), f = j.squaredNorm();
    Jacobian g;
    Eigen::Matrix4d h;
    deriveByJacobian(j,
      { 1 + 1 / (d * d), -2 * f / (d * d * d), -2 / (d * d * d), 6 * f / (d * d * d * d), 0 }, g,
      h);
    // Columns of J move by -(row sums of the inverse) times x.
    const double a = -(t.inverse(0, 0) + t.inverse(1, 0)), b = -(t.inverse(0, 1) + t.inverse(1, 1));
    Eigen::Matrix<double, 4, 2> by;
    by << a, 0, 0, a, b, 0, 0, b;
    gradient += t.weight * by.transpose() * g;
    hessian += t.weight * by.transpose() * h * by;
  }
}

} // namespace

/// Into the kernel of its ring; on a curve between its neighbours there.
bool LevelPlaces::place(Index v)
{
  const std::vector<Index> corners = mesh_.cornersAround(v);
  const bool closed = mesh_.isClosed(v);
  std::vector<FixedVec2> ring;
  ring.reserve(corners.size() + 1);
  for (const Index c : corners)
  {
    ring.push_back(mesh_.toOwn(c, mesh_.image(Mesh::next(c))));
  }
  if (!closed)
  {
    ring.push_back(mesh_.toOwn(corners.back(), mesh_.image(Mesh::previous(corners.back()))));
  }
  const int count = static_cast<int>(ring.size());
  std::optional<FixedVec2> p;
  if (mesh_.vertex(v).freedom == PatchFreedom::Plane)
  {
    p = kernelPoint(ring.data(), count, closed);
  }
  else
  {
    std::vector<FixedVec2> ends;
    for (const Index c : corners)
    {
      if (mesh_.isConstrained(c))
      {
        ends.push_back(mesh_.toOwn(c, mesh_.image(Mesh::next(c))));
      }
    }
    if (!closed)
    {
      ends.push_back(ring.back());
    }
    if (ends.size() == 2)
    {
      p = kernelPointOnSegment(ring.data(), count, closed, ends[0], ends[1]);
    }
  }
  if (p)
  {
    mesh_.setPlace(v, *p);
  }
  return p.has_value();
}

/// Newton steps of one vertex on the symmetric Dirichlet energy of its star, which stays positive.
void LevelPlaces::relax(Index v, int steps)
{
  const LevelMesh::Vertex& vertex = mesh_.vertex(v);
  if (vertex.freedom == PatchFreedom::Fixed)
  {
    return;
  }
  const std::vector<Index> corners = mesh_.cornersAround(v);
  std::vector<StarTriangle> triangles;
  const FixedVec2 base = vertex.place;
  for (const Index c : corners)
  {
    const Vector3 ab = mesh_.vertex(mesh_.target(c)).position - vertex.position;
    const Vector3 ac = mesh_.vertex(mesh_.origin(Mesh::previous(c))).position - vertex.position;
    StarTriangle triangle;
    triangle.inverse = inverseOfTriangle(scale_ * ab, scale_ * ac);
    triangle.next = toDouble(mesh_.toOwn(c, mesh_.image(Mesh::next(c))) - base);
    triangle.previous = toDouble(mesh_.toOwn(c, mesh_.image(Mesh::previous(c))) - base);
    triangle.weight = 0.5 / std::abs(triangle.inverse.determinant());
    triangles.push_back(triangle);
  }
  Vector2 x(0, 0);
  for (int step = 0; step < steps; ++step)
  {
    work_ += triangles.size();
    Vector2 gradient(0, 0);
    Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
    const double before = energyOf(triangles, x);
    if (!std::isfinite(before))
    {
      return;
    }
    derive(triangles, x, gradient, hessian);
    Vector2 direction = Vector2::Zero();
    if (vertex.freedom == PatchFreedom::Plane)
    {
      direction = -hessian.inverse() * gradient;
    }
    else
    {
      const int axis = vertex.freedom == PatchFreedom::AlongU ? 0 : 1;
      direction[axis] = -gradient[axis] / hessian(axis, axis);
    }
    if (!direction.allFinite())
    {
      return;
    }
    bool moved = false;
    for (double length = 1; length > 1e-3 && !moved; length *= 0.5)
    {
      const Vector2 trial = x + length * direction;
      if (energyOf(triangles, trial) < before)
      {
        const FixedVec2 old = vertex.place;
        mesh_.setPlace(v, base + toFixed(trial));
        moved = std::all_of(
          corners.begin(), corners.end(), [&](Index c) { return mesh_.isPositive(Mesh::face(c)); });
        if (moved)
        {
          x = toDouble(vertex.place - base);
        }
        else
        {
          mesh_.setPlace(v, old);
        }
      }
    }
    if (!moved)
    {
      return;
    }
  }
}

bool LevelPlaces::putBack(Index v)
{
  if (!place(v))
  {
    return false;
  }
  relax(v, kStepsOfVertex);
  for (const Index w : mesh_.neighbours(v))
  {
    relax(w, kStepsOfRing);
  }
  return true;
}

} // namespace quadrille

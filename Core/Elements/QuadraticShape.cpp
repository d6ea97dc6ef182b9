// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Elements/QuadraticShape.h"

#include "Quads/QuadShape.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

const std::array<Vector2, 9> kNodePlaces{ Vector2{ -1, -1 }, Vector2{ 1, -1 }, Vector2{ 1, 1 },
  Vector2{ -1, 1 }, Vector2{ 0, -1 }, Vector2{ 1, 0 }, Vector2{ 0, 1 }, Vector2{ -1, 0 },
  Vector2{ 0, 0 } };

using ShapeDerivatives = std::array<std::array<double, 9>, 2>;

/// A quadratic function on [-1, 1] that is 1 at the node -1, 0 or 1 and 0 at the others: value and derivative.
std::array<double, 2> lagrange(double node, double x)
{
  if (node == 0)
  {
    return { 1 - x * x, -2 * x };
  }
  return { x * (x + node) / 2, x + node / 2 };
}

ShapeDerivatives ofLagrange(const Vector2& p)
{
  ShapeDerivatives result{};
  for (std::size_t i = 0; i < 9; ++i)
  {
    const auto [u, du] = lagrange(kNodePlaces[i].x(), p.x());
    const auto [v, dv] = lagrange(kNodePlaces[i].y(), p.y());
    result[0][i] = du * v;
    result[1][i] = u * dv;
  }
  return result;
}

ShapeDerivatives ofSerendipity(const Vector2& p)
{
  ShapeDerivatives result{};
  const double x = p.x(), y = p.y();
  for (std::size_t i = 0; i < 8; ++i)
  {
    const double a = kNodePlaces[i].x(), b = kNodePlaces[i].y();
    if (i < 4) // (1 + a x) (1 + b y) (a x + b y - 1) / 4
    {
      result[0][i] = a * (1 + b * y) * (2 * a * x + b * y) / 4;
      result[1][i] = b * (1 + a * x) * (a * x + 2 * b * y) / 4;
    }
    else if (a == 0) // (1 - x^2) (1 + b y) / 2
    {
      result[0][i] = -x * (1 + b * y);
      result[1][i] = (1 - x * x) * b / 2;
    }
    else // (1 + a x) (1 - y^2) / 2
    {
      result[0][i] = a * (1 - y * y) / 2;
      result[1][i] = -y * (1 + a * x);
    }
  }
  return result;
}

} // namespace

std::vector<Vector2> jacobianPlaces(int nodes)
{
  std::vector<Vector2> places(kNodePlaces.begin(), kNodePlaces.begin() + nodes);
  const double g = std::sqrt(0.6);
  for (const double y : { -g, 0.0, g })
  {
    for (const double x : { -g, 0.0, g })
    {
      places.emplace_back(x, y);
    }
  }
  return places;
}

std::array<std::array<double, 9>, 2> shapeDerivatives(int nodes, const Vector2& place)
{
  return nodes == 9 ? ofLagrange(place) : ofSerendipity(place);
}

QuadraticShape::QuadraticShape(int nodes)
{
  for (const Vector2& place : jacobianPlaces(nodes))
  {
    derivatives_.push_back(shapeDerivatives(nodes, place));
  }
}

double QuadraticShape::leastDeterminant(const QuadraticNodes& x) const
{
  const Vector3 area = centreNormal({ x[0], x[1], x[2], x[3] });
  const double length = area.norm();
  if (!(length > 0))
  {
    return -kInfinity;
  }
  const Vector3 normal = area / length;
  double least = kInfinity;
  for (const ShapeDerivatives& d : derivatives_)
  {
    Vector3 along = Vector3::Zero(), across = Vector3::Zero();
    for (std::size_t i = 1; i < 9; ++i)
    {
      // From the first corner on: the derivatives sum up to zero, and far from the origin digits are kept.
      const Vector3 fromFirst = x[i] - x[0];
      along += d[0][i] * fromFirst;
      across += d[1][i] * fromFirst;
    }
    least = std::min(least, normal.dot(along.cross(across)));
  }
  return least;
}

} // namespace quadrille

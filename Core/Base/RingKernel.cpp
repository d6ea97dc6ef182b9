// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/RingKernel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille
{

namespace
{

/// A convex polygon with room for one more vertex per clipping line.
struct ConvexPolygon
{
  std::array<Vector2, 2 * kMaximumRing + 8> point;
  int count = 0;

  void push(const Vector2& p) { point[static_cast<std::size_t>(count++)] = p; }
  const Vector2& at(int i) const { return point[static_cast<std::size_t>(i == count ? 0 : i)]; }
};

/// Keeps what lies left of a -> b.
ConvexPolygon clip(const ConvexPolygon& polygon, const Vector2& a, const Vector2& b)
{
  ConvexPolygon result;
  for (int i = 0; i < polygon.count; ++i)
  {
    const Vector2& p = polygon.at(i);
    const Vector2& q = polygon.at(i + 1);
    const double sideP = parallelogram(b - a, p - a);
    const double sideQ = parallelogram(b - a, q - a);
    if (sideP >= 0)
    {
      result.push(p);
    }
    if ((sideP > 0 && sideQ < 0) || (sideP < 0 && sideQ > 0))
    {
      result.push(p + sideP / (sideP - sideQ) * (q - p));
    }
  }
  return result;
}

/// Centroid, or the mean of the corners where the area vanishes in double precision.
Vector2 center(const ConvexPolygon& polygon)
{
  Vector2 weighted = Vector2::Zero();
  Vector2 mean = Vector2::Zero();
  double area = 0;
  const Vector2& origin = polygon.at(0);
  for (int i = 0; i < polygon.count; ++i)
  {
    const Vector2 p = polygon.at(i) - origin;
    const Vector2 q = polygon.at(i + 1) - origin;
    const double piece = parallelogram(p, q);
    area += piece;
    weighted += piece * (p + q);
    mean += p / polygon.count;
  }
  return origin + (area > 0 ? Vector2(weighted / (3 * area)) : mean);
}

Vector2 asDouble(FixedVec2 p)
{
  return { static_cast<double>(p.u), static_cast<double>(p.v) };
}

/// The first of the four grid points about `p` that works.
std::optional<FixedVec2> roundInside(
  const FixedVec2* ring, int count, bool closed, const Vector2& p)
{
  const double u = std::floor(p.x());
  const double v = std::floor(p.y());
  if (!(std::abs(u) < 0x1p44) || !(std::abs(v) < 0x1p44))
  {
    return std::nullopt;
  }
  const FixedVec2 base{ static_cast<std::int64_t>(u), static_cast<std::int64_t>(v) };
  const int nearest = (p.x() - u >= 0.5 ? 1 : 0) + (p.y() - v >= 0.5 ? 2 : 0);
  for (int i = 0; i < 4; ++i)
  {
    const int pick = i ^ nearest;
    const FixedVec2 candidate = base + FixedVec2{ pick & 1, pick >> 1 };
    if (starIsPositive(ring, count, closed, candidate))
    {
      return candidate;
    }
  }
  return std::nullopt;
}

/// How often a closed ring of counterclockwise triangles winds round p: each turns by less than half a circle, so
/// one that leaves the lower half plane crosses the ray from p towards +u, which happens once a round.
int windings(const FixedVec2* ring, int count, FixedVec2 p)
{
  int upwards = 0;
  for (int i = 0; i < count; ++i)
  {
    const FixedVec2 next = ring[i + 1 == count ? 0 : i + 1];
    upwards += ring[i].v < p.v && next.v >= p.v ? 1 : 0;
  }
  return upwards;
}

} // namespace

bool starIsPositive(const FixedVec2* ring, int count, bool closed, FixedVec2 p)
{
  for (int i = 0; i + 1 < count; ++i)
  {
    if (!(determinant(p, ring[i], ring[i + 1]) > 0))
    {
      return false;
    }
  }
  return !closed || (determinant(p, ring[count - 1], ring[0]) > 0 && windings(ring, count, p) == 1);
}

std::optional<FixedVec2> kernelPoint(const FixedVec2* ring, int count, bool closed)
{
  std::array<Vector2, kMaximumRing + 1> points;
  Vector2 low = asDouble(ring[0]);
  Vector2 high = low;
  for (int i = 0; i < count; ++i)
  {
    const Vector2 p = asDouble(ring[i]);
    points[static_cast<std::size_t>(i)] = p;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  ConvexPolygon kernel;
  kernel.push(low);
  kernel.push({ high.x(), low.y() });
  kernel.push(high);
  kernel.push({ low.x(), high.y() });
  const int edges = closed ? count : count - 1;
  for (int i = 0; i < edges && kernel.count > 0; ++i)
  {
    kernel = clip(kernel, points[static_cast<std::size_t>(i)],
      points[static_cast<std::size_t>(i + 1 == count ? 0 : i + 1)]);
  }
  if (kernel.count == 0)
  {
    return std::nullopt;
  }
  return roundInside(ring, count, closed, center(kernel));
}

std::optional<FixedVec2> kernelPointOnSegment(
  const FixedVec2* ring, int count, bool closed, FixedVec2 a, FixedVec2 b)
{
  double low = 0;
  double high = 1;
  const int edges = closed ? count : count - 1;
  for (int i = 0; i < edges; ++i)
  {
    const FixedVec2 p = ring[i];
    const FixedVec2 q = ring[i + 1 == count ? 0 : i + 1];
    const double atA = static_cast<double>(determinant(a, p, q));
    const double atB = static_cast<double>(determinant(b, p, q));
    if (atA <= 0 && atB <= 0)
    {
      return std::nullopt;
    }
    if (atA < 0)
    {
      low = std::max(low, atA / (atA - atB));
    }
    if (atB < 0)
    {
      high = std::min(high, atA / (atA - atB));
    }
  }
  const double t = 0.5 * (low + high);
  const FixedVec2 ab = b - a;
  const FixedVec2 p = a +
    FixedVec2{ static_cast<std::int64_t>(std::llround(t * static_cast<double>(ab.u))),
      static_cast<std::int64_t>(std::llround(t * static_cast<double>(ab.v))) };
  if (!(low < high) || !starIsPositive(ring, count, closed, p))
  {
    return std::nullopt;
  }
  return p;
}

} // namespace quadrille

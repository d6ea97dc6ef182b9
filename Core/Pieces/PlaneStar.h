// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What both ways to carry points to the finest mesh share: the triangles of a star laid out in a plane, among which a
/// point is found again. A point is a FlatPoint or a Complex.
#pragma once

#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Hierarchy/DecimationLog.h"
#include "Pieces/CarriedPlaces.h"
#include "Transfer/PlaneReplay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace quadrille
{

/// A point of a plane, in single precision: coordinates are those of one triangle of the level, and what is fine
/// against it still has three digits where a million triangles lie on it.
struct FlatPoint
{
  float x = 0, y = 0;

  friend FlatPoint operator+(FlatPoint a, FlatPoint b) { return { a.x + b.x, a.y + b.y }; }
  friend FlatPoint operator-(FlatPoint a, FlatPoint b) { return { a.x - b.x, a.y - b.y }; }
  /// As complex numbers: the first one rotates where it has length 1.
  friend FlatPoint operator*(FlatPoint a, FlatPoint b)
  {
    return { a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x };
  }
};

inline float planeCross(FlatPoint a, FlatPoint b)
{
  return a.x * b.y - a.y * b.x;
}
inline double planeCross(Complex a, Complex b)
{
  return a.real() * b.imag() - a.imag() * b.real();
}

inline void convert(FlatPoint from, Complex& to)
{
  to = { from.x, from.y };
}
inline void convert(Complex from, FlatPoint& to)
{
  to = { static_cast<float>(from.real()), static_cast<float>(from.imag()) };
}
inline void convert(Complex from, Complex& to)
{
  to = from;
}

/// A triangle that a point may go to.
template <typename Point>
struct PlaneTriangle
{
  Index slot = kInvalidIndex; ///< of the first corner
  std::array<Point, 3> corner{};

  /// Barycentric coordinates of p, in the order of the corners; not finite for a triangle without area.
  std::array<double, 3> weightsOf(Point p) const
  {
    const double area = planeCross(corner[1] - corner[0], corner[2] - corner[0]);
    const double second = double{ planeCross(p - corner[0], corner[2] - corner[0]) } / area;
    const double third = double{ planeCross(corner[1] - corner[0], p - corner[0]) } / area;
    return { 1 - second - third, second, third };
  }
  /// The least of them: below 0 outside. Triangles without area hold nothing, nor do inverted ones.
  double depthOf(Point p) const
  {
    if (!(planeCross(corner[1] - corner[0], corner[2] - corner[0]) > 0))
    {
      return -std::numeric_limits<double>::infinity();
    }
    const std::array<double, 3> weights = weightsOf(p);
    return std::min({ weights[0], weights[1], weights[2] });
  }
};

/// The triangle that holds p, or that it is least far outside of; null where none has an area.
template <typename Point>
const PlaneTriangle<Point>* triangleOf(const std::vector<PlaneTriangle<Point>>& triangles, Point p)
{
  const PlaneTriangle<Point>* best = nullptr;
  double depth = -std::numeric_limits<double>::infinity();
  for (const PlaneTriangle<Point>& triangle : triangles)
  {
    const double ofThis = triangle.depthOf(p);
    if (ofThis > depth)
    {
      depth = ofThis;
      best = &triangle;
    }
  }
  return best;
}

/// The triangles of the star of a record's vertex at p, in its ring.
template <typename Point>
void layOutStar(const CollapseRecord& record, const std::array<Point, kMaximumRing + 1>& ring,
  Point p, std::vector<PlaneTriangle<Point>>& triangles)
{
  // Of an interior star the end of the ring is its beginning, the target.
  const auto count = static_cast<std::size_t>(record.ringSize());
  triangles.clear();
  for (std::size_t i = 0; i < static_cast<std::size_t>(record.faces); ++i)
  {
    triangles.push_back({ record.slot[i], { p, ring[i], ring[(i + 1) % count] } });
  }
}

/// p, or where that would invert the star a point in its kernel, if there is one.
template <typename Point>
Point intoStar(
  const CollapseRecord& record, const std::array<Point, kMaximumRing + 1>& ring, Point p)
{
  const auto count = static_cast<std::size_t>(record.ringSize());
  bool isPositive = true;
  for (std::size_t i = 0; i < static_cast<std::size_t>(record.faces); ++i)
  {
    isPositive = isPositive && planeCross(ring[i] - p, ring[(i + 1) % count] - p) > 0;
  }
  if (isPositive)
  {
    return p;
  }
  std::array<Complex, kMaximumRing + 1> wide;
  for (std::size_t i = 0; i < count; ++i)
  {
    convert(ring[i], wide[i]);
  }
  Complex at;
  convert(p, at);
  convert(intoKernel(wide.data(), record, at), p);
  return p;
}

/// None below 0, sum 1. rounding: weights below it are on the edge, or at the corner.
inline std::array<double, 3> insideWeights(std::array<double, 3> weights, double rounding)
{
  double sum = 0;
  for (double& weight : weights)
  {
    weight = weight > rounding ? weight : 0; // also where it is no number
    sum += weight;
  }
  if (!(sum > 0) || !(sum <= std::numeric_limits<double>::max()))
  {
    return { 1.0 / 3, 1.0 / 3, 1.0 / 3 };
  }
  for (double& weight : weights)
  {
    weight /= sum;
  }
  return weights;
}

/// Calls carry(block) for each block of the rounds [0, rounds) of the log, the last round first.
template <typename Carry>
void carryBackwards(const DecimationLog& log, std::size_t rounds, int threads,
  const ProgressCallback& progress, const Carry& carry)
{
  for (std::size_t round = rounds; round-- > 0;)
  {
    report(progress, static_cast<double>(rounds - round) / static_cast<double>(rounds + 1),
      "carrying points to the surface");
    const DecimationLog::Round& blocks = log.rounds[round];
    parallelForEach(blocks.blockCount, 1, threads,
      [&](std::size_t block) { carry(log.blocks[blocks.firstBlock + block]); });
  }
}

/// Throws InvalidInput where a place is on no face of the level.
void requirePlaces(const Level& level, const std::vector<FacePlace>& places);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/NearestTriangle.h"

#include <unsupported/Eigen/BVH>

#include <cmath>
#include <utility>

namespace quadrille
{

namespace
{

using Box = Eigen::AlignedBox3d;
using Corners = std::array<Vector3, 3>;

/// Weights of the point of a triangle nearest to p, by the region of the plane that p lies over [Ericson 2005, 5.1.5].
/// Regions of corners and edges come first, so that a segment never gets as far as the last one.
std::array<double, 3> nearestWeights(const Corners& t, const Vector3& p)
{
  const Vector3 ab = t[1] - t[0];
  const Vector3 ac = t[2] - t[0];
  const double d1 = ab.dot(p - t[0]);
  const double d2 = ac.dot(p - t[0]);
  if (d1 <= 0 && d2 <= 0)
  {
    return { 1, 0, 0 };
  }
  const double d3 = ab.dot(p - t[1]);
  const double d4 = ac.dot(p - t[1]);
  if (d3 >= 0 && d4 <= d3)
  {
    return { 0, 1, 0 };
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0)
  {
    const double v = d1 / (d1 - d3);
    return { 1 - v, v, 0 };
  }
  const double d5 = ab.dot(p - t[2]);
  const double d6 = ac.dot(p - t[2]);
  if (d6 >= 0 && d5 <= d6)
  {
    return { 0, 0, 1 };
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0)
  {
    const double w = d2 / (d2 - d6);
    return { 1 - w, 0, w };
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
  {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return { 0, 1 - w, w };
  }
  const double sum = va + vb + vc;
  return { va / sum, vb / sum, vc / sum };
}

Corners cornersOf(const TriangleList& triangles, Index t)
{
  const std::array<Index, 3>& c = triangles.corners[t];
  return { triangles.points[c[0]], triangles.points[c[1]], triangles.points[c[2]] };
}

/// What Eigen's search asks of a box and of a triangle: squares of distances.
struct Search
{
  using Scalar = double;

  const TriangleList& triangles;
  const Vector3& p;
  const Vector3& facing;
  double limit; ///< square of the distance within which to look
  NearestTriangle::Place best;
  double least = std::numeric_limits<double>::infinity();

  double minimumOnVolume(const Box& box) const
  {
    const double square = box.squaredExteriorDistance(p);
    return square <= limit ? square : std::numeric_limits<double>::max();
  }

  double minimumOnObject(Index t)
  {
    const Corners corners = cornersOf(triangles, t);
    const bool faces =
      facing.isZero(0) || (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(facing) > 0;
    if (!faces)
    {
      return std::numeric_limits<double>::max();
    }
    const std::array<double, 3> weights = nearestWeights(corners, p);
    const Vector3 point =
      weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
    const double square = (point - p).squaredNorm();
    if (square <= limit && square < least)
    {
      least = square;
      best = { t, weights, point, std::sqrt(square) };
    }
    return square;
  }
};

std::vector<Index> countUp(std::size_t count)
{
  std::vector<Index> ids(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    ids[i] = static_cast<Index>(i);
  }
  return ids;
}

std::vector<Box> boxesOf(const TriangleList& triangles)
{
  std::vector<Box> boxes;
  boxes.reserve(triangles.corners.size());
  for (const std::array<Index, 3>& corners : triangles.corners)
  {
    Box box(triangles.points[corners[0]]);
    box.extend(triangles.points[corners[1]]);
    box.extend(triangles.points[corners[2]]);
    boxes.push_back(box);
  }
  return boxes;
}

} // namespace

struct NearestTriangle::Tree
{
  Tree(const std::vector<Index>& ids, const std::vector<Box>& boxesOfIds)
    : boxes(ids.begin(), ids.end(), boxesOfIds.begin(), boxesOfIds.end())
  {
  }

  Eigen::KdBVH<double, 3, Index> boxes;
};

NearestTriangle::NearestTriangle(TriangleList triangles) : triangles_(std::move(triangles))
{
  if (!triangles_.corners.empty())
  {
    tree_ = std::make_unique<Tree>(countUp(triangles_.corners.size()), boxesOf(triangles_));
  }
}

NearestTriangle::~NearestTriangle() = default;

std::optional<NearestTriangle::Place> NearestTriangle::at(
  const Vector3& p, const Vector3& facing, double within) const
{
  if (tree_ == nullptr)
  {
    return std::nullopt;
  }
  Search search{ triangles_, p, facing, within * within, {} };
  Eigen::BVMinimize(tree_->boxes, search);
  return search.best.triangle == kInvalidIndex ? std::nullopt : std::optional<Place>(search.best);
}

std::size_t NearestTriangle::bytes() const
{
  // A tree of n triangles has about n boxes and twice as many links.
  return triangles_.points.size() * sizeof(Vector3) +
    triangles_.corners.size() * (sizeof(std::array<Index, 3>) + sizeof(Box) + 3 * sizeof(int));
}

} // namespace quadrille

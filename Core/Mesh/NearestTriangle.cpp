// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/NearestTriangle.h"

#include <unsupported/Eigen/BVH>

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{

namespace
{

using TriangleBox = Eigen::AlignedBox3d;
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

NearestTriangle::Place placeOn(const Corners& corners, Index t, const Vector3& p)
{
  NearestTriangle::Place place;
  place.triangle = t;
  place.weights = nearestWeights(corners, p);
  place.point =
    place.weights[0] * corners[0] + place.weights[1] * corners[1] + place.weights[2] * corners[2];
  place.distance = (place.point - p).norm();
  return place;
}

using TriangleTree = Eigen::KdBVH<double, 3, Index>;

/// Depth first, the nearer box first. Eigen's BVMinimize takes the best of all boxes next, from a queue that is new for
/// each place, and needs twice the time.
class TreeSearch
{
public:
  TreeSearch(const TriangleList& triangles, const TriangleTree& tree, const Vector3& p,
    const Vector3& facing, double within)
    : triangles_(triangles), tree_(tree), p_(p), facing_(facing), isFacing_(!facing.isZero(0)),
      least_(within * within)
  {
  }

  NearestTriangle::Place run()
  {
    visit(tree_.getRootIndex());
    return best_;
  }

private:
  void visit(int node)
  {
    TriangleTree::VolumeIterator volume{}, volumeEnd{};
    TriangleTree::ObjectIterator triangle{}, triangleEnd{};
    tree_.getChildren(node, volume, volumeEnd, triangle, triangleEnd);
    for (; triangle != triangleEnd; ++triangle)
    {
      test(*triangle);
    }
    if (volume == volumeEnd)
    {
      return;
    }
    std::array<int, 2> boxes{ volume[0], volume[volumeEnd - volume - 1] };
    std::array<double, 2> squares{ distanceTo(boxes[0]), distanceTo(boxes[1]) };
    if (squares[1] < squares[0])
    {
      std::swap(boxes[0], boxes[1]);
      std::swap(squares[0], squares[1]);
    }
    if (squares[0] <= least_)
    {
      visit(boxes[0]);
    }
    if (boxes[1] != boxes[0] && squares[1] <= least_)
    {
      visit(boxes[1]);
    }
  }

  double distanceTo(int box) const { return tree_.getVolume(box).squaredExteriorDistance(p_); }

  /// The normal of a triangle; where a segment leads.
  Vector3 wayOf(const Corners& corners, Index t) const
  {
    const Vector3 along = corners[1] - corners[0];
    const bool isSegment = triangles_.corners[t][0] == triangles_.corners[t][2];
    return isSegment ? along : Vector3(along.cross(corners[2] - corners[0]));
  }

  /// Of triangles at the same distance the one with the lowest id.
  void test(Index t)
  {
    const Corners corners = cornersOf(triangles_, t);
    if (isFacing_ && !(wayOf(corners, t).dot(facing_) > 0))
    {
      return;
    }
    const NearestTriangle::Place place = placeOn(corners, t, p_);
    const double square = (place.point - p_).squaredNorm();
    if (square < least_ || (square == least_ && t < best_.triangle))
    {
      least_ = square;
      best_ = place;
    }
  }

  const TriangleList& triangles_;
  const TriangleTree& tree_;
  const Vector3& p_;
  const Vector3& facing_;
  bool isFacing_;
  double least_; ///< square
  NearestTriangle::Place best_;
};

/// For Eigen's BVIntersect.
struct WithinSearch
{
  bool intersectVolume(const TriangleBox& box) const
  {
    return box.squaredExteriorDistance(p) <= distance * distance;
  }
  bool intersectObject(Index t)
  {
    if (placeOn(cornersOf(triangles, t), t, p).distance <= distance)
    {
      found.push_back(t);
    }
    return false; // there may be more
  }

  const TriangleList& triangles;
  const Vector3& p;
  double distance;
  std::vector<Index> found;
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

std::vector<TriangleBox> boxesOf(const TriangleList& triangles)
{
  std::vector<TriangleBox> boxes;
  boxes.reserve(triangles.corners.size());
  for (const std::array<Index, 3>& corners : triangles.corners)
  {
    TriangleBox box(triangles.points[corners[0]]);
    box.extend(triangles.points[corners[1]]);
    box.extend(triangles.points[corners[2]]);
    boxes.push_back(box);
  }
  return boxes;
}

} // namespace

TriangleList trianglesOf(const Mesh& mesh)
{
  TriangleList list;
  list.points = mesh.position.vector();
  list.corners.resize(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    list.corners[f] = { mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] };
  }
  return list;
}

struct NearestTriangle::Tree
{
  Tree(const std::vector<Index>& ids, const std::vector<TriangleBox>& boxesOfIds)
    : boxes(ids.begin(), ids.end(), boxesOfIds.begin(), boxesOfIds.end())
  {
  }

  TriangleTree boxes;
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
  const Place best = TreeSearch(triangles_, tree_->boxes, p, facing, within).run();
  return best.triangle == kInvalidIndex ? std::nullopt : std::optional<Place>(best);
}

std::vector<Index> NearestTriangle::within(const Vector3& p, double distance) const
{
  WithinSearch search{ triangles_, p, distance, {} };
  if (tree_)
  {
    Eigen::BVIntersect(tree_->boxes, search);
  }
  std::sort(search.found.begin(), search.found.end());
  return std::move(search.found);
}

NearestTriangle::Place NearestTriangle::on(Index triangle, const Vector3& p) const
{
  return placeOn(cornersOf(triangles_, triangle), triangle, p);
}

std::size_t NearestTriangle::bytes() const
{
  // A tree of n triangles has about n boxes and twice as many links.
  return triangles_.points.size() * sizeof(Vector3) +
    triangles_.corners.size() *
    (sizeof(std::array<Index, 3>) + sizeof(TriangleBox) + 3 * sizeof(int));
}

} // namespace quadrille

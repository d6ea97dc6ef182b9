// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/NearestTriangle.h"

#include <algorithm>
#include <utility>

namespace quadrille
{

namespace
{

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

/// The normal of a triangle; where a segment leads.
Vector3 wayOf(const TriangleList& triangles, const Corners& corners, Index t)
{
  const Vector3 along = corners[1] - corners[0];
  const bool isSegment = triangles.corners[t][0] == triangles.corners[t][2];
  return isSegment ? along : Vector3(along.cross(corners[2] - corners[0]));
}

} // namespace

void TriangleList::add(const Vector3& a, const Vector3& b, const Vector3& c)
{
  const auto first = static_cast<Index>(points.size());
  points.insert(points.end(), { a, b, c });
  corners.push_back({ first, first + 1, first + 2 });
}

void TriangleList::addSegment(const Vector3& a, const Vector3& b)
{
  const auto first = static_cast<Index>(points.size());
  points.insert(points.end(), { a, b });
  corners.push_back({ first, first + 1, first + 1 });
}

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

NearestTriangle::NearestTriangle(TriangleList triangles) : triangles_(std::move(triangles))
{
  std::vector<BoxTree::Box> boxes(triangles_.corners.size());
  for (Index t = 0; t < boxes.size(); ++t)
  {
    const Corners corners = cornersOf(triangles_, t);
    boxes[t] = { corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]),
      corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]) };
  }
  tree_ = BoxTree(boxes, 1);
}

std::optional<NearestTriangle::Place> NearestTriangle::at(
  const Vector3& p, const Vector3& facing, double within) const
{
  const bool isFacing = !facing.isZero(0);
  const Index nearest = tree_.nearest(
    p,
    [&](Index t)
    {
      const Corners corners = cornersOf(triangles_, t);
      return isFacing && !(wayOf(triangles_, corners, t).dot(facing) > 0)
        ? kInfinity
        : (placeOn(corners, t, p).point - p).squaredNorm();
    },
    within);
  return nearest == kInvalidIndex ? std::nullopt : std::optional<Place>(on(nearest, p));
}

std::vector<Index> NearestTriangle::within(const Vector3& p, double distance) const
{
  std::vector<Index> found;
  tree_.visitWithin(p, distance,
    [&](Index t)
    {
      if (on(t, p).distance <= distance)
      {
        found.push_back(t);
      }
    });
  std::sort(found.begin(), found.end());
  return found;
}

NearestTriangle::Place NearestTriangle::on(Index triangle, const Vector3& p) const
{
  return placeOn(cornersOf(triangles_, triangle), triangle, p);
}

std::size_t NearestTriangle::bytes() const
{
  return triangles_.points.size() * sizeof(Vector3) +
    triangles_.corners.size() * sizeof(std::array<Index, 3>) + tree_.bytes();
}

} // namespace quadrille

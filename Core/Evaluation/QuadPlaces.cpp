// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/QuadPlaces.h"

#include "Base/Lists.h"
#include "Mesh/Distance.h"
#include "Requests/Guides.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{

namespace
{

/// Weights of the corners in the plane of the triangle; a place on it has weights from 0 to 1.
Vector3 weightsIn(const std::array<Vector3, 3>& corners, const Vector3& p)
{
  const Vector3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double area = normal.squaredNorm();
  if (!(area > 0))
  {
    return Vector3::Constant(1.0 / 3);
  }
  Vector3 weights;
  for (int i = 0; i < 3; ++i)
  {
    const Vector3& a = corners[static_cast<std::size_t>((i + 1) % 3)];
    const Vector3& b = corners[static_cast<std::size_t>((i + 2) % 3)];
    weights[i] = std::clamp(normal.dot((a - p).cross(b - p)) / area, 0.0, 1.0);
  }
  return weights / std::max(weights.sum(), 1e-300);
}

} // namespace

//------------------------------------------------------------------------------
ReachedValences::ReachedValences(const QuadMesh& mesh) : mesh_(mesh)
{
  const auto finish = [&mesh](Points& points)
  {
    std::vector<BoxTree::Box> boxes;
    for (const Index p : points.ids)
    {
      boxes.push_back({ mesh.points[p], mesh.points[p] });
    }
    points.tree = BoxTree(boxes, 1);
  };
  for (Index p = 0; p < mesh.points.size(); ++p)
  {
    all_.ids.push_back(p);
    if (valence(p) != kRegularValence)
    {
      byValence_[valence(p)].ids.push_back(p);
    }
  }
  finish(all_);
  for (auto& [valence, points] : byValence_)
  {
    finish(points);
  }
}

std::optional<Index> ReachedValences::nearestIn(const Points& points, const Vector3& p) const
{
  const Index found = points.tree.nearest(
    p, [&](Index i) { return (mesh_.points[points.ids[i]] - p).squaredNorm(); });
  return found == kInvalidIndex ? std::nullopt : std::optional<Index>(points.ids[found]);
}

std::optional<Index> ReachedValences::nearest(const Vector3& p) const
{
  return nearestIn(all_, p);
}

std::optional<Index> ReachedValences::nearestOf(int valence, const Vector3& p) const
{
  const auto found = byValence_.find(valence);
  return found == byValence_.end() ? std::nullopt : nearestIn(found->second, p);
}

//------------------------------------------------------------------------------
NearestQuads::NearestQuads(const QuadMesh& mesh)
  : mesh_(mesh), edgeLengthRound_(mesh.points.size(), 0)
{
  std::vector<int> quadsRound(mesh.points.size(), 0);
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    double length = 0;
    for (std::size_t i = 0; i < 4; ++i)
    {
      length += 0.25 * (mesh.points[quad[(i + 1) % 4]] - mesh.points[quad[i]]).norm();
    }
    for (const Index p : quad)
    {
      edgeLengthRound_[p] += length;
      ++quadsRound[p];
    }
  }
  for (std::size_t p = 0; p < quadsRound.size(); ++p)
  {
    edgeLengthRound_[p] /= std::max(quadsRound[p], 1);
  }
  std::vector<BoxTree::Box> boxes(2 * mesh.quads.size());
  for (Index i = 0; i < boxes.size(); ++i)
  {
    const std::array<Vector3, 3> corner = triangle(i);
    boxes[i] = { corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]),
      corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]) };
  }
  tree_ = BoxTree(boxes, 1);
}

/// 0 1 2 and 0 2 3 of a quad.
std::array<Vector3, 3> NearestQuads::triangle(Index i) const
{
  const std::array<Index, 4>& quad = mesh_.quads[i / 2];
  const std::size_t second = i % 2 == 0 ? 1 : 2;
  return { mesh_.points[quad[0]], mesh_.points[quad[second]], mesh_.points[quad[second + 1]] };
}

std::optional<NearestQuads::Place> NearestQuads::at(const Vector3& p) const
{
  const auto placeOn = [&](Index i)
  {
    const std::array<Vector3, 3> corner = triangle(i);
    return nearestOnTriangle(p, corner[0], corner[1], corner[2]);
  };
  const Index nearest = tree_.nearest(p, [&](Index i) { return (placeOn(i) - p).squaredNorm(); });
  if (nearest == kInvalidIndex)
  {
    return std::nullopt;
  }
  Place place;
  place.quad = nearest / 2;
  place.point = placeOn(nearest);
  const bool isSecond = nearest % 2 != 0;
  const std::array<Index, 4>& quad = mesh_.quads[place.quad];
  std::array<Vector3, 4> corners;
  std::transform(
    quad.begin(), quad.end(), corners.begin(), [this](Index i) { return mesh_.points[i]; });
  // Coordinates in the unit square, where the corners are (0, 0), (1, 0), (1, 1), (0, 1).
  const Vector3 weights = weightsIn(triangle(nearest), place.point);
  const double u = isSecond ? weights[1] : weights[1] + weights[2];
  const double v = isSecond ? weights[1] + weights[2] : weights[2];
  const Vector3 alongU = (1 - v) * (corners[1] - corners[0]) + v * (corners[2] - corners[3]);
  const Vector3 alongV = (1 - u) * (corners[3] - corners[0]) + u * (corners[2] - corners[1]);
  const auto squaredTo = [&](Index i) { return (mesh_.points[i] - p).squaredNorm(); };
  place.edgeLength = edgeLengthRound_[*std::min_element(
    quad.begin(), quad.end(), [&](Index a, Index b) { return squaredTo(a) < squaredTo(b); })];
  place.along = { Vector3(alongU.stableNormalized()), Vector3(alongV.stableNormalized()) };
  return place;
}

//------------------------------------------------------------------------------
NearestEdges::NearestEdges(const QuadMesh& mesh) : mesh_(mesh)
{
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      const Index a = quad[i];
      const Index b = quad[(i + 1) % 4];
      edges_.push_back({ std::min(a, b), std::max(a, b) });
    }
  }
  sortUnique(edges_);
  std::vector<BoxTree::Box> boxes;
  for (const auto& [a, b] : edges_)
  {
    boxes.push_back(
      { mesh.points[a].cwiseMin(mesh.points[b]), mesh.points[a].cwiseMax(mesh.points[b]) });
  }
  tree_ = BoxTree(boxes, 1);
}

std::optional<double> NearestEdges::distance(const Vector3& p) const
{
  const auto to = [&](Index i)
  { return distanceToSegment(p, mesh_.points[edges_[i][0]], mesh_.points[edges_[i][1]]); };
  const Index nearest = tree_.nearest(p,
    [&](Index i)
    {
      const double d = to(i);
      return d * d;
    });
  return nearest == kInvalidIndex ? std::nullopt : std::optional<double>(to(nearest));
}

} // namespace quadrille

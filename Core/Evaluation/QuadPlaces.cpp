// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/QuadPlaces.h"

#include "Quads/QuadProjection.h"

#include <algorithm>

namespace quadrille
{

namespace
{

TriangleList linesOf(const QuadMesh& mesh)
{
  TriangleList list;
  list.points = mesh.points;
  for (const QuadLine& line : mesh.lines)
  {
    list.corners.push_back({ line.a, line.b, line.b });
  }
  return list;
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

std::optional<Index> ReachedValences::nearestIn(
  const Points& points, const Vector3& p, const QuadSide& side) const
{
  const Index found = points.tree.nearest(p,
    [&](Index i)
    {
      const Index point = points.ids[i];
      return side.has(point) ? (mesh_.points[point] - p).squaredNorm() : kInfinity;
    });
  return found == kInvalidIndex ? std::nullopt : std::optional<Index>(points.ids[found]);
}

std::optional<Index> ReachedValences::nearest(const Vector3& p, const QuadSide& side) const
{
  return nearestIn(all_, p, side);
}

std::optional<Index> ReachedValences::nearestOf(
  int valence, const Vector3& p, const QuadSide& side) const
{
  const auto found = byValence_.find(valence);
  return found == byValence_.end() ? std::nullopt : nearestIn(found->second, p, side);
}

//------------------------------------------------------------------------------
NearestQuads::NearestQuads(const QuadMesh& mesh)
  : mesh_(mesh), halves_(halvesOf(mesh.points, mesh.quads)),
    edgeLengthRound_(mesh.points.size(), 0), pointNormals_(pointNormals(mesh.points, mesh.quads))
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
    pointNormals_[p].stableNormalize();
  }
}

std::optional<NearestQuads::Place> NearestQuads::at(const Vector3& p) const
{
  const auto nearest = halves_.at(p);
  if (!nearest)
  {
    return std::nullopt;
  }
  Place place;
  place.quad = nearest->triangle / 2;
  place.point = nearest->point;
  const bool isSecond = nearest->triangle % 2 != 0;
  const std::array<Index, 4>& quad = mesh_.quads[place.quad];
  std::array<Vector3, 4> corners;
  std::transform(
    quad.begin(), quad.end(), corners.begin(), [this](Index i) { return mesh_.points[i]; });
  // Coordinates in the unit square, where the corners are (0, 0), (1, 0), (1, 1), (0, 1).
  const std::array<double, 3>& weights = nearest->weights;
  const double u = isSecond ? weights[1] : weights[1] + weights[2];
  const double v = isSecond ? weights[1] + weights[2] : weights[2];
  const Vector3 alongU = (1 - v) * (corners[1] - corners[0]) + v * (corners[2] - corners[3]);
  const Vector3 alongV = (1 - u) * (corners[3] - corners[0]) + u * (corners[2] - corners[1]);
  const auto squaredTo = [&](Index i) { return (mesh_.points[i] - p).squaredNorm(); };
  place.edgeLength = edgeLengthRound_[*std::min_element(
    quad.begin(), quad.end(), [&](Index a, Index b) { return squaredTo(a) < squaredTo(b); })];
  for (const Index corner : quad)
  {
    place.normal += pointNormals_[corner];
  }
  place.normal.stableNormalize();
  place.along = { Vector3(alongU.stableNormalized()), Vector3(alongV.stableNormalized()) };
  return place;
}

std::size_t NearestQuads::bytes() const
{
  return halves_.bytes() + edgeLengthRound_.size() * sizeof(double) +
    pointNormals_.size() * sizeof(Vector3);
}

Vector3 NearestQuads::normalAt(const Vector3& p) const
{
  const std::optional<Place> there = at(p);
  return there ? there->normal : Vector3(Vector3::Zero());
}

//------------------------------------------------------------------------------
NearestLines::NearestLines(const QuadMesh& mesh) : lines_(linesOf(mesh)) {}

std::optional<double> NearestLines::distance(const Vector3& p) const
{
  const auto nearest = lines_.at(p);
  return nearest ? std::optional<double>(nearest->distance) : std::nullopt;
}

} // namespace quadrille

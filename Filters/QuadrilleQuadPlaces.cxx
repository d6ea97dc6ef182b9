// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleQuadPlaces.h"

#include "Mesh/Guides.h"

#include <vtkCellArray.h>
#include <vtkPoints.h>

#include <algorithm>
#include <cmath>

namespace quadrille
{

namespace
{

void setPoints(const QuadMesh& mesh, vtkPolyData* data)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vector3& p : mesh.points)
  {
    points->InsertNextPoint(p.data());
  }
  data->SetPoints(points);
}

/// The nearest cell and the place on it.
struct NearestCell
{
  vtkIdType cell = -1;
  Vector3 point = Vector3::Zero();
  double distance = 0;
};

NearestCell nearestCell(vtkStaticCellLocator* locator, vtkGenericCell* work, const Vector3& p)
{
  NearestCell found;
  int part = 0;
  double distance2 = 0;
  locator->FindClosestPoint(p.data(), found.point.data(), work, found.cell, part, distance2);
  found.distance = std::sqrt(distance2);
  return found;
}

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
  setPoints(mesh, data_);
  tolerance_ = 1e-6 * data_->GetLength();
  if (!mesh.points.empty())
  {
    locator_->SetDataSet(data_);
    locator_->BuildLocator();
  }
}

int ReachedValences::at(const Vector3& p) const
{
  const vtkIdType found = mesh_.points.empty() ? -1 : locator_->FindClosestPoint(p.data());
  if (found < 0 || (mesh_.points[static_cast<std::size_t>(found)] - p).norm() > tolerance_)
  {
    return kRegularValence;
  }
  const auto i = static_cast<std::size_t>(found);
  return mesh_.valence[i] + (mesh_.onBoundary[i] != 0 ? 1 : 0);
}

//------------------------------------------------------------------------------
NearestQuads::NearestQuads(const QuadMesh& mesh) : mesh_(mesh)
{
  setPoints(mesh, data_);
  vtkNew<vtkCellArray> triangles;
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    for (const std::size_t last : { 2, 3 }) // 0 1 2 and 0 2 3
    {
      triangles->InsertNextCell({ static_cast<vtkIdType>(quad[0]),
        static_cast<vtkIdType>(quad[last - 1]), static_cast<vtkIdType>(quad[last]) });
    }
  }
  data_->SetPolys(triangles);
  locator_->SetDataSet(data_);
  locator_->BuildLocator();
}

std::optional<NearestQuads::Place> NearestQuads::at(const Vector3& p) const
{
  const NearestCell nearest = nearestCell(locator_, cell_, p);
  if (nearest.cell < 0)
  {
    return std::nullopt;
  }
  Place place;
  place.quad = static_cast<Index>(nearest.cell / 2);
  const bool isSecond = nearest.cell % 2 != 0;
  const std::array<Index, 4>& quad = mesh_.quads[place.quad];
  std::array<Vector3, 4> corners;
  std::transform(
    quad.begin(), quad.end(), corners.begin(), [this](Index i) { return mesh_.points[i]; });
  // Coordinates in the unit square, where the corners are (0, 0), (1, 0), (1, 1), (0, 1).
  const Vector3 weights =
    weightsIn({ corners[0], corners[isSecond ? 2 : 1], corners[isSecond ? 3 : 2] }, nearest.point);
  const double u = isSecond ? weights[1] : weights[1] + weights[2];
  const double v = isSecond ? weights[1] + weights[2] : weights[2];
  const Vector3 alongU = (1 - v) * (corners[1] - corners[0]) + v * (corners[2] - corners[3]);
  const Vector3 alongV = (1 - u) * (corners[3] - corners[0]) + u * (corners[2] - corners[1]);
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
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  setPoints(mesh, data_);
  vtkNew<vtkCellArray> lines;
  for (const std::array<Index, 2>& edge : edges_)
  {
    lines->InsertNextCell({ static_cast<vtkIdType>(edge[0]), static_cast<vtkIdType>(edge[1]) });
  }
  data_->SetLines(lines);
  locator_->SetDataSet(data_);
  locator_->BuildLocator();
}

std::optional<NearestEdges::Place> NearestEdges::at(const Vector3& p) const
{
  const NearestCell nearest = nearestCell(locator_, cell_, p);
  if (nearest.cell < 0)
  {
    return std::nullopt;
  }
  const std::array<Index, 2>& edge = edges_[static_cast<std::size_t>(nearest.cell)];
  return Place{ nearest.distance, (mesh_.points[edge[0]] - mesh_.points[edge[1]]).norm() };
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/Soup.h"

#include "Base/Parallel.h"
#include "Common/NewArray.h"
#include "Convert/Attributes.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <utility>

namespace quadrille
{

namespace
{

NearestTriangle::Place nearestTo(const NearestTriangle& tree, const Vector3& p)
{
  return *tree.at(p); // there is a triangle, and no bound
}

std::vector<PointOrigin> pointOrigins(
  const NearestTriangle& tree, const TriangleList& target, int threads)
{
  std::vector<PointOrigin> origins(target.points.size());
  parallelForEach(origins.size(), kHeavyChunk, threads,
    [&](std::size_t i)
    {
      const NearestTriangle::Place place = nearestTo(tree, target.points[i]);
      const std::array<Index, 3>& corners = tree.triangles().corners[place.triangle];
      origins[i] = { { corners[0], corners[1], corners[2] }, place.weights };
    });
  return origins;
}

std::vector<vtkIdType> cellOrigins(
  const NearestTriangle& tree, const ConvertedSoup& from, const TriangleList& target, int threads)
{
  std::vector<vtkIdType> origins(target.corners.size());
  parallelForEach(origins.size(), kHeavyChunk, threads,
    [&](std::size_t i)
    {
      const std::array<Index, 3>& c = target.corners[i];
      const Vector3 centre = (target.points[c[0]] + target.points[c[1]] + target.points[c[2]]) / 3;
      const NearestTriangle::Place place = nearestTo(tree, centre);
      origins[i] = from.surface.cell(from.soup.polygon[place.triangle]);
    });
  return origins;
}

/// Of what writeTriangleList wrote.
TriangleList readTriangleList(vtkPolyData* data)
{
  TriangleList triangles;
  triangles.points.resize(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < triangles.points.size(); ++i)
  {
    data->GetPoint(static_cast<vtkIdType>(i), triangles.points[i].data());
  }
  const std::vector<Index> corners = readCorners(data);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
  {
    triangles.corners.push_back({ corners[i], corners[i + 1], corners[i + 2] });
  }
  return triangles;
}

} // namespace

ConvertedSoup convertSoup(vtkPolyData* data, int threads)
{
  ConvertedSoup result;
  result.surface = convertSurface(data, "", threads);
  result.soup = soupOf(result.surface.input, threads);
  result.surface.input = {};
  return result;
}

vtkSmartPointer<vtkPolyData> writeTriangleList(const TriangleList& triangles)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  const auto coordinates = newArray<vtkDoubleArray>("Points", 3, triangles.points.size());
  for (std::size_t i = 0; i < triangles.points.size(); ++i)
  {
    coordinates->SetTuple(static_cast<vtkIdType>(i), triangles.points[i].data());
  }
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  data->SetPoints(points);
  const auto corners = newArray<vtkIdTypeArray>("", 1, 3 * triangles.corners.size());
  for (std::size_t i = 0; i < triangles.corners.size(); ++i)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      corners->SetValue(static_cast<vtkIdType>(3 * i + k), triangles.corners[i][k]);
    }
  }
  vtkNew<vtkCellArray> cells;
  cells->SetData(3, corners);
  data->SetPolys(cells);
  return data;
}

std::vector<std::string> carryFromNearest(
  vtkPolyData* source, const ConvertedSoup& from, vtkPolyData* target, int threads)
{
  target->GetFieldData()->PassData(source->GetFieldData());
  const bool hasArrays = source->GetPointData()->GetNumberOfArrays() > 0 ||
    source->GetCellData()->GetNumberOfArrays() > 0;
  if (!hasArrays)
  {
    return {};
  }
  if (from.soup.triangles.corners.empty())
  {
    return { "arrays of points without polygons are not carried over" };
  }
  const NearestTriangle tree(from.soup.triangles);
  const TriangleList surface = readTriangleList(target);
  std::vector<std::string> notCarried =
    carryPointArrays(source->GetPointData(), source->GetNumberOfPoints(), target->GetPointData(),
      pointOrigins(tree, surface, threads), threads);
  for (std::string& text : carryCellArrays(source->GetCellData(), source->GetNumberOfCells(),
         target->GetCellData(), cellOrigins(tree, from, surface, threads), threads))
  {
    notCarried.push_back(std::move(text));
  }
  return notCarried;
}

} // namespace quadrille

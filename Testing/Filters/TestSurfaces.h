// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Surfaces for the tests of the filters, from the meshes that the tests of Core share.
#pragma once

#include "TestMeshes.h"

#include "Extraction/Extraction.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace quadrille::test
{

inline vtkSmartPointer<vtkPolyData> toPolyData(const Mesh& mesh)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vector3& p : mesh.position)
  {
    points->InsertNextPoint(p.data());
  }
  vtkNew<vtkCellArray> polys;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    polys->InsertNextCell(
      { static_cast<vtkIdType>(mesh.origin[3 * f]), static_cast<vtkIdType>(mesh.origin[3 * f + 1]),
        static_cast<vtkIdType>(mesh.origin[3 * f + 2]) });
  }
  data->SetPoints(points);
  data->SetPolys(polys);
  return data;
}

inline vtkSmartPointer<vtkPolyData> polyline(const std::vector<Vector3>& points)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> coordinates;
  coordinates->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell(static_cast<int>(points.size()));
  for (const Vector3& p : points)
  {
    lines->InsertCellPoint(coordinates->InsertNextPoint(p.data()));
  }
  data->SetPoints(coordinates);
  data->SetLines(lines);
  return data;
}

/// The mean of the corners of a cell.
inline Vector3 cellCentre(vtkPolyData* data, vtkIdType cell)
{
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  data->GetCellPoints(cell, count, ids);
  Vector3 sum = Vector3::Zero();
  for (vtkIdType i = 0; i < count; ++i)
  {
    sum += Vector3(data->GetPoint(ids[i]));
  }
  return sum / static_cast<double>(count);
}

/// Collects errors and warnings of a filter, so that a test of a failure does not print them.
class Messages
{
public:
  explicit Messages(vtkAlgorithm* filter)
  {
    callback_->SetClientData(this);
    callback_->SetCallback(
      [](vtkObject*, unsigned long event, void* client, void* text)
      {
        auto* self = static_cast<Messages*>(client);
        (event == vtkCommand::ErrorEvent ? self->errors : self->warnings) +=
          static_cast<const char*>(text);
      });
    for (vtkObject* source :
      { static_cast<vtkObject*>(filter), static_cast<vtkObject*>(filter->GetExecutive()) })
    {
      source->AddObserver(vtkCommand::ErrorEvent, callback_);
      source->AddObserver(vtkCommand::WarningEvent, callback_);
    }
  }
  std::string errors;
  std::string warnings;

private:
  vtkNew<vtkCallbackCommand> callback_;
};

/// Number of faces at each edge, and whether every face has four corners.
struct QuadTally
{
  bool onlyQuads = true;
  std::size_t edges = 0;
  std::size_t boundaryEdges = 0;
  std::size_t badEdges = 0; ///< more than two faces, or twice in the same direction
  long long eulerCharacteristic = 0;
};

inline QuadTally tally(vtkPolyData* quads)
{
  QuadTally result;
  std::map<std::pair<vtkIdType, vtkIdType>, int> directed;
  auto cells = vtk::TakeSmartPointer(quads->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    result.onlyQuads = result.onlyQuads && count == 4;
    for (vtkIdType i = 0; i < count; ++i)
    {
      ++directed[{ ids[i], ids[(i + 1) % count] }];
    }
  }
  for (const auto& [edge, uses] : directed)
  {
    const bool hasTwin = directed.count({ edge.second, edge.first }) > 0;
    result.badEdges += uses > 1;
    result.boundaryEdges += !hasTwin;
    result.edges += !hasTwin || edge.first < edge.second;
  }
  result.eulerCharacteristic = static_cast<long long>(quads->GetNumberOfPoints()) -
    static_cast<long long>(result.edges) + static_cast<long long>(quads->GetNumberOfPolys());
  return result;
}

} // namespace quadrille::test

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Surfaces for the tests of the filters, from the meshes that the tests of Core share.
#pragma once

#include "SphereWithoutRoom.h"
#include "TestMeshes.h"

#include "Base/Lists.h"
#include "Extraction/Extraction.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <algorithm>
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

/// With the connections as an array.
inline vtkSmartPointer<vtkPolyData> sphereWithoutRoomData()
{
  const SurfaceInput input = sphereWithoutRoom();
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkIntArray> connections;
  connections->SetName("ConnectId");
  for (const Vector3& p : input.points)
  {
    points->InsertNextPoint(p.data());
    const auto ends = std::find_if(input.curves.begin(), input.curves.end(),
      [&](const CurveRequest& curve) { return contains(curve.points, p); });
    connections->InsertNextValue(
      ends == input.curves.end() ? 0 : static_cast<int>(ends - input.curves.begin()) + 1);
  }
  vtkNew<vtkCellArray> polys;
  for (std::size_t i = 0; i < input.polygonPoints.size(); i += 3)
  {
    polys->InsertNextCell({ static_cast<vtkIdType>(input.polygonPoints[i]),
      static_cast<vtkIdType>(input.polygonPoints[i + 1]),
      static_cast<vtkIdType>(input.polygonPoints[i + 2]) });
  }
  data->SetPoints(points);
  data->SetPolys(polys);
  data->GetPointData()->AddArray(connections);
  return data;
}

/// Asks to stop once, when the progress text begins so.
class StopAt
{
public:
  StopAt(vtkAlgorithm* filter, std::string begin) : filter_(filter), begin_(std::move(begin))
  {
    command_->SetClientData(this);
    command_->SetCallback(
      [](vtkObject*, unsigned long, void* data, void*)
      {
        auto* own = static_cast<StopAt*>(data);
        const char* text = own->filter_->GetProgressText();
        if (!own->hasStopped_ && text && std::string(text).rfind(own->begin_, 0) == 0)
        {
          own->hasStopped_ = true;
          own->filter_->SetAbortExecute(1);
        }
      });
    tag_ = filter->AddObserver(vtkCommand::ProgressEvent, command_);
  }
  ~StopAt() { filter_->RemoveObserver(tag_); }
  StopAt(const StopAt&) = delete;
  StopAt& operator=(const StopAt&) = delete;

private:
  vtkAlgorithm* filter_;
  std::string begin_;
  vtkNew<vtkCallbackCommand> command_;
  unsigned long tag_ = 0;
  bool hasStopped_ = false;
};

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

inline vtkIdType nearestPoint(vtkPolyData* data, Vector3 place)
{
  return data->FindPoint(place.data()); // the form that VTK's versions share
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

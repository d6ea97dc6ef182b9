// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Convert/Frame.h"

#include "Convert/PolyData.h"

#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <cmath>
#include <optional>

namespace quadrille
{

namespace
{

constexpr int kFrameNumbers = 8;
/// Half the steps of the frame's grid and some more, in units of the frame.
constexpr double kMoved = 1e-7;

std::optional<Frame> readFrame(vtkPolyData* data)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(arrays::kFrame);
  if (!array || array->GetNumberOfComponents() != kFrameNumbers || array->GetNumberOfTuples() != 1)
  {
    return std::nullopt;
  }
  double n[kFrameNumbers];
  array->GetTuple(0, n);
  Frame frame;
  frame.centre = Vector3(n[0], n[1], n[2]);
  frame.unit = n[3];
  frame.sign = Vector3(n[4], n[5], n[6]);
  frame.reversed = n[7] != 0;
  const bool sound = frame.centre.allFinite() && frame.unit > 0 && std::isfinite(frame.unit) &&
    (frame.sign.cwiseAbs().array() == 1).all();
  return sound ? std::optional<Frame>(frame) : std::nullopt;
}

/// The positions in the frame of the mesh's vertices, where there are such and the points lie where the frame puts
/// them.
std::optional<std::vector<Vector3>> framePositions(
  vtkPolyData* data, const Mesh& mesh, const Frame& frame)
{
  vtkDataArray* array = data->GetPointData()->GetArray(arrays::kFramePosition);
  if (!array || array->GetNumberOfComponents() != 3)
  {
    return std::nullopt;
  }
  vtkDataArray* split = data->GetPointData()->GetArray(arrays::kSurfacePointId);
  std::vector<Vector3> positions(mesh.vertexCount(), Vector3::Constant(NAN));
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    const auto v = static_cast<std::size_t>(split ? split->GetTuple1(i) : static_cast<double>(i));
    if (v < positions.size())
    {
      array->GetTuple(i, positions[v].data());
    }
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    const Vector3 place = frame.toUser(positions[v]);
    const double limit =
      kMoved * frame.unit + std::ldexp(mesh.position[v].cwiseAbs().maxCoeff(), -50);
    // Written so that NaN is refused as well.
    if (!((place - mesh.position[v]).cwiseAbs().maxCoeff() <= limit))
    {
      return std::nullopt;
    }
  }
  return positions;
}

Frame ownFrame(const Mesh& mesh)
{
  Frame frame;
  if (mesh.position.empty())
  {
    return frame;
  }
  Vector3 low = mesh.position.front();
  Vector3 high = low;
  for (const Vector3& p : mesh.position)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double unit = (high - low).maxCoeff();
  if (std::isnormal(unit))
  {
    frame.centre = low / 2 + high / 2;
    frame.unit = unit;
  }
  return frame;
}

} // namespace

void addFrame(vtkPolyData* data, const Frame& frame, const std::vector<Vector3>& positions)
{
  vtkNew<vtkDoubleArray> numbers;
  numbers->SetName(arrays::kFrame);
  numbers->SetNumberOfComponents(kFrameNumbers);
  const double tuple[kFrameNumbers] = { frame.centre.x(), frame.centre.y(), frame.centre.z(),
    frame.unit, frame.sign.x(), frame.sign.y(), frame.sign.z(), frame.reversed ? 1.0 : 0.0 };
  numbers->InsertNextTuple(tuple);
  data->GetFieldData()->AddArray(numbers);

  vtkDataArray* split = data->GetPointData()->GetArray(arrays::kSurfacePointId);
  vtkNew<vtkDoubleArray> points;
  points->SetName(arrays::kFramePosition);
  points->SetNumberOfComponents(3);
  points->SetNumberOfTuples(data->GetNumberOfPoints());
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    const auto v = static_cast<std::size_t>(split ? split->GetTuple1(i) : static_cast<double>(i));
    points->SetTypedTuple(i, positions[v].data());
  }
  data->GetPointData()->AddArray(points);
}

Frame enterFrame(vtkPolyData* data, Mesh& mesh)
{
  if (const std::optional<Frame> frame = readFrame(data))
  {
    if (std::optional<std::vector<Vector3>> positions = framePositions(data, mesh, *frame))
    {
      mesh.position = std::move(*positions);
      if (frame->reversed)
      {
        reverseFaces(mesh);
      }
      return *frame;
    }
  }
  const Frame frame = ownFrame(mesh);
  for (Vector3& p : mesh.position.editAll())
  {
    p = (p - frame.centre) / frame.unit;
  }
  return frame;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ElementGrids/ElementFrames.h"

#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Base/Refuse.h"
#include "Common/NewArray.h"
#include "ElementGrids/ElementQuality.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <Eigen/Eigenvalues>

#include <array>
#include <cmath>

namespace quadrille
{

namespace
{

using ElementCorners = std::array<vtkIdType, 4>;

/// Calls visit(element, its corners) for all, on several threads.
template <class Visitor>
void forEachElement(vtkUnstructuredGrid* grid, int threads, const Visitor& visit)
{
  parallelFor(static_cast<std::size_t>(grid->GetNumberOfCells()), kMediumChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      vtkNew<vtkIdList> ids;
      for (std::size_t i = begin; i < end; ++i)
      {
        grid->GetCells()->GetCellAtId(static_cast<vtkIdType>(i), ids);
        visit(i, ElementCorners{ ids->GetId(0), ids->GetId(1), ids->GetId(2), ids->GetId(3) });
      }
    });
}

std::array<Vector3, 4> positionsOf(vtkUnstructuredGrid* grid, const ElementCorners& corners)
{
  std::array<Vector3, 4> p;
  for (std::size_t k = 0; k < 4; ++k)
  {
    grid->GetPoints()->GetPoint(corners[k], p[k].data());
  }
  return p;
}

/// Integrals of the shape functions of the corners over the quad, over its area: by 2 by 2 Gauss points, which is exact
/// where it is plane. A quarter each where it has no area.
std::array<double, 4> cornerShares(const std::array<Vector3, 4>& p)
{
  const double g = 1 / std::sqrt(3.0);
  const std::array<std::array<double, 2>, 4> signs{ { { -1, -1 }, { 1, -1 }, { 1, 1 },
    { -1, 1 } } };
  std::array<double, 4> shares{};
  double area = 0;
  for (const auto& [a, b] : signs)
  {
    const double x = g * a, y = g * b;
    Vector3 along = Vector3::Zero(), across = Vector3::Zero();
    std::array<double, 4> shape{};
    for (std::size_t k = 0; k < 4; ++k)
    {
      const double sx = signs[k][0], sy = signs[k][1];
      shape[k] = (1 + sx * x) * (1 + sy * y) / 4;
      along += sx * (1 + sy * y) / 4 * p[k];
      across += sy * (1 + sx * x) / 4 * p[k];
    }
    const double part = along.cross(across).norm();
    area += part;
    for (std::size_t k = 0; k < 4; ++k)
    {
      shares[k] += part * shape[k];
    }
  }
  for (double& share : shares)
  {
    share = area > 0 ? share / area : 0.25;
  }
  return shares;
}

/// An array of the elements, or else of their points.
struct ElementSource
{
  vtkDataArray* array = nullptr;
  bool isOfCells = false;
};

ElementSource sourceArray(
  vtkUnstructuredGrid* grid, const std::string& name, int components, const char* what)
{
  vtkDataArray* const ofCells = grid->GetCellData()->GetArray(name.c_str());
  vtkDataArray* const array = ofCells ? ofCells : grid->GetPointData()->GetArray(name.c_str());
  if (!array)
  {
    refuse("there is no cell or point array '", name, "' of numbers on the quads for the ", what,
      ": arrays of the surface are carried to them under their names");
  }
  if (array->GetNumberOfComponents() != components)
  {
    refuse("the array '", name, "' has ", array->GetNumberOfComponents(),
      " numbers a tuple, but the ", what, " needs ", components);
  }
  return { array, ofCells != nullptr };
}

/// The element's own vector, or the mean of its points.
Vector3 vectorOf(const ElementSource& source, std::size_t element, const ElementCorners& corners,
  const std::array<double, 4>& shares)
{
  Vector3 v;
  if (source.isOfCells)
  {
    source.array->GetTuple(static_cast<vtkIdType>(element), v.data());
    return v;
  }
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < 4; ++k)
  {
    source.array->GetTuple(corners[k], v.data());
    sum += shares[k] * v;
  }
  return sum;
}

/// Of a point array the direction that the corners have in common, of the length 1; zero where all of them are.
Vector3 directionOf(const ElementSource& source, std::size_t element, const ElementCorners& corners)
{
  if (source.isOfCells)
  {
    return vectorOf(source, element, corners, {});
  }
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Vector3 first = Vector3::Zero();
  for (const vtkIdType corner : corners)
  {
    Vector3 v;
    source.array->GetTuple(corner, v.data());
    if (!v.allFinite())
    {
      return v;
    }
    sum += v.stableNormalized() * v.stableNormalized().transpose();
    first = first.isZero(0) ? v : first;
  }
  if (sum.isZero(0))
  {
    return Vector3::Zero();
  }
  const Vector3 common = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvectors().col(2);
  return common.dot(first) < 0 ? Vector3(-common) : common;
}

/// Turns the frame about its normal; false where the direction is zero or along the normal.
bool turnTo(ElementFrame& frame, const Vector3& direction)
{
  const Vector3 d = direction.stableNormalized();
  const Vector3 normal = frame.row(2).transpose();
  const Vector3 inPlane = d - d.dot(normal) * normal;
  if (!(inPlane.norm() > kRoundingOfSingle))
  {
    return false;
  }
  frame.row(0) = inPlane.normalized().transpose();
  frame.row(1) = normal.cross(Vector3(frame.row(0).transpose())).transpose();
  return true;
}

std::string placeOfElement(vtkUnstructuredGrid* grid, std::size_t element)
{
  return std::to_string(element) + " at " +
    placeText(centreOfElement(grid, static_cast<vtkIdType>(element)));
}

ElementNotice noticeOf(const std::vector<std::uint8_t>& marks, std::uint8_t mark)
{
  ElementNotice notice;
  for (std::size_t i = 0; i < marks.size(); ++i)
  {
    if (marks[i] == mark && notice.count++ == 0)
    {
      notice.first = static_cast<vtkIdType>(i);
    }
  }
  return notice;
}

} // namespace

std::vector<ElementFrame> elementFrames(vtkUnstructuredGrid* grid, int threads)
{
  std::vector<ElementFrame> frames(static_cast<std::size_t>(grid->GetNumberOfCells()));
  forEachElement(grid, threads,
    [&](std::size_t i, const ElementCorners& corners)
    {
      const std::array<Vector3, 4> p = positionsOf(grid, corners);
      const Vector3 along = p[1] - p[0] + p[2] - p[3];
      const Vector3 normal = along.cross(p[2] - p[1] + p[3] - p[0]);
      const Vector3 first = along / along.norm(), third = normal / normal.norm();
      frames[i].row(0) = first.transpose();
      frames[i].row(1) = third.cross(first).transpose();
      frames[i].row(2) = third.transpose();
    });
  return frames;
}

ElementNotice addThickness(vtkUnstructuredGrid* grid, const std::string& name, int threads)
{
  const ElementSource source = sourceArray(grid, name, 1, "thickness");
  const auto count = static_cast<std::size_t>(grid->GetNumberOfCells());
  auto thickness = newArray<vtkDoubleArray>("Thickness", 1, count);
  std::vector<std::uint8_t> isWrong(count, 0);
  forEachElement(grid, threads,
    [&](std::size_t i, const ElementCorners& corners)
    {
      double value = 0;
      if (source.isOfCells)
      {
        value = source.array->GetComponent(static_cast<vtkIdType>(i), 0);
      }
      else
      {
        const std::array<double, 4> shares = cornerShares(positionsOf(grid, corners));
        for (std::size_t k = 0; k < 4; ++k)
        {
          value += shares[k] * source.array->GetComponent(corners[k], 0);
        }
      }
      thickness->SetValue(static_cast<vtkIdType>(i), value);
      isWrong[i] = value > 0 && std::isfinite(value) ? 0 : 1;
    });
  grid->GetCellData()->AddArray(thickness);
  return noticeOf(isWrong, 1);
}

ElementNotice addElementAxis(vtkUnstructuredGrid* grid, const std::string& name,
  AxisFallback fallback, std::vector<ElementFrame>& frames, int threads)
{
  const ElementSource source = sourceArray(grid, name, 3, "direction of the elements");
  std::vector<std::uint8_t> marks(frames.size(), 0);
  enum Mark : std::uint8_t
  {
    kFallback = 1,
    kNothing,
    kNotFinite
  };
  forEachElement(grid, threads,
    [&](std::size_t i, const ElementCorners& corners)
    {
      const Vector3 direction = directionOf(source, i, corners);
      if (!direction.allFinite())
      {
        marks[i] = kNotFinite;
        return;
      }
      if (turnTo(frames[i], direction))
      {
        return;
      }
      const bool isGlobal =
        fallback == AxisFallback::X || fallback == AxisFallback::Y || fallback == AxisFallback::Z;
      const bool hasAxis = isGlobal
        ? turnTo(frames[i], Vector3::Unit(static_cast<Eigen::Index>(fallback) - 1))
        : fallback == AxisFallback::Element && frames[i].allFinite();
      marks[i] = hasAxis ? kFallback : kNothing;
    });
  if (const ElementNotice wrong = noticeOf(marks, kNotFinite); wrong.count > 0)
  {
    refuse("the array '", name, "' is not finite in ", wrong.count,
      " elements, the first is element ",
      placeOfElement(grid, static_cast<std::size_t>(wrong.first)));
  }
  if (const ElementNotice lost = noticeOf(marks, kNothing); lost.count > 0)
  {
    refuse("the direction '", name, "' is zero or along the normal of ", lost.count,
      " elements, the first is element ",
      placeOfElement(grid, static_cast<std::size_t>(lost.first)),
      fallback == AxisFallback::None
        ? ": choose what they get instead, a global axis or the direction of the element itself"
        : ", and the axis to take instead is along the normal, too: choose another one, or the "
          "direction of the element itself");
  }
  auto axis = newArray<vtkDoubleArray>("ElementAxis", 3, frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i)
  {
    const Vector3 first = frames[i].row(0).transpose();
    axis->SetTuple(static_cast<vtkIdType>(i), first.data());
  }
  grid->GetCellData()->AddArray(axis);
  return noticeOf(marks, kFallback);
}

void addVectorsInElement(vtkUnstructuredGrid* grid, const std::string& name,
  const std::vector<ElementFrame>& frames, int threads)
{
  const ElementSource source = sourceArray(grid, name, 3, "vectors in the frame of the elements");
  auto array = newArray<vtkDoubleArray>((name + "InElement").c_str(), 3, frames.size());
  forEachElement(grid, threads,
    [&](std::size_t i, const ElementCorners& corners)
    {
      const std::array<double, 4> shares =
        source.isOfCells ? std::array<double, 4>{} : cornerShares(positionsOf(grid, corners));
      const Vector3 local = frames[i] * vectorOf(source, i, corners, shares);
      array->SetTypedTuple(static_cast<vtkIdType>(i), local.data());
    });
  grid->GetCellData()->AddArray(array);
}

} // namespace quadrille

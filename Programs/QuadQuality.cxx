// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadQuality.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDataArray.h>
#include <vtkMath.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <limits>

namespace quadrille
{

namespace
{

using Vector = std::array<double, 3>;

Vector minus(const Vector& a, const Vector& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

Vector cross(const Vector& a, const Vector& b)
{
  Vector c;
  vtkMath::Cross(a.data(), b.data(), c.data());
  return c;
}

double length(const Vector& a)
{
  return vtkMath::Norm(a.data());
}

double scaledJacobian(const std::array<Vector, 4>& p)
{
  const Vector x = minus({ p[1][0] + p[2][0], p[1][1] + p[2][1], p[1][2] + p[2][2] },
    { p[0][0] + p[3][0], p[0][1] + p[3][1], p[0][2] + p[3][2] });
  const Vector y = minus({ p[2][0] + p[3][0], p[2][1] + p[3][1], p[2][2] + p[3][2] },
    { p[0][0] + p[1][0], p[0][1] + p[1][1], p[0][2] + p[1][2] });
  Vector normal = cross(x, y);
  if (vtkMath::Normalize(normal.data()) == 0)
  {
    return 0;
  }
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < 4; ++i)
  {
    const Vector forward = minus(p[(i + 1) % 4], p[i]);
    const Vector backward = minus(p[(i + 3) % 4], p[i]);
    const double scale = length(forward) * length(backward);
    const Vector c = cross(forward, backward);
    least = std::min(least, scale > 0 ? vtkMath::Dot(normal.data(), c.data()) / scale : 0.0);
  }
  return least;
}

void countValences(vtkPolyData* quads, QuadQuality& quality)
{
  vtkDataArray* valence = quads->GetPointData()->GetArray("Valence");
  vtkDataArray* boundary = quads->GetPointData()->GetArray("OnBoundary");
  for (vtkIdType i = 0; valence && boundary && i < quads->GetNumberOfPoints(); ++i)
  {
    const int v = static_cast<int>(valence->GetTuple1(i));
    if (boundary->GetTuple1(i) != 0)
    {
      quality.irregularVertices += v != 3;
      continue;
    }
    ++quality.valences[v];
    quality.irregularVertices += v != 4;
    quality.irregularOther += v != 3 && v != 4 && v != 5;
  }
}

} // namespace

QuadQuality measureQuads(vtkPolyData* quads)
{
  QuadQuality quality;
  quality.minimumScaledJacobian = quads->GetNumberOfPolys() > 0 ? 1 : 0;
  double jacobians = 0;
  double lengths = 0;
  auto cells = vtk::TakeSmartPointer(quads->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    std::array<Vector, 4> p;
    for (std::size_t i = 0; i < 4; ++i)
    {
      quads->GetPoint(ids[i], p[i].data());
    }
    const double jacobian = scaledJacobian(p);
    jacobians += jacobian;
    quality.minimumScaledJacobian = std::min(quality.minimumScaledJacobian, jacobian);
    quality.notPositive += jacobian <= 0;
    for (std::size_t i = 0; i < 4; ++i)
    {
      lengths += length(minus(p[(i + 1) % 4], p[i]));
    }
  }
  const auto n = static_cast<double>(std::max<vtkIdType>(1, quads->GetNumberOfPolys()));
  quality.meanScaledJacobian = jacobians / n;
  quality.meanEdgeLength = lengths / (4 * n);
  countValences(quads, quality);
  return quality;
}

} // namespace quadrille

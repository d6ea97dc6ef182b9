// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadSurfacePick.h"

#include "vtkCell.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkMath.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolygon.h"
#include "vtkTriangle.h"

#include <algorithm>
#include <limits>
#include <vector>

vtkStandardNewMacro(vtkQuadSurfacePick);

namespace
{

void forget(double vector[3])
{
  std::fill_n(vector, 3, std::numeric_limits<double>::quiet_NaN());
}

/// The place of the line through a and b nearest to x.
void footOnLine(const double a[3], const double b[3], const double x[3], double foot[3])
{
  double along[3], from[3];
  vtkMath::Subtract(b, a, along);
  vtkMath::Subtract(x, a, from);
  const double share = vtkMath::Dot(from, along) / vtkMath::Dot(along, along);
  for (int c = 0; c < 3; ++c)
  {
    foot[c] = a[c] + share * along[c];
  }
}

struct PlaceOnCell
{
  double place[3];
  int part = 0;
  std::vector<double> weights;
};

/// The place of the cell nearest to the line: to the line and back to the cell in turns [von Neumann 1949].
PlaceOnCell nearestToLine(vtkCell* cell, const double a[3], const double b[3])
{
  constexpr int turns =
    64; // at 60 degrees to the surface each one leaves three quarters of the way
  PlaceOnCell found;
  found.weights.resize(static_cast<std::size_t>(cell->GetNumberOfPoints()));
  cell->GetPoints()->GetPoint(0, found.place);
  double least = std::numeric_limits<double>::infinity();
  for (vtkIdType i = 0; i < cell->GetNumberOfPoints(); ++i)
  {
    double corner[3], foot[3];
    cell->GetPoints()->GetPoint(i, corner);
    footOnLine(a, b, corner, foot);
    const double squared = vtkMath::Distance2BetweenPoints(corner, foot);
    if (squared < least)
    {
      least = squared;
      std::copy_n(corner, 3, found.place);
    }
  }
  double local[3];
  for (int i = 0; i < turns; ++i)
  {
    double foot[3], nearest[3], squared;
    footOnLine(a, b, found.place, foot);
    if (cell->EvaluatePosition(foot, nearest, found.part, local, squared, found.weights.data()) < 0)
    {
      break; // a cell without area: its corner stays
    }
    std::copy_n(nearest, 3, found.place);
  }
  // Weights are of the foot, which lies outside.
  double back[3], squared;
  cell->EvaluatePosition(found.place, back, found.part, local, squared, found.weights.data());
  return found;
}

/// Of the triangles of a cell of a surface, and of the faces of one of a volume, that which the place lies on.
void flatNormal(vtkCell* cell, const double place[3], double normal[3])
{
  double least = std::numeric_limits<double>::infinity();
  vtkNew<vtkIdList> ids;
  vtkNew<vtkPoints> corners;
  if (cell->GetCellDimension() == 2)
  {
    cell->Triangulate(0, ids, corners);
  }
  for (vtkIdType i = 0; i + 2 < corners->GetNumberOfPoints(); i += 3)
  {
    vtkNew<vtkTriangle> triangle;
    double nearest[3], local[3], weights[3], squared;
    int part = 0;
    for (vtkIdType c = 0; c < 3; ++c)
    {
      triangle->GetPoints()->SetPoint(c, corners->GetPoint(i + c));
    }
    if (triangle->EvaluatePosition(place, nearest, part, local, squared, weights) >= 0 &&
      squared < least)
    {
      least = squared;
      vtkPolygon::ComputeNormal(triangle->GetPoints(), normal);
    }
  }
  for (int i = 0; cell->GetCellDimension() == 3 && i < cell->GetNumberOfFaces(); ++i)
  {
    vtkCell* face = cell->GetFace(i);
    std::vector<double> weights(static_cast<std::size_t>(face->GetNumberOfPoints()));
    double nearest[3], local[3], squared;
    int part = 0;
    if (face->EvaluatePosition(place, nearest, part, local, squared, weights.data()) >= 0 &&
      squared < least)
    {
      least = squared;
      vtkPolygon::ComputeNormal(face->GetPoints(), normal);
    }
  }
}

} // namespace

vtkQuadSurfacePick::vtkQuadSurfacePick()
{
  forget(this->Intersection);
  forget(this->IntersectionNormal);
}

vtkQuadSurfacePick::~vtkQuadSurfacePick() = default;

//------------------------------------------------------------------------------
void vtkQuadSurfacePick::PickCell(vtkDataSet* selected)
{
  vtkCell* cell = selected->GetCell(0);
  double where = 0, local[3];
  PlaceOnCell found;
  found.weights.resize(static_cast<std::size_t>(cell->GetNumberOfPoints()));
  if (cell->IntersectWithLine(
        this->PointA, this->PointB, 0, where, found.place, local, found.part) != 0)
  {
    double same[3];
    cell->EvaluateLocation(found.part, local, same, found.weights.data());
  }
  else
  {
    found = nearestToLine(cell, this->PointA, this->PointB);
  }
  std::copy_n(found.place, 3, this->Intersection);
  vtkDataArray* normals = selected->GetPointData()->GetNormals();
  if (!normals)
  {
    flatNormal(cell, found.place, this->IntersectionNormal);
    return;
  }
  std::fill_n(this->IntersectionNormal, 3, 0.0);
  for (vtkIdType i = 0; i < cell->GetNumberOfPoints(); ++i)
  {
    double normal[3];
    normals->GetTuple(cell->GetPointId(static_cast<int>(i)), normal);
    vtkMath::MultiplyScalar(normal, found.weights[static_cast<std::size_t>(i)]);
    vtkMath::Add(this->IntersectionNormal, normal, this->IntersectionNormal);
  }
  vtkMath::Normalize(this->IntersectionNormal);
}

//------------------------------------------------------------------------------
void vtkQuadSurfacePick::PickFrom(vtkDataSet* selected)
{
  if (!this->SnapOnMeshPoint)
  {
    this->PickCell(selected);
    return;
  }
  selected->GetPoint(0, this->Intersection);
  if (vtkDataArray* normals = selected->GetPointData()->GetNormals())
  {
    normals->GetTuple(0, this->IntersectionNormal);
  }
}

//------------------------------------------------------------------------------
void vtkQuadSurfacePick::ComputeIntersection()
{
  forget(this->Intersection);
  forget(this->IntersectionNormal);
  if (!this->IsComplete() || vtkMath::Distance2BetweenPoints(this->PointA, this->PointB) == 0)
  {
    return;
  }
  const std::vector<vtkSmartPointer<vtkDataSet>> selected = this->GetSelected();
  if (!selected.empty())
  {
    this->PickFrom(selected.front());
  }
  this->Share(!selected.empty());
}

//------------------------------------------------------------------------------
void vtkQuadSurfacePick::Share(bool isFound)
{
  vtkMultiProcessController* ranks = vtkMultiProcessController::GetGlobalController();
  if (!ranks || ranks->GetNumberOfProcesses() < 2)
  {
    return;
  }
  const int mine = isFound ? ranks->GetLocalProcessId() : ranks->GetNumberOfProcesses();
  int first = 0;
  ranks->AllReduce(&mine, &first, 1, vtkCommunicator::MIN_OP);
  if (first < ranks->GetNumberOfProcesses())
  {
    ranks->Broadcast(this->Intersection, 3, first);
    ranks->Broadcast(this->IntersectionNormal, 3, first);
  }
}

//------------------------------------------------------------------------------
void vtkQuadSurfacePick::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PointA: " << this->PointA[0] << " " << this->PointA[1] << " " << this->PointA[2]
     << "\n";
  os << indent << "PointB: " << this->PointB[0] << " " << this->PointB[1] << " " << this->PointB[2]
     << "\n";
  os << indent << "SnapOnMeshPoint: " << this->SnapOnMeshPoint << "\n";
  os << indent << "Intersection: " << this->Intersection[0] << " " << this->Intersection[1] << " "
     << this->Intersection[2] << "\n";
}

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadConstraintSource.h"

#include "Common/NewArray.h"
#include "Convert/PolyData.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <cstddef>

vtkStandardNewMacro(vtkQuadConstraintSource);

//------------------------------------------------------------------------------
vtkQuadConstraintSource::vtkQuadConstraintSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkQuadConstraintSource::~vtkQuadConstraintSource() = default;

//------------------------------------------------------------------------------
void vtkQuadConstraintSource::SetNumberOfPoints(vtkIdType number)
{
  const auto size = static_cast<std::size_t>(number < 0 ? 0 : number);
  if (size != this->Points.size())
  {
    this->Points.resize(size, { 0, 0, 0 });
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkQuadConstraintSource::SetPoint(vtkIdType index, double x, double y, double z)
{
  if (index < 0)
  {
    vtkErrorMacro("there is no point " << index);
    return;
  }
  if (index >= this->GetNumberOfPoints())
  {
    this->SetNumberOfPoints(index + 1);
  }
  std::array<double, 3>& point = this->Points[static_cast<std::size_t>(index)];
  const std::array<double, 3> place{ x, y, z };
  if (point != place)
  {
    point = place;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkQuadConstraintSource::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkPolyData* output = vtkPolyData::GetData(outputs, 0);
  const bool isPoint = this->Kind >= VALENCE;
  if (!this->Enabled || this->Points.size() < (isPoint ? 1 : 2))
  {
    return 1;
  }
  const vtkIdType count = isPoint ? 1 : this->GetNumberOfPoints();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cell;
  const bool isClosed = !isPoint && (this->Kind == CYCLE || (this->Closed && this->Kind < MOVE));
  cell->InsertNextCell(static_cast<int>(count + (isClosed ? 1 : 0)));
  for (vtkIdType i = 0; i < count; ++i)
  {
    cell->InsertCellPoint(
      points->InsertNextPoint(this->Points[static_cast<std::size_t>(i)].data()));
  }
  if (isClosed)
  {
    cell->InsertCellPoint(0);
  }
  output->SetPoints(points);
  isPoint ? output->SetVerts(cell) : output->SetLines(cell);
  auto valence = quadrille::newArray<vtkIntArray>(
    quadrille::arrays::kTargetValence, 1, static_cast<std::size_t>(count));
  valence->Fill(this->Kind == VALENCE ? this->Valence : 0);
  output->GetPointData()->AddArray(valence);
  // All kinds have all arrays, so that they can be put together.
  auto type = quadrille::newArray<vtkIntArray>(quadrille::arrays::kConstraintType);
  auto weight = quadrille::newArray<vtkDoubleArray>(quadrille::arrays::kGuidingWeight);
  auto radius = quadrille::newArray<vtkDoubleArray>(quadrille::arrays::kGuidingRadius);
  auto factor = quadrille::newArray<vtkDoubleArray>(quadrille::arrays::kSizeFactor);
  type->InsertNextValue(this->Kind == VALENCE ? 0 : this->Kind);
  weight->InsertNextValue(this->Weight);
  radius->InsertNextValue(this->Radius);
  factor->InsertNextValue(this->Factor);
  output->GetCellData()->AddArray(type);
  output->GetCellData()->AddArray(weight);
  output->GetCellData()->AddArray(radius);
  output->GetCellData()->AddArray(factor);
  return 1;
}

//------------------------------------------------------------------------------
void vtkQuadConstraintSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Kind: " << this->Kind << "\n";
  os << indent << "Enabled: " << this->Enabled << "\n";
  os << indent << "NumberOfPoints: " << this->GetNumberOfPoints() << "\n";
  os << indent << "Closed: " << this->Closed << "\n";
  os << indent << "Valence: " << this->Valence << "\n";
  os << indent << "Weight: " << this->Weight << "\n";
  os << indent << "Radius: " << this->Radius << "\n";
  os << indent << "Factor: " << this->Factor << "\n";
}

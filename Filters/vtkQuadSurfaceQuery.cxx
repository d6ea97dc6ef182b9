// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadSurfaceQuery.h"

#include "vtkAlgorithm.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkExtractSelection.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"

namespace
{

std::vector<vtkSmartPointer<vtkDataSet>> partsOf(vtkDataObject* data)
{
  std::vector<vtkSmartPointer<vtkDataSet>> parts;
  const auto add = [&parts](vtkDataObject* part)
  {
    auto* cells = vtkDataSet::SafeDownCast(part);
    if (cells && cells->GetNumberOfCells() > 0)
    {
      parts.emplace_back(cells);
    }
  };
  add(data);
  if (auto* blocks = vtkCompositeDataSet::SafeDownCast(data))
  {
    auto iterator = vtk::TakeSmartPointer(blocks->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      add(iterator->GetCurrentDataObject());
    }
  }
  return parts;
}

} // namespace

vtkQuadSurfaceQuery::vtkQuadSurfaceQuery() = default;
vtkQuadSurfaceQuery::~vtkQuadSurfaceQuery() = default;

//------------------------------------------------------------------------------
void vtkQuadSurfaceQuery::Set(vtkSmartPointer<vtkAlgorithm>& member, vtkAlgorithm* value)
{
  if (member != value)
  {
    member = value;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkQuadSurfaceQuery::SetInput(vtkAlgorithm* input)
{
  this->Set(this->Input, input);
}

//------------------------------------------------------------------------------
void vtkQuadSurfaceQuery::SetSelection(vtkAlgorithm* selection)
{
  this->Set(this->Selection, selection);
}

//------------------------------------------------------------------------------
std::vector<vtkSmartPointer<vtkDataSet>> vtkQuadSurfaceQuery::GetSelected()
{
  vtkMultiProcessController* ranks = vtkMultiProcessController::GetGlobalController();
  vtkNew<vtkExtractSelection> extract;
  extract->SetInputConnection(0, this->Input->GetOutputPort(0));
  extract->SetInputConnection(1, this->Selection->GetOutputPort(0));
  extract->UpdatePiece(
    ranks ? ranks->GetLocalProcessId() : 0, ranks ? ranks->GetNumberOfProcesses() : 1, 0);
  return partsOf(extract->GetOutputDataObject(0));
}

//------------------------------------------------------------------------------
std::vector<vtkSmartPointer<vtkDataSet>> vtkQuadSurfaceQuery::GetAll()
{
  std::vector<vtkSmartPointer<vtkDataSet>> copies;
  for (vtkDataSet* part : this->Input ? partsOf(this->Input->GetOutputDataObject(0))
                                      : std::vector<vtkSmartPointer<vtkDataSet>>{})
  {
    auto copy = vtk::TakeSmartPointer(part->NewInstance());
    copy->ShallowCopy(part);
    copies.emplace_back(copy);
  }
  return copies;
}

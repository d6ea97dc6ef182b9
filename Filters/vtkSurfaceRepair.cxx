// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceRepair.h"

#include "Blocks/Blocks.h"
#include "Common/NewArray.h"
#include "Common/Report.h"
#include "Convert/Soup.h"
#include "Repair/SoupRepair.h"

#include "vtkCellData.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

vtkStandardNewMacro(vtkSurfaceRepair);

namespace
{

void addMarks(vtkPolyData* data, const char* name, const std::vector<std::uint8_t>& marks)
{
  const auto array = quadrille::newArray<vtkUnsignedCharArray>(name, 1, marks.size());
  std::copy(marks.begin(), marks.end(), array->GetPointer(0));
  data->GetCellData()->AddArray(array);
}

} // namespace

//------------------------------------------------------------------------------
vtkSurfaceRepair::vtkSurfaceRepair() = default;
vtkSurfaceRepair::~vtkSurfaceRepair() = default;

//------------------------------------------------------------------------------
void vtkSurfaceRepair::Execute(quadrille::Block& block)
{
  const quadrille::ConvertedSoup input =
    quadrille::convertSoup(block.input(), this->NumberOfThreads);
  quadrille::SoupRepairOptions options;
  options.fillBelow = this->FillHolesBelow;
  options.findSelfIntersections = this->FindSelfIntersections != 0;
  options.progress = this->MakeProgress(0, 1);
  const quadrille::RepairedSoup repaired = quadrille::repairSoup(input.soup, options);
  const vtkSmartPointer<vtkPolyData> surface = quadrille::writeTriangleList(repaired.surface);
  for (const std::string& text :
    quadrille::carryFromNearest(block.input(), input, surface, this->NumberOfThreads))
  {
    this->AddWarning(text);
  }
  addMarks(surface, "Filling", repaired.isFilling);
  if (options.findSelfIntersections)
  {
    addMarks(surface, "SelfIntersecting", repaired.isIntersecting);
  }
  const quadrille::SoupReport& report = repaired.report;
  quadrille::addNumber(surface, "SelfIntersections",
    options.findSelfIntersections ? static_cast<double>(report.intersectingPairs) : -1);
  quadrille::addCount(surface, "FilledHoles", report.filledHoles);
  quadrille::addCount(surface, "OpenBoundaries", report.openBoundaries);
  quadrille::addCount(surface, "Components", report.components);
  quadrille::addCount(surface, "NeedsWrap", report.isHopeless(repaired.surface.corners.size()));
  for (const std::string& sentence : report.sentences())
  {
    this->AddNotice(sentence);
  }
  block.output()->ShallowCopy(surface);
  this->SetResult(std::to_string(repaired.surface.corners.size()) + " triangles in " +
    std::to_string(report.components) + (report.components == 1 ? " component" : " components"));
}

//------------------------------------------------------------------------------
void vtkSurfaceRepair::AddSettings(std::ostream& os) const
{
  this->Superclass::AddSettings(os);
  os << "FillHolesBelow " << this->FillHolesBelow << '\n'
     << "FindSelfIntersections " << this->FindSelfIntersections << '\n';
}

//------------------------------------------------------------------------------
void vtkSurfaceRepair::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FillHolesBelow: " << this->FillHolesBelow << "\n";
  os << indent << "FindSelfIntersections: " << this->FindSelfIntersections << "\n";
}

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadProjection.h"

#include "Base/Refuse.h"
#include "Blocks/Blocks.h"
#include "Common/NewArray.h"
#include "Common/Report.h"
#include "Convert/Soup.h"
#include "ElementGrids/ElementGrid.h"
#include "Quads/QuadProjection.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

vtkStandardNewMacro(vtkQuadProjection);

namespace
{

constexpr double kPartOfDiagonal = 1.0 / 300; // twice the offset of a wrap by default

double offsetOf(vtkPolyData* quads)
{
  vtkDataArray* offset = quads->GetFieldData()->GetArray("WrapOffset");
  return offset && offset->GetNumberOfTuples() == 1 ? offset->GetTuple1(0) : 0;
}

/// The quads with other points, without what names places of the surface that they were made on.
void writeProjected(vtkPolyData* quads, const std::vector<quadrille::Vector3>& before,
  const std::vector<quadrille::Vector3>& after, vtkPolyData* output)
{
  output->ShallowCopy(quads);
  const auto coordinates = quadrille::newArray<vtkDoubleArray>("Points", 3, after.size());
  const auto marks = quadrille::newArray<vtkUnsignedCharArray>("OnSurface", 1, after.size());
  for (std::size_t i = 0; i < after.size(); ++i)
  {
    coordinates->SetTuple(static_cast<vtkIdType>(i), after[i].data());
    marks->SetValue(static_cast<vtkIdType>(i), after[i] == before[i] ? 0 : 1);
  }
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  output->SetPoints(points);
  for (const char* name : { quadrille::arrays::kSourceCellId, quadrille::arrays::kSourcePointIds,
         quadrille::arrays::kSourceBarycentric, quadrille::arrays::kQuadNormals })
  {
    output->GetPointData()->RemoveArray(name);
    output->GetCellData()->RemoveArray(name);
  }
  output->GetPointData()->AddArray(marks);
}

void tellStaying(std::size_t count, const char* reason, std::string& text)
{
  if (count > 0)
  {
    text += (text.empty() ? "" : "; ") + std::to_string(count) + reason;
  }
}

} // namespace

//------------------------------------------------------------------------------
vtkQuadProjection::vtkQuadProjection()
{
  this->SetNumberOfInputPorts(2);
}

vtkQuadProjection::~vtkQuadProjection() = default;

//------------------------------------------------------------------------------
vtkQuadrilleAlgorithm::PortRole vtkQuadProjection::GetPortRole(int port) const
{
  return port == 0 ? PortRole::Mesh : PortRole::Surface;
}

//------------------------------------------------------------------------------
void vtkQuadProjection::Execute(quadrille::Block& block)
{
  vtkPolyData* quads = block.input();
  const std::vector<std::array<quadrille::Index, 4>> corners = quadrille::readQuads(quads);
  if (!block.input(1))
  {
    quadrille::refuse("there is no surface to put the quads onto: connect the second input");
  }
  const quadrille::ConvertedSoup surface =
    quadrille::convertSoup(block.input(1), this->NumberOfThreads);
  if (surface.soup.triangles.corners.empty())
  {
    quadrille::refuse("the second input has no polygons: quads are put onto a surface only");
  }
  const std::vector<quadrille::Vector3> before =
    quadrille::readPointPositions(quads, this->NumberOfThreads);
  quadrille::QuadProjectionOptions options;
  options.distance = this->MaximumDistance > 0 ? this->MaximumDistance
    : offsetOf(quads) > 0                      ? 2 * offsetOf(quads)
                                               : kPartOfDiagonal * surface.soup.diagonal;
  options.angle = vtkMath::RadiansFromDegrees(this->MaximumAngle);
  options.threads = this->NumberOfThreads;
  std::vector<quadrille::Vector3> after = before;
  const quadrille::NearestTriangle tree(surface.soup.triangles);
  const quadrille::QuadProjectionReport report =
    quadrille::projectQuads(after, corners, tree, options);
  writeProjected(quads, before, after, block.output());
  quadrille::addCount(block.output(), "PointsOnSurface", report.moved);
  std::string staying;
  tellStaying(report.far, " are farther from the surface than they may be", staying);
  tellStaying(report.turned, " have another direction than the surface there", staying);
  tellStaying(report.twoSided, " lie on one of two sides round a sheet", staying);
  tellStaying(report.kept, " would turn a quad over", staying);
  if (!staying.empty())
  {
    this->AddNotice("of the points that stay off the surface " + staying);
  }
  this->SetResult(std::to_string(report.moved) + " of " + std::to_string(after.size()) +
    " points lie on the surface");
}

//------------------------------------------------------------------------------
void vtkQuadProjection::AddSettings(std::ostream& os) const
{
  this->Superclass::AddSettings(os);
  os << "MaximumDistance " << this->MaximumDistance << '\n'
     << "MaximumAngle " << this->MaximumAngle << '\n';
}

//------------------------------------------------------------------------------
void vtkQuadProjection::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaximumDistance: " << this->MaximumDistance << "\n";
  os << indent << "MaximumAngle: " << this->MaximumAngle << "\n";
}

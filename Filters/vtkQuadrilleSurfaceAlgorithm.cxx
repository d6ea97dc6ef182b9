// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleSurfaceAlgorithm.h"

#include "Pipeline/Pipeline.h"
#include "QuadrilleBlocks.h"
#include "QuadrilleConvert.h"
#include "QuadrilleCurves.h"

#include "vtkCellData.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>

//------------------------------------------------------------------------------
vtkQuadrilleSurfaceAlgorithm::vtkQuadrilleSurfaceAlgorithm()
{
  this->SetNumberOfInputPorts(2);
}

vtkQuadrilleSurfaceAlgorithm::~vtkQuadrilleSurfaceAlgorithm() = default;

//------------------------------------------------------------------------------
void vtkQuadrilleSurfaceAlgorithm::SetCoarseVertices(int number)
{
  const int clamped = number <= 0 ? 0 : std::max(number, 4);
  if (this->CoarseVertices != clamped)
  {
    this->CoarseVertices = clamped;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleSurfaceAlgorithm::SetPatchArrayName(const char* name)
{
  const std::string value = name ? name : "";
  if (value != this->PatchArrayName)
  {
    this->PatchArrayName = value;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
quadrille::ConvertedSurface vtkQuadrilleSurfaceAlgorithm::ConvertInputs(quadrille::Block& block)
{
  vtkPolyData* data = block.input(0);
  quadrille::ConvertedSurface surface =
    quadrille::convertSurface(data, this->PatchArrayName, this->NumberOfThreads);
  if (surface.ignoredCells > 0)
  {
    this->AddNotice(std::to_string(surface.ignoredCells) + " vertex and line cells are not used");
  }
  this->WarnOfUnusedArrays(data);
  vtkPolyData* curves = block.input(1);
  if (curves && curves->GetNumberOfCells() > 0)
  {
    for (const std::string& notice : quadrille::applyCurves(surface, data, curves))
    {
      this->AddNotice(notice);
      vtkWarningMacro(<< notice);
    }
  }
  return surface;
}

//------------------------------------------------------------------------------
void vtkQuadrilleSurfaceAlgorithm::WarnOfUnusedArrays(vtkPolyData* surface)
{
  const auto warn = [this](vtkDataSetAttributes* attributes, const char* name)
  {
    if (attributes->HasArray(name))
    {
      const std::string text = std::string("array '") + name + "' is not used by this version";
      this->AddNotice(text);
      vtkWarningMacro(<< text);
    }
  };
  warn(surface->GetPointData(), "ConnectId");
}

//------------------------------------------------------------------------------
quadrille::RemeshOptions vtkQuadrilleSurfaceAlgorithm::MakeOptions(
  const quadrille::Block& block)
{
  quadrille::RemeshOptions options;
  if (this->TargetType == TARGET_NUMBER_OF_QUADS)
  {
    if (this->NumberOfQuads < 1)
    {
      throw quadrille::InvalidInput("NumberOfQuads must be at least 1");
    }
    const double share = block.areaShare * static_cast<double>(this->NumberOfQuads);
    options.quads = static_cast<std::size_t>(std::max(1.0, std::round(share)));
  }
  else if (this->TargetType == TARGET_EDGE_LENGTH)
  {
    options.edgeLength = this->EdgeLength;
  }
  else if (block.wholeDiagonal > 0)
  {
    options.edgeLength = this->RelativeEdgeLength * block.wholeDiagonal;
  }
  options.relativeEdgeLength = this->RelativeEdgeLength;
  options.featureAngle.reset();
  if (this->DetectFeatures)
  {
    options.featureAngle = vtkMath::RadiansFromDegrees(this->FeatureAngle);
  }
  options.coarseVertices = static_cast<quadrille::Index>(this->CoarseVertices);
  options.threads = this->NumberOfThreads;
  return options;
}

//------------------------------------------------------------------------------
void vtkQuadrilleSurfaceAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TargetType: " << this->TargetType << "\n";
  os << indent << "NumberOfQuads: " << this->NumberOfQuads << "\n";
  os << indent << "EdgeLength: " << this->EdgeLength << "\n";
  os << indent << "RelativeEdgeLength: " << this->RelativeEdgeLength << "\n";
  os << indent << "DetectFeatures: " << this->DetectFeatures << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "PatchArrayName: " << this->PatchArrayName << "\n";
  os << indent << "CoarseVertices: " << this->CoarseVertices << "\n";
}

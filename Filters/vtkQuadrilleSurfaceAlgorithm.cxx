// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleSurfaceAlgorithm.h"

#include "Pipeline/Pipeline.h"
#include "QuadrilleConvert.h"
#include "QuadrilleCurves.h"

#include "vtkCellData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>

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
int vtkQuadrilleSurfaceAlgorithm::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

//------------------------------------------------------------------------------
quadrille::ConvertedSurface vtkQuadrilleSurfaceAlgorithm::ConvertInputs(
  vtkInformationVector** inputs)
{
  vtkPolyData* data = vtkPolyData::GetData(inputs[0]);
  quadrille::ConvertedSurface surface = quadrille::convertSurface(data, this->PatchArrayName);
  if (surface.ignoredCells > 0)
  {
    this->AddNotice(std::to_string(surface.ignoredCells) + " vertex and line cells are not used");
  }
  this->WarnOfUnusedArrays(data);
  vtkPolyData* curves = vtkPolyData::GetData(inputs[1]);
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
quadrille::RemeshOptions vtkQuadrilleSurfaceAlgorithm::MakeOptions()
{
  quadrille::RemeshOptions options;
  if (this->TargetType == TARGET_NUMBER_OF_QUADS)
  {
    if (this->NumberOfQuads < 1)
    {
      throw quadrille::InvalidInput("NumberOfQuads must be at least 1");
    }
    options.quads = static_cast<std::size_t>(this->NumberOfQuads);
  }
  else if (this->TargetType == TARGET_EDGE_LENGTH)
  {
    options.edgeLength = this->EdgeLength;
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

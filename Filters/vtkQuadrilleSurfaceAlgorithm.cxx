// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleSurfaceAlgorithm.h"

#include "Blocks/BlockQuads.h"
#include "Blocks/Blocks.h"
#include "Convert/PolyData.h"
#include "Pipeline/Options.h"
#include "Pipeline/QuadsOfShape.h"
#include "Runs/GivenInputs.h"

#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>

//------------------------------------------------------------------------------
vtkQuadrilleSurfaceAlgorithm::vtkQuadrilleSurfaceAlgorithm()
{
  this->SetNumberOfInputPorts(4);
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
void vtkQuadrilleSurfaceAlgorithm::SetGuideArrayName(const char* name)
{
  const std::string value = name ? name : "";
  if (value != this->GuideArrayName)
  {
    this->GuideArrayName = value;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
std::string vtkQuadrilleSurfaceAlgorithm::GetGuideArrayInUse() const
{
  return this->GuideArrayName == "(none)" ? "" : this->GuideArrayName;
}

//------------------------------------------------------------------------------
quadrille::GivenInputs vtkQuadrilleSurfaceAlgorithm::GetGivenInputs(
  const quadrille::Block& block) const
{
  quadrille::GivenInputs given;
  for (std::size_t port = 0; port < block.inputs.size(); ++port)
  {
    given.ports.emplace_back(block.input(static_cast<int>(port)));
  }
  given.patchArray = this->PatchArrayName;
  given.guideArray = this->GetGuideArrayInUse();
  given.strokeWeight = this->StrokeWeight;
  given.strokeRadius = this->StrokeRadius;
  given.pointValence = this->PointValence;
  given.options = this->MakeOptions(block);
  return given;
}

//------------------------------------------------------------------------------
void vtkQuadrilleSurfaceAlgorithm::TellOfInputs(const std::vector<quadrille::ToldOfInputs>& told)
{
  for (const quadrille::ToldOfInputs& word : told)
  {
    word.isWarning ? this->AddWarning(word.text) : this->AddNotice(word.text);
  }
}

//------------------------------------------------------------------------------
quadrille::ConvertedSurface vtkQuadrilleSurfaceAlgorithm::ConvertInputs(
  const quadrille::Block& block, quadrille::AskedConstraints& asked)
{
  std::vector<quadrille::ToldOfInputs> told;
  try
  {
    quadrille::ConvertedSurface surface =
      quadrille::readInputs(this->GetGivenInputs(block), told, asked);
    this->TellOfInputs(told);
    return surface;
  }
  catch (const std::exception&)
  {
    this->TellOfInputs(told);
    throw;
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleSurfaceAlgorithm::SetQuadsOfBlocks(const char* pairs)
{
  const std::string value = pairs ? pairs : "";
  if (value != this->QuadsOfBlocks)
  {
    this->QuadsOfBlocks = value;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
double vtkQuadrilleSurfaceAlgorithm::GetQuadsOfAll() const
{
  return static_cast<double>(this->NumberOfQuads != BY_SHAPE
      ? this->NumberOfQuads
      : static_cast<vtkIdType>(quadrille::kLeastQuadsOfShape));
}

//------------------------------------------------------------------------------
double vtkQuadrilleSurfaceAlgorithm::GetSharedTarget() const
{
  return this->TargetType == TARGET_NUMBER_OF_QUADS ? this->GetQuadsOfAll() : 0;
}

//------------------------------------------------------------------------------
double vtkQuadrilleSurfaceAlgorithm::LeastAreaShare(std::size_t blocks, double target) const
{
  // Fewer quads than this are no shape of a part, whatever the others are.
  constexpr double leastQuads = 50;
  const double quads = this->TargetType == TARGET_NUMBER_OF_QUADS ? target : this->GetQuadsOfAll();
  return std::min(leastQuads / std::max(1.0, quads),
    0.5 / static_cast<double>(std::max(blocks, std::size_t{ 1 })));
}

//------------------------------------------------------------------------------
double vtkQuadrilleSurfaceAlgorithm::ReadOwnTarget(
  const std::string& block, vtkFieldData* fieldData) const
{
  if (this->TargetType != TARGET_NUMBER_OF_QUADS)
  {
    return 0;
  }
  for (const quadrille::BlockQuads& pair : quadrille::readBlockQuads(this->QuadsOfBlocks))
  {
    if (quadrille::isNamed(block, pair.block))
    {
      return pair.quads;
    }
  }
  return quadrille::quadsInFieldData(fieldData);
}

//------------------------------------------------------------------------------
void vtkQuadrilleSurfaceAlgorithm::CheckBlockNames(const std::vector<std::string>& names) const
{
  quadrille::checkBlockQuads(quadrille::readBlockQuads(this->QuadsOfBlocks), names);
}

//------------------------------------------------------------------------------
quadrille::RemeshOptions vtkQuadrilleSurfaceAlgorithm::MakeOptions(
  const quadrille::Block& block) const
{
  quadrille::RemeshOptions options;
  if (this->TargetType == TARGET_NUMBER_OF_QUADS)
  {
    if (this->NumberOfQuads < 0)
    {
      throw quadrille::InvalidInput(
        "NumberOfQuads must be at least 1, or 0 for as many as the shape needs");
    }
    const double share =
      block.ownTarget > 0 ? block.ownTarget : block.areaShare * this->GetQuadsOfAll();
    options.quads = static_cast<std::size_t>(std::max(1.0, std::round(share)));
    options.growsWithShape = this->NumberOfQuads == BY_SHAPE && !(block.ownTarget > 0);
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
  vtkPolyData* surface = block.input(0);
  const bool isKnown = surface && surface->GetFieldData()->HasArray(quadrille::arrays::kCadShape);
  if (this->DetectFeatures && !isKnown) // of CAD files the reader has marked them
  {
    options.featureAngle = vtkMath::RadiansFromDegrees(this->FeatureAngle);
  }
  options.featureCriterion = this->FeatureCriterion == FEATURES_BY_ANGLE
    ? quadrille::FeatureCriterion::Angle
    : quadrille::FeatureCriterion::Creases;
  options.coarseVertices = static_cast<quadrille::Index>(this->CoarseVertices);
  options.threads = this->NumberOfThreads;
  return options;
}

//------------------------------------------------------------------------------
void vtkQuadrilleSurfaceAlgorithm::AddSettings(std::ostream& os) const
{
  this->Superclass::AddSettings(os);
  os << "TargetType " << this->TargetType << '\n'
     << "NumberOfQuads " << this->NumberOfQuads << '\n'
     << "QuadsAre " << this->QuadsAre << '\n'
     << "QuadsOfBlocks " << this->QuadsOfBlocks.size() << ' ' << this->QuadsOfBlocks << '\n'
     << "EdgeLength " << this->EdgeLength << '\n'
     << "RelativeEdgeLength " << this->RelativeEdgeLength << '\n'
     << "DetectFeatures " << this->DetectFeatures << '\n'
     << "FeatureAngle " << this->FeatureAngle << '\n'
     << "FeatureCriterion " << this->FeatureCriterion << '\n'
     << "PatchArrayName " << this->PatchArrayName << '\n'
     << "CoarseVertices " << this->CoarseVertices << '\n'
     << "StrokeWeight " << this->StrokeWeight << '\n'
     << "StrokeRadius " << this->StrokeRadius << '\n'
     << "GuideArrayName " << this->GuideArrayName << '\n'
     << "PointValence " << this->PointValence << '\n';
}

//------------------------------------------------------------------------------
void vtkQuadrilleSurfaceAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TargetType: " << this->TargetType << "\n";
  os << indent << "NumberOfQuads: " << this->NumberOfQuads << "\n";
  os << indent << "QuadsAre: " << this->QuadsAre << "\n";
  os << indent << "QuadsOfBlocks: " << this->QuadsOfBlocks << "\n";
  os << indent << "EdgeLength: " << this->EdgeLength << "\n";
  os << indent << "RelativeEdgeLength: " << this->RelativeEdgeLength << "\n";
  os << indent << "DetectFeatures: " << this->DetectFeatures << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "FeatureCriterion: " << this->FeatureCriterion << "\n";
  os << indent << "PatchArrayName: " << this->PatchArrayName << "\n";
  os << indent << "CoarseVertices: " << this->CoarseVertices << "\n";
  os << indent << "StrokeWeight: " << this->StrokeWeight << "\n";
  os << indent << "StrokeRadius: " << this->StrokeRadius << "\n";
  os << indent << "GuideArrayName: " << this->GuideArrayName << "\n";
  os << indent << "PointValence: " << this->PointValence << "\n";
}

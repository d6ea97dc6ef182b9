// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleSurfaceAlgorithm.h"

#include "Blocks/BlockQuads.h"
#include "Blocks/Blocks.h"
#include "Constraints/ConstraintTable.h"
#include "Constraints/Constraints.h"
#include "Convert/ArrayNames.h"
#include "Convert/PolyData.h"
#include "Pipeline/Pipeline.h"
#include "Pipeline/SizedSurface.h"
#include "Prepare/ConstraintPlacement.h"
#include "Runs/InPieces.h"

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
quadrille::ConvertedSurface vtkQuadrilleSurfaceAlgorithm::ConvertInputs(
  quadrille::Block& block, quadrille::AskedConstraints* asked)
{
  vtkPolyData* data = block.input(0);
  this->WarnOfUnusedArrays(block);
  quadrille::ConvertedSurface surface =
    quadrille::convertSurface(data, this->PatchArrayName, this->NumberOfThreads);
  if (!this->GetGuideArrayInUse().empty())
  {
    quadrille::addGuideArray(data, this->GuideArrayName, surface);
  }
  this->TellIgnored(surface);
  quadrille::ConstraintInputs constraints;
  constraints.curves = block.input(1);
  constraints.strokes = block.input(2);
  constraints.points = block.input(3);
  if (this->GetNumberOfInputPorts() > 5)
  {
    constraints.connections = block.input(4);
    constraints.cycles = block.input(5);
  }
  if (this->GetNumberOfInputPorts() > 6)
  {
    constraints.mixed = block.input(6);
  }
  constraints.surface = data;
  constraints.strokeWeight = this->StrokeWeight;
  constraints.strokeRadius = this->StrokeRadius;
  constraints.valence = this->PointValence;
  constraints.threads = this->NumberOfThreads;
  if (constraints.points || constraints.mixed)
  {
    constraints.sameWithin = quadrille::kOnePlace *
      quadrille::targetEdgeLength(this->MakeOptions(block),
        quadrille::areaOfPolygons(surface.input), quadrille::diagonalOf(surface.input));
  }
  if (asked)
  {
    asked->arrays = quadrille::arrayConstraints(
      surface.input, [&surface](quadrille::Index polygon) { return surface.cell(polygon); });
  }
  quadrille::PlacedConstraints result = quadrille::applyConstraints(surface, constraints);
  for (const std::string& notice : result.notices)
  {
    this->AddWarning(notice);
  }
  if (asked)
  {
    asked->placed = std::move(result.placed);
  }
  else if (std::any_of(result.placed.begin(), result.placed.end(),
             [](const quadrille::PlacedConstraint& placed)
             { return placed.kind == quadrille::ConstraintKind::Move; }))
  {
    throw quadrille::InvalidInput(
      "an irregular vertex is to be moved, which needs the quads without "
      "the move: only Quad Remesh can do this");
  }
  return surface;
}

//------------------------------------------------------------------------------
quadrille::ConvertedSurface vtkQuadrilleSurfaceAlgorithm::ConvertForPieces(
  const quadrille::Block& block)
{
  this->WarnOfUnusedArrays(block);
  quadrille::ConvertedSurface surface = quadrille::polygonsOf(block.input(0));
  this->TellIgnored(surface);
  return surface;
}

//------------------------------------------------------------------------------
void vtkQuadrilleSurfaceAlgorithm::TellIgnored(const quadrille::ConvertedSurface& surface)
{
  if (surface.ignoredCells > 0)
  {
    this->AddNotice(std::to_string(surface.ignoredCells) + " vertex and line cells are not used");
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleSurfaceAlgorithm::WarnOfUnusedArrays(const quadrille::Block& block)
{
  const auto warn = [&](int port, const char* name, const std::vector<quadrille::ReadArray>& read)
  {
    if (vtkPolyData* data = block.input(port))
    {
      for (const std::string& notice : quadrille::arrayNotices(data, name, read))
      {
        this->AddWarning(notice);
      }
    }
  };
  warn(0, "the surface", quadrille::surfaceArrays(this->PatchArrayName));
  warn(1, "the feature curves", quadrille::lineArrays());
  warn(2, "the guiding strokes", quadrille::lineArrays());
  warn(3, "the valence points", quadrille::pointArrays());
  if (this->GetNumberOfInputPorts() > 6)
  {
    std::vector<quadrille::ReadArray> all = quadrille::lineArrays();
    for (const quadrille::ReadArray& array : quadrille::pointArrays())
    {
      all.push_back(array);
    }
    warn(6, "the constraints", all);
  }
  for (const std::string& notice :
    quadrille::partnerNotices(block.input(0), block.input(1), block.input(2)))
  {
    this->AddWarning(notice);
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
double vtkQuadrilleSurfaceAlgorithm::GetSharedTarget() const
{
  return this->TargetType == TARGET_NUMBER_OF_QUADS ? static_cast<double>(this->NumberOfQuads) : 0;
}

//------------------------------------------------------------------------------
double vtkQuadrilleSurfaceAlgorithm::LeastAreaShare(std::size_t blocks, double target) const
{
  // Fewer quads than this are no shape of a part, whatever the others are.
  constexpr double leastQuads = 50;
  const double quads =
    this->TargetType == TARGET_NUMBER_OF_QUADS ? target : static_cast<double>(this->NumberOfQuads);
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
    if (this->NumberOfQuads < 1)
    {
      throw quadrille::InvalidInput("NumberOfQuads must be at least 1");
    }
    const double share = block.ownTarget > 0
      ? block.ownTarget
      : block.areaShare * static_cast<double>(this->NumberOfQuads);
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

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadRemesh.h"

#include "Base/Angles.h"
#include "Base/Error.h"
#include "Base/InvalidElement.h"
#include "Base/InvalidPolygon.h"
#include "Blocks/Blocks.h"
#include "Blocks/LevelMemory.h"
#include "Blocks/Together.h"
#include "Common/Report.h"
#include "Convert/MappedOutput.h"
#include "Convert/PolyData.h"
#include "Convert/Quads.h"
#include "Evaluation/ConstraintMeasures.h"
#include "Pipeline/Pipeline.h"
#include "Pipeline/QuadsOfShape.h"
#include "Pipeline/ResultStore.h"
#include "Runs/BackgroundRun.h"
#include "Runs/Problems.h"
#include "Runs/RunOfBlock.h"
#include "Ways/Ways.h"

#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <cstddef>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkQuadRemesh);

namespace
{

/// Numbers of a block's report: what would mend it.
constexpr const char* kMendedBySmaller = "MendedBySmaller"; // quads
constexpr const char* kIsTooLarge = "IsTooLarge";

} // namespace

//------------------------------------------------------------------------------
vtkQuadRemesh::vtkQuadRemesh()
{
  this->SetNumberOfInputPorts(7);
  this->SetNumberOfOutputPorts(9);
}

//------------------------------------------------------------------------------
vtkQuadRemesh::~vtkQuadRemesh() = default;

//------------------------------------------------------------------------------
int vtkQuadRemesh::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 6)
  {
    info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  }
  return this->Superclass::FillInputPortInformation(port, info);
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::SetKeepLevels(vtkTypeBool on)
{
  if (!on)
  {
    this->VisitStates(
      [](quadrille::BlockState& state)
      {
        state.memory.reset();
        state.earlier.clear();
      });
  }
  if (this->KeepLevels != on)
  {
    this->KeepLevels = on;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
double vtkQuadRemesh::GetRememberedMegabytes() const
{
  if (this->GetIsUnderway() != 0 || (this->Ending && !this->Ending->isOver()))
  {
    return this->RememberedBefore;
  }
  std::size_t bytes = 0;
  this->VisitStates(
    [&bytes](quadrille::BlockState& state)
    {
      bytes += state.memory ? state.memoryAs<quadrille::LevelMemory>().levels.bytes() : 0;
      bytes += state.bytesOfEarlier();
    });
  return 1e-6 * static_cast<double>(bytes);
}

//------------------------------------------------------------------------------
vtkPolyData* vtkQuadRemesh::GetPolyDataOutputAt(int port)
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(port));
}

//------------------------------------------------------------------------------
const char* vtkQuadRemesh::GetBlockType(int outputPort) const
{
  return outputPort == 6 ? "vtkTable" : "vtkPolyData";
}

//------------------------------------------------------------------------------
vtkTable* vtkQuadRemesh::GetConstraintTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(6));
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::CheckProperties() const
{
  if (this->MaximumNumberOfQuads < 1)
  {
    throw quadrille::InvalidInput("MaximumNumberOfQuads must be at least 1");
  }
  if (this->SmoothingSteps < 0)
  {
    throw quadrille::InvalidInput("SmoothingSteps must be at least 0");
  }
}

//------------------------------------------------------------------------------
quadrille::RemeshOptions vtkQuadRemesh::MakeRunOptions(const quadrille::Block& block)
{
  quadrille::RemeshOptions options = this->MakeOptions(block);
  options.maximumNumberOfQuads = static_cast<std::size_t>(this->MaximumNumberOfQuads);
  options.smoothingSteps = this->SmoothingSteps;
  if (this->MemoryLimit > 0)
  {
    options.memoryLimit = 1e6 * this->MemoryLimit;
  }
  options.method = static_cast<quadrille::MapMethod>(this->Method);
  options.coarsestIntegers = this->Integers == INTEGERS_COARSEST;
  options.anisotropyLimit = this->AnisotropyLimit;
  this->SetSizes(options);
  if (this->CurvatureGuides)
  {
    options.curvatureGuides = this->LeastAnisotropy;
  }
  options.smallestDetail = this->SmallestDetail;
  options.smallDetails = static_cast<quadrille::SmallDetails>(this->SmallDetails);
  options.removeSmallComponents = this->SmallComponents == REMOVE_SMALL_COMPONENTS;
  options.finalQuality = static_cast<quadrille::FinalQuality>(this->FinalQuality);
  options.distortionMetric = this->DistortionMetric != 0;
  options.mergeCharts = this->MakesMappedSurface();
  options.keepsPositions = false; // unless something asks for them
  options.progress = this->MakeProgress(0.02, 0.95);
  options.warmStart = this->WarmStart != 0;
  options.preview = this->Preview != 0;
  return options;
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::TellRun(quadrille::Block& block, const quadrille::RemeshResult& result)
{
  if (!result.stopped.empty())
  {
    this->KeepSoFar();
  }
  quadrille::BlockReport& report = block.state->report;
  report.reusedStages = result.reused;
  report.numbers["TargetQuads"] = static_cast<double>(result.targetQuads);
  this->SetStageRecords(result.stages);
  this->SetCertificate(result.certificate);
  const quadrille::SmallParts& parts = result.smallParts;
  report.numbers["Handles"] = static_cast<double>(parts.handles);
  report.numbers["UnresolvedHandles"] = static_cast<double>(parts.unresolvedHandles);
  if (result.targetEdgeLength > 0) // what is refused before has none
  {
    report.numbers["ShortestLoopOverEdgeLength"] = parts.shortestLoop / result.targetEdgeLength;
    report.numbers["ShortestBoundaryOverEdgeLength"] =
      parts.boundary.shortest / result.targetEdgeLength;
  }
  for (const std::string& notice : result.notices)
  {
    this->AddNotice(notice);
  }
  const quadrille::FailedParts& failed = result.failed;
  if (failed.components > 0)
  {
    report.numbers[kMendedBySmaller] = 1;
    report.numbers["ComponentsWithoutQuads"] = static_cast<double>(failed.components);
    report.certificate =
      failed.countText() + ", without a map; of the others: " + report.certificate;
    this->WarnInForeground(failed.text());
  }
  if (!result.status.ok())
  {
    quadrille::Problems problems;
    problems.failed = failed.places;
    problems.surface = block.state->lastResult.empty() ? block.input() : nullptr;
    problems.words = { result.status.message };
    if (result.status.code != quadrille::StatusCode::Cancelled)
    {
      const bool isLimit = result.status.code == quadrille::StatusCode::TooLarge;
      report.numbers[isLimit ? kIsTooLarge : kMendedBySmaller] = 1;
    }
    block.output(GetProblemPort())->ShallowCopy(quadrille::writeProblems(problems));
  }
  quadrille::requireOk(result.status, "remeshing");
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::WarnInForeground(const std::string& text)
{
  if (!this->WasInBackground)
  {
    vtkWarningMacro(<< text);
  }
}

//------------------------------------------------------------------------------
const char* vtkQuadRemesh::GetRemedyText()
{
  std::ostringstream text;
  const vtkIdType target = this->GetTargetQuads();
  constexpr vtkIdType ofHalfTheLength = 4; // as many quads
  const bool helpsSmaller =
    this->SumOverBlocks(kMendedBySmaller) > 0 || this->SumOverBlocks("InvertedQuads") > 0;
  if (this->SumOverBlocks(kIsTooLarge) > 0)
  {
    if (target > this->MaximumNumberOfQuads)
    {
      text << "MaximumNumberOfQuads " << target;
    }
  }
  else if (helpsSmaller && target <= this->MaximumNumberOfQuads / ofHalfTheLength)
  {
    switch (this->GetTargetType())
    {
      case TARGET_EDGE_LENGTH:
        text << "EdgeLength " << this->GetEdgeLength() / 2;
        break;
      case TARGET_RELATIVE_EDGE_LENGTH:
        text << "RelativeEdgeLength " << this->GetRelativeEdgeLength() / 2;
        break;
      default:
        text << "NumberOfQuads "
             << ofHalfTheLength * (this->NumberOfQuads > 0 ? this->NumberOfQuads : target);
    }
  }
  this->RemedyText = text.str();
  return this->RemedyText.c_str();
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataObject> vtkQuadRemesh::MakeProblems(quadrille::Block& block)
{
  const auto port = static_cast<std::size_t>(this->GetProblemPort());
  if (port < block.outputs.size() && block.output(this->GetProblemPort())->GetNumberOfCells() > 0)
  {
    return block.outputs[port];
  }
  if (!block.state->lastResult.empty() || block.inputs.empty() || !block.input())
  {
    return nullptr; // the quads from before are shown, or there is nothing
  }
  quadrille::Problems problems;
  problems.surface = block.input();
  problems.words = { block.state->report.outcomeText };
  return quadrille::writeProblems(problems);
}

//------------------------------------------------------------------------------
int vtkQuadRemesh::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const int isMade = this->Superclass::RequestData(request, inputs, outputs);
  if (this->GetOutcome() != Underway)
  {
    this->LeaveBackground(); // nobody waits for it any more
  }
  return isMade;
}

namespace
{

/// The middle of the cell, or the point, that an error is of.
quadrille::Vector3 placeOf(vtkPolyData* input, const quadrille::InvalidElement& error)
{
  if (error.kind() == quadrille::InvalidElement::Kind::Cell)
  {
    return quadrille::middleOf(input, error.id());
  }
  quadrille::Vector3 place;
  input->GetPoint(error.id(), place.data());
  return place;
}

/// For the output Problems of the block.
vtkSmartPointer<vtkPolyData> problemAt(const quadrille::Block& block,
  const quadrille::Vector3& place, const quadrille::InvalidInput& error)
{
  quadrille::Problems problems;
  problems.failed = { place };
  problems.surface = block.state->lastResult.empty() ? block.input() : nullptr;
  problems.words = { error.what() };
  return quadrille::writeProblems(problems);
}

} // namespace

//------------------------------------------------------------------------------
void vtkQuadRemesh::Execute(quadrille::Block& block)
{
  this->CheckProperties();
  vtkPolyData* input = block.input();
  const std::unique_ptr<quadrille::PreparedRun> run = this->MakeRun(block);
  this->TellOfInputs(run->told);
  if (run->failure)
  {
    try
    {
      std::rethrow_exception(run->failure);
    }
    catch (const quadrille::InvalidPolygon& error)
    {
      if (run->converted)
      {
        const auto place = quadrille::middleOf(input, run->converted->cell(error.polygon()));
        block.output(GetProblemPort())->ShallowCopy(problemAt(block, place, error));
      }
      throw;
    }
    catch (const quadrille::InvalidElement& error)
    {
      block.output(GetProblemPort())->ShallowCopy(problemAt(block, placeOf(input, error), error));
      throw;
    }
  }
  const quadrille::ConvertedSurface& converted = *run->converted;
  quadrille::AskedConstraints& asked = run->asked;
  const quadrille::RemeshOptions& options = run->problem.options;
  auto* memory = static_cast<quadrille::LevelMemory*>(run->memory.get());
  const quadrille::QuadsMade& made = *run->made;
  for (const std::string& warning : made.warnings)
  {
    this->AddNotice(warning);
    this->WarnInForeground(warning);
  }
  const quadrille::RemeshResult& result = made.remeshed;
  asked.curves = result.curves;
  const std::optional<std::size_t> quads = quadrille::quadsAsked(options, result.targetQuads);
  asked.edgeLength =
    quadrille::lengthOfSizeOne(result.targetEdgeLength, quads, result.quads.quads.size());
  this->TellRun(block, result);
  if (made.thinning)
  {
    this->AddNotice(
      made.thinning->text() + " (Pieces Never, --pieces never, keeps the surface whole)");
  }
  if (options.preview)
  {
    this->WritePreview(block, asked, result);
    return;
  }
  this->WriteQuads(block, { converted, asked, made });
  if (!block.path.empty() && quads && !options.coarsestIntegers &&
    quadrille::isFarFrom(*quads, block))
  {
    this->AddNotice("has " + std::to_string(result.quads.quads.size()) +
      " quads where its share is " + std::to_string(*quads) +
      ": its topology and its features take so many");
  }
  if (this->MakesMappedSurface())
  {
    vtkPolyData* mapped = block.output(1);
    if (result.mapIsKnown)
    {
      mapped->ShallowCopy(memory->mapped.surface);
    }
    else
    {
      vtkPolyData* earlier =
        memory != nullptr ? memory->mapped.sameTriangles(result, input) : nullptr;
      quadrille::writeMapped(
        result, options, { input, &converted, this->TextureCoordinates != 0, earlier }, mapped);
    }
    if (memory != nullptr)
    {
      memory->mapped = { input, input->GetMTime(), this->TextureCoordinates, result.mapKey,
        vtkSmartPointer<vtkPolyData>::New(), result.surface.hash, result.frame.reversed,
        quadrille::MappedOutput::cellStamps(input) };
      memory->mapped.surface->ShallowCopy(mapped);
    }
  }
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::SetSizes(quadrille::RemeshOptions& options) const
{
  if (this->ChordError > 0)
  {
    options.sizes.chordError = this->ChordError;
  }
  if (this->AngleAQuad > 0)
  {
    options.sizes.turn = quadrille::radians(this->AngleAQuad);
  }
  options.sizes.gapQuads = this->GapQuads;
  options.sizes.smallest = this->SmallestSize;
  options.sizes.largest = this->LargestSize;
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::AddSettings(std::ostream& os) const
{
  this->Superclass::AddSettings(os);
  os << "Method " << this->Method << '\n'
     << "Integers " << this->Integers << '\n'
     << "AnisotropyLimit " << this->AnisotropyLimit << '\n'
     << "ChordError " << this->ChordError << '\n'
     << "AngleAQuad " << this->AngleAQuad << '\n'
     << "GapQuads " << this->GapQuads << '\n'
     << "SmallestSize " << this->SmallestSize << '\n'
     << "LargestSize " << this->LargestSize << '\n'
     << "CurvatureGuides " << this->CurvatureGuides << '\n'
     << "LeastAnisotropy " << this->LeastAnisotropy << '\n'
     << "SmoothingSteps " << this->SmoothingSteps << '\n'
     << "SmallestDetail " << this->SmallestDetail << '\n'
     << "SmallDetails " << this->SmallDetails << '\n'
     << "SmallComponents " << this->SmallComponents << '\n'
     << "FailedComponents " << this->FailedComponents << '\n'
     << "SpreadSurfaces " << this->SpreadSurfaces << '\n'
     << "Pieces " << this->Pieces << '\n'
     << "WarmStart " << this->WarmStart << '\n'
     << "Preview " << this->Preview << '\n'
     << "Conforming " << this->Conforming << '\n'
     << "FinalQuality " << this->FinalQuality << '\n'
     << "DistortionMetric " << this->DistortionMetric << '\n'
     << "CellDataFrom " << this->CellDataFrom << '\n'
     << "ComputeMappedSurface " << this->ComputeMappedSurface << '\n'
     << "TextureCoordinates " << this->TextureCoordinates << '\n';
  if (this->FinalQuality != Coarse)
  {
    os << "MemoryLimit " << this->MemoryLimit << '\n'; // by which the finer map may be left out
  }
}

//------------------------------------------------------------------------------
bool vtkQuadRemesh::AllowsEarlier(const quadrille::BlockReport& report) const
{
  const auto quads = report.numbers.find("ActualQuads");
  return quads == report.numbers.end() ||
    quads->second <= static_cast<double>(this->MaximumNumberOfQuads);
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Integers: " << this->Integers << "\n";
  os << indent << "AnisotropyLimit: " << this->AnisotropyLimit << "\n";
  os << indent << "MaximumNumberOfQuads: " << this->MaximumNumberOfQuads << "\n";
  os << indent << "SmoothingSteps: " << this->SmoothingSteps << "\n";
  os << indent << "MemoryLimit: " << this->MemoryLimit << "\n";
  os << indent << "ChordError: " << this->ChordError << "\n";
  os << indent << "AngleAQuad: " << this->AngleAQuad << "\n";
  os << indent << "GapQuads: " << this->GapQuads << "\n";
  os << indent << "SmallestSize: " << this->SmallestSize << "\n";
  os << indent << "LargestSize: " << this->LargestSize << "\n";
  os << indent << "CurvatureGuides: " << this->CurvatureGuides << "\n";
  os << indent << "LeastAnisotropy: " << this->LeastAnisotropy << "\n";
  os << indent << "SmallestDetail: " << this->SmallestDetail << "\n";
  os << indent << "SmallDetails: " << this->SmallDetails << "\n";
  os << indent << "FailedComponents: " << this->FailedComponents << "\n";
  os << indent << "ComponentsWithoutQuads: " << this->GetComponentsWithoutQuads() << "\n";
  os << indent << "SmallComponents: " << this->SmallComponents << "\n";
  os << indent << "SpreadSurfaces: " << this->SpreadSurfaces << "\n";
  os << indent << "Pieces: " << this->Pieces << "\n";
  os << indent << "KeepLevels: " << this->KeepLevels << "\n";
  os << indent << "WarmStart: " << this->WarmStart << "\n";
  os << indent << "Preview: " << this->Preview << "\n";
  os << indent << "InBackground: " << this->InBackground << "\n";
  os << indent << "Conforming: " << this->Conforming << "\n";
  os << indent << "ReusedStagesText: " << this->GetReusedStagesText() << "\n";
  os << indent << "RememberedMegabytes: " << this->GetRememberedMegabytes() << "\n";
  os << indent << "FinalQuality: " << this->FinalQuality << "\n";
  os << indent << "DistortionMetric: " << this->DistortionMetric << "\n";
  os << indent << "CellDataFrom: " << this->CellDataFrom << "\n";
  os << indent << "ComputeMappedSurface: " << this->ComputeMappedSurface << "\n";
  os << indent << "TextureCoordinates: " << this->TextureCoordinates << "\n";
  os << indent << "TargetQuads: " << this->GetTargetQuads() << "\n";
  os << indent << "ActualQuads: " << this->GetActualQuads() << "\n";
  os << indent << "Handles: " << this->GetHandles() << "\n";
  os << indent << "UnresolvedHandles: " << this->GetUnresolvedHandles() << "\n";
  os << indent << "ShortestLoopOverEdgeLength: " << this->GetShortestLoopOverEdgeLength() << "\n";
  os << indent << "ShortestBoundaryOverEdgeLength: " << this->GetShortestBoundaryOverEdgeLength()
     << "\n";
}

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadRemesh.h"

#include "Blocks/Blocks.h"
#include "Blocks/LevelMemory.h"
#include "Convert/PolyData.h"
#include "Pipeline/Options.h"
#include "Ranks/Spread.h"
#include "Runs/BackgroundRun.h"
#include "Runs/GivenInputs.h"
#include "Runs/InPieces.h"
#include "Ways/Ways.h"

#include "vtkPolyData.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

//------------------------------------------------------------------------------
std::string vtkQuadRemesh::WhyNotCut(const quadrille::Block& block) const
{
  if (!this->GetGuideArrayInUse().empty())
  {
    return "directions by an array are those of the whole surface";
  }
  for (std::size_t port = 1; port < block.inputs.size(); ++port)
  {
    vtkPolyData* constraints = block.input(static_cast<int>(port));
    if (constraints && constraints->GetNumberOfPoints() > 0)
    {
      return "constraints are drawn on the whole surface";
    }
  }
  const std::string array = quadrille::constrainingArray(block.input(), this->PatchArrayName);
  return array.empty() ? "" : "the array " + array + " constrains the whole surface";
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::SetWishes(quadrille::QuadProblem& problem) const
{
  problem.cellsByArea = this->CellDataFrom != CELL_DATA_FROM_CENTRE;
  if (this->Symmetry == SYMMETRY_NONE)
  {
    return;
  }
  quadrille::SymmetryOptions& symmetry = problem.symmetry.emplace();
  symmetry.planeCurve = static_cast<quadrille::PlaneCurve>(this->PlaneCurve);
  const quadrille::Vector3 origin(this->SymmetryOrigin), direction(this->SymmetryNormal);
  if (this->Symmetry == SYMMETRY_PLANE)
  {
    symmetry.plane = quadrille::MirrorPlane{ origin, direction };
  }
  if (this->Symmetry == SYMMETRY_AXIS || this->Symmetry == SYMMETRY_AXIS_FOUND)
  {
    symmetry.rotation = quadrille::RotationRequest{ this->RotationOrder, std::nullopt };
  }
  if (this->Symmetry == SYMMETRY_AXIS)
  {
    symmetry.rotation->axis = quadrille::RotationAxis{ origin, direction };
  }
}

//------------------------------------------------------------------------------
std::unique_ptr<quadrille::PreparedRun> vtkQuadRemesh::PrepareRun(quadrille::Block& block)
{
  auto run = std::make_unique<quadrille::PreparedRun>();
  run->inputs = this->GetGivenInputs(block);
  if (this->GoesToBackground(block))
  {
    run->inputs.detach();
  }
  quadrille::QuadProblem& problem = run->problem;
  vtkPolyData* input = block.input();
  quadrille::GivenSurface& surface = problem.surface;
  surface.polygons = static_cast<std::size_t>(input->GetNumberOfPolys());
  surface.triangles = [given = run->inputs.port(0)] { return quadrille::trianglesOf(given); };
  surface.whyNotCut = this->WhyNotCut(block);
  surface.whole = [reads = run.get()]
  {
    reads->converted = quadrille::readInputs(
      reads->inputs, reads->told, reads->asked, reads->problem.store, &reads->read);
    return std::move(reads->converted->input);
  };
  problem.options = this->MakeRunOptions(block);
  problem.options.leavesOutFailed = this->FailedComponents == LEAVE_OUT_FAILED_COMPONENTS;
  this->SetWishes(problem);
  // Joined pieces are thinned out already.
  problem.thinning = quadrille::isJoined(input) ? quadrille::Thinning::Never
                                                : static_cast<quadrille::Thinning>(this->Pieces);
  problem.placed = &run->asked.placed;
  problem.places = [reads = run.get()] { return reads->read->places.get(); };
  if (this->KeepLevels)
  {
    auto& memory = block.state->memoryAs<quadrille::LevelMemory>();
    run->memory = block.state->memory;
    problem.store = &memory.levels;
    problem.options.knownMap =
      problem.options.mergeCharts ? memory.mapped.mapFor(input, this->TextureCoordinates) : 0;
  }
  return run;
}

//------------------------------------------------------------------------------
bool vtkQuadRemesh::GoesToBackground(const quadrille::Block& block) const
{
  return this->InBackground && this->RunsAlone() && block.path.empty() &&
    static_cast<std::size_t>(block.input()->GetNumberOfPolys()) < quadrille::kTrianglesWorthPieces;
}

//------------------------------------------------------------------------------
std::unique_ptr<quadrille::PreparedRun> vtkQuadRemesh::MakeRun(quadrille::Block& block)
{
  if (this->Background && this->Background->isFor(block.wanted))
  {
    if (this->InBackground && !this->Background->isOver())
    {
      throw quadrille::Underway();
    }
    this->WasInBackground = true;
    return this->TakeFromBackground();
  }
  this->WasInBackground = false;
  this->LeaveBackground(); // of other settings
  std::unique_ptr<quadrille::PreparedRun> run = this->PrepareRun(block);
  if (!this->GoesToBackground(block))
  {
    this->Ending.reset(); // waits for it, as both have the same memory
    run->make();
    return run;
  }
  this->RememberedBefore = this->GetRememberedMegabytes();
  this->Background = std::make_unique<quadrille::BackgroundRun>(
    std::move(run), block.wanted, this->TimeLimit, std::move(this->Ending));
  throw quadrille::Underway();
}

//------------------------------------------------------------------------------
std::unique_ptr<quadrille::PreparedRun> vtkQuadRemesh::TakeFromBackground()
{
  const std::unique_ptr<quadrille::BackgroundRun> background = std::move(this->Background);
  std::unique_ptr<quadrille::PreparedRun> run = background->take();
  if (background->hasRunOutOfTime())
  {
    this->NoteTimeIsOver();
  }
  return run;
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::LeaveBackground()
{
  if (this->Background && !this->Background->isOver())
  {
    this->Background->leave();
    this->Ending = std::move(this->Background); // the one before is its own
  }
  this->Background.reset();
}

//------------------------------------------------------------------------------
vtkTypeBool vtkQuadRemesh::GetIsUnderway() const
{
  return this->Background && !this->Background->isOver() ? 1 : 0;
}

//------------------------------------------------------------------------------
int vtkQuadRemesh::GetUnderwayProgress() const
{
  constexpr double hundredths = 100;
  return this->Background ? static_cast<int>(hundredths * this->Background->progress()) : 0;
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::TakeUnderway()
{
  this->InBackground = 0;
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::StopUnderway()
{
  if (this->Background)
  {
    this->Background->stop();
  }
}

//------------------------------------------------------------------------------
std::string vtkQuadRemesh::ReasonNotToSpread(
  const std::vector<vtkSmartPointer<vtkPolyData>>& pieces) const
{
  quadrille::QuadProblem problem;
  problem.options.method = static_cast<quadrille::MapMethod>(this->Method);
  problem.options.preview = this->Preview != 0;
  this->SetWishes(problem);
  const std::string reason = quadrille::whyNotSpread(problem);
  return reason.empty() ? quadrille::reasonNotToSpread(pieces, this->GetGuideArrayInUse()) : reason;
}

//------------------------------------------------------------------------------
void vtkQuadRemesh::PlanSpread(const quadrille::Block& block, const quadrille::SpreadSize& size,
  quadrille::SpreadPlan& plan) const
{
  quadrille::RemeshOptions options = this->MakeOptions(block);
  this->SetSizes(options);
  plan.piece = quadrille::pieceOptionsOf(options, size.area, size.diagonal);
  plan.patchArray = this->PatchArrayName;
  plan.guideArray = this->GetGuideArrayInUse();
  plan.memoryLimit = 1e6 * this->MemoryLimit;
}

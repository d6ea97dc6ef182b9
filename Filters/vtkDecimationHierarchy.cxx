// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDecimationHierarchy.h"

#include "Base/PlaceText.h"
#include "Blocks/Blocks.h"
#include "Common/Report.h"
#include "Convert/Frame.h"
#include "Convert/PolyData.h"
#include "Evaluation/ConstraintWords.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/ContentHash.h"
#include "Pipeline/EnterFrame.h"
#include "Pipeline/Estimate.h"
#include "Pipeline/FirstLevels.h"
#include "Pipeline/LeaveFrame.h"
#include "Pipeline/SizedSurface.h"
#include "Requests/DrawnLines.h"
#include "Requests/Guides.h"
#include "Session/Moves.h"
#include "Stages/Log.h"
#include "Stages/SharedLevels.h"

#include "vtkFieldData.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <utility>

vtkStandardNewMacro(vtkDecimationHierarchy);

namespace
{

/// What a block keeps for its next execution.
struct HierarchyMemory : quadrille::SharedLevels
{
  quadrille::ResultStore levels;
};

bool hasRoom(const quadrille::SurfaceInput& input, const quadrille::RemeshOptions& options,
  const quadrille::ResultStore& store)
{
  const std::size_t triangles = input.polygonPoints.size() / 3;
  const double quads = static_cast<double>(options.quads.value_or(0));
  const quadrille::RunEstimate run = quadrille::estimateRun(triangles, quads, options.threads);
  return quadrille::bytesToRemember(run, triangles, store.bytes()) <= quadrille::freeMemory();
}

quadrille::DecimationCost costOf(int type)
{
  switch (type)
  {
    case vtkDecimationHierarchy::COST_GAUSSIAN_MEMORY:
      return quadrille::DecimationCost::GaussianMemory;
    case vtkDecimationHierarchy::COST_QUADRIC:
      return quadrille::DecimationCost::Quadric;
    case vtkDecimationHierarchy::COST_UNIFORM:
      return quadrille::DecimationCost::Uniform;
    default:
      return quadrille::DecimationCost::Gaussian;
  }
}

} // namespace

//------------------------------------------------------------------------------
vtkDecimationHierarchy::vtkDecimationHierarchy()
{
  this->SetNumberOfOutputPorts(3);
}

vtkDecimationHierarchy::~vtkDecimationHierarchy() = default;

//------------------------------------------------------------------------------
const char* vtkDecimationHierarchy::GetBlockType(int outputPort) const
{
  return outputPort == 2 ? "vtkTable" : "vtkPolyData";
}

//------------------------------------------------------------------------------
void vtkDecimationHierarchy::Execute(quadrille::Block& block)
{
  auto& held = block.state->memoryAs<HierarchyMemory>();
  held.surface.reset(); // before the new one takes its memory
  held.map.reset();
  quadrille::AskedConstraints asked;
  quadrille::ConvertedSurface converted = this->ConvertInputs(block, asked);
  if (quadrille::asksForMoves(asked.placed))
  {
    throw quadrille::InvalidInput(
      "an irregular vertex is to be moved, which needs the quads without "
      "the move: only Quad Remesh can do this");
  }
  const std::vector<quadrille::CurveRequest>& drawnCurves = converted.input.curves;
  if (!std::all_of(drawnCurves.begin(), drawnCurves.end(),
        [](const quadrille::CurveRequest& curve) { return curve.isDrawn(); }))
  {
    throw quadrille::InvalidInput("a connection is asked for, which needs the quads without it: "
                                  "only Quad Remesh can do this");
  }
  quadrille::RemeshOptions options = this->MakeOptions(block);
  // The log belongs to the surface as the next filters prepare it again.
  options.smallDetails = quadrille::SmallDetails::Resolve;
  options.decimationCost = costOf(this->DecimationCost);
  quadrille::checkOptions(options);
  // The log knows features alone, which cycles become.
  quadrille::DrawnRequests drawn = converted.input.drawn;
  quadrille::addFeatures(drawnCurves, quadrille::CurveKind::Cycle, drawn.features);
  quadrille::ResultStore* store = this->KeepLevels ? &held.levels : nullptr;
  if (store != nullptr && !hasRoom(converted.input, options, *store))
  {
    store->clear();
    store = nullptr;
    this->AddNotice("stages are not remembered, as there is no room for them: a change will start "
                    "from the beginning");
  }
  quadrille::EnteredInput entered = quadrille::enterFrame(converted.input, options, store);
  quadrille::FramedInput& framed = entered.framed;
  const quadrille::Frame& frame = framed.frame;
  const quadrille::PlaceScope places(frame.centre, frame.unit, frame.sign);
  if (options.edgeLength)
  {
    options.edgeLength = frame.lengthOf(*options.edgeLength);
  }

  quadrille::SurfaceRecipe recipe;
  recipe.featureAngle = options.featureAngle;
  recipe.featureCriterion = options.featureCriterion;
  recipe.patchArray = this->PatchArrayName;
  recipe.drawn = drawn;
  const auto made = std::make_shared<quadrille::SharedSurface>();
  made->key.input = store != nullptr ? entered.known.inputHash
                                     : quadrille::contentHash(framed.input, options.threads);
  quadrille::DrawnRequests drawnInFrame = framed.input.drawn;
  quadrille::addFeatures(framed.input.curves, quadrille::CurveKind::Cycle, drawnInFrame.features);
  made->key.drawn = quadrille::drawnHash(std::move(drawnInFrame));
  options.progress =
    this->MakeProgress(0.0, 1.8); // the levels end where half of a whole run is done
  quadrille::SizedSurface sized = quadrille::sizeSurface(framed.input, options, entered.known);
  quadrille::requireOk(sized.status, "the levels");
  recipe.edgeLength = sized.edgeLength;
  made->key.featureAngle = recipe.featureAngle;
  made->key.featureCriterion = recipe.featureCriterion;
  made->key.edgeLength = recipe.edgeLength;
  const quadrille::FirstLevels levels = quadrille::makeFirstLevels(sized, frame, options, store);
  const quadrille::Hierarchy& hierarchy = levels.hierarchy;
  // The store, if there is one, has its triangles for the next execution.
  made->surface = store != nullptr ? *sized.surface : std::move(*sized.surface);
  const quadrille::PreparedSurface& surface = made->surface;

  sized.stages.add(levels.stages);
  this->SetStageRecords(sized.stages.all());
  std::vector<std::string>& reused = block.state->report.reusedStages;
  reused = sized.reused;
  reused.insert(reused.end(), levels.reused.begin(), levels.reused.end());
  for (const std::vector<std::string>& notices : { sized.notices, levels.notices })
  {
    for (const std::string& notice : notices)
    {
      if (!notice.empty())
      {
        this->AddNotice(notice);
      }
    }
  }
  const std::vector<quadrille::Vector3> positions =
    quadrille::userPositions(surface, frame, framed.points);
  const auto write = [&](quadrille::Level level)
  {
    const std::vector<quadrille::Vector3> inFrame = level.mesh.position;
    quadrille::leaveFrame(level, frame, positions);
    const auto data =
      quadrille::writeLevel(level, quadrille::levelValences(surface, level.mesh, level.fineVertex));
    quadrille::addFrame(data, frame, inFrame);
    return data;
  };
  vtkPolyData* coarse = block.output(0);
  coarse->ShallowCopy(write(hierarchy.coarse));
  quadrille::addNumber(coarse, "TargetEdgeLength", frame.unit * sized.edgeLength);
  quadrille::addCount(coarse, "TargetQuads", sized.targetQuads);
  quadrille::addCount(coarse, "SizeWish", static_cast<std::size_t>(levels.sizes));
  std::vector<quadrille::CurveRequest> curves = surface.curves;
  for (quadrille::CurveRequest& curve : curves)
  {
    std::transform(curve.points.begin(), curve.points.end(), curve.points.begin(),
      [&frame](const quadrille::Vector3& p) { return frame.toUser(p); });
  }
  quadrille::addCurveRequests(coarse, curves);
  quadrille::addText(coarse, "ReusedStages", reused);
  quadrille::addFields(coarse, quadrille::stageFields(sized.stages.all()));
  quadrille::addFields(coarse, quadrille::repairFields(surface.repair));
  quadrille::addText(coarse, "Notices", this->GetBlockNotices());
  block.output(1)->ShallowCopy(write(hierarchy.intermediate));
  recipe.edgeLength *= frame.unit;
  quadrille::writeLog(hierarchy.log, recipe, block.outputTable(2));
  held.surface = made;
  quadrille::share(held.surface);
}

//------------------------------------------------------------------------------
void vtkDecimationHierarchy::SetKeepLevels(vtkTypeBool on)
{
  if (!on)
  {
    this->VisitStates([](quadrille::BlockState& state) { state.memory.reset(); });
  }
  if (this->KeepLevels != on)
  {
    this->KeepLevels = on;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkDecimationHierarchy::AddSettings(std::ostream& os) const
{
  this->Superclass::AddSettings(os);
  os << "DecimationCost " << this->DecimationCost << '\n';
}

//------------------------------------------------------------------------------
void vtkDecimationHierarchy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "KeepLevels: " << this->KeepLevels << "\n";
  os << indent << "DecimationCost: " << this->DecimationCost << "\n";
}

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDecimationHierarchy.h"

#include "Base/PlaceText.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/ContentHash.h"
#include "Mesh/RepairText.h"
#include "Pipeline/LeaveFrame.h"
#include "Pipeline/Pipeline.h"
#include "QuadrilleBlocks.h"
#include "QuadrilleConvert.h"
#include "QuadrilleFrame.h"
#include "QuadrilleLog.h"
#include "QuadrilleReport.h"
#include "QuadrilleSharedLevels.h"
#include "QuadrilleStages.h"

#include "vtkFieldData.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

vtkStandardNewMacro(vtkDecimationHierarchy);

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
  auto& held = block.state->memoryAs<quadrille::SharedLevels>();
  held = {}; // before the new one takes its memory
  quadrille::ConvertedSurface converted = this->ConvertInputs(block);
  quadrille::RemeshOptions options = this->MakeOptions(block);
  quadrille::FramedInput framed =
    quadrille::enterFrame(std::move(converted.input), options.threads);
  const quadrille::Frame& frame = framed.frame;
  const quadrille::PlaceScope places(frame.centre, frame.unit, frame.sign);
  if (options.edgeLength)
  {
    options.edgeLength = frame.lengthOf(*options.edgeLength);
  }

  quadrille::SurfaceRecipe recipe;
  recipe.featureAngle = options.featureAngle;
  recipe.patchArray = this->PatchArrayName;
  recipe.curveMarks = converted.curveMarks;
  quadrille::StageClock clock;
  const auto made = std::make_shared<quadrille::SharedSurface>();
  made->key.input = quadrille::contentHash(framed.input, options.threads);
  quadrille::PreparedSurface& surface = made->surface;
  surface = quadrille::prepareFromRecipe(
    framed.input, recipe, options.threads, this->MakeProgress(0.0, 0.3), clock);
  framed.input = {};
  quadrille::TargetSize target = quadrille::chooseTarget(surface, options);
  recipe.edgeLength = target.edgeLength;
  const quadrille::SizingReport limited =
    quadrille::refineFromRecipe(surface, recipe, this->MakeProgress(0.3, 0.4), clock);
  made->key.featureAngle = recipe.featureAngle;
  made->key.edgeLength = recipe.edgeLength;
  if (limited.changed > 0 && !options.quads)
  {
    target.quads = quadrille::predictedQuads(surface, target.edgeLength);
  }

  quadrille::HierarchyOptions levels;
  levels.targetEdgeLength = target.edgeLength;
  levels.coarseVertices = options.coarseVertices;
  levels.threads = options.threads;
  const quadrille::SurfaceGuides guides = quadrille::surfaceGuides(surface);
  levels.guides = guides.faces;
  levels.keepVertices = quadrille::indexVertices(surface);
  levels.progress = this->MakeProgress(0.4, 0.95);
  const quadrille::Hierarchy hierarchy =
    quadrille::buildHierarchy(surface.mesh, surface.hash, levels);
  clock.add("phase1", hierarchy.secondsPhase1, surface.mesh.faceCount(),
    hierarchy.intermediate.mesh.faceCount());
  clock.add("phase2", hierarchy.secondsPhase2, hierarchy.intermediate.mesh.faceCount(),
    hierarchy.coarse.mesh.faceCount());

  this->SetStageRecords(clock.records);
  for (const std::string& sentence : quadrille::repairSentences(surface.repair))
  {
    this->AddNotice("input: " + sentence);
  }
  for (const std::string& notice :
    { surface.facets.text(), quadrille::sizingNotice(surface.mesh, limited), hierarchy.notice })
  {
    if (!notice.empty())
    {
      this->AddNotice(notice);
    }
  }
  for (const std::string& notice : quadrille::requestNotices(surface, guides))
  {
    this->AddNotice(notice);
  }
  const std::vector<quadrille::Vector3> positions =
    quadrille::userPositions(surface, frame, framed.points);
  const auto write = [&](quadrille::Level level)
  {
    const std::vector<quadrille::Vector3> inFrame = level.mesh.position;
    quadrille::leaveFrame(level, frame, positions);
    const auto data =
      quadrille::writeLevel(level, quadrille::levelValences(surface, level.fineVertex));
    quadrille::addFrame(data, frame, inFrame);
    return data;
  };
  vtkPolyData* coarse = block.output(0);
  coarse->ShallowCopy(write(hierarchy.coarse));
  quadrille::addNumber(coarse, "TargetEdgeLength", frame.unit * target.edgeLength);
  quadrille::addCount(coarse, "TargetQuads", target.quads);
  quadrille::addStages(coarse, clock.records);
  quadrille::addRepair(coarse, surface.repair);
  quadrille::addText(coarse, "Notices", this->GetBlockNotices());
  block.output(1)->ShallowCopy(write(hierarchy.intermediate));
  recipe.edgeLength *= frame.unit;
  quadrille::writeLog(hierarchy.log, recipe, block.outputTable(2));
  held.surface = made;
  quadrille::share(held.surface);
}

//------------------------------------------------------------------------------
void vtkDecimationHierarchy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

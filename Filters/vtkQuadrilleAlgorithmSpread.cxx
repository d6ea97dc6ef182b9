// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleAlgorithm.h"

#include "Base/Error.h"
#include "Blocks/BlockRun.h"
#include "Blocks/Blocks.h"
#include "Ranks/Spread.h"

#include "vtkDataObject.h"
#include "vtkDataObjectTypes.h"
#include "vtkPolyData.h"

#include <algorithm>

//------------------------------------------------------------------------------
bool vtkQuadrilleAlgorithm::StaysSpread(
  Run& run, Work& work, const std::vector<vtkSmartPointer<vtkDataObject>>& pieces)
{
  const auto mode = static_cast<quadrille::SpreadMode>(this->GetSpreadMode());
  const bool isLarge = run.ranks.size() > 1 && work.cells > quadrille::kSpreadFaces;
  if (mode == quadrille::SpreadMode::Never ||
    (mode == quadrille::SpreadMode::Automatic && !isLarge))
  {
    return false;
  }
  std::vector<vtkSmartPointer<vtkPolyData>> surfaces;
  for (vtkDataObject* piece : pieces)
  {
    surfaces.emplace_back(vtkPolyData::SafeDownCast(piece));
  }
  const bool isTogether = std::count_if(run.works.begin(), run.works.end(),
                            [&](const Work& other) { return other.group == work.group; }) > 1;
  std::string reason = isTogether ? "it may be made together with blocks that it meets" : "";
  for (const std::string& text : run.ranks.gather(this->ReasonNotToSpread(surfaces)))
  {
    reason = reason.empty() ? text : reason;
  }
  if (reason.empty())
  {
    work.spread = std::make_unique<quadrille::SpreadSurface>(run.ranks, work.owner, surfaces);
    if (work.spread->size().cells == 0)
    {
      work.spread.reset(); // the filter says what is missing
    }
    return work.spread != nullptr;
  }
  if (mode == quadrille::SpreadMode::Always)
  {
    work.error = "the surface cannot stay spread over the ranks: " + reason +
      "; set Spread Surfaces to Never, which brings all of it to one rank";
  }
  else
  {
    work.notices.push_back("the surface was brought to one rank and not left spread, as " + reason);
  }
  return false;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::JoinSpread(Run& run)
{
  for (Work& work : run.works)
  {
    if (!work.spread)
    {
      continue;
    }
    try
    {
      quadrille::SpreadPlan plan;
      this->PlanSpread(work.block, work.spread->size(), plan);
      plan.piece.threads = this->NumberOfThreads;
      plan.piece.progress = this->MakeProgress(0, 0.02);
      work.block.inputs[0] = work.spread->join(plan, work.notices);
    }
    catch (const quadrille::Cancelled&)
    {
      // Whether time was over on any rank: it may not yet be so on the one that tells it.
      for (const std::string& isOver : run.ranks.gather(this->TimeIsOver ? "1" : ""))
      {
        this->TimeIsOver = this->TimeIsOver || !isOver.empty();
      }
      work.failure = std::current_exception();
    }
    catch (const std::exception&)
    {
      work.failure = std::current_exception(); // on all ranks alike
    }
    if (work.failure)
    {
      work.spread.reset();
    }
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SpreadResults(Run& run)
{
  for (Work& work : run.works)
  {
    if (!work.spread)
    {
      continue;
    }
    const char made = work.isMade ? (work.block.state->report.isSoFar ? 's' : 'm') : '-';
    const std::string told =
      run.ranks.gather(std::string(1, made))[static_cast<std::size_t>(work.owner)];
    if (told == "-")
    {
      continue;
    }
    // What is left to do after a stop that has kept something must not be stopped.
    this->IsBlockSoFar = told == "s";
    try
    {
      this->SpreadResult(run, work);
    }
    catch (const std::exception&)
    {
      if (run.owns(work))
      {
        this->FailBlockBy(*work.block.state, std::current_exception());
      }
    }
    this->IsBlockSoFar = false;
    work.spread.reset();
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SpreadResult(Run& run, Work& work)
{
  std::vector<vtkSmartPointer<vtkDataObject>>& outputs = work.block.outputs;
  if (!run.owns(work))
  {
    outputs.clear();
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      outputs.push_back(
        vtk::TakeSmartPointer(vtkDataObjectTypes::NewDataObject(this->GetBlockType(port))));
    }
  }
  std::vector<vtkPolyData*> others;
  for (std::size_t port = 1; port < outputs.size(); ++port)
  {
    if (auto* data = vtkPolyData::SafeDownCast(outputs[port]))
    {
      others.push_back(data);
    }
  }
  const vtkSmartPointer<vtkPolyData> quads =
    work.spread->spread(vtkPolyData::SafeDownCast(outputs[0]), others, run.ghostLevels);
  const std::vector<quadrille::SpreadFigures> figures = work.spread->figures();
  quadrille::addSpreadFigures(quads, figures);
  outputs[0] = quads;
  quadrille::BlockState& state = *work.block.state;
  state.lastResult = outputs;
  state.isSpread = true;
  work.isSpread = true;
  state.ghostLevels = run.ghostLevels;
  if (run.owns(work))
  {
    state.report.stageTimes += "\n" + quadrille::spreadText(figures);
  }
}

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleAlgorithm.h"

#include "Base/Error.h"
#include "Blocks/BlockRun.h"
#include "Blocks/Blocks.h"
#include "Common/Report.h"
#include "Runs/BackgroundRun.h"

#include "vtkDataObjectTypes.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <new>
#include <sstream>

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::RunWorks(const std::vector<Work*>& works)
{
  const auto all = [&works](const auto& holds)
  { return std::all_of(works.begin(), works.end(), holds); };
  if (all([](const Work* work) { return !work->isChanged; }))
  {
    for (Work* work : works)
    {
      if (work->block.state->report.outcome == Succeeded)
      {
        work->block.state->report.reusedStages = { "all" };
      }
    }
    return;
  }
  if (all([this](Work* work) { return this->TakeEarlier(*work, false); }))
  {
    all([this](Work* work) { return this->TakeEarlier(*work, true); });
    return;
  }
  std::vector<Work*> whole;
  for (Work* work : works)
  {
    work->block.state->report = {};
    work->block.state->report.notices = work->notices;
    // What cannot be had, and what has no faces, is not executed together with others.
    vtkPolyData* surface =
      this->GetPortRole(0) == PortRole::Surface ? work->block.input() : nullptr;
    if (work->error.empty() && !work->failure && surface &&
      surface->GetNumberOfPolys() + surface->GetNumberOfStrips() > 0)
    {
      whole.push_back(work);
    }
    else
    {
      this->RunTogether({ work }, {});
    }
  }
  std::vector<quadrille::Block*> blocks;
  for (Work* work : whole)
  {
    blocks.push_back(&work->block);
  }
  const double begin = this->BlockBegin, end = this->BlockEnd;
  double done = 0;
  for (const Together& together : this->FindTogether(blocks))
  {
    std::vector<Work*> members;
    for (const std::size_t i : together.blocks)
    {
      members.push_back(whole[i]);
    }
    const auto count = static_cast<double>(whole.size());
    this->BlockBegin = begin + (end - begin) * done / count;
    done += static_cast<double>(members.size());
    this->BlockEnd = begin + (end - begin) * done / count;
    this->RunTogether(members, together.notices);
  }
}

//------------------------------------------------------------------------------
bool vtkQuadrilleAlgorithm::TakeEarlier(Work& work, bool andUse)
{
  if (!this->KeepsResult() || !work.error.empty() || work.failure || work.spread)
  {
    return false;
  }
  quadrille::BlockState& state = *work.block.state;
  const quadrille::EarlierResult* earlier = state.findEarlier(this->ResultFor(work));
  if (!earlier || !this->AllowsEarlier(earlier->report))
  {
    return false;
  }
  if (andUse)
  {
    state.lastResult = earlier->result;
    state.problems = nullptr;
    state.isSpread = false;
    state.report = earlier->report;
    state.report.reusedStages = { "all" };
  }
  return true;
}

//------------------------------------------------------------------------------
quadrille::EarlierResult vtkQuadrilleAlgorithm::ResultFor(const Work& work) const
{
  return { this->GetSettings(), { work.stamps.begin() + 1, work.stamps.end() },
    work.block.areaShare, work.block.wholeDiagonal, {}, {} }; // the first stamp is the filter's
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::RunTogether(
  const std::vector<Work*>& works, const std::vector<std::string>& notices)
{
  Work& first = *works.front();
  this->Report = &first.block.state->report;
  this->IsBlockSoFar = false;
  for (Work* work : works)
  {
    work->block.state->problems = nullptr;
  }
  try
  {
    if (!first.error.empty())
    {
      throw quadrille::InvalidInput(first.error);
    }
    if (first.failure)
    {
      std::rethrow_exception(first.failure);
    }
    for (const std::string& notice : notices)
    {
      this->AddNotice(notice);
    }
    std::vector<quadrille::Block*> blocks;
    for (Work* work : works)
    {
      this->PrepareOutputs(work->block);
      blocks.push_back(&work->block);
    }
    first.block.wanted = this->ResultFor(first);
    works.size() == 1 ? this->ExecuteBlock(first.block) : this->ExecuteTogether(blocks);
    for (Work* work : works)
    {
      this->ConcludeBlock(*work);
    }
  }
  catch (const std::exception&)
  {
    this->FailBlockBy(*first.block.state, std::current_exception());
    const quadrille::BlockReport& report = first.block.state->report;
    for (Work* work : works)
    {
      if (work != &first && (report.outcome == Aborted || report.outcome == TimedOut))
      {
        this->FailBlockAsStopped(*work->block.state);
      }
      else if (work != &first)
      {
        this->FailBlock(*work->block.state, static_cast<OutcomeType>(report.outcome),
          "is made together with '" + first.block.name + "', which failed");
        work->block.state->report.mayPass = report.mayPass;
      }
    }
    for (Work* work : works)
    {
      this->ShowFailure(work->block);
    }
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::FailBlockBy(
  quadrille::BlockState& state, const std::exception_ptr& failure)
{
  try
  {
    std::rethrow_exception(failure);
  }
  catch (const quadrille::Underway& underway)
  {
    this->FailBlock(state, Underway, underway.what());
    state.report.mayPass = true;
  }
  catch (const quadrille::InvalidInput& error)
  {
    this->FailBlock(state, BadInput, error.what());
  }
  catch (const quadrille::Cancelled&)
  {
    this->FailBlockAsStopped(state);
  }
  catch (const quadrille::StageFailure& error)
  {
    if (error.code == quadrille::StatusCode::Cancelled)
    {
      this->FailBlockAsStopped(state);
      return;
    }
    const bool tooLarge = error.code == quadrille::StatusCode::TooLarge;
    this->FailBlock(state, tooLarge ? TooLarge : NoValidResult, error.what());
  }
  catch (const quadrille::OutOfMemory& error)
  {
    this->FailBlock(state, NoValidResult, error.what());
    state.report.mayPass = true;
  }
  catch (const std::bad_alloc&)
  {
    this->FailBlock(state, NoValidResult, "out of memory; ask for fewer quads or free memory");
    state.report.mayPass = true;
  }
  catch (const std::exception& error)
  {
    this->FailBlock(state, NoValidResult, std::string("internal error: ") + error.what());
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::PrepareOutputs(quadrille::Block& block)
{
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    block.outputs.push_back(
      vtk::TakeSmartPointer(vtkDataObjectTypes::NewDataObject(this->GetBlockType(port))));
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ExecuteBlock(quadrille::Block& block)
{
  // Composite data may have blocks of points and lines, and grids that finer ones replace: no error, but told.
  vtkPolyData* surface =
    this->GetPortRole(0) == PortRole::Surface && !block.path.empty() ? block.input() : nullptr;
  if (surface && surface->GetNumberOfPolys() + surface->GetNumberOfStrips() == 0)
  {
    this->AddNotice("has no faces and is left empty");
  }
  else
  {
    this->Execute(block);
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ConcludeBlock(Work& work)
{
  quadrille::BlockState& state = *work.block.state;
  state.report.outcome = Succeeded;
  work.isMade = true;
  if (!work.spread)
  {
    state.lastResult = work.block.outputs;
    state.isSpread = false;
  }
  if (this->IsBlockSoFar)
  {
    state.report.isSoFar = true;
    state.report.outcome = this->TimeIsOver ? TimedOut : Aborted;
    state.report.outcomeText = this->StopText() + "; these are the best quads so far";
  }
  else if (this->KeepsResult() && !work.spread)
  {
    quadrille::EarlierResult made = this->ResultFor(work);
    made.report = state.report;
    made.result = state.lastResult;
    state.keepEarlier(std::move(made));
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::FailBlock(
  quadrille::BlockState& state, OutcomeType outcome, const std::string& text)
{
  state.report.outcome = outcome;
  state.report.outcomeText = text;
  const bool hasResult = !state.lastResult.empty();
  if (hasResult || outcome == Aborted)
  {
    state.report.outcomeText +=
      hasResult ? "; the previous result is kept" : "; there is no result";
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ShowFailure(quadrille::Block& block)
{
  quadrille::BlockReport& report = block.state->report;
  if (report.outcome != Aborted && report.outcome != Underway)
  {
    block.state->problems = this->MakeProblems(block);
    report.showsFailure = block.state->problems != nullptr && !report.mayPass;
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::FailBlockAsStopped(quadrille::BlockState& state)
{
  this->IsBlockSoFar = false; // what comes after the stop has been stopped, too
  this->FailBlock(state, this->TimeIsOver ? TimedOut : Aborted, this->StopText());
}

//------------------------------------------------------------------------------
std::string vtkQuadrilleAlgorithm::StopText() const
{
  if (!this->TimeIsOver)
  {
    return "stopped on request";
  }
  std::ostringstream text;
  text << "stopped after the time limit of " << this->TimeLimit << " s";
  return text.str();
}

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleAlgorithm.h"

#include "Blocks/BlockRun.h"
#include "Blocks/Blocks.h"
#include "Common/Report.h"
#include "Common/Stamps.h"
#include "Common/VtkVersions.h"
#include "Ranks/Ranks.h"

#include "vtkDataObject.h"
#include "vtkDataObjectTypes.h"
#include "vtkInformationVector.h"

#include <algorithm>

namespace
{

/// Letters in a line of ResultText, as many as ParaView's panel shows.
constexpr std::size_t kPanelWidth = 60;

/// A text of several blocks: each line begins with the block's name.
void addLines(std::string& text, const std::string& block, const std::string& lines)
{
  for (const std::string& line : quadrille::splitLines(lines))
  {
    text += (text.empty() ? "" : "\n") + (block.empty() ? "" : block + ": ") + line;
  }
}

std::string joinLines(const std::vector<std::string>& lines)
{
  std::string text;
  for (const std::string& line : lines)
  {
    addLines(text, "", line);
  }
  return text;
}

} // namespace

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ExchangeReports(Run& run)
{
  quadrille::Packer packer;
  for (const Work& work : run.works)
  {
    packer.count(run.owns(work));
    if (run.owns(work))
    {
      work.block.state->report.pack(packer);
    }
  }
  for (const std::string& bytes : run.ranks.gather(packer.bytes()))
  {
    quadrille::Unpacker unpacker(bytes);
    for (Work& work : run.works)
    {
      if (unpacker.count() != 0)
      {
        work.block.state->report = quadrille::BlockReport::unpack(unpacker);
      }
    }
  }
  for (Work& work : run.works)
  {
    quadrille::BlockState& state = *work.block.state;
    const bool hasSucceeded = state.report.outcome == Succeeded;
    const bool isMade = work.isChanged && (hasSucceeded || state.report.isSoFar);
    if (isMade && state.isSpread && !work.isSpread)
    {
      // The result is in one place again, with the owner; the others let their parts go.
      state.isSpread = false;
      state.lastResult.clear();
    }
    const bool failsAgain =
      !hasSucceeded && state.report.outcome != Aborted && !state.report.mayPass;
    state.lastStamps = hasSucceeded ? work.stamps : std::vector<quadrille::Stamp>{};
    state.failedStamps = failsAgain ? work.stamps : std::vector<quadrille::Stamp>{};
    if (work.isChanged)
    {
      state.lastAreaShare = work.block.areaShare;
      state.lastWholeDiagonal = work.block.wholeDiagonal;
    }
  }
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::Conclude(const Run& run, vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    std::map<quadrille::BlockPath, vtkSmartPointer<vtkDataObject>> results;
    for (const Work& work : run.works)
    {
      if (!run.owns(work) && !work.block.state->isSpread)
      {
        continue;
      }
      // A copy, so that what is done to an output later does not change the result that is kept.
      auto& result = results[work.block.path];
      result = vtk::TakeSmartPointer(vtkDataObjectTypes::NewDataObject(this->GetBlockType(port)));
      if (!work.block.state->lastResult.empty())
      {
        result->ShallowCopy(work.block.state->lastResult[static_cast<std::size_t>(port)]);
      }
      if (port == this->GetProblemPort() && work.block.state->problems)
      {
        result->ShallowCopy(work.block.state->problems);
      }
    }
    quadrille::writeBlocks(run.trees[0], results, run.input, vtkDataObject::GetData(outputs, port));
  }
  std::vector<std::pair<std::string, quadrille::BlockReport>> reports;
  for (const Work& work : run.works)
  {
    reports.emplace_back(run.works.size() > 1 ? work.block.name : "", work.block.state->report);
  }
  this->SetReports(reports);
  if (this->Outcome == Underway)
  {
    return 1; // with what was made before
  }
  if (this->Outcome == Aborted)
  {
    // No error: it is what the user asked for. Returning 0 leaves the filter out of date.
    // The flags have done their duty; left standing they would make the executive empty the outputs.
    quadrille::forgetStop(this);
    if (this->IsRoot)
    {
      vtkWarningMacro(<< this->OutcomeText);
    }
    return 0;
  }
  if (run.ranks.size() > 1 && quadrille::isAskedToStop(this))
  {
    quadrille::forgetStop(this); // it came when all was done, and on this rank only
  }
  this->UpdateProgress(1.0);
  if (this->Outcome == Succeeded)
  {
    return 1;
  }
  const auto hasResult = [](const quadrille::BlockReport& report)
  { return report.outcome == Succeeded || report.isSoFar; };
  if (run.anew && std::all_of(this->Reports.begin(), this->Reports.end(), hasResult))
  {
    if (this->IsRoot)
    {
      vtkWarningMacro(<< this->OutcomeText);
    }
  }
  else if (run.anew)
  {
    this->ReportFailure(this->OutcomeText);
  }
  // The results of the other blocks are valid and have to be seen, and so has what shows a failure.
  return std::any_of(this->Reports.begin(), this->Reports.end(),
    [&](const quadrille::BlockReport& report) { return hasResult(report) || report.showsFailure; });
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::ReportFailure(const std::string& text)
{
  this->OutcomeText = text;
  if (this->ResultText.empty())
  {
    this->Verdict = "Failed: " + text;
    this->ResultText = quadrille::wrapLines(this->Verdict, kPanelWidth);
  }
  if (this->IsRoot)
  {
    vtkErrorMacro(<< text);
  }
  return 0;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SetReports(
  const std::vector<std::pair<std::string, quadrille::BlockReport>>& reports)
{
  this->Outcome = Succeeded;
  bool isVerdictWell = true;
  for (const auto& [name, report] : reports)
  {
    // A stop on request weighs most, as the filter is then left out of date; else the first failure counts.
    if (this->Outcome == Succeeded || report.outcome == Aborted)
    {
      this->Outcome = report.outcome;
    }
    addLines(this->OutcomeText, name, report.outcomeText);
    addLines(this->StageTimesText, name, report.stageTimes);
    addLines(this->CertificateText, name, report.certificate);
    addLines(this->NoticesText, name, joinLines(report.notices));
    const std::string made = report.result.empty() ? "Done" : report.result;
    const std::string verdict = report.isSoFar ? made + "; " + report.outcomeText
      : report.outcome == Succeeded            ? made
      : report.outcome == Underway             ? "Underway: " + report.outcomeText
                                               : "Failed: " + report.outcomeText;
    addLines(this->ResultText, name, verdict);
    const bool isWell = report.outcome == Succeeded && !report.hasDefect;
    if (this->Verdict.empty() || (isVerdictWell && !isWell))
    {
      this->Verdict = (name.empty() ? "" : name + ": ") + verdict;
      isVerdictWell = isWell;
    }
    this->IsSoFar = this->IsSoFar || report.isSoFar;
    for (const std::string& notice : report.notices)
    {
      addLines(this->ResultText, name, "Note: " + notice);
    }
    addLines(this->ReusedText, name, joinLines(report.reusedStages));
    this->Reports.push_back(report);
  }
  this->ResultText = quadrille::wrapLines(this->ResultText, kPanelWidth);
}

//------------------------------------------------------------------------------
double vtkQuadrilleAlgorithm::SumOverBlocks(const char* number) const
{
  double sum = 0;
  for (const quadrille::BlockReport& report : this->Reports)
  {
    const auto value = report.numbers.find(number);
    sum += value == report.numbers.end() ? 0 : value->second;
  }
  return sum;
}

//------------------------------------------------------------------------------
double vtkQuadrilleAlgorithm::LeastOverBlocks(const char* number) const
{
  double least = 0;
  for (const quadrille::BlockReport& report : this->Reports)
  {
    const auto value = report.numbers.find(number);
    if (value != report.numbers.end() && value->second > 0)
    {
      least = least > 0 ? std::min(least, value->second) : value->second;
    }
  }
  return least;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ResetOutcome()
{
  this->Outcome = NotRun;
  this->TimeIsOver = false;
  this->IsSoFar = false;
  this->IsBlockSoFar = false;
  this->FarthestProgress = 0;
  this->Started = std::chrono::steady_clock::now();
  this->Reports.clear();
  this->OutcomeText.clear();
  this->StageTimesText.clear();
  this->CertificateText.clear();
  this->NoticesText.clear();
  this->ResultText.clear();
  this->Verdict.clear();
  this->ReusedText.clear();
}

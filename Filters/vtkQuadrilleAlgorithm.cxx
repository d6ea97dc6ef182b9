// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleAlgorithm.h"

#include "GridMap/GridMap.h"
#include "Pipeline/Pipeline.h"
#include "QuadrilleBlocks.h"
#include "QuadrilleReport.h"
#include "QuadrilleStamps.h"
#include "QuadrilleSurfaces.h"

#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkDataObjectTypes.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <new>
#include <sstream>

using Executive = vtkStreamingDemandDrivenPipeline;

namespace
{

/// Letters in a line of ResultText, as many as ParaView's panel shows.
constexpr std::size_t kPanelWidth = 60;

/// Which part of the output is asked for; a serial run asks for piece 0 of 1.
int requestedPiece(vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  return info->Has(Executive::UPDATE_PIECE_NUMBER()) ? info->Get(Executive::UPDATE_PIECE_NUMBER())
                                                     : 0;
}

int requestedPieces(vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  return info->Has(Executive::UPDATE_NUMBER_OF_PIECES())
    ? info->Get(Executive::UPDATE_NUMBER_OF_PIECES())
    : 1;
}

void initializeOutputs(vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* output = vtkDataObject::GetData(outputs, port))
    {
      output->Initialize();
    }
  }
}

/// Whether the first input has nothing to work on, which is normal on a rank of a parallel run.
bool isEmpty(vtkInformationVector** inputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  return !input || input->GetNumberOfElements(vtkDataObject::CELL) == 0;
}

/// Keeps the executive from adding a dump of the request to the reason that the filter itself has told, then goes.
class IgnoreOnce : public vtkCommand
{
public:
  static IgnoreOnce* New() { return new IgnoreOnce; }
  void Execute(vtkObject* caller, unsigned long, void*) override { caller->RemoveObserver(this); }
};

/// Place and name: a block that moved or was renamed is another one.
std::string keyOf(const quadrille::Block& block)
{
  std::string key;
  for (const unsigned index : block.path)
  {
    key += std::to_string(index) + "/";
  }
  return key + block.name;
}

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

/// One execution: the structure of the input and its blocks.
struct vtkQuadrilleAlgorithm::Run
{
  std::vector<quadrille::BlockTree> trees; ///< by input port; empty for shared ones
  std::vector<quadrille::Block> blocks;
  std::vector<quadrille::Stamp> stamps; ///< of what all blocks share
  bool anew = false; ///< a block was executed
};

//------------------------------------------------------------------------------
vtkQuadrilleAlgorithm::vtkQuadrilleAlgorithm() = default;
vtkQuadrilleAlgorithm::~vtkQuadrilleAlgorithm() = default;

//------------------------------------------------------------------------------
vtkQuadrilleAlgorithm::PortRole vtkQuadrilleAlgorithm::GetPortRole(int port) const
{
  return port == 0 ? PortRole::Surface : PortRole::Shared;
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::FillInputPortInformation(int port, vtkInformation* info)
{
  // Composite data first: the executive then leaves the walk through its blocks to the filter.
  const PortRole role = this->GetPortRole(port);
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(),
    role == PortRole::Surface ? "vtkDataSet" : role == PortRole::Log ? "vtkTable" : "vtkPolyData");
  if (role == PortRole::Shared)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject"); // RequestDataObject chooses
  return 1;
}

//------------------------------------------------------------------------------
vtkTypeBool vtkQuadrilleAlgorithm::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const vtkTypeBool done = request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT())
    ? this->RequestDataObject(inputs, outputs)
    : this->Superclass::ProcessRequest(request, inputs, outputs);
  if (!done)
  {
    this->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, vtkNew<IgnoreOnce>());
  }
  return done;
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::RequestDataObject(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  std::string composite;
  try
  {
    composite = quadrille::compositeTypeFor(vtkDataObject::GetData(inputs[0]));
  }
  catch (const quadrille::InvalidInput& error)
  {
    return this->ReportFailure(error.what());
  }
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    const std::string type = composite.empty() ? this->GetBlockType(port) : composite;
    vtkInformation* info = outputs->GetInformationObject(port);
    vtkDataObject* output = vtkDataObject::GetData(info);
    if (!output || type != output->GetClassName())
    {
      const auto made = vtk::TakeSmartPointer(vtkDataObjectTypes::NewDataObject(type.c_str()));
      info->Set(vtkDataObject::DATA_OBJECT(), made);
      this->GetOutputPortInformation(port)->Set(
        vtkDataObject::DATA_EXTENT_TYPE(), made->GetExtentType());
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  // The whole mesh has to be in one place: rank 0 asks for all of it.
  const int piece = requestedPiece(outputs);
  const int pieces = piece == 0 ? 1 : requestedPieces(outputs);
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < inputs[port]->GetNumberOfInformationObjects(); ++i)
    {
      vtkInformation* info = inputs[port]->GetInformationObject(i);
      info->Set(Executive::UPDATE_PIECE_NUMBER(), piece);
      info->Set(Executive::UPDATE_NUMBER_OF_PIECES(), pieces);
      info->Set(Executive::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->ResetOutcome();
  if (requestedPiece(outputs) > 0 || (requestedPieces(outputs) > 1 && isEmpty(inputs)))
  {
    initializeOutputs(outputs);
    this->States.clear();
    this->Outcome = Succeeded;
    return 1;
  }
  const quadrille::PollScope scope(
    [this](double, const std::string&) { return this->ShowProgressAndGoOn(); });
  try
  {
    return this->RunBlocks(inputs, outputs);
  }
  catch (const quadrille::InvalidInput& error)
  {
    this->Outcome = BadInput;
    return this->ReportFailure(error.what());
  }
  catch (const std::exception& error)
  {
    this->Outcome = NoValidResult;
    return this->ReportFailure(std::string("internal error: ") + error.what());
  }
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::RunBlocks(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  Run run;
  const int ports = this->GetNumberOfInputPorts();
  run.stamps.emplace_back(nullptr, this->GetMTime());
  std::vector<vtkSmartPointer<vtkDataObject>> shared(static_cast<std::size_t>(ports));
  for (int port = 0; port < ports; ++port)
  {
    vtkDataObject* data = vtkDataObject::GetData(inputs[port]);
    const bool isShared = this->GetPortRole(port) == PortRole::Shared;
    run.trees.push_back(isShared ? quadrille::BlockTree{} : quadrille::blockTree(data));
    if (isShared && data)
    {
      shared[port] = quadrille::joinShared(quadrille::blockTree(data));
      quadrille::addStamps(data, run.stamps);
    }
  }
  for (const auto& [path, node] : run.trees[0])
  {
    // An empty leaf of composite data is normal; a plain data set without cells is told by the filter.
    const bool isEmptyLeaf = !path.empty() &&
      std::none_of(node.pieces.begin(), node.pieces.end(), quadrille::hasCells);
    if (!node.isBlock || isEmptyLeaf)
    {
      continue;
    }
    quadrille::Block& block = run.blocks.emplace_back();
    block.path = path;
    block.name = quadrille::blockName(run.trees[0], path);
    block.inputs = shared;
    block.inputs.resize(static_cast<std::size_t>(ports));
  }
  if (run.blocks.empty())
  {
    throw quadrille::InvalidInput("the input has no block with a surface");
  }
  std::map<std::string, std::unique_ptr<quadrille::BlockState>> states;
  for (quadrille::Block& block : run.blocks)
  {
    auto& state = states[keyOf(block)] = std::move(this->States[keyOf(block)]);
    if (!state)
    {
      state = std::make_unique<quadrille::BlockState>();
    }
    block.state = state.get();
  }
  this->States = std::move(states);
  for (std::size_t i = 0; i < run.blocks.size(); ++i)
  {
    this->BlockBegin = static_cast<double>(i) / static_cast<double>(run.blocks.size());
    this->BlockEnd = static_cast<double>(i + 1) / static_cast<double>(run.blocks.size());
    this->RunBlock(run, run.blocks[i]);
  }
  return this->Conclude(run, outputs);
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::RunBlock(Run& run, quadrille::Block& block)
{
  quadrille::BlockState& state = *block.state;
  std::vector<quadrille::Stamp> stamps = run.stamps;
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    const auto node = run.trees[port].find(block.path);
    if (node != run.trees[port].end())
    {
      for (vtkDataObject* piece : node->second.pieces)
      {
        quadrille::addStamps(piece, stamps);
      }
    }
  }
  if (this->KeepsResult() && stamps == state.lastStamps)
  {
    state.report.reusedStages = { "all" };
    return;
  }
  if (stamps == state.failedStamps)
  {
    return; // another port asks: its report says already why there is nothing
  }
  run.anew = true;
  state.lastStamps.clear();
  state.failedStamps.clear();
  state.report = {};
  this->Report = &state.report;
  try
  {
    for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
    {
      const auto node = run.trees[port].find(block.path);
      if (node != run.trees[port].end())
      {
        const auto& pieces = node->second.pieces;
        if (this->GetPortRole(port) == PortRole::Surface)
        {
          block.inputs[port] = quadrille::joinSurface(pieces, state.report.notices);
        }
        else
        {
          block.inputs[port] = quadrille::joinExact(pieces);
        }
      }
    }
    this->ExecuteBlock(block);
    state.lastStamps = std::move(stamps);
    return;
  }
  catch (const quadrille::InvalidInput& error)
  {
    this->FailBlock(block, BadInput, error.what());
  }
  catch (const quadrille::Cancelled&)
  {
    this->FailBlockAsStopped(block);
  }
  catch (const quadrille::StageFailure& failure)
  {
    if (failure.code == quadrille::StatusCode::Cancelled)
    {
      this->FailBlockAsStopped(block);
      return;
    }
    const bool tooLarge = failure.code == quadrille::StatusCode::TooLarge;
    this->FailBlock(block, tooLarge ? TooLarge : NoValidResult, failure.what());
  }
  catch (const std::bad_alloc&)
  {
    this->FailBlock(block, NoValidResult, "out of memory; ask for fewer quads or free memory");
    return; // it may be there the next time
  }
  catch (const std::exception& error)
  {
    this->FailBlock(block, NoValidResult, std::string("internal error: ") + error.what());
  }
  if (state.report.outcome != Aborted)
  {
    state.failedStamps = std::move(stamps);
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ExecuteBlock(quadrille::Block& block)
{
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    block.outputs.push_back(
      vtk::TakeSmartPointer(vtkDataObjectTypes::NewDataObject(this->GetBlockType(port))));
  }
  this->Execute(block);
  block.state->lastResult = block.outputs;
  block.state->report.outcome = Succeeded;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::FailBlock(
  quadrille::Block& block, OutcomeType outcome, const std::string& text)
{
  quadrille::BlockReport& report = block.state->report;
  report.outcome = outcome;
  report.outcomeText = text;
  const bool hasResult = !block.state->lastResult.empty();
  if (hasResult || outcome == Aborted)
  {
    report.outcomeText += hasResult ? "; the previous result is kept" : "; there is no result";
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::FailBlockAsStopped(quadrille::Block& block)
{
  if (!this->TimeIsOver)
  {
    this->FailBlock(block, Aborted, "stopped on request");
    return;
  }
  std::ostringstream text;
  text << "stopped after the time limit of " << this->TimeLimit << " s";
  this->FailBlock(block, TimedOut, text.str());
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::Conclude(const Run& run, vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    std::map<quadrille::BlockPath, vtkSmartPointer<vtkDataObject>> results;
    for (const quadrille::Block& block : run.blocks)
    {
      // A copy, so that what is done to an output later does not change the result that is kept.
      auto& result = results[block.path];
      result = vtk::TakeSmartPointer(vtkDataObjectTypes::NewDataObject(this->GetBlockType(port)));
      if (!block.state->lastResult.empty())
      {
        result->ShallowCopy(block.state->lastResult[port]);
      }
    }
    quadrille::writeBlocks(run.trees[0], results, vtkDataObject::GetData(outputs, port));
  }
  std::vector<std::pair<std::string, quadrille::BlockReport>> reports;
  for (const quadrille::Block& block : run.blocks)
  {
    reports.emplace_back(run.blocks.size() > 1 ? block.name : "", block.state->report);
  }
  this->SetReports(reports);
  if (this->Outcome == Aborted)
  {
    // No error: it is what the user asked for. Returning 0 leaves the filter out of date.
    // The flags have done their duty; left standing they would make the executive empty the outputs.
    this->SetAbortExecute(0);
    this->SetAbortOutput(false);
    vtkWarningMacro(<< this->OutcomeText);
    return 0;
  }
  this->UpdateProgress(1.0);
  if (this->Outcome == Succeeded)
  {
    return 1;
  }
  if (run.anew)
  {
    this->ReportFailure(this->OutcomeText);
  }
  // The results of the other blocks are valid and have to be seen.
  return std::any_of(this->Reports.begin(), this->Reports.end(),
    [](const quadrille::BlockReport& report) { return report.outcome == Succeeded; });
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::ReportFailure(const std::string& text)
{
  this->OutcomeText = text;
  if (this->ResultText.empty())
  {
    this->ResultText = quadrille::wrapLines("Failed: " + text, kPanelWidth);
  }
  vtkErrorMacro(<< text);
  return 0;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SetReports(
  const std::vector<std::pair<std::string, quadrille::BlockReport>>& reports)
{
  this->Outcome = Succeeded;
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
    addLines(this->ResultText, name,
      report.outcome == Succeeded ? made : "Failed: " + report.outcomeText);
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
std::function<bool(double, const std::string&)> vtkQuadrilleAlgorithm::MakeProgress(
  double begin, double end)
{
  return [this, begin, end](double fraction, const std::string& text)
  {
    // A stage that is tried again starts from its beginning; the bar must not run backwards.
    const double ofBlock = begin + (end - begin) * std::clamp(fraction, 0.0, 1.0);
    const double progress = this->BlockBegin + (this->BlockEnd - this->BlockBegin) * ofBlock;
    this->FarthestProgress = std::max(this->FarthestProgress, progress);
    this->SetProgressText(text.c_str());
    return this->ShowProgressAndGoOn();
  };
}

//------------------------------------------------------------------------------
bool vtkQuadrilleAlgorithm::ShowProgressAndGoOn()
{
  this->UpdateProgress(this->FarthestProgress);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - this->Started;
  this->TimeIsOver = this->TimeLimit > 0 && spent.count() > this->TimeLimit;
  return !this->TimeIsOver && !this->CheckAbort();
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SetStageRecords(const std::vector<quadrille::StageRecord>& stages)
{
  this->Report->stageTimes = quadrille::stageTimesText(stages);
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SetCertificate(const quadrille::Certificate& certificate)
{
  this->Report->certificate = certificate.text();
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::AddNotice(const std::string& text)
{
  this->Report->notices.push_back(text);
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::AddWarning(const std::string& text)
{
  this->AddNotice(text);
  vtkWarningMacro(<< text);
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SetResult(const std::string& text)
{
  this->Report->result = text;
}

//------------------------------------------------------------------------------
const std::vector<std::string>& vtkQuadrilleAlgorithm::GetBlockNotices() const
{
  return this->Report->notices;
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
void vtkQuadrilleAlgorithm::VisitStates(
  const std::function<void(quadrille::BlockState&)>& visit) const
{
  for (const auto& [key, state] : this->States)
  {
    visit(*state);
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ResetOutcome()
{
  this->Outcome = NotRun;
  this->TimeIsOver = false;
  this->FarthestProgress = 0;
  this->Started = std::chrono::steady_clock::now();
  this->Reports.clear();
  this->OutcomeText.clear();
  this->StageTimesText.clear();
  this->CertificateText.clear();
  this->NoticesText.clear();
  this->ResultText.clear();
  this->ReusedText.clear();
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "TimeLimit: " << this->TimeLimit << "\n";
  os << indent << "Outcome: " << this->Outcome << "\n";
  os << indent << "OutcomeText: " << this->OutcomeText << "\n";
  os << indent << "StageTimesText: " << this->StageTimesText << "\n";
  os << indent << "CertificateText: " << this->CertificateText << "\n";
  os << indent << "NoticesText: " << this->NoticesText << "\n";
  os << indent << "ResultText: " << this->ResultText << "\n";
}

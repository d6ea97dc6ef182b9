// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleAlgorithm.h"

#include "Base/Error.h"
#include "Base/Progress.h"
#include "Blocks/BlockRun.h"
#include "Blocks/Blocks.h"
#include "Blocks/Shared.h"
#include "Common/Report.h"
#include "Common/VtkVersions.h"
#include "GridMap/Certificate.h"
#include "Pipeline/StageRecords.h"
#include "Ranks/Ranks.h"
#include "Ranks/Spread.h"
#include "vtkQuadrilleExecutive.h"

#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkDataObjectTypes.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <ostream>
#include <set>
#include <sstream>

using Executive = vtkStreamingDemandDrivenPipeline;

namespace
{

/// Which part of the output is asked for; a serial run asks for piece 0 of 1.
int requestedPiece(vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  return info->Has(Executive::UPDATE_PIECE_NUMBER()) ? info->Get(Executive::UPDATE_PIECE_NUMBER())
                                                     : 0;
}

int requestedGhostLevels(vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  const auto key = Executive::UPDATE_NUMBER_OF_GHOST_LEVELS();
  return info->Has(key) ? std::max(0, info->Get(key)) : 0;
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

/// Keeps the executive from adding a dump of the request to the reason that the filter itself has told, then goes.
class IgnoreOnce : public vtkCommand
{
public:
  static IgnoreOnce* New() { return new IgnoreOnce; }
  void Execute(vtkObject* caller, unsigned long, void*) override { caller->RemoveObserver(this); }
};

} // namespace

//------------------------------------------------------------------------------
vtkQuadrilleAlgorithm::vtkQuadrilleAlgorithm() = default;
vtkQuadrilleAlgorithm::~vtkQuadrilleAlgorithm() = default;

//------------------------------------------------------------------------------
vtkExecutive* vtkQuadrilleAlgorithm::CreateDefaultExecutive()
{
  return vtkQuadrilleExecutive::New();
}

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
    role == PortRole::Surface ? "vtkDataSet"
      : role == PortRole::Log ? "vtkTable"
                              : "vtkPolyData");
  if (role == PortRole::Shared || role == PortRole::OptionalMesh)
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
  // Ranks that work together each ask for their own part, all alike, so that filters upstream can work together, too.
  // Else the whole is asked for once.
  const quadrille::Ranks ranks(quadrille::controllerOf(outputs));
  const bool isAlone = !ranks.isParallel() && requestedPiece(outputs) == 0;
  const int piece = ranks.isParallel() ? ranks.rank() : requestedPiece(outputs);
  const int pieces = isAlone ? 1 : requestedPieces(outputs);
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
  Run run(quadrille::controllerOf(outputs));
  run.ghostLevels = requestedGhostLevels(outputs);
  if (!run.ranks.isParallel() && requestedPiece(outputs) > 0)
  {
    initializeOutputs(outputs);
    this->States.clear();
    this->Outcome = Succeeded;
    return 1;
  }
  this->IsRoot = run.ranks.isRoot();
  this->IsAlone = run.ranks.size() == 1;
  const quadrille::PollScope scope(
    [this](double, const std::string&) { return this->ShowProgressAndGoOn(); });
  try
  {
    return this->RunBlocks(run, inputs, outputs);
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
int vtkQuadrilleAlgorithm::RunBlocks(
  Run& run, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  std::string error;
  try
  {
    this->ReadInputs(run, inputs);
  }
  catch (const std::exception& failure)
  {
    error = failure.what();
  }
  auto* executive = vtkQuadrilleExecutive::SafeDownCast(this->GetExecutive());
  if (executive && executive->GetUpstreamFailed())
  {
    error = "a filter that makes the input failed on rank " + std::to_string(run.ranks.rank());
  }
  run.ranks.agree(error);
  this->ListBlocks(run);
  this->ReadOwnTargets(run);
  this->GroupBlocks(run);
  this->TakeStates(run);
  run.anew = std::any_of(
    run.works.begin(), run.works.end(), [](const Work& work) { return work.isChanged; });
  if (run.anew)
  {
    this->GatherInputs(run);
    this->MeasureBlocks(run);
    this->JoinSpread(run);
    quadrille::shareOut(run);
  }
  std::set<std::size_t> changed; // what is executed together is changed together
  for (const Work& work : run.works)
  {
    if (work.isChanged)
    {
      changed.insert(work.group);
    }
  }
  std::map<std::size_t, std::vector<Work*>> mine; // by group
  for (Work& work : run.works)
  {
    work.isChanged = changed.count(work.group) != 0;
    if (run.owns(work))
    {
      mine[work.group].push_back(&work);
    }
  }
  this->Stop = run.anew ? &run.stop : nullptr;
  double begin = 0;
  for (const auto& [group, works] : mine)
  {
    this->BlockBegin = begin / static_cast<double>(mine.size());
    this->BlockEnd = ++begin / static_cast<double>(mine.size());
    this->RunWorks(works);
  }
  if (run.anew)
  {
    this->WaitForAll(run);
    this->SpreadResults(run);
  }
  this->ExchangeReports(run);
  return this->Conclude(run, outputs);
}

//------------------------------------------------------------------------------
double vtkQuadrilleAlgorithm::ReadOwnTarget(const std::string&, vtkFieldData*) const
{
  return 0;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::CheckBlockNames(const std::vector<std::string>&) const {}

//------------------------------------------------------------------------------
std::string vtkQuadrilleAlgorithm::GetSettings() const
{
  std::ostringstream text;
  text.precision(17);
  this->AddSettings(text);
  return text.str();
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::AddSettings(std::ostream& os) const
{
  os << "RankIndependent " << this->RankIndependent << '\n';
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::GetSpreadMode() const
{
  return static_cast<int>(quadrille::SpreadMode::Never);
}

//------------------------------------------------------------------------------
std::string vtkQuadrilleAlgorithm::ReasonNotToSpread(
  const std::vector<vtkSmartPointer<vtkPolyData>>& /*pieces*/) const
{
  return {};
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::PlanSpread(const quadrille::Block& /*block*/,
  const quadrille::SpreadSize& /*size*/, quadrille::SpreadPlan& /*plan*/) const
{
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::WaitForAll(Run& run)
{
  // Observers of progress may ask to stop on a rank that waits, too.
  auto last = std::chrono::steady_clock::now();
  run.stop.join(
    [&]
    {
      const auto now = std::chrono::steady_clock::now();
      if (now - last > quadrille::PollScope::kInterval)
      {
        last = now;
        this->UpdateProgress(this->FarthestProgress);
      }
      return !quadrille::isAskedToStop(this);
    });
  this->Stop = nullptr;
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
  // What is left to do after a stop that has kept something must not make another kind of stop of it.
  if (!this->IsBlockSoFar)
  {
    this->TimeIsOver = this->TimeLimit > 0 && spent.count() > this->TimeLimit;
  }
  bool isAsked = quadrille::isAskedToStop(this);
  if (this->Stop && isAsked)
  {
    this->Stop->tell();
  }
  isAsked = isAsked || (this->Stop && this->Stop->isTold());
  return this->IsBlockSoFar || (!this->TimeIsOver && !isAsked);
}

//------------------------------------------------------------------------------
std::vector<vtkQuadrilleAlgorithm::Together> vtkQuadrilleAlgorithm::FindTogether(
  const std::vector<quadrille::Block*>& blocks)
{
  std::vector<Together> all;
  for (std::size_t i = 0; i < blocks.size(); ++i)
  {
    all.push_back({ { i }, {} });
  }
  return all;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ExecuteTogether(const std::vector<quadrille::Block*>& blocks)
{
  for (quadrille::Block* block : blocks)
  {
    this->Execute(*block);
  }
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
void vtkQuadrilleAlgorithm::SayOf(quadrille::Block& block)
{
  this->Report = &block.state->report;
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
void vtkQuadrilleAlgorithm::VisitStates(
  const std::function<void(quadrille::BlockState&)>& visit) const
{
  for (const auto& [key, state] : this->States)
  {
    visit(*state);
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "TimeLimit: " << this->TimeLimit << "\n";
  os << indent << "RankIndependent: " << this->RankIndependent << "\n";
  os << indent << "Outcome: " << this->Outcome << "\n";
  os << indent << "OutcomeText: " << this->OutcomeText << "\n";
  os << indent << "StageTimesText: " << this->StageTimesText << "\n";
  os << indent << "CertificateText: " << this->CertificateText << "\n";
  os << indent << "NoticesText: " << this->NoticesText << "\n";
  os << indent << "Verdict: " << this->Verdict << "\n";
  os << indent << "ResultText: " << this->ResultText << "\n";
}

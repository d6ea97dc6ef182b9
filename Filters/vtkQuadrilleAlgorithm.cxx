// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleAlgorithm.h"

#include "GridMap/GridMap.h"
#include "Pipeline/Pipeline.h"
#include "QuadrilleReport.h"
#include "QuadrilleStamps.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <new>
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
  vtkPolyData* input = vtkPolyData::GetData(inputs[0]);
  return !input || input->GetNumberOfCells() == 0;
}

} // namespace

//------------------------------------------------------------------------------
vtkQuadrilleAlgorithm::vtkQuadrilleAlgorithm() = default;
vtkQuadrilleAlgorithm::~vtkQuadrilleAlgorithm() = default;

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
  std::vector<quadrille::Stamp> stamps = quadrille::stampsOf(inputs, this->GetNumberOfInputPorts());
  stamps.emplace_back(nullptr, this->GetMTime());
  stamps.emplace_back(nullptr, requestedPiece(outputs));
  stamps.emplace_back(nullptr, requestedPieces(outputs));
  if (this->KeepsResult() && stamps == this->LastStamps)
  {
    this->RestoreResult(outputs);
    this->ResultIsKept();
    this->UpdateProgress(1.0);
    return 1;
  }
  this->LastStamps.clear();
  this->ResetOutcome();
  if (requestedPiece(outputs) > 0 || (requestedPieces(outputs) > 1 && isEmpty(inputs)))
  {
    initializeOutputs(outputs);
    this->LastResult.clear();
    this->Outcome = Succeeded;
    return 1;
  }
  const quadrille::PollScope scope(
    [this](double, const std::string&) { return this->ShowProgressAndGoOn(); });
  try
  {
    this->Execute(inputs, outputs);
    this->KeepResult(outputs);
    this->Outcome = Succeeded;
    this->LastStamps = std::move(stamps);
    this->UpdateProgress(1.0);
    return 1;
  }
  catch (const quadrille::InvalidInput& error)
  {
    return this->Fail(BadInput, error.what(), outputs);
  }
  catch (const quadrille::Cancelled&)
  {
    return this->FailCancelled(outputs);
  }
  catch (const quadrille::StageFailure& failure)
  {
    if (failure.code == quadrille::StatusCode::Cancelled)
    {
      return this->FailCancelled(outputs);
    }
    const bool tooLarge = failure.code == quadrille::StatusCode::TooLarge;
    return this->Fail(tooLarge ? TooLarge : NoValidResult, failure.what(), outputs);
  }
  catch (const std::bad_alloc&)
  {
    return this->Fail(NoValidResult, "out of memory; ask for fewer quads or free memory", outputs);
  }
  catch (const std::exception& error)
  {
    return this->Fail(NoValidResult, std::string("internal error: ") + error.what(), outputs);
  }
}

//------------------------------------------------------------------------------
std::function<bool(double, const std::string&)> vtkQuadrilleAlgorithm::MakeProgress(
  double begin, double end)
{
  return [this, begin, end](double fraction, const std::string& text)
  {
    // A stage that is tried again starts from its beginning; the bar must not run backwards.
    const double progress = begin + (end - begin) * std::clamp(fraction, 0.0, 1.0);
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
  this->StageTimesText = quadrille::stageTimesText(stages);
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::SetCertificate(const quadrille::Certificate& certificate)
{
  this->CertificateText = certificate.text();
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::AddNotice(const std::string& text)
{
  this->NoticesText += (this->NoticesText.empty() ? "" : "\n") + text;
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::ResetOutcome()
{
  this->Outcome = NotRun;
  this->TimeIsOver = false;
  this->FarthestProgress = 0;
  this->Started = std::chrono::steady_clock::now();
  this->OutcomeText.clear();
  this->StageTimesText.clear();
  this->CertificateText.clear();
  this->NoticesText.clear();
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::KeepResult(vtkInformationVector* outputs)
{
  this->LastResult.clear();
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* output = vtkDataObject::GetData(outputs, port);
    this->LastResult.push_back(vtk::TakeSmartPointer(output->NewInstance()));
    this->LastResult.back()->ShallowCopy(output);
  }
}

//------------------------------------------------------------------------------
void vtkQuadrilleAlgorithm::RestoreResult(vtkInformationVector* outputs)
{
  initializeOutputs(outputs);
  for (std::size_t port = 0; port < this->LastResult.size(); ++port)
  {
    vtkDataObject::GetData(outputs, static_cast<int>(port))->ShallowCopy(this->LastResult[port]);
  }
}

//------------------------------------------------------------------------------
std::string vtkQuadrilleAlgorithm::DescribeOutputs() const
{
  return this->LastResult.empty() ? "there is no result" : "the previous result is kept";
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::Fail(
  OutcomeType outcome, const std::string& text, vtkInformationVector* outputs)
{
  this->RestoreResult(outputs);
  this->Outcome = outcome;
  this->OutcomeText = text;
  if (!this->LastResult.empty())
  {
    this->OutcomeText += "; " + this->DescribeOutputs();
  }
  vtkErrorMacro(<< this->OutcomeText);
  return 0;
}

//------------------------------------------------------------------------------
int vtkQuadrilleAlgorithm::FailCancelled(vtkInformationVector* outputs)
{
  if (this->TimeIsOver)
  {
    std::ostringstream text;
    text << "stopped after the time limit of " << this->TimeLimit << " s";
    return this->Fail(TimedOut, text.str(), outputs);
  }
  // No error: it is what the user asked for. Returning 0 leaves the filter out of date.
  // The flags have done their duty; left standing they would make the executive empty the outputs.
  this->SetAbortExecute(0);
  this->SetAbortOutput(false);
  this->RestoreResult(outputs);
  this->Outcome = Aborted;
  this->OutcomeText = "stopped on request; " + this->DescribeOutputs();
  vtkWarningMacro(<< this->OutcomeText);
  return 0;
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
}

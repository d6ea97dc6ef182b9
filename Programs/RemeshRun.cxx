// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "RemeshRun.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>

namespace quadrille
{

RemeshRun::RemeshRun()
{
  filter_->KeepLevelsOff(); // there is no next execution
  onError_->SetClientData(&errors_);
  onError_->SetCallback(
    [](vtkObject*, unsigned long event, void* client, void* text)
    {
      // Warnings come back as notices.
      if (event == vtkCommand::ErrorEvent && text)
      {
        *static_cast<std::string*>(client) += static_cast<const char*>(text);
      }
    });
  filter_->AddObserver(vtkCommand::ErrorEvent, onError_);
  filter_->AddObserver(vtkCommand::WarningEvent, onError_);
  filter_->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, onError_);

  onProgress_->SetClientData(this);
  onProgress_->SetCallback(
    [](vtkObject*, unsigned long, void* client, void*)
    {
      auto* run = static_cast<RemeshRun*>(client);
      const char* text = run->filter_->GetProgressText();
      run->closeGap();
      run->lastText_ = text ? text : "";
      if (!run->tellProgress(run->filter_->GetProgress(), run->lastText_))
      {
        run->filter_->SetAbortExecute(1);
      }
    });
  filter_->AddObserver(vtkCommand::ProgressEvent, onProgress_);
}

RemeshRun::~RemeshRun() = default;

void RemeshRun::onProgress(std::function<bool(double, const std::string&)> progress)
{
  progress_ = std::move(progress);
}

bool RemeshRun::tellProgress(double fraction, const std::string& text)
{
  return !progress_ || progress_(fraction, text);
}

void RemeshRun::addNotice(const std::string& text)
{
  notices_ += text.empty() ? "" : text + "\n";
}

std::string RemeshRun::notices()
{
  const std::string own = filter_->GetNoticesText();
  return notices_ + own;
}

void RemeshRun::closeGap()
{
  const auto time = std::chrono::steady_clock::now();
  const double gap = std::chrono::duration<double>(time - lastCall_).count();
  lastCall_ = time;
  if (gap > longestGap_)
  {
    longestGap_ = gap;
    longestGapText_ = lastText_;
  }
}

ExitCode RemeshRun::execute(vtkPolyData* input)
{
  errors_.clear();
  longestGap_ = 0;
  lastText_ = "start";
  lastCall_ = std::chrono::steady_clock::now();
  filter_->SetInputData(input);
  filter_->Update();
  closeGap();
  switch (filter_->GetOutcome())
  {
    case vtkQuadrilleAlgorithm::Succeeded:
      if (filter_->GetComponentsWithoutQuads() > 0)
      {
        return kPartialQuads;
      }
      return filter_->GetOutput()->GetNumberOfPolys() > 0 ||
          (filter_->GetMethod() == vtkQuadRemesh::METHOD_SEAMLESS &&
            filter_->GetMappedSurface()->GetNumberOfPolys() > 0)
        ? kValidQuads
        : kNoValidResult;
    case vtkQuadrilleAlgorithm::BadInput:
      return kBadInput;
    default:
      return filter_->GetIsSoFar() && filter_->GetOutput()->GetNumberOfPolys() > 0 ? kStoppedQuads
                                                                                   : kNoValidResult;
  }
}

std::string RemeshRun::error() const
{
  if (!failure_.empty())
  {
    return failure_;
  }
  const std::string outcome = vtkQuadRemesh::SafeDownCast(filter_.Get())->GetOutcomeText();
  if (!outcome.empty())
  {
    return outcome;
  }
  return errors_.empty() ? "no quads were made" : errors_;
}

std::vector<StageRow> RemeshRun::stages()
{
  vtkFieldData* data = filter_->GetOutput()->GetFieldData();
  auto* names = vtkStringArray::SafeDownCast(data->GetAbstractArray("StageNames"));
  vtkDataArray* seconds = data->GetArray("StageSeconds");
  vtkDataArray* in = data->GetArray("StageElementsIn");
  vtkDataArray* out = data->GetArray("StageElementsOut");
  std::vector<StageRow> rows;
  for (vtkIdType i = 0; names && seconds && in && out && i < names->GetNumberOfValues(); ++i)
  {
    rows.push_back({ names->GetValue(i), seconds->GetTuple1(i),
      static_cast<long long>(in->GetTuple1(i)), static_cast<long long>(out->GetTuple1(i)) });
  }
  return rows;
}

} // namespace quadrille

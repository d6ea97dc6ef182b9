// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ElementRun.h"

#include "MeshFiles.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

namespace quadrille
{

void ElementRun::addOptions(CommandOptions& options)
{
  options.beginGroup("elements for simulation:");
  options.addCount(
    "order", "N", { 1, 2 }, [this](long long order) { filter_->SetOrder(static_cast<int>(order)); },
    "1 (default), or 2: elements of second order, with nodes between the corners that lie on the "
    "surface and on the curves of features and boundaries (vtu, ex2, e)");
  options.addCount(
    "nodes", "N", { 8, 9 },
    [this](long long nodes) { filter_->SetNodesPerElement(static_cast<int>(nodes)); },
    "with --order 2: 8 nodes an element (default), or 9, with one in the centre");
}

void ElementRun::check(const CommandOptions& options, const std::string& output) const
{
  const bool isSecond = filter_->GetOrder() == vtkQuadElements::SECOND;
  if (options.given("nodes") && !isSecond)
  {
    throw UsageError("--nodes belongs to elements of second order: give --order 2, too");
  }
  if (isSecond && !canWriteElements(output))
  {
    throw UsageError("--order 2 needs a format that has such elements: vtu, ex2 or e");
  }
}

void ElementRun::prepare(RemeshRun& run, bool isWrapped)
{
  // The mapped surface has all features, and no handles that were closed. Of quads with a symmetry it is a part only,
  // and of a wrap it is the wrap.
  usesMappedSurface_ = filter_->GetOrder() == vtkQuadElements::SECOND && !isWrapped &&
    run.filter()->GetSymmetry() == vtkQuadRemesh::SYMMETRY_NONE;
  if (usesMappedSurface_)
  {
    run.filter()->ComputeMappedSurfaceOn();
  }
}

bool ElementRun::isAsked() const
{
  return filter_->GetOrder() == vtkQuadElements::SECOND;
}

vtkSmartPointer<vtkDataSet> ElementRun::execute(RemeshRun& run, vtkPolyData* input)
{
  filter_->SetInputData(run.filter()->GetOutput());
  filter_->SetSurfaceData(usesMappedSurface_ ? run.filter()->GetMappedSurface() : input);
  filter_->SetPatchArrayName(run.filter()->GetPatchArrayName());
  filter_->SetNumberOfThreads(run.filter()->GetNumberOfThreads());
  vtkNew<vtkCallbackCommand> silence; // what goes wrong is in OutcomeText and NoticesText
  silence->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  filter_->AddObserver(vtkCommand::ErrorEvent, silence);
  filter_->AddObserver(vtkCommand::WarningEvent, silence);
  filter_->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, silence);
  vtkNew<vtkCallbackCommand> progress;
  progress->SetClientData(&run);
  progress->SetCallback(
    [](vtkObject* caller, unsigned long, void* client, void*)
    {
      auto* filter = static_cast<vtkQuadElements*>(caller);
      const char* text = filter->GetProgressText();
      if (!static_cast<RemeshRun*>(client)->tellProgress(filter->GetProgress(), text ? text : ""))
      {
        filter->SetAbortExecute(1);
      }
    });
  filter_->AddObserver(vtkCommand::ProgressEvent, progress);
  filter_->Update();
  if (filter_->GetOutcome() != vtkQuadrilleAlgorithm::Succeeded)
  {
    run.fail(std::string("the elements: ") + filter_->GetOutcomeText());
    return nullptr;
  }
  run.addNotice(filter_->GetNoticesText());
  return filter_->GetElements();
}

} // namespace quadrille

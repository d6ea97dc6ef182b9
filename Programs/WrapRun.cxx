// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "WrapRun.h"

#ifdef QUADRILLE_USE_CGAL
#include "Report.h"

#include <vtkQuadProjection.h>
#include <vtkSurfaceRepair.h>
#include <vtkSurfaceWrap.h>

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkPolyData.h>

#include <optional>
#include <sstream>
#endif

namespace quadrille
{

#ifdef QUADRILLE_USE_CGAL

namespace
{

/// Brings a filter beside the run up to date: its messages are not printed, its progress is the run's.
bool update(vtkQuadrilleAlgorithm* filter, RemeshRun& run)
{
  struct Client
  {
    vtkQuadrilleAlgorithm* filter;
    RemeshRun* run;
  } client{ filter, &run };
  vtkNew<vtkCallbackCommand> silence;
  silence->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  vtkNew<vtkCallbackCommand> onProgress;
  onProgress->SetClientData(&client);
  onProgress->SetCallback(
    [](vtkObject*, unsigned long, void* data, void*)
    {
      const auto* told = static_cast<Client*>(data);
      const char* text = told->filter->GetProgressText();
      if (!told->run->tellProgress(told->filter->GetProgress(), text ? text : ""))
      {
        told->filter->SetAbortExecute(1);
      }
    });
  filter->AddObserver(vtkCommand::ErrorEvent, silence);
  filter->AddObserver(vtkCommand::WarningEvent, silence);
  filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, silence);
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, onProgress);
  filter->Update();
  filter->RemoveObserver(tag); // the client goes
  return filter->GetOutcome() == vtkQuadrilleAlgorithm::Succeeded;
}

/// Stops and limits are no reason to try something else.
bool mayTryAgain(vtkQuadRemesh* filter)
{
  const int outcome = filter->GetOutcome();
  return outcome == vtkQuadrilleAlgorithm::BadInput ||
    outcome == vtkQuadrilleAlgorithm::NoValidResult;
}

/// Most faces cross others, or most stand alone.
bool isNoSurface(RemeshRun& run, vtkPolyData* input)
{
  vtkNew<vtkSurfaceRepair> repair;
  repair->SetInputData(input);
  return update(repair, run) && fieldNumber(repair->GetOutput(), "NeedsWrap") != 0;
}

/// The quads of the input itself; nothing where a wrap is to be remeshed, and the run has a notice why.
std::optional<ExitCode> executeUnwrapped(RemeshRun& run, vtkPolyData* input)
{
  if (isNoSurface(run, input))
  {
    run.addNotice(
      "most faces of the input cross others or stand alone, so a wrap of it was remeshed");
    return std::nullopt;
  }
  const ExitCode code = run.execute(input);
  if (code == kValidQuads || !mayTryAgain(run.filter()))
  {
    return code;
  }
  run.addNotice("the input itself has no quads, so a wrap of it was remeshed: " + run.error());
  return std::nullopt;
}

std::string lengthText(double length)
{
  std::ostringstream text;
  text << length;
  return text.str();
}

ExitCode codeOf(vtkQuadrilleAlgorithm* filter)
{
  return filter->GetOutcome() == vtkQuadrilleAlgorithm::BadInput ? kBadInput : kNoValidResult;
}

} // namespace

bool canWrap()
{
  return true;
}

ExitCode executeWrapped(RemeshRun& run, vtkPolyData* input, const WrapRequest& request)
{
  if (request.onlyAfterFailure)
  {
    if (const std::optional<ExitCode> code = executeUnwrapped(run, input))
    {
      return *code;
    }
  }
  vtkNew<vtkSurfaceWrap> wrap;
  wrap->SetInputData(input);
  wrap->SetAlpha(request.alpha);
  wrap->SetNumberOfThreads(run.filter()->GetNumberOfThreads());
  if (!update(wrap, run))
  {
    run.fail(std::string("the wrap of the input: ") + wrap->GetOutcomeText());
    return codeOf(wrap);
  }
  vtkPolyData* surface = wrap->GetOutput();
  run.addNotice("the wrap has " + std::to_string(surface->GetNumberOfPolys()) +
    " triangles, alpha " + lengthText(fieldNumber(surface, "WrapAlpha")) + ", offset " +
    lengthText(fieldNumber(surface, "WrapOffset")) +
    (request.detectsFeatures ? ""
                             : "; sharp edges, which a wrap rounds, are not looked for on it (give "
                               "--feature-angle to have them)"));
  if (!request.detectsFeatures)
  {
    run.filter()->DetectFeaturesOff();
  }
  run.filter()->SetPatchArrayName("");
  const ExitCode code = run.execute(surface);
  vtkPolyData* quads = run.filter()->GetOutput();
  if (code == kStoppedQuads)
  {
    run.fail(run.error() + " of the wrap, which were not put onto the input any more");
    return kNoValidResult;
  }
  if (code != kValidQuads || quads->GetNumberOfPolys() == 0)
  {
    return code;
  }
  vtkNew<vtkQuadProjection> projection;
  projection->SetInputData(quads);
  projection->SetSurfaceData(input);
  projection->SetNumberOfThreads(run.filter()->GetNumberOfThreads());
  if (!update(projection, run))
  {
    run.fail(std::string("the quads of the wrap: ") + projection->GetOutcomeText());
    return codeOf(projection);
  }
  quads->ShallowCopy(projection->GetOutput());
  run.addNotice(std::to_string(static_cast<long long>(fieldNumber(quads, "PointsOnSurface"))) +
    " of " + std::to_string(quads->GetNumberOfPoints()) + " points were put onto the input");
  run.addNotice(projection->GetNoticesText());
  return code;
}

#else

bool canWrap()
{
  return false;
}

ExitCode executeWrapped(RemeshRun& run, vtkPolyData* input, const WrapRequest&)
{
  return run.execute(input);
}

#endif

} // namespace quadrille

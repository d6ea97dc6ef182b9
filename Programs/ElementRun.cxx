// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ElementRun.h"

#include "MeshFiles.h"

#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include <sstream>

namespace quadrille
{

void ElementRun::addOptions(CommandOptions& options)
{
  options.beginGroup("elements for simulation:");
  options.addCount(
    "order", "N", { 1, 2 }, [this](long long order) { filter_->SetOrder(static_cast<int>(order)); },
    "1 (default), or 2: elements of second order, with nodes between the corners that lie on the "
    "surface and on the curves of features and boundaries (vtu, ex2, e, inp, msh)");
  options.addCount(
    "nodes", "N", { 8, 9 },
    [this](long long nodes) { filter_->SetNodesPerElement(static_cast<int>(nodes)); },
    "with --order 2: 8 nodes an element (default), or 9, with one in the centre");
  options.addFlag(
    "quality",
    [this]
    {
      filter_->QualityOn();
      isWanted_ = true;
    },
    "write measures of each element, as Verdict defines them, as cell arrays: ScaledJacobian, "
    "AspectRatio, Skew, Warpage, Taper, EdgeRatio, MinimumAngle and MaximumAngle; their ranges and "
    "histograms go into the report");
  options.addTexts(
    "require", "LIMIT",
    [this](const std::string& text)
    {
      const std::string error = vtkQuadElements::GetRequirementError(text.c_str());
      if (!error.empty())
      {
        throw UsageError("--require: " + error);
      }
      filter_->AddRequirement(text.c_str());
      isWanted_ = true;
    },
    "a limit that all elements have to keep, as \"scaled-jacobian>0.2\", in quotes; else the exit "
    "code is 3, the mesh is written all the same, and the worst places are told; may be given "
    "several times; measures: scaled-jacobian, aspect-ratio, skew, warpage, taper, edge-ratio, "
    "minimum-angle, maximum-angle");
  options.addCount(
    "worst", "N", { 0, 1000000 },
    [this](long long count)
    {
      filter_->SetNumberOfWorst(static_cast<int>(count));
      tellsWorst_ = true;
    },
    "tell so many elements with the least scaled Jacobian, and so many that do not keep a limit "
    "(default: 10 for each limit); has --quality with it");
  options.addText(
    "thickness", "NAME",
    [this](const std::string& name)
    {
      filter_->SetThicknessArrayName(name.c_str());
      isWanted_ = true;
    },
    "array of the input with the thickness: becomes the cell array Thickness, by area; --cell-data "
    "is then area where it is not given");
  options.addText(
    "axis", "NAME",
    [this](const std::string& name)
    {
      filter_->SetAxisArrayName(name.c_str());
      isWanted_ = true;
    },
    "array of the input with directions, as GuidingDirection: becomes the cell array ElementAxis, "
    "a unit vector in the plane of each element");
  options.addChoice(
    "axis-fallback", "WORD", { "none", "x", "y", "z", "element" },
    [this](int fallback) { filter_->SetAxisFallback(fallback); },
    "what elements get whose direction is zero or along the normal: x, y or z, that axis; element, "
    "the direction from its edge 3 to its edge 1; none (default): an error that tells where");
  options.addTexts(
    "local-vectors", "NAME",
    [this](const std::string& name)
    {
      filter_->AddVectorArrayName(name.c_str());
      isWanted_ = true;
    },
    "array of the input with vectors: their components along ElementAxis (or from edge 3 to edge "
    "1), across it and along the normal become the cell array NAMEInElement; may be given several "
    "times");
}

void ElementRun::check(const CommandOptions& options, const std::string& output) const
{
  const bool isSecond = filter_->GetOrder() == vtkQuadElements::SECOND;
  if (options.given("nodes") && !isSecond)
  {
    throw UsageError("--nodes belongs to elements of second order: give --order 2, too");
  }
  if (options.given("axis-fallback") && !options.given("axis"))
  {
    throw UsageError("--axis-fallback belongs to --axis NAME");
  }
  if (isAsked() && output.empty())
  {
    throw UsageError("the method seamless makes no quads, so there are no elements");
  }
  if (isSecond && !canWriteElements(output))
  {
    throw UsageError("--order 2 needs a format that has such elements: vtu, ex2, e, inp or msh");
  }
}

void ElementRun::prepare(RemeshRun& run, bool isWrapped, bool hasCellData)
{
  // The mapped surface has all features, and no handles that were closed. Of quads with a symmetry it is a part only,
  // and of a wrap it is the wrap.
  usesMappedSurface_ = filter_->GetOrder() == vtkQuadElements::SECOND && !isWrapped &&
    run.filter()->GetSymmetry() == vtkQuadRemesh::SYMMETRY_NONE;
  if (usesMappedSurface_)
  {
    run.filter()->ComputeMappedSurfaceOn();
  }
  if (*filter_->GetThicknessArrayName() != '\0' && !hasCellData)
  {
    run.filter()->SetCellDataFrom(vtkQuadRemesh::CELL_DATA_FROM_AREA);
  }
  if (tellsWorst_)
  {
    filter_->QualityOn();
  }
}

bool ElementRun::isAsked() const
{
  return filter_->GetOrder() == vtkQuadElements::SECOND || isWanted_ || tellsWorst_;
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
  isDone_ = true;
  isGood_ = filter_->GetNumberOfFailedElements() == 0;
  run.addNotice(filter_->GetNoticesText());
  if (tellsWorst_)
  {
    tellWorst(run);
  }
  if (filter_->GetOrder() == vtkQuadElements::SECOND)
  {
    return filter_->GetElements();
  }
  // Every format has quads.
  auto quads = vtkSmartPointer<vtkPolyData>::New();
  quads->ShallowCopy(run.filter()->GetOutput());
  quads->GetCellData()->ShallowCopy(filter_->GetElements()->GetCellData());
  quads->GetFieldData()->ShallowCopy(filter_->GetElements()->GetFieldData());
  return quads;
}

std::string ElementRun::failure() const
{
  if (isGood_)
  {
    return {};
  }
  // The notices have a line for each requirement.
  std::istringstream lines(filter_->GetNoticesText());
  std::string text;
  for (std::string line; std::getline(lines, line);)
  {
    const bool isOfRequirement =
      line.find(" fail ") != std::string::npos || line.find(" fails ") != std::string::npos;
    text += isOfRequirement ? (text.empty() ? "" : "; ") + line : "";
  }
  return text;
}

void ElementRun::tellWorst(RemeshRun& run)
{
  vtkPolyData* places = filter_->GetWorstElements();
  vtkPointData* data = places->GetPointData();
  std::ostringstream text;
  text << "the least scaled Jacobians:";
  for (vtkIdType i = 0; i < places->GetNumberOfPoints(); ++i)
  {
    if (data->GetAbstractArray("Measure")->GetVariantValue(i).ToString() != "ScaledJacobian")
    {
      break; // those of limits come with them
    }
    const double* p = places->GetPoint(i);
    text << (i > 0 ? "; " : " ") << data->GetArray("Value")->GetTuple1(i) << " in element "
         << static_cast<long long>(data->GetArray("ElementId")->GetTuple1(i)) << " at (" << p[0]
         << ", " << p[1] << ", " << p[2] << ")";
  }
  run.addNotice(text.str());
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CadRun.h"

#include "MeshFiles.h"

#include <vtkDataSet.h>
#include <vtkPolyData.h>
#ifdef QUADRILLE_WITH_CAD
#include "Common/VtkErrors.h"

#include <vtkCallbackCommand.h>
#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkQuadCADProjection.h>
#include <vtkQuadrilleCADReader.h>
#endif

#include <array>
#include <sstream>

namespace quadrille
{

void CadRun::addOptions(CommandOptions& options)
{
  options.beginGroup("CAD files (step, stp, iges, igs, brep), whose sharp edges are features:");
  options.addNumber(
    "cad-chord-error", "R", { 1e-6, 0.1 }, [this](double error) { chordError_ = error; },
    "by how much the triangles that quads are made on may lie off the shape, over its diagonal "
    "(default 0.0005)");
  options.addChoice(
    "cad-follow", "WORD", { "sharp", "all", "none" }, [this](int follow) { follow_ = follow; },
    "which edges of the shape become edges of the quads: sharp (default), all, also those where "
    "faces go on into each other, or none; seams and poles never do");
  options.addChoice(
    "cad-nodes", "WORD", { "exact", "triangles" }, [this](int word) { keepsNodes_ = word == 1; },
    "where the nodes of the mesh lie: exact (default), on the surfaces, curves and vertices of the "
    "shape, or on the triangles");
}

bool CadRun::isCad(const std::string& path)
{
  const std::string extension = extensionOf(path);
  static const std::array<const char*, 6> kKnown{ "step", "stp", "iges", "igs", "brep", "brp" };
  for (const char* known : kKnown)
  {
    if (extension == known)
    {
      return true;
    }
  }
  return false;
}

void CadRun::check(const CommandOptions& options, const std::string& input) const
{
  for (const char* option : { "cad-chord-error", "cad-follow", "cad-nodes" })
  {
    if (options.given(option) && !isCad(input))
    {
      throw UsageError(std::string("--") + option + " is for CAD files, and " + input + " is none");
    }
  }
}

#ifdef QUADRILLE_WITH_CAD

vtkSmartPointer<vtkPolyData> CadRun::read(RemeshRun& run, const std::string& path) const
{
  vtkNew<vtkQuadrilleCADReader> reader;
  reader->SetFileName(path.c_str());
  reader->SetChordError(chordError_);
  reader->SetFollow(follow_);
  reader->JoinPartsOn();
  const ErrorCollector errors(reader);
  const ErrorCollector pipelineErrors(reader->GetExecutive());
  const vtkNew<vtkCallbackCommand> silence; // its warnings are the notices
  reader->AddObserver(vtkCommand::WarningEvent, silence);
  reader->Update();
  if (*reader->GetOutcomeText() != '\0')
  {
    throw FileError(reader->GetOutcomeText());
  }
  std::istringstream lines(reader->GetNoticesText());
  for (std::string line; std::getline(lines, line);)
  {
    run.addNotice(line);
  }
  return vtkPolyData::SafeDownCast(reader->GetOutputDataObject(0));
}

vtkSmartPointer<vtkDataSet> CadRun::project(
  RemeshRun& run, const vtkSmartPointer<vtkDataSet>& mesh) const
{
  if (keepsNodes_)
  {
    return mesh;
  }
  vtkNew<vtkQuadCADProjection> filter;
  const ErrorCollector errors(filter);
  const ErrorCollector pipelineErrors(filter->GetExecutive());
  filter->SetInputData(mesh);
  filter->Update();
  if (*filter->GetOutcomeText() != '\0')
  {
    run.fail(std::string("the exact shape: ") + filter->GetOutcomeText());
    return nullptr;
  }
  const vtkIdType off = filter->GetNodesOffGeometry();
  run.addNotice(std::to_string(filter->GetNodesOnGeometry()) + " nodes lie on the exact shape, " +
    (off == 0 ? "none" : std::to_string(off)) + (off == 1 ? " stays" : " stay") +
    " on the triangles (point array CadPlace)");
  if (*filter->GetNoticesText() != '\0')
  {
    run.addNotice(filter->GetNoticesText());
  }
  return vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
}

#else

vtkSmartPointer<vtkPolyData> CadRun::read(RemeshRun&, const std::string& path) const
{
  throw FileError(path +
    ": this build reads no CAD files: build it with Open CASCADE (package "
    "libocct-data-exchange-dev), or have your CAD program write STL or PLY");
}

vtkSmartPointer<vtkDataSet> CadRun::project(
  RemeshRun&, const vtkSmartPointer<vtkDataSet>& mesh) const
{
  return mesh;
}

#endif

} // namespace quadrille

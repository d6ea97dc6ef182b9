// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleSession.h"

#include "Base/Refuse.h"
#include "Common/NewArray.h"
#include "Convert/PolyData.h"
#include "Session/SessionText.h"

#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <optional>
#include <utility>

vtkStandardNewMacro(vtkQuadrilleSession);

//------------------------------------------------------------------------------
struct vtkQuadrilleSession::Internals
{
  std::optional<quadrille::Session> Session;
  std::string Report;
  std::string Error;
  bool ErrorIsInInput = false;
  vtkNew<vtkPolyData> Quads, Irregular, PreviewQuads;
  std::shared_ptr<const quadrille::SessionResult> Written; ///< what these two hold

  quadrille::Session& Get()
  {
    if (!this->Session)
    {
      quadrille::refuse("the session has no surface: start it, or load one");
    }
    return *this->Session;
  }

  /// What `act` returns, or an empty value where it throws.
  template <class Act>
  auto Try(const Act& act) -> decltype(act())
  {
    this->Error.clear();
    this->ErrorIsInInput = false;
    try
    {
      return act();
    }
    catch (const quadrille::InvalidInput& error)
    {
      this->ErrorIsInInput = true;
      this->Error = error.what();
    }
    catch (const std::exception& error)
    {
      this->Error = error.what();
    }
    return {};
  }

  void Write();
};

namespace
{

quadrille::SurfaceInput convertInput(vtkPolyData* surface, int threads)
{
  if (surface == nullptr)
  {
    quadrille::refuse("there is no surface");
  }
  return quadrille::convertSurface(surface, quadrille::arrays::kPatchId, threads).input;
}

vtkSmartPointer<vtkPoints> vtkPointsAt(const std::vector<quadrille::Vector3>& places)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  for (const quadrille::Vector3& p : places)
  {
    points->InsertNextPoint(p.data());
  }
  return points;
}

void writeSessionQuads(const quadrille::QuadMesh& quads, vtkPolyData* output)
{
  auto valence = quadrille::newArray<vtkIntArray>(quadrille::arrays::kValence);
  auto onBoundary = quadrille::newArray<vtkIntArray>(quadrille::arrays::kOnBoundary);
  vtkNew<vtkCellArray> cells;
  for (const std::array<quadrille::Index, 4>& quad : quads.quads)
  {
    cells->InsertNextCell({ static_cast<vtkIdType>(quad[0]), static_cast<vtkIdType>(quad[1]),
      static_cast<vtkIdType>(quad[2]), static_cast<vtkIdType>(quad[3]) });
  }
  for (std::size_t i = 0; i < quads.points.size(); ++i)
  {
    valence->InsertNextValue(quads.valence[i]);
    onBoundary->InsertNextValue(quads.onBoundary[i]);
  }
  output->Initialize();
  output->SetPoints(vtkPointsAt(quads.points));
  output->SetPolys(cells);
  output->GetPointData()->AddArray(valence);
  output->GetPointData()->AddArray(onBoundary);
}

} // namespace

//------------------------------------------------------------------------------
void vtkQuadrilleSession::Internals::Write()
{
  const std::shared_ptr<const quadrille::SessionResult> result =
    this->Session ? this->Session->result() : nullptr;
  if (result == this->Written)
  {
    return;
  }
  this->Written = result;
  this->Quads->Initialize();
  this->Irregular->Initialize();
  if (!result)
  {
    return;
  }
  writeSessionQuads(result->quads, this->Quads);
  const auto addImages = [this](const std::vector<quadrille::Index>& images, const char* name)
  {
    if (!images.empty())
    {
      auto image = quadrille::newArray<vtkIdTypeArray>(name);
      for (const quadrille::Index point : images)
      {
        image->InsertNextValue(point);
      }
      this->Quads->GetPointData()->AddArray(image);
    }
  };
  addImages(result->mirrorPoint, quadrille::arrays::kMirrorPoint);
  addImages(result->rotatedPoint, quadrille::arrays::kRotatedPoint);

  std::vector<quadrille::Vector3> places;
  auto irregularValence = quadrille::newArray<vtkIntArray>(quadrille::arrays::kValence);
  vtkNew<vtkCellArray> vertices;
  for (const quadrille::IrregularVertex& vertex : result->irregular)
  {
    vertices->InsertNextCell({ static_cast<vtkIdType>(places.size()) });
    places.push_back(vertex.place);
    irregularValence->InsertNextValue(vertex.valence);
  }
  this->Irregular->SetPoints(vtkPointsAt(places));
  this->Irregular->SetVerts(vertices);
  this->Irregular->GetPointData()->AddArray(irregularValence);
}

//------------------------------------------------------------------------------
vtkQuadrilleSession::vtkQuadrilleSession() : Data(new Internals) {}

vtkQuadrilleSession::~vtkQuadrilleSession() = default;

//------------------------------------------------------------------------------
bool vtkQuadrilleSession::Start(vtkPolyData* surface, const std::string& settings)
{
  return this->Data->Try(
    [&]
    {
      quadrille::RemeshOptions options;
      quadrille::settingsFromText(settings, options);
      this->Data->Session.emplace(convertInput(surface, options.threads), options);
      this->Data->Report.clear();
      return true;
    });
}

//------------------------------------------------------------------------------
bool vtkQuadrilleSession::Save(const std::string& fileName)
{
  return this->Data->Try(
    [&]
    {
      this->Data->Get().save(fileName);
      return true;
    });
}

//------------------------------------------------------------------------------
bool vtkQuadrilleSession::Load(const std::string& fileName, vtkPolyData* surface)
{
  return this->Data->Try(
    [&]
    {
      this->Data->Session.emplace(quadrille::Session::load(fileName, convertInput(surface, 0)));
      this->Data->Report.clear();
      return true;
    });
}

//------------------------------------------------------------------------------
bool vtkQuadrilleSession::SetSettings(const std::string& settings)
{
  return this->Data->Try(
    [&]
    {
      quadrille::changeSettings(this->Data->Get(), settings);
      return true;
    });
}

std::string vtkQuadrilleSession::GetSettings()
{
  return this->Data->Try([&] { return quadrille::settingsText(this->Data->Get().settings()); });
}

//------------------------------------------------------------------------------
int vtkQuadrilleSession::AddConstraint(const std::string& constraint)
{
  return this->Data->Try(
    [&] { return this->Data->Get().add(quadrille::contentFromText(constraint)); });
}

bool vtkQuadrilleSession::EditConstraint(int id, const std::string& constraint)
{
  return this->Data->Try(
    [&]
    {
      this->Data->Get().edit(id, quadrille::contentFromText(constraint));
      return true;
    });
}

bool vtkQuadrilleSession::RemoveConstraint(int id)
{
  return this->Data->Try(
    [&]
    {
      this->Data->Get().remove(id);
      return true;
    });
}

std::string vtkQuadrilleSession::GetConstraints()
{
  return this->Data->Try([&] { return quadrille::constraintsText(this->Data->Get()); });
}

//------------------------------------------------------------------------------
void vtkQuadrilleSession::TellProgress(quadrille::Session& session)
{
  this->AbortUpdate = false;
  session.setProgress(
    [this](double fraction, const std::string&)
    {
      this->Progress = fraction;
      this->InvokeEvent(vtkCommand::ProgressEvent, &this->Progress);
      return !this->AbortUpdate;
    });
}

bool vtkQuadrilleSession::Update()
{
  return this->Data->Try(
    [&]
    {
      quadrille::Session& session = this->Data->Get();
      this->TellProgress(session);
      const quadrille::SessionReport& report = session.update();
      this->Data->Report = quadrille::reportText(report);
      this->Data->Error = report.status.message;
      return report.status.ok();
    });
}

bool vtkQuadrilleSession::Preview()
{
  return this->Data->Try(
    [&]
    {
      quadrille::Session& session = this->Data->Get();
      this->TellProgress(session);
      const quadrille::SessionResult made = session.preview();
      this->Data->Error = made.report.status.message;
      if (made.report.status.ok())
      {
        writeSessionQuads(made.quads, this->Data->PreviewQuads);
      }
      return made.report.status.ok();
    });
}

vtkPolyData* vtkQuadrilleSession::GetPreviewQuads()
{
  return this->Data->PreviewQuads;
}

std::string vtkQuadrilleSession::GetReport() const
{
  return this->Data->Report;
}

//------------------------------------------------------------------------------
vtkPolyData* vtkQuadrilleSession::GetQuads()
{
  this->Data->Write();
  return this->Data->Quads;
}

vtkPolyData* vtkQuadrilleSession::GetIrregularVertices()
{
  this->Data->Write();
  return this->Data->Irregular;
}

//------------------------------------------------------------------------------
bool vtkQuadrilleSession::Undo()
{
  return this->Data->Try([&] { return this->Data->Get().undo(); });
}

bool vtkQuadrilleSession::Redo()
{
  return this->Data->Try([&] { return this->Data->Get().redo(); });
}

bool vtkQuadrilleSession::CanUndo()
{
  return this->Data->Try([&] { return this->Data->Get().canUndo(); });
}

bool vtkQuadrilleSession::CanRedo()
{
  return this->Data->Try([&] { return this->Data->Get().canRedo(); });
}

//------------------------------------------------------------------------------
bool vtkQuadrilleSession::NameState(const std::string& name)
{
  return this->Data->Try(
    [&]
    {
      this->Data->Get().nameState(name);
      return true;
    });
}

bool vtkQuadrilleSession::GoTo(const std::string& name)
{
  return this->Data->Try(
    [&]
    {
      this->Data->Get().goTo(name);
      return true;
    });
}

int vtkQuadrilleSession::GetNumberOfNamedStates()
{
  return this->Data->Try([&] { return static_cast<int>(this->Data->Get().stateNames().size()); });
}

std::string vtkQuadrilleSession::GetStateName(int i)
{
  return this->Data->Try(
    [&]
    {
      const std::vector<std::string> names = this->Data->Get().stateNames();
      if (i < 0 || i >= static_cast<int>(names.size()))
      {
        quadrille::refuse("there is no state ", i, ", but ", names.size(), " have names");
      }
      return names[static_cast<std::size_t>(i)];
    });
}

std::string vtkQuadrilleSession::Compare(const std::string& first, const std::string& second)
{
  return this->Data->Try(
    [&] { return quadrille::comparisonText(this->Data->Get().compare(first, second)); });
}

//------------------------------------------------------------------------------
std::string vtkQuadrilleSession::GetErrorText() const
{
  return this->Data->Error;
}

bool vtkQuadrilleSession::GetErrorIsInInput() const
{
  return this->Data->ErrorIsInInput;
}

//------------------------------------------------------------------------------
void vtkQuadrilleSession::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "AbortUpdate: " << this->AbortUpdate << "\n";
  os << indent << "Progress: " << this->Progress << "\n";
  os << indent << "Report: " << this->Data->Report << "\n";
  os << indent << "ErrorText: " << this->Data->Error << "\n";
  os << indent << "ErrorIsInInput: " << this->Data->ErrorIsInInput << "\n";
}

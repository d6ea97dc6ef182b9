// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadMeshWriter.h"

#include "Common/Far.h"
#include "ElementGrids/Elements.h"
#include "Export/InpWriter.h"
#include "Export/MshWriter.h"
#include "Export/OutputFile.h"
#include "Export/SurfaceWriters.h"
#include "Files/CadNames.h"
#include "Files/MeshFiles.h"

#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cctype>
#include <new>

vtkStandardNewMacro(vtkQuadMeshWriter);

namespace
{

constexpr const char* kExtensions[] = { "vtp", "vtu", "ex2", "e", "exo", "exodus", "inp", "msh",
  "mesh", "obj", "ply", "stl" };

/// The name of a property of a PLY file is one word.
std::string plyProperty(const quadrille::PatchSource& patches)
{
  const char* name = patches.array ? patches.array->GetName() : nullptr;
  const std::string word = name ? name : "";
  const bool isWord =
    std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isgraph(c) != 0; });
  return isWord || word.empty() ? word : "PatchId";
}

/// Graphics formats have patches where these are the user's, PLY where it is asked for them, too; STL has none.
quadrille::PatchSource patchesOfFormat(
  const quadrille::PatchSource& patches, const std::string& extension, bool withDetails)
{
  const bool isGraphics = extension == "obj" || extension == "ply" || extension == "stl";
  const bool hasPatches = extension == "obj" || (extension == "ply" && withDetails);
  return isGraphics && !(hasPatches && patches.isAsked) ? quadrille::PatchSource{} : patches;
}

/// Those of a format without sets are not derived, which takes longer than writing it.
quadrille::MeshSets setsOfFormat(const quadrille::ElementMesh& mesh,
  const quadrille::PatchSource& patches, const std::string& extension)
{
  if (patches.array || (extension != "obj" && extension != "ply" && extension != "stl"))
  {
    return quadrille::setsOf(mesh);
  }
  quadrille::requireValid(mesh);
  return {};
}

} // namespace

//------------------------------------------------------------------------------
vtkQuadMeshWriter::vtkQuadMeshWriter() = default;
vtkQuadMeshWriter::~vtkQuadMeshWriter() = default;

//------------------------------------------------------------------------------
void vtkQuadMeshWriter::SetText(std::string& member, const char* value)
{
  const std::string text = value ? value : "";
  if (text != member)
  {
    member = text;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkQuadMeshWriter::SetFileName(const char* name)
{
  this->SetText(this->FileName, name);
}

//------------------------------------------------------------------------------
void vtkQuadMeshWriter::SetPatchArrayName(const char* name)
{
  const std::string text = name ? name : "";
  this->SetText(this->PatchArrayName, text == "(automatic)" ? "" : text.c_str());
}

//------------------------------------------------------------------------------
void vtkQuadMeshWriter::SetElementType(const char* type)
{
  const bool isAutomatic = type != nullptr && std::string(type) == "Automatic";
  this->SetText(this->ElementType, isAutomatic ? "" : type);
}

//------------------------------------------------------------------------------
void vtkQuadMeshWriter::SetMaterial(const char* name)
{
  this->SetText(this->Material, name);
}

//------------------------------------------------------------------------------
bool vtkQuadMeshWriter::CanWriteFile(const char* name)
{
  const std::string extension = quadrille::extensionOf(name ? name : "");
  return std::find(std::begin(kExtensions), std::end(kExtensions), extension) !=
    std::end(kExtensions);
}

//------------------------------------------------------------------------------
std::string vtkQuadMeshWriter::GetExtensions()
{
  std::string list;
  for (const char* extension : kExtensions)
  {
    list += (list.empty() ? "" : ", ") + std::string(extension);
  }
  return list;
}

//------------------------------------------------------------------------------
int vtkQuadMeshWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  return 1;
}

//------------------------------------------------------------------------------
void vtkQuadMeshWriter::WriteElements(vtkDataSet* mesh, const std::string& path)
{
  using namespace quadrille;
  const std::string extension = quadrille::extensionOf(path);
  std::vector<std::string> notices;
  const auto add = [&notices](const std::vector<std::string>& more)
  { notices.insert(notices.end(), more.begin(), more.end()); };
  const ProgressCallback progress = [this](double fraction, const std::string& text)
  {
    this->SetProgressText(text.c_str());
    this->UpdateProgress(fraction);
    return this->GetAbortExecute() == 0;
  };
  PollScope polling(progress);
  const ProgressCallback told = polling.callback();
  const PatchSource patches =
    patchesOfFormat(patchSource(mesh, this->PatchArrayName), extension, this->FileDetails);
  ElementMesh elements = readElements(mesh, patches, notices);
  const bool hasCurves = extension != "obj" && extension != "ply" && extension != "stl";
  if (hasCurves)
  {
    readCadNames(mesh, elements);
  }
  const MeshSets sets = setsOfFormat(elements, patches, extension);
  const std::string missing = hasCurves ? cadNamesWithoutSet(mesh, sets) : "";
  if (!missing.empty())
  {
    notices.push_back(missing);
  }
  if (extension == "inp")
  {
    add(writeInp(elements, sets, path,
      { this->ElementType, static_cast<InpDialect>(this->Dialect), this->Material, told }));
  }
  else if (extension == "msh")
  {
    add(writeMsh(elements, sets, path,
      this->MshVersion == MSH_4_1 ? quadrille::MshVersion::V41 : quadrille::MshVersion::V22, told));
  }
  else if (extension == "mesh")
  {
    add(writeMedit(elements, sets, path, told));
  }
  else if (extension == "obj")
  {
    add(writeObj(elements, sets, patches.array != nullptr, path, told));
  }
  else if (extension == "ply")
  {
    add(writePly(elements, sets, plyProperty(patches), isFar(mesh), path, told));
  }
  else if (extension == "stl")
  {
    add(writeStl(elements, path, told));
  }
  else
  {
    add(writeExodus(mesh, elements, sets, path));
  }
  this->AddNotices(notices);
}

//------------------------------------------------------------------------------
void vtkQuadMeshWriter::AddNotices(const std::vector<std::string>& notices)
{
  for (const std::string& notice : notices)
  {
    this->NoticesText += notice + "\n";
  }
}

//------------------------------------------------------------------------------
void vtkQuadMeshWriter::WriteFile(vtkDataSet* mesh, const std::string& path)
{
  const std::string extension = quadrille::extensionOf(path);
  if (extension == "vtu")
  {
    this->AddNotices(quadrille::writeVtu(mesh, this->FileDetails, path));
  }
  else if (extension == "vtp")
  {
    auto* surface = vtkPolyData::SafeDownCast(mesh);
    if (!surface)
    {
      throw quadrille::InvalidInput("a vtp file holds a vtkPolyData, but this is a " +
        std::string(mesh->GetClassName()) + ": write vtu");
    }
    quadrille::writeVtp(surface, path);
  }
  else
  {
    this->WriteElements(mesh, path);
  }
}

//------------------------------------------------------------------------------
void vtkQuadMeshWriter::WriteData()
{
  this->OutcomeText.clear();
  this->NoticesText.clear();
  this->Outcome = Succeeded;
  try
  {
    auto* mesh = vtkDataSet::SafeDownCast(this->GetInput());
    if (this->FileName.empty())
    {
      throw quadrille::InvalidInput("no file is named: set FileName");
    }
    if (!CanWriteFile(this->FileName.c_str()))
    {
      throw quadrille::InvalidInput(
        this->FileName + ": unknown extension; known are " + GetExtensions());
    }
    quadrille::writeThenRename(this->FileName,
      [this, mesh](const std::string& temporary) { this->WriteFile(mesh, temporary); });
    this->UpdateProgress(1);
    return;
  }
  catch (const quadrille::Cancelled&)
  {
    this->Outcome = Stopped;
    this->OutcomeText = this->FileName + ": not written, as it was stopped";
  }
  catch (const quadrille::WriteError& error)
  {
    this->Outcome = CannotWrite;
    this->OutcomeText = error.what();
  }
  catch (const std::bad_alloc&)
  {
    this->Outcome = CannotWrite;
    this->OutcomeText = this->FileName + ": there is not enough memory to write it";
  }
  catch (const std::exception& error)
  {
    this->Outcome = BadInput;
    this->OutcomeText = this->FileName.empty() || !CanWriteFile(this->FileName.c_str())
      ? error.what()
      : this->FileName + ": " + error.what();
  }
  this->SetErrorCode(
    this->Outcome == CannotWrite ? vtkErrorCode::CannotOpenFileError : vtkErrorCode::UserError);
  vtkErrorMacro(<< this->OutcomeText);
}

//------------------------------------------------------------------------------
void vtkQuadMeshWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n";
  os << indent << "PatchArrayName: " << this->PatchArrayName << "\n";
  os << indent << "ElementType: " << this->ElementType << "\n";
  os << indent << "Dialect: " << this->Dialect << "\n";
  os << indent << "Material: " << this->Material << "\n";
  os << indent << "MshVersion: " << this->MshVersion << "\n";
  os << indent << "FileDetails: " << this->FileDetails << "\n";
  os << indent << "Outcome: " << this->Outcome << "\n";
  os << indent << "OutcomeText: " << this->OutcomeText << "\n";
  os << indent << "NoticesText: " << this->NoticesText << "\n";
}

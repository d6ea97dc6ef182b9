// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleCADReader.h"

#include "Base/Error.h"
#include "Cad/CadFormat.h"
#include "Cad/Calls.h"
#include "Files/CadData.h"

#include "vtkCompositeDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <sstream>

vtkStandardNewMacro(vtkQuadrilleCADReader);

struct vtkQuadrilleCADReader::Parts
{
  quadrille::CadFile file;
  quadrille::CadReadOptions options;
  std::string stamp;
  vtkMTimeType failedAt = 0; ///< of the reader, which reads again when it is modified
};

//------------------------------------------------------------------------------
vtkQuadrilleCADReader::vtkQuadrilleCADReader() : Found(std::make_unique<Parts>())
{
  this->SetNumberOfInputPorts(0);
  this->SetNumberOfOutputPorts(2);
}

vtkQuadrilleCADReader::~vtkQuadrilleCADReader() = default;

//------------------------------------------------------------------------------
int vtkQuadrilleCADReader::CanReadFile(const char* name)
{
  return name && quadrille::cadFormatOf(name) ? 1 : 0;
}

//------------------------------------------------------------------------------
void vtkQuadrilleCADReader::SetFileName(const char* name)
{
  const std::string value = name ? name : "";
  if (value != this->FileName)
  {
    this->FileName = value;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
vtkPolyData* vtkQuadrilleCADReader::GetEdges()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(1));
}

//------------------------------------------------------------------------------
int vtkQuadrilleCADReader::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkDataObject" : "vtkPolyData");
  return 1;
}

//------------------------------------------------------------------------------
/// Of all that the result depends on.
std::string vtkQuadrilleCADReader::StampOfFile() const
{
  std::error_code code;
  std::ostringstream stamp;
  stamp.precision(17);
  stamp << this->FileName << ' ' << std::filesystem::file_size(this->FileName, code) << ' '
        << std::filesystem::last_write_time(this->FileName, code).time_since_epoch().count() << ' '
        << this->ChordError << ' ' << this->SharpAngle << ' ' << this->JoinParts << ' '
        << this->TimeLimit;
  return stamp.str();
}

//------------------------------------------------------------------------------
void vtkQuadrilleCADReader::Read()
{
  const std::string stamp = this->StampOfFile();
  const bool isTried = this->Found->stamp == stamp &&
    (this->OutcomeText.empty() || this->Found->failedAt == this->GetMTime());
  if (isTried)
  {
    return;
  }
  *this->Found = Parts();
  this->Found->stamp = stamp;
  this->NoticesText.clear();
  this->OutcomeText.clear();
  quadrille::CadReadOptions& options = this->Found->options;
  options.timeLimit = this->TimeLimit;
  options.joined = this->JoinParts != 0;
  options.tessellation.chordError = this->ChordError;
  options.tessellation.sharpAngle = vtkMath::RadiansFromDegrees(this->SharpAngle);
  try
  {
    if (this->FileName.empty())
    {
      throw quadrille::InvalidInput("no file is named: set FileName");
    }
    this->Found->file = quadrille::cadCalls().readCadFile(this->FileName, options);
  }
  catch (const std::bad_alloc&)
  {
    this->OutcomeText = this->FileName + ": there is not enough memory for it";
  }
  catch (const std::exception& error)
  {
    this->OutcomeText = error.what();
  }
  this->Found->failedAt = this->OutcomeText.empty() ? 0 : this->GetMTime();
  for (const std::string& notice : this->Found->file.notices)
  {
    this->NoticesText += notice + "\n";
  }
}

//------------------------------------------------------------------------------
int vtkQuadrilleCADReader::RequestDataObject(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  this->Read();
  const bool isOne = this->Found->file.parts.size() < 2;
  vtkInformation* info = outputs->GetInformationObject(0);
  vtkDataObject* output = info->Get(vtkDataObject::DATA_OBJECT());
  if (!output || !output->IsA(isOne ? "vtkPolyData" : "vtkMultiBlockDataSet"))
  {
    vtkSmartPointer<vtkDataObject> fresh;
    if (isOne)
    {
      fresh = vtkSmartPointer<vtkPolyData>::New();
    }
    else
    {
      fresh = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    }
    info->Set(vtkDataObject::DATA_OBJECT(), fresh);
  }
  vtkInformation* ofEdges = outputs->GetInformationObject(1);
  if (!vtkPolyData::SafeDownCast(ofEdges->Get(vtkDataObject::DATA_OBJECT())))
  {
    ofEdges->Set(vtkDataObject::DATA_OBJECT(), vtkNew<vtkPolyData>());
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkQuadrilleCADReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  this->Read();
  if (!this->OutcomeText.empty())
  {
    vtkErrorMacro(<< this->OutcomeText);
    return 0;
  }
  const quadrille::CadFile& file = this->Found->file;
  const auto follow = static_cast<quadrille::CadFollow>(this->Follow);
  const auto polyDataOf = [&](const quadrille::CadPart& part)
  { return quadrille::cadPolyData(part, file.unit, this->Found->options.tessellation, follow); };
  if (auto* blocks = vtkMultiBlockDataSet::GetData(outputs, 0))
  {
    blocks->SetNumberOfBlocks(static_cast<unsigned>(file.parts.size()));
    for (unsigned i = 0; i < file.parts.size(); ++i)
    {
      blocks->SetBlock(i, polyDataOf(file.parts[i]));
      blocks->GetMetaData(i)->Set(vtkCompositeDataSet::NAME(), file.parts[i].name.c_str());
    }
  }
  else
  {
    vtkPolyData::GetData(outputs, 0)->ShallowCopy(polyDataOf(file.parts.front()));
  }
  vtkPolyData::GetData(outputs, 1)->ShallowCopy(quadrille::cadEdges(file.parts));
  if (!this->NoticesText.empty())
  {
    std::string text = this->NoticesText;
    text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ';');
    vtkWarningMacro(<< text);
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkQuadrilleCADReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n";
  os << indent << "ChordError: " << this->ChordError << "\n";
  os << indent << "SharpAngle: " << this->SharpAngle << "\n";
  os << indent << "Follow: " << this->Follow << "\n";
  os << indent << "JoinParts: " << this->JoinParts << "\n";
  os << indent << "TimeLimit: " << this->TimeLimit << "\n";
  os << indent << "OutcomeText: " << this->OutcomeText << "\n";
  os << indent << "NoticesText: " << this->NoticesText << "\n";
}

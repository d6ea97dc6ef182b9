// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrillePLYReader.h"

#include "Base/Error.h"
#include "QuadrillePly.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <exception>
#include <fstream>
#include <new>

vtkStandardNewMacro(vtkQuadrillePLYReader);

//------------------------------------------------------------------------------
vtkQuadrillePLYReader::vtkQuadrillePLYReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkQuadrillePLYReader::~vtkQuadrillePLYReader() = default;

//------------------------------------------------------------------------------
void vtkQuadrillePLYReader::SetFileName(const char* name)
{
  const std::string value = name ? name : "";
  if (value != this->FileName)
  {
    this->FileName = value;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkQuadrillePLYReader::CanReadFile(const char* name)
{
  std::ifstream file(name ? name : "", std::ios::binary);
  char magic[4] = {};
  file.read(magic, 4);
  return file.gcount() == 4 && std::string(magic, 3) == "ply" &&
    (magic[3] == '\n' || magic[3] == '\r');
}

//------------------------------------------------------------------------------
int vtkQuadrillePLYReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  this->OutcomeText.clear();
  try
  {
    if (this->FileName.empty())
    {
      throw quadrille::InvalidInput("no file is named: set FileName");
    }
    vtkPolyData::GetData(outputs, 0)->ShallowCopy(quadrille::readPly(this->FileName));
    return 1;
  }
  catch (const std::bad_alloc&)
  {
    this->OutcomeText = this->FileName + ": there is not enough memory for it";
  }
  catch (const std::exception& error)
  {
    this->OutcomeText = error.what();
  }
  vtkErrorMacro(<< this->OutcomeText);
  return 0;
}

//------------------------------------------------------------------------------
void vtkQuadrillePLYReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n";
  os << indent << "OutcomeText: " << this->OutcomeText << "\n";
}

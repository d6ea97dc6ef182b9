// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleFileReader.h"

#include "Base/Error.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPolyData.h"

#include <exception>
#include <new>

//------------------------------------------------------------------------------
vtkQuadrilleFileReader::vtkQuadrilleFileReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkQuadrilleFileReader::~vtkQuadrilleFileReader() = default;

//------------------------------------------------------------------------------
void vtkQuadrilleFileReader::SetFileName(const char* name)
{
  const std::string value = name ? name : "";
  if (value != this->FileName)
  {
    this->FileName = value;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkQuadrilleFileReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  this->OutcomeText.clear();
  try
  {
    if (this->FileName.empty())
    {
      throw quadrille::InvalidInput("no file is named: set FileName");
    }
    vtkPolyData::GetData(outputs, 0)->ShallowCopy(this->ReadSurface(this->FileName));
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
void vtkQuadrilleFileReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n";
  os << indent << "OutcomeText: " << this->OutcomeText << "\n";
}

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrillePLYReader.h"

#include "Files/SurfaceFile.h"

#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <fstream>

vtkStandardNewMacro(vtkQuadrillePLYReader);

//------------------------------------------------------------------------------
vtkQuadrillePLYReader::vtkQuadrillePLYReader() = default;
vtkQuadrillePLYReader::~vtkQuadrillePLYReader() = default;

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
vtkSmartPointer<vtkPolyData> vtkQuadrillePLYReader::ReadSurface(const std::string& path)
{
  return quadrille::polyDataOf(quadrille::readPly(path, this->NumberOfThreads));
}

//------------------------------------------------------------------------------
void vtkQuadrillePLYReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

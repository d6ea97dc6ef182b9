// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleSTLReader.h"

#include "Files/SurfaceFile.h"

#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkQuadrilleSTLReader);

//------------------------------------------------------------------------------
vtkQuadrilleSTLReader::vtkQuadrilleSTLReader() = default;
vtkQuadrilleSTLReader::~vtkQuadrilleSTLReader() = default;

//------------------------------------------------------------------------------
int vtkQuadrilleSTLReader::CanReadFile(const char* name)
{
  return quadrille::isBinaryStl(name ? name : "") ? 1 : 0;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> vtkQuadrilleSTLReader::ReadSurface(const std::string& path)
{
  return quadrille::polyDataOf(quadrille::readBinaryStl(path, this->NumberOfThreads));
}

//------------------------------------------------------------------------------
void vtkQuadrilleSTLReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleOFFReader.h"

#include "Files/SurfaceFile.h"

#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <fstream>

vtkStandardNewMacro(vtkQuadrilleOFFReader);

//------------------------------------------------------------------------------
vtkQuadrilleOFFReader::vtkQuadrilleOFFReader() = default;
vtkQuadrilleOFFReader::~vtkQuadrilleOFFReader() = default;

//------------------------------------------------------------------------------
int vtkQuadrilleOFFReader::CanReadFile(const char* name)
{
  std::ifstream file(name ? name : "", std::ios::binary);
  std::string word;
  while (file >> word && word.front() == '#')
  {
    std::getline(file, word);
  }
  return file && word.size() >= 3 && word.size() <= 7 &&
    word.compare(word.size() - 3, 3, "OFF") == 0;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkPolyData> vtkQuadrilleOFFReader::ReadSurface(const std::string& path)
{
  return quadrille::polyDataOf(quadrille::readOff(path));
}

//------------------------------------------------------------------------------
void vtkQuadrilleOFFReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

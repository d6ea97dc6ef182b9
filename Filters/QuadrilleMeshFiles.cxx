// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleMeshFiles.h"

#include "Export/OutputFile.h"
#include "QuadrilleVtkErrors.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace quadrille
{

namespace
{

/// Into memory first: where a disk is full, the writers of XML files may end the process, or tell nothing.
void runXmlWriter(vtkXMLWriter* writer, const std::string& path)
{
  // Appended, the default, cannot be read back with the libexpat of an updated Debian 12.
  writer->SetDataModeToBinary();
  writer->WriteToOutputStringOn();
  const ErrorCollector errors(writer);
  const ErrorCollector executiveErrors(writer->GetExecutive()); // repeats the others at length
  if (!writer->Write() || !errors.text().empty())
  {
    throw WriteError(path + ": cannot be written: " + errors.sentence());
  }
  OutputFile file(path);
  file << writer->GetOutputString();
  file.close();
}

/// Bytes of a binary PLY file of this mesh by its own header; 0 where that is not whole.
std::uintmax_t plyBytes(vtkPolyData* mesh, const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  std::uintmax_t bytes = 0, elements = 0;
  bool isFace = false;
  for (std::string line; std::getline(file, line);)
  {
    std::istringstream words(line);
    std::string first, second;
    words >> first >> second;
    if (first == "end_header")
    {
      return bytes + static_cast<std::uintmax_t>(file.tellg());
    }
    if (first == "element")
    {
      isFace = second == "face";
      words >> elements;
    }
    else if (first == "property" && second == "list")
    {
      bytes += isFace ? elements +
          sizeof(std::int32_t) *
            static_cast<std::uintmax_t>(mesh->GetPolys()->GetNumberOfConnectivityIds())
                      : 0;
    }
    else if (first == "property")
    {
      bytes += elements * (second == "uchar" ? 1 : second == "double" ? 8 : 4);
    }
  }
  return 0;
}

} // namespace

void writeVtp(vtkPolyData* mesh, const std::string& path)
{
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(mesh);
  runXmlWriter(writer, path);
}

void writeVtu(vtkDataSet* mesh, const std::string& path)
{
  vtkSmartPointer<vtkDataSet> grid = mesh;
  if (auto* surface = vtkPolyData::SafeDownCast(mesh))
  {
    auto quads = vtkSmartPointer<vtkUnstructuredGrid>::New();
    quads->SetPoints(surface->GetPoints());
    vtkCellArray* const polygons = surface->GetPolys();
    std::vector<int> types;
    for (vtkIdType i = 0; i < polygons->GetNumberOfCells(); ++i)
    {
      const vtkIdType corners = polygons->GetCellSize(i);
      types.push_back(corners == 4 ? VTK_QUAD : corners == 3 ? VTK_TRIANGLE : VTK_POLYGON);
    }
    quads->SetCells(types.data(), polygons);
    quads->GetPointData()->ShallowCopy(mesh->GetPointData());
    quads->GetCellData()->ShallowCopy(mesh->GetCellData());
    quads->GetFieldData()->ShallowCopy(mesh->GetFieldData());
    grid = quads;
  }
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  runXmlWriter(writer, path);
}

void writePlainPly(vtkPolyData* mesh, const std::string& path)
{
  vtkNew<vtkPLYWriter> writer;
  writer->SetInputData(mesh);
  writer->SetFileTypeToBinary();
  writer->SetFileName(path.c_str());
  const ErrorCollector errors(writer);
  if (!writer->Write() || !errors.text().empty())
  {
    throw WriteError(path + ": cannot be written: " + errors.sentence());
  }
  // The writer does not look whether its bytes have arrived.
  if (std::filesystem::file_size(path) != plyBytes(mesh, path))
  {
    throw WriteError(path + ": cannot be written as a whole: is the disk full?");
  }
}

} // namespace quadrille

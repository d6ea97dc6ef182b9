// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleMeshFiles.h"

#include "Export/OutputFile.h"
#include "QuadrilleVtkErrors.h"

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
    quads->SetCells(VTK_QUAD, surface->GetPolys());
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
  writer->WriteToOutputStringOn();
  const ErrorCollector errors(writer);
  if (!writer->Write() || !errors.text().empty())
  {
    throw WriteError(path + ": cannot be written: " + errors.sentence());
  }
  OutputFile file(path);
  file << writer->GetOutputString();
  file.close();
}

} // namespace quadrille

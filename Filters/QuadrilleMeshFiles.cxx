// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleMeshFiles.h"

#include "Export/OutputFile.h"
#include "QuadrilleVtkErrors.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
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

template <class Writer>
void runWriter(Writer* writer, const std::string& path)
{
  const ErrorCollector errors(writer);
  writer->SetFileName(path.c_str());
  const int written = writer->Write();
  if (!errors.text().empty() || !written)
  {
    throw WriteError(path + ": cannot be written: " + errors.sentence());
  }
}

} // namespace

void writeVtp(vtkPolyData* mesh, const std::string& path)
{
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(mesh);
  // Appended, the default, cannot be read back with the libexpat of an updated Debian 12.
  writer->SetDataModeToBinary();
  runWriter(writer.Get(), path);
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
  writer->SetDataModeToBinary();
  runWriter(writer.Get(), path);
}

void writePlainPly(vtkPolyData* mesh, const std::string& path)
{
  vtkNew<vtkPLYWriter> writer;
  writer->SetInputData(mesh);
  writer->SetFileTypeToBinary();
  runWriter(writer.Get(), path);
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/MeshFiles.h"

#include "Common/VtkErrors.h"
#include "ElementGrids/Elements.h"
#include "Export/OutputFile.h"

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
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

/// What programs without VTK read: numbers with a name. meshio ends at texts, bits and field data without values; VTK
/// names an array without a name by its address.
bool isReadByAll(vtkAbstractArray* array)
{
  const char* name = array->GetName();
  return vtkDataArray::SafeDownCast(array) && array->GetDataType() != VTK_BIT && name &&
    *name != '\0' && array->GetNumberOfValues() > 0;
}

/// Returns the names of the arrays that it removes.
std::vector<std::string> keepWhatAllRead(vtkFieldData* arrays)
{
  std::vector<std::string> removed;
  for (int i = arrays->GetNumberOfArrays() - 1; i >= 0; --i)
  {
    vtkAbstractArray* array = arrays->GetAbstractArray(i);
    if (!isReadByAll(array))
    {
      removed.insert(removed.begin(), array->GetName() ? array->GetName() : "");
      arrays->RemoveArray(i);
    }
  }
  return removed;
}

vtkSmartPointer<vtkUnstructuredGrid> gridOf(vtkDataSet* mesh)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  if (auto* surface = vtkPolyData::SafeDownCast(mesh))
  {
    grid->SetPoints(surface->GetPoints());
    vtkCellArray* const polygons = surface->GetPolys();
    std::vector<int> types;
    for (vtkIdType i = 0; i < polygons->GetNumberOfCells(); ++i)
    {
      const vtkIdType corners = polygons->GetCellSize(i);
      types.push_back(corners == 4 ? VTK_QUAD : corners == 3 ? VTK_TRIANGLE : VTK_POLYGON);
    }
    grid->SetCells(types.data(), polygons);
    grid->GetPointData()->ShallowCopy(mesh->GetPointData());
    grid->GetCellData()->ShallowCopy(mesh->GetCellData());
  }
  else
  {
    grid->ShallowCopy(mesh);
  }
  vtkNew<vtkFieldData> fields; // of its own, whatever a shallow copy shares
  fields->ShallowCopy(mesh->GetFieldData());
  grid->SetFieldData(fields);
  return grid;
}

} // namespace

void writeVtp(vtkPolyData* mesh, const std::string& path)
{
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(mesh);
  runXmlWriter(writer, path);
}

std::vector<std::string> writeVtu(vtkDataSet* mesh, bool withDetails, const std::string& path)
{
  const auto grid = gridOf(mesh);
  std::vector<std::string> leftOut;
  if (!withDetails)
  {
    const std::vector<std::string> ofFields = keepWhatAllRead(grid->GetFieldData());
    for (vtkFieldData* arrays : { static_cast<vtkFieldData*>(grid->GetPointData()),
           static_cast<vtkFieldData*>(grid->GetCellData()) })
    {
      const std::vector<std::string> names = keepWhatAllRead(arrays);
      leftOut.insert(leftOut.end(), names.begin(), names.end());
    }
    // Other texts of field data are those of the run, which its report has.
    if (std::count(ofFields.begin(), ofFields.end(), arrays::kPatchNames) > 0)
    {
      leftOut.emplace_back(arrays::kPatchNames);
    }
  }
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  runXmlWriter(writer, path);
  if (leftOut.empty())
  {
    return {};
  }
  return { "arrays that many readers of vtu stop at are left out: " + quoted(leftOut) +
    "; to have them, ask for the details of the file, or write vtp" };
}

std::string quoted(const std::vector<std::string>& names)
{
  std::string list;
  for (const std::string& name : names)
  {
    list += (list.empty() ? "'" : ", '") + name + "'";
  }
  return list;
}

} // namespace quadrille

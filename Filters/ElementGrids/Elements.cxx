// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ElementGrids/Elements.h"

#include "Base/LargeArray.h"
#include "Base/Refuse.h"
#include "Convert/ArrayNames.h"
#include "Convert/PolyData.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <map>
#include <optional>

namespace quadrille
{

namespace
{

vtkCellArray* elementCells(vtkDataSet* data)
{
  if (auto* surface = vtkPolyData::SafeDownCast(data))
  {
    if (surface->GetNumberOfVerts() + surface->GetNumberOfLines() + surface->GetNumberOfStrips() >
      0)
    {
      refuse("the mesh has vertices, lines or strips beside its quads: take the quads alone "
             "(Extract Cells By Type)");
    }
    return surface->GetPolys();
  }
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    return grid->GetCells();
  }
  refuse("a mesh for simulation is a vtkPolyData or a vtkUnstructuredGrid, not a ",
    data ? data->GetClassName() : "nothing");
}

int nodesOfType(int type)
{
  switch (type)
  {
    case VTK_QUAD:
    case VTK_POLYGON: // of polygons, with four corners
      return 4;
    case VTK_QUADRATIC_QUAD:
      return 8;
    case VTK_BIQUADRATIC_QUAD:
      return 9;
    default:
      return 0;
  }
}

void readElementCells(vtkDataSet* data, ElementMesh& mesh)
{
  auto cells = vtk::TakeSmartPointer(elementCells(data)->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    const vtkIdType cell = cells->GetCurrentCellId();
    pollNowAndThen(static_cast<std::size_t>(cell));
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    const int nodes = nodesOfType(data->GetCellType(cell));
    if (nodes == 0 || nodes != count)
    {
      refuse("cell ", cell, " is no quad of 4, 8 or 9 points (it has ", count,
        "): only quads are written here");
    }
    if (cell == 0)
    {
      mesh.nodesPerElement = nodes;
      mesh.elements.reserve(
        static_cast<std::size_t>(nodes) * static_cast<std::size_t>(data->GetNumberOfCells()));
    }
    if (nodes != mesh.nodesPerElement)
    {
      refuse("cell ", cell, " has ", nodes, " points, but cell 0 has ", mesh.nodesPerElement,
        ": elements are of one kind");
    }
    for (vtkIdType i = 0; i < count; ++i)
    {
      mesh.elements.push_back(static_cast<Index>(ids[i]));
    }
  }
}

void readElementNodes(vtkDataSet* data, ElementMesh& mesh)
{
  growLarge(mesh.nodes, static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    pollNowAndThen(i);
    data->GetPoint(static_cast<vtkIdType>(i), mesh.nodes[i].data());
  }
}

/// Null where it is not there.
vtkDataArray* elementArray(vtkDataSet* data, const char* name, int components)
{
  vtkAbstractArray* any = data->GetCellData()->GetAbstractArray(name);
  auto* array = vtkDataArray::SafeDownCast(any);
  if (any && (!array || array->GetNumberOfComponents() != components))
  {
    refuse("array '", name, "' of the cells must have ", components,
      components == 1 ? " number" : " numbers", " a cell: make it anew, or rename it");
  }
  return array;
}

void readElementArrays(vtkDataSet* data, ElementMesh& mesh)
{
  const std::size_t count = mesh.elementCount();
  if (vtkDataArray* features = elementArray(data, arrays::kFeatureEdges, 1))
  {
    mesh.featureEdges.resize(count);
    for (std::size_t e = 0; e < count; ++e)
    {
      mesh.featureEdges[e] =
        static_cast<std::uint8_t>(features->GetComponent(static_cast<vtkIdType>(e), 0));
    }
  }
  if (vtkDataArray* thickness = elementArray(data, arrays::kThickness, 1))
  {
    mesh.thickness.resize(count);
    for (std::size_t e = 0; e < count; ++e)
    {
      mesh.thickness[e] = thickness->GetComponent(static_cast<vtkIdType>(e), 0);
    }
  }
  if (vtkDataArray* axes = elementArray(data, arrays::kElementAxis, 3))
  {
    mesh.axis.resize(count);
    for (std::size_t e = 0; e < count; ++e)
    {
      axes->GetTuple(static_cast<vtkIdType>(e), mesh.axis[e].data());
    }
  }
}

//------------------------------------------------------------------------------
// Patches

/// Patches in the order of their first elements.
class PatchReader
{
public:
  explicit PatchReader(ElementMesh& mesh) : mesh_(mesh)
  {
    growLarge(mesh.patchOf, mesh.elementCount(), Index{ 0 });
  }

  void readNumbers(vtkDataArray* array)
  {
    requireWhole(array, "cell");
    std::map<std::int64_t, Index> patches;
    for (std::size_t e = 0; e < mesh_.patchOf.size(); ++e)
    {
      pollNowAndThen(e);
      const auto number =
        static_cast<std::int64_t>(array->GetVariantValue(static_cast<vtkIdType>(e)).ToLongLong());
      const auto found = patches.emplace(number, static_cast<Index>(mesh_.patches.size()));
      if (found.second)
      {
        mesh_.patches.push_back({ number, {} });
      }
      mesh_.patchOf[e] = found.first->second;
    }
  }

  /// The strings themselves are the patches, numbered from 1.
  void readStrings(vtkStringArray* array)
  {
    std::map<std::string, Index> patches;
    for (std::size_t e = 0; e < mesh_.patchOf.size(); ++e)
    {
      pollNowAndThen(e);
      const std::string name = array->GetValue(static_cast<vtkIdType>(e));
      const auto found = patches.emplace(name, static_cast<Index>(mesh_.patches.size()));
      if (found.second)
      {
        mesh_.patches.push_back({ static_cast<std::int64_t>(mesh_.patches.size()) + 1, name });
      }
      mesh_.patchOf[e] = found.first->second;
    }
  }

  /// Each patch is named as most of its elements are.
  void nameByElements(vtkStringArray* array, std::vector<std::string>& notices)
  {
    std::vector<std::map<std::string, Index>> counts(mesh_.patches.size());
    for (std::size_t e = 0; e < mesh_.patchOf.size(); ++e)
    {
      pollNowAndThen(e);
      ++counts[mesh_.patchOf[e]][array->GetValue(static_cast<vtkIdType>(e))];
    }
    std::size_t mixed = 0;
    for (std::size_t p = 0; p < counts.size(); ++p)
    {
      mesh_.patches[p].name = std::max_element(counts[p].begin(), counts[p].end(),
        [](const auto& a, const auto& b) {
          return a.second < b.second;
        })->first;
      mixed += counts[p].size() > 1 ? 1 : 0;
    }
    if (mixed > 0)
    {
      notices.push_back(std::to_string(mixed) + (mixed == 1 ? " patch has" : " patches have") +
        " elements of more than one name in the cell array '" + array->GetName() +
        "': the one of most of them is taken");
    }
  }

  void nameByNumbers(vtkFieldData* fields)
  {
    auto* names = vtkStringArray::SafeDownCast(fields->GetAbstractArray(arrays::kPatchNames));
    if (!names || mesh_.patches.empty())
    {
      return;
    }
    vtkDataArray* numbers = fields->GetArray(arrays::kPatchNumbers);
    if (numbers && numbers->GetNumberOfTuples() != names->GetNumberOfValues())
    {
      refuse("the field data have ", names->GetNumberOfValues(), " ", arrays::kPatchNames, " and ",
        numbers->GetNumberOfTuples(), " ", arrays::kPatchNumbers, ": give as many");
    }
    std::map<std::int64_t, std::string> nameOf;
    const std::int64_t first = numbers ? 0 : firstNumber(names->GetNumberOfValues());
    for (vtkIdType i = 0; i < names->GetNumberOfValues(); ++i)
    {
      nameOf[numbers ? numbers->GetVariantValue(i).ToLongLong() : first + i] = names->GetValue(i);
    }
    for (MeshPatch& patch : mesh_.patches)
    {
      const auto found = nameOf.find(patch.number);
      patch.name = found == nameOf.end() ? "" : found->second;
    }
  }

private:
  /// Numbers from 1 where they fill 1 to the number of names, else from 0.
  std::int64_t firstNumber(std::int64_t names) const
  {
    const auto range = std::minmax_element(mesh_.patches.begin(), mesh_.patches.end(),
      [](const MeshPatch& a, const MeshPatch& b) { return a.number < b.number; });
    return range.first->number >= 1 && range.second->number == names ? 1 : 0;
  }

  ElementMesh& mesh_;
};

void readPatches(vtkDataSet* data, const PatchSource& patches, ElementMesh& mesh,
  std::vector<std::string>& notices)
{
  if (!patches.array)
  {
    mesh.patches.push_back({ 1, {} });
    if (patches.leftOut > 0)
    {
      notices.push_back("all elements are one set, as the layout has " +
        std::to_string(patches.leftOut) + " patches; to have these as sets, ask for the array " +
        arrays::kLayoutPatch);
    }
    return;
  }
  PatchReader reader(mesh);
  if (auto* strings = vtkStringArray::SafeDownCast(patches.array))
  {
    reader.readStrings(strings);
    return;
  }
  reader.readNumbers(vtkDataArray::SafeDownCast(patches.array));
  auto* names =
    vtkStringArray::SafeDownCast(data->GetCellData()->GetAbstractArray(arrays::kPatchNames));
  if (patches.isAsked && names)
  {
    reader.nameByElements(names, notices);
  }
  else if (patches.isAsked)
  {
    reader.nameByNumbers(data->GetFieldData());
  }
}

/// Numbers from 0 on; -1 is no patch.
int layoutPatches(vtkAbstractArray* array)
{
  auto* numbers = vtkDataArray::SafeDownCast(array);
  return numbers && numbers->GetNumberOfTuples() > 0 ? static_cast<int>(numbers->GetRange()[1]) + 1
                                                     : 0;
}

} // namespace

PatchSource patchSource(vtkDataSet* data, const std::string& name)
{
  vtkCellData* cells = data->GetCellData();
  if (!name.empty())
  {
    vtkAbstractArray* array = cells->GetAbstractArray(name.c_str());
    if (!array)
    {
      refuse("the mesh has no cell array '", name, "' to make sets of");
    }
    if (array->GetNumberOfComponents() != 1)
    {
      refuse("the cell array '", name, "' has ", array->GetNumberOfComponents(),
        " values a cell, but the number of a patch, or its name, is one");
    }
    return { array, name != arrays::kLayoutPatch, 0 };
  }
  for (const char* known : { arrays::kPatchId, arrays::kPatchNames, arrays::kLayoutPatch })
  {
    vtkAbstractArray* array = cells->GetAbstractArray(known);
    const bool isString = vtkStringArray::SafeDownCast(array) != nullptr;
    if (array && array->GetNumberOfComponents() == 1 && isString == (known == arrays::kPatchNames))
    {
      const int layout = known == arrays::kLayoutPatch ? layoutPatches(array) : 0;
      return layout > kMostLayoutPatches ? PatchSource{ nullptr, false, layout }
                                         : PatchSource{ array, known != arrays::kLayoutPatch, 0 };
    }
  }
  return {};
}

ElementMesh readElements(
  vtkDataSet* data, const PatchSource& patches, std::vector<std::string>& notices)
{
  ElementMesh mesh;
  readElementNodes(data, mesh);
  readElementCells(data, mesh);
  readElementArrays(data, mesh);
  readPatches(data, patches, mesh, notices);
  return mesh;
}

} // namespace quadrille

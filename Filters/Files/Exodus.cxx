// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/MeshFiles.h"

#include "Base/Lists.h"
#include "Base/Refuse.h"
#include "Common/NewArray.h"
#include "Common/VtkErrors.h"
#include "Export/OutputFile.h"
#include "Export/SetNames.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkExodusIIWriter.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkModelMetadata.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <limits>
#include <map>

namespace quadrille
{

namespace
{

constexpr const char* kBlockIds = "ElementBlockIds"; // which vtkExodusIIWriter looks for

/// A set of nodes, or of sides of elements; both count from 1.
struct ExodusSet
{
  std::string name;
  std::vector<int> members;
  std::vector<int> sides; ///< of side sets, per member
};

int* copyOf(const std::vector<int>& values)
{
  int* copy = new int[values.size() + 1]; // vtkModelMetadata deletes it
  std::copy(values.begin(), values.end(), copy);
  return copy;
}

/// vtkExodusIIWriter makes its metadata anew for each file, with sets from a multiblock only, for which it searches all
/// elements at each side, and with one name for all blocks of a grid. So names and sets are put in where it has them
/// made and calls a virtual function.
class ExodusWriter : public vtkExodusIIWriter
{
public:
  static ExodusWriter* New();
  vtkTypeMacro(ExodusWriter, vtkExodusIIWriter);

  std::map<int, std::string> blockNames; ///< by id
  std::vector<ExodusSet> nodeSets;
  std::vector<ExodusSet> sideSets;

protected:
  ExodusWriter() = default;

  void CheckBlockInfoMap() override
  {
    for (auto& [id, block] : this->BlockInfoMap)
    {
      block.Name = this->blockNames[id].c_str();
      // "quad" for 9 nodes, too, which the writer does not know by themselves.
      block.Type = block.Type == VTK_BIQUADRATIC_QUAD ? VTK_QUADRATIC_QUAD : block.Type;
    }
  }

  int CheckParameters() override
  {
    if (!this->Superclass::CheckParameters())
    {
      return 0;
    }
    vtkModelMetadata* metadata = this->GetModelMetadata();
    this->AddNodeSets(metadata);
    this->AddSideSets(metadata);
    return 1;
  }

private:
  ExodusWriter(const ExodusWriter&) = delete;
  void operator=(const ExodusWriter&) = delete;

  /// What both kinds of sets have, one after the other.
  struct Flat
  {
    std::vector<int> ids, sizes, members, sides;
    vtkNew<vtkStringArray> names; ///< by id
  };

  static void Flatten(const std::vector<ExodusSet>& sets, Flat& flat)
  {
    flat.names->SetNumberOfValues(static_cast<vtkIdType>(sets.size() + 1));
    for (std::size_t i = 0; i < sets.size(); ++i)
    {
      flat.ids.push_back(static_cast<int>(i + 1));
      flat.sizes.push_back(static_cast<int>(sets[i].members.size()));
      flat.members.insert(flat.members.end(), sets[i].members.begin(), sets[i].members.end());
      flat.sides.insert(flat.sides.end(), sets[i].sides.begin(), sets[i].sides.end());
      flat.names->SetValue(static_cast<vtkIdType>(i + 1), sets[i].name);
    }
  }

  void AddNodeSets(vtkModelMetadata* metadata) const
  {
    Flat flat;
    Flatten(this->nodeSets, flat);
    metadata->SetNumberOfNodeSets(static_cast<int>(this->nodeSets.size()));
    metadata->SetSumNodesPerNodeSet(static_cast<int>(flat.members.size()));
    metadata->SetNodeSetNames(flat.names);
    metadata->SetNodeSetIds(copyOf(flat.ids));
    metadata->SetNodeSetSize(copyOf(flat.sizes));
    metadata->SetNodeSetNumberOfDistributionFactors(copyOf(std::vector<int>(flat.ids.size(), 0)));
    metadata->SetNodeSetNodeIdList(copyOf(flat.members));
  }

  void AddSideSets(vtkModelMetadata* metadata) const
  {
    Flat flat;
    Flatten(this->sideSets, flat);
    metadata->SetNumberOfSideSets(static_cast<int>(this->sideSets.size()));
    metadata->SetSumSidesPerSideSet(static_cast<int>(flat.members.size()));
    metadata->SetSideSetNames(flat.names);
    metadata->SetSideSetIds(copyOf(flat.ids));
    metadata->SetSideSetSize(copyOf(flat.sizes));
    metadata->SetSideSetNumDFPerSide(copyOf(std::vector<int>(flat.members.size(), 0)));
    metadata->SetSideSetElementList(copyOf(flat.members));
    metadata->SetSideSetSideList(copyOf(flat.sides));
  }
};

vtkStandardNewMacro(ExodusWriter);

/// The writer takes the precision of the points from the first array of real numbers that it finds, and fails at arrays
/// that hold no numbers.
void toExodusArrays(vtkDataSetAttributes* attributes, std::vector<std::string>& leftOut)
{
  for (int i = attributes->GetNumberOfArrays() - 1; i >= 0; --i)
  {
    vtkAbstractArray* any = attributes->GetAbstractArray(i);
    vtkDataArray* array = vtkDataArray::SafeDownCast(any);
    if (!array || !array->GetName())
    {
      leftOut.emplace_back(any->GetName() ? any->GetName() : "without a name");
      attributes->RemoveArray(i);
    }
    else if (array->GetDataType() == VTK_FLOAT)
    {
      vtkNew<vtkDoubleArray> copy;
      copy->DeepCopy(array);
      copy->SetName(array->GetName());
      attributes->AddArray(copy); // in the place of the one of this name
    }
  }
}

/// It takes what begins like "displacement" for one, whatever the case, and leaves it out.
void removeDisplacements(vtkPointData* points, std::vector<std::string>& leftOut)
{
  for (int i = points->GetNumberOfArrays() - 1; i >= 0; --i)
  {
    std::string start = std::string(points->GetArrayName(i)).substr(0, 3);
    std::transform(start.begin(), start.end(), start.begin(),
      [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    if (start == "DIS")
    {
      leftOut.emplace_back(points->GetArrayName(i));
      points->RemoveArray(i);
    }
  }
}

vtkSmartPointer<vtkIdTypeArray> countedFromOne(const char* name, vtkIdType count)
{
  auto ids = newArray<vtkIdTypeArray>(name, 1, static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i)
  {
    ids->SetValue(i, i + 1);
  }
  return ids;
}

/// The numbers of the patches where they are fit for ids of blocks, else 1, 2, ...
std::vector<int> blockIdsOf(const MeshSets& sets)
{
  const bool areFit = std::all_of(sets.patches.begin(), sets.patches.end(),
    [](const ElementSet& set)
    { return set.number >= 1 && set.number <= std::numeric_limits<int>::max(); });
  std::vector<int> ids;
  for (std::size_t i = 0; i < sets.patches.size(); ++i)
  {
    ids.push_back(static_cast<int>(areFit ? sets.patches[i].number : std::int64_t(i + 1)));
  }
  return ids;
}

vtkSmartPointer<vtkUnstructuredGrid> exodusGrid(vtkDataSet* mesh, const MeshSets& sets,
  const std::vector<int>& blockIds, std::vector<std::string>& leftOut)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  if (auto* surface = vtkPolyData::SafeDownCast(mesh))
  {
    grid->SetPoints(surface->GetPoints());
    grid->SetCells(VTK_QUAD, surface->GetPolys());
    grid->GetPointData()->ShallowCopy(mesh->GetPointData());
    grid->GetCellData()->ShallowCopy(mesh->GetCellData());
  }
  else
  {
    grid->ShallowCopy(mesh);
  }
  grid->GetFieldData()->Initialize(); // text has no place in a file
  toExodusArrays(grid->GetPointData(), leftOut);
  toExodusArrays(grid->GetCellData(), leftOut);
  removeDisplacements(grid->GetPointData(), leftOut);
  auto blocks =
    newArray<vtkIntArray>(kBlockIds, 1, static_cast<std::size_t>(grid->GetNumberOfCells()));
  for (std::size_t i = 0; i < sets.patches.size(); ++i)
  {
    for (const Index e : sets.patches[i].elements)
    {
      blocks->SetValue(static_cast<vtkIdType>(e), blockIds[i]);
    }
  }
  grid->GetCellData()->AddArray(blocks);
  grid->GetPointData()->SetGlobalIds(countedFromOne("GlobalNodeId", grid->GetNumberOfPoints()));
  grid->GetCellData()->SetGlobalIds(countedFromOne("GlobalElementId", grid->GetNumberOfCells()));
  return grid;
}

ExodusSet nodeSet(const std::string& name, const std::vector<Index>& nodes)
{
  ExodusSet set{ name, {}, {} };
  for (const Index node : nodes)
  {
    set.members.push_back(static_cast<int>(node + 1));
  }
  return set;
}

ExodusSet sideSet(const std::string& name, const std::vector<ElementSide>& sides)
{
  ExodusSet set{ name, {}, {} };
  for (const ElementSide& side : sides)
  {
    set.members.push_back(static_cast<int>(side.element + 1));
    set.sides.push_back(static_cast<int>(side.side + 1));
  }
  return set;
}

/// Names of blocks come last, so that a patch cannot take one of the generated names.
void addSets(const ElementMesh& mesh, const MeshSets& sets, const std::vector<int>& blockIds,
  SetNames& names, ExodusWriter* writer)
{
  for (const auto* curves : { &sets.boundaries, &sets.curves })
  {
    const std::vector<std::string> curveNames = names.uniqueOf(*curves);
    for (std::size_t i = 0; i < curves->size(); ++i)
    {
      writer->nodeSets.push_back(nodeSet(curveNames[i], nodesOf(sets, (*curves)[i])));
      writer->sideSets.push_back(sideSet(curveNames[i], sidesOf(sets, (*curves)[i])));
    }
  }
  const std::vector<std::string> cornerNames = names.uniqueOf(sets.corners);
  for (std::size_t i = 0; i < cornerNames.size(); ++i)
  {
    writer->nodeSets.push_back(nodeSet(cornerNames[i], { sets.corners[i].node }));
  }
  const std::vector<std::string> blockNames = names.uniqueOf(sets.patches);
  for (std::size_t i = 0; i < blockIds.size(); ++i)
  {
    writer->blockNames[blockIds[i]] = blockNames[i];
    if (sets.patches[i].isNamed)
    {
      writer->nodeSets.push_back(nodeSet(blockNames[i], nodesOf(mesh, sets.patches[i])));
    }
  }
}

} // namespace

std::vector<std::string> writeExodus(
  vtkDataSet* mesh, const ElementMesh& elements, const MeshSets& sets, const std::string& path)
{
  // The writer counts the nodes of all elements in an int.
  if (elements.elements.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) / 2)
  {
    refuse("vtkExodusIIWriter has room for about a billion nodes of elements, but there are ",
      elements.elements.size(), ": write msh or inp");
  }
  std::vector<std::string> leftOut;
  SetNames names(kExodusNames);
  const std::vector<int> blockIds = blockIdsOf(sets);
  vtkNew<ExodusWriter> writer;
  addSets(elements, sets, blockIds, names, writer);
  writer->SetInputData(exodusGrid(mesh, sets, blockIds, leftOut));
  writer->SetBlockIdArrayName(kBlockIds);
  writer->WriteOutBlockIdArrayOff();
  writer->SetStoreDoubles(1);
  writer->SetFileName(path.c_str());
  const ErrorCollector errors(writer);
  if (!writer->Write() || !errors.text().empty())
  {
    throw WriteError(
      path + ": cannot be written (is there room on the disk?): " + errors.sentence());
  }
  std::vector<std::string> notices;
  if (!leftOut.empty())
  {
    notices.push_back("arrays that an Exodus file cannot have are left out: " + quoted(leftOut));
  }
  append(notices, names.notices());
  return notices;
}

} // namespace quadrille

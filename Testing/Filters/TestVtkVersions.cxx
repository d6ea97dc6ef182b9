// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Both sides of what Filters/Common/VtkVersions.h guards, whichever VTK this is: stand-ins have the functions of the
/// other.
#include "Blocks/Blocks.h"
#include "Common/VtkVersions.h"

#include <vtkCellArray.h>
#include <vtkDataSet.h>
#include <vtkNew.h>
#include <vtkOverlappingAMR.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkShortArray.h>
#include <vtkUniformGrid.h>

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace quadrille
{
namespace
{

std::vector<long long> valuesOfIds(vtkDataArray* plain)
{
  return withIds(plain,
    [&](const auto* ids)
    {
      return std::vector<long long>(
        ids, ids + static_cast<std::size_t>(plain->GetNumberOfValues()));
    });
}

TEST(VtkVersions, IdsOfCellsAreNotCopiedWhereTheyLieInMemory)
{
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({ 0, 1, 2 });
  cells->InsertNextCell({ 2, 1, 3, 4 });
  for (int pass = 0; pass < 2; ++pass)
  {
    EXPECT_EQ(plainIds(cells->GetOffsetsArray()), cells->GetOffsetsArray());
    EXPECT_EQ(plainIds(cells->GetConnectivityArray()), cells->GetConnectivityArray());
    EXPECT_EQ(valuesOfIds(cells->GetOffsetsArray()), std::vector<long long>({ 0, 3, 7 }));
    EXPECT_EQ(
      valuesOfIds(cells->GetConnectivityArray()), std::vector<long long>({ 0, 1, 2, 2, 1, 3, 4 }));
    ASSERT_TRUE(cells->ConvertTo32BitStorage());
  }
}

/// What VTK 9.6 allows: another layout, another type.
TEST(VtkVersions, IdsOfAnyOtherArrayAreCopied)
{
  const std::vector<long long> wanted{ 0, 3, 6, 9 };
  vtkNew<vtkSOADataArrayTemplate<long long>> apart;
  vtkNew<vtkShortArray> narrow;
  apart->SetNumberOfComponents(1); // VTK 9.1 has no room for values before
  apart->SetNumberOfTuples(4);
  narrow->SetNumberOfTuples(4);
  for (vtkIdType i = 0; i < 4; ++i)
  {
    apart->SetValue(i, wanted[static_cast<std::size_t>(i)]);
    narrow->SetValue(i, static_cast<short>(wanted[static_cast<std::size_t>(i)]));
  }
  for (vtkDataArray* array :
    { static_cast<vtkDataArray*>(apart), static_cast<vtkDataArray*>(narrow) })
  {
    const vtkSmartPointer<vtkDataArray> plain = plainIds(array);
    EXPECT_NE(plain, array);
    EXPECT_EQ(valuesOfIds(plain), wanted);
  }
}

struct GridsOfLevel
{
  unsigned count;
  unsigned GetNumberOfPartitions() const { return count; }
  const unsigned* GetPartition(unsigned i) const { return i < count ? &count : nullptr; }
};

/// As vtkUniformGridAMR by VTK 9.6 on; the functions of before are there, but deprecated.
struct LevelsOfCollection
{
  std::array<GridsOfLevel, 2> levels{ { { 1 }, { 4 } } };
  const GridsOfLevel* GetPartitionedDataSet(unsigned level) const
  {
    return level < levels.size() ? &levels[level] : nullptr;
  }
  unsigned GetNumberOfDataSets(unsigned) const { return 99; }
  const unsigned* GetDataSet(unsigned, unsigned) const { return nullptr; }
};

TEST(VtkVersions, GridsOfALevelComeFromEitherKindOfAdaptiveMesh)
{
  LevelsOfCollection levels;
  EXPECT_EQ(gridCount(&levels, 1u), 4u);
  EXPECT_EQ(gridCount(&levels, 2u), 0u);
  EXPECT_EQ(gridOf(&levels, 1u, 3u), &levels.levels[1].count);

  vtkNew<vtkOverlappingAMR> mesh;
  const std::array<int, 2> blocks{ 1, 2 };
  mesh->Initialize(2, blocks.data());
  EXPECT_EQ(gridCount(mesh.Get(), 0u), 1u);
  EXPECT_EQ(gridCount(mesh.Get(), 1u), 2u);
  EXPECT_EQ(gridOf(mesh.Get(), 1u, 1u), nullptr);
}

/// Also where an adaptive mesh is a collection by its class.
TEST(VtkVersions, AnAdaptiveMeshHasABlockForEachLevel)
{
  vtkNew<vtkOverlappingAMR> mesh;
  const std::array<int, 2> blocks{ 1, 2 };
  mesh->Initialize(2, blocks.data());
  EXPECT_EQ(compositeTypeFor(mesh), "vtkMultiBlockDataSet");
  const BlockTree tree = blockTree(mesh);
  ASSERT_EQ(tree.size(), 6u); // the root, two levels, three grids
  EXPECT_EQ(tree.at({ 1 }).type, "vtkMultiBlockDataSet");
  EXPECT_EQ(blockName(tree, { 1, 1 }), "Level 1/Grid 1");
}

struct CellsWithCopy
{
  void GetCellAtId(vtkIdType, vtkIdList* ids) { ids->InsertNextId(5); }
};
struct CellsWithPointer
{
  vtkIdType corner = 7;
  void GetCellAtId(vtkIdType, vtkIdList*) {}
  void GetCellAtId(vtkIdType, vtkIdType& count, const vtkIdType*& ids, vtkIdList*)
  {
    count = 1;
    ids = &corner;
  }
};

template <class Cells>
vtkIdType onlyCorner()
{
  Cells cells;
  vtkNew<vtkIdList> copy;
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  getCorners(&cells, 0, count, ids, copy);
  return count == 1 ? ids[0] : -1;
}

TEST(VtkVersions, CornersComeFromEitherFunction)
{
  EXPECT_EQ(onlyCorner<CellsWithCopy>(), 5);
  EXPECT_EQ(onlyCorner<CellsWithPointer>(), 7);
}

/// VTK 9.1's.
struct PlainFilter
{
  int asked = 1;
  int GetAbortExecute() const { return asked; }
  void SetAbortExecute(int value) { asked = value; }
};
/// By VTK 9.2 on, where a filter below was asked.
struct FilterAskedBelow : PlainFilter
{
  bool below = true;
  bool CheckAbort() const { return asked != 0 || below; }
  void SetAbortOutput(bool value) { below = value; }
};

template <class Filter>
void expectStopIsForgotten(Filter filter)
{
  EXPECT_TRUE(isAskedToStop(&filter));
  forgetStop(&filter);
  EXPECT_FALSE(isAskedToStop(&filter));
}

TEST(VtkVersions, AStopIsSeenAndForgottenWithEitherSetOfFunctions)
{
  expectStopIsForgotten(PlainFilter());
  expectStopIsForgotten(FilterAskedBelow());
}

} // namespace
} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Composite data and data sets that are no surfaces, in a serial run.
#include "TestSurfaces.h"

#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkQuadRemesh.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace quadrille
{
namespace
{

/// A solid box of hexahedra, n cells along each side.
vtkSmartPointer<vtkImageData> solidBox(int n)
{
  auto box = vtkSmartPointer<vtkImageData>::New();
  box->SetDimensions(n + 1, n + 1, n + 1);
  return box;
}

void setBlock(vtkMultiBlockDataSet* data, unsigned index, vtkDataObject* block, const char* name)
{
  data->SetBlock(index, block);
  data->GetMetaData(index)->Set(vtkCompositeDataSet::NAME(), name);
}

vtkPolyData* blockOf(vtkQuadRemesh* filter, unsigned index, int port = 0)
{
  auto* data = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(port));
  return data ? vtkPolyData::SafeDownCast(data->GetBlock(index)) : nullptr;
}

bool contains(const char* text, const std::string& part)
{
  return std::string(text).find(part) != std::string::npos;
}

TEST(Blocks, VolumesGiveTheirSurface)
{
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(solidBox(10));
  filter->SetTargetTypeToNumberOfQuads();
  filter->SetNumberOfQuads(300);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  const test::QuadTally t = test::tally(filter->GetOutput());
  EXPECT_EQ(t.eulerCharacteristic, 2);
  EXPECT_EQ(t.boundaryEdges, 0u);
  EXPECT_TRUE(contains(filter->GetNoticesText(), "the surface of 1000 volume cells"))
    << filter->GetNoticesText();
  EXPECT_TRUE(filter->GetOutput()->GetCellData()->HasArray("vtkOriginalCellIds"));
}

/// Leaves of all kinds, one of them empty, one a table: what an Exodus file or a group has.
TEST(Blocks, EachBlockIsRemeshedByItself)
{
  vtkNew<vtkMultiBlockDataSet> input;
  setBlock(input, 0, test::toPolyData(test::torus(40, 20)), "Torus");
  setBlock(input, 1, nullptr, "Nothing");
  setBlock(input, 2, solidBox(8), "Box");
  vtkNew<vtkTable> table;
  setBlock(input, 3, table, "Table");
  vtkNew<vtkUnstructuredGrid> empty;
  setBlock(input, 4, empty, "Empty");
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(input);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  ASSERT_NE(blockOf(filter, 0), nullptr);
  ASSERT_NE(blockOf(filter, 2), nullptr);
  EXPECT_EQ(test::tally(blockOf(filter, 0)).eulerCharacteristic, 0);
  EXPECT_EQ(test::tally(blockOf(filter, 2)).eulerCharacteristic, 2);
  for (const unsigned i : { 1u, 3u, 4u })
  {
    EXPECT_EQ(blockOf(filter, i), nullptr);
  }
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_EQ(output->GetNumberOfBlocks(), 5u);
  EXPECT_STREQ(output->GetMetaData(2u)->Get(vtkCompositeDataSet::NAME()), "Box");
  EXPECT_EQ(filter->GetActualQuads(),
    blockOf(filter, 0)->GetNumberOfCells() + blockOf(filter, 2)->GetNumberOfCells());
  EXPECT_EQ(blockOf(filter, 2)->GetFieldData()->GetArray("ActualQuads")->GetTuple1(0),
    blockOf(filter, 2)->GetNumberOfCells());
  EXPECT_TRUE(contains(filter->GetNoticesText(), "Box: the surface of 512 volume cells"));
  EXPECT_TRUE(contains(filter->GetStageTimesText(), "Torus: "));
  EXPECT_GT(blockOf(filter, 2, 1)->GetNumberOfCells(), 0);
}

TEST(Blocks, AFailingBlockKeepsItsOwnResult)
{
  vtkNew<vtkMultiBlockDataSet> input;
  const vtkSmartPointer<vtkPolyData> torus = test::toPolyData(test::torus(40, 20));
  setBlock(input, 0, test::toPolyData(test::unitCube(8)), "Cube");
  setBlock(input, 1, torus, "Torus");
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  filter->SetInputData(input);
  const vtkSmartPointer<vtkPolyData> broken = test::toPolyData(test::torus(40, 20));
  broken->GetPoints()->SetPoint(7, 0, std::nan(""), 0);
  setBlock(input, 1, broken, "Torus");
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
  EXPECT_TRUE(contains(filter->GetOutcomeText(), "Torus: ")) << filter->GetOutcomeText();
  EXPECT_EQ(test::tally(blockOf(filter, 0)).eulerCharacteristic, 2);
  EXPECT_EQ(blockOf(filter, 1)->GetNumberOfCells(), 0); // not the cube

  setBlock(input, 1, torus, "Torus");
  input->Modified();
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_TRUE(contains(filter->GetReusedStagesText(), "Cube: all")); // only the torus was made
  const vtkIdType cells = blockOf(filter, 1)->GetNumberOfCells();
  setBlock(input, 1, broken, "Torus");
  input->Modified();
  filter->Update();
  EXPECT_TRUE(contains(filter->GetOutcomeText(), "the previous result is kept"));
  EXPECT_EQ(blockOf(filter, 1)->GetNumberOfCells(), cells);
  EXPECT_EQ(test::tally(blockOf(filter, 1)).eulerCharacteristic, 0);
}

} // namespace
} // namespace quadrille

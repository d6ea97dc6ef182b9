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
#include <vtkPartitionedDataSet.h>
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

/// The n-th of each `count` faces, with points of its own.
vtkSmartPointer<vtkPolyData> everyNth(vtkPolyData* whole, int count, int n)
{
  auto part = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polys;
  for (vtkIdType cell = n; cell < whole->GetNumberOfCells(); cell += count)
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    whole->GetCellPoints(cell, size, ids);
    polys->InsertNextCell(static_cast<int>(size));
    for (vtkIdType i = 0; i < size; ++i)
    {
      polys->InsertCellPoint(points->InsertNextPoint(whole->GetPoint(ids[i])));
    }
  }
  part->SetPoints(points);
  part->SetPolys(polys);
  return part;
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
  filter->SetQuadsAreToPerBlock(); // else the other block's size changes with the first's box
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

TEST(Blocks, AStopTellsWhichBlocksAreDone)
{
  vtkNew<vtkMultiBlockDataSet> input;
  setBlock(input, 0, test::toPolyData(test::torus(40, 20)), "Done");
  setBlock(input, 1, test::sphereWithoutRoomData(), "So far");
  setBlock(input, 2, test::toPolyData(test::torus(40, 20)), "Not made");
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  filter->SetInputData(input);
  filter->SetTargetTypeToNumberOfQuads();
  filter->SetNumberOfQuads(340);
  {
    const test::StopAt stop(filter, "Attempt 2 of at most ");
    filter->Update();
  }
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Aborted);
  EXPECT_TRUE(filter->GetIsSoFar());
  const std::string text = filter->GetOutcomeText();
  EXPECT_EQ(text.find("Done: "), std::string::npos) << text;
  EXPECT_NE(
    text.find("So far: stopped on request; these are the best quads so far"), std::string::npos)
    << text;
  EXPECT_NE(text.find("Not made: stopped on request; there is no result"), std::string::npos)
    << text;
  EXPECT_GT(blockOf(filter, 0)->GetNumberOfCells(), 0);
  EXPECT_GT(blockOf(filter, 1)->GetNumberOfCells(), 0);
  EXPECT_EQ(blockOf(filter, 2)->GetNumberOfCells(), 0);
  filter->SetAbortExecute(0);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_FALSE(filter->GetIsSoFar());
  for (const unsigned block : { 0U, 1U, 2U })
  {
    EXPECT_GT(blockOf(filter, block)->GetNumberOfCells(), 0) << block;
  }
}

/// Any way to cut a surface gives the same quads, to the bit, and a closed one.
TEST(Blocks, PiecesOfASurfaceAreOneSurface)
{
  const vtkSmartPointer<vtkPolyData> whole = test::toPolyData(test::torus(48, 24));
  std::vector<std::vector<double>> coordinates;
  for (const int count : { 2, 3, 7 })
  {
    vtkNew<vtkPartitionedDataSet> input;
    for (int p = 0; p < count; ++p)
    {
      input->SetPartition(static_cast<unsigned>(p), everyNth(whole, count, p));
    }
    input->SetPartition(
      static_cast<unsigned>(count), everyNth(whole, 2, 0)); // what others have, too
    vtkNew<vtkQuadRemesh> filter;
    filter->SetInputData(input);
    filter->SetTargetTypeToNumberOfQuads();
    filter->SetNumberOfQuads(500);
    filter->Update();
    ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
    auto* output = vtkPartitionedDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    ASSERT_NE(output, nullptr);
    ASSERT_EQ(output->GetNumberOfPartitions(), 1u);
    auto* quads = vtkPolyData::SafeDownCast(output->GetPartitionAsDataObject(0));
    const test::QuadTally t = test::tally(quads);
    EXPECT_EQ(t.eulerCharacteristic, 0);
    EXPECT_EQ(t.boundaryEdges, 0u);
    EXPECT_TRUE(contains(filter->GetNoticesText(), "faces of several pieces were taken once"))
      << filter->GetNoticesText();
    std::vector<double>& all = coordinates.emplace_back();
    for (vtkIdType i = 0; i < quads->GetNumberOfPoints(); ++i)
    {
      all.insert(all.end(), quads->GetPoint(i), quads->GetPoint(i) + 3);
    }
  }
  EXPECT_EQ(coordinates[0], coordinates[1]);
  EXPECT_EQ(coordinates[0], coordinates[2]);
}

/// Two halves of a solid box: the faces in which they meet are inside.
TEST(Blocks, VolumesInPiecesHaveNoInnerWalls)
{
  vtkNew<vtkPartitionedDataSet> input;
  for (const int side : { 0, 1 })
  {
    vtkNew<vtkImageData> half;
    half->SetExtent(side ? 4 : 0, side ? 8 : 4, 0, 8, 0, 8);
    input->SetPartition(static_cast<unsigned>(side), half);
  }
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(input);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  auto* output = vtkPartitionedDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  const test::QuadTally t =
    test::tally(vtkPolyData::SafeDownCast(output->GetPartitionAsDataObject(0)));
  EXPECT_EQ(t.eulerCharacteristic, 2);
  EXPECT_EQ(t.boundaryEdges, 0u);
  EXPECT_TRUE(contains(filter->GetNoticesText(), "128 faces where volumes meet were left out"))
    << filter->GetNoticesText();
}

/// The number of quads is for all blocks together, or for each.
TEST(Blocks, TheSizeIsSharedByArea)
{
  vtkNew<vtkMultiBlockDataSet> input;
  setBlock(input, 0, test::toPolyData(test::gridPlane(20, 20)), "Small");
  const vtkSmartPointer<vtkPolyData> large = test::toPolyData(test::gridPlane(20, 20));
  for (vtkIdType i = 0; i < large->GetNumberOfPoints(); ++i)
  {
    const double* p = large->GetPoint(i);
    large->GetPoints()->SetPoint(i, 2 * p[0], 2 * p[1], 2 * p[2] + 5);
  }
  setBlock(input, 1, large, "Large");
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(input);
  filter->SetTargetTypeToNumberOfQuads();
  filter->SetNumberOfQuads(1000);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  EXPECT_EQ(filter->GetTargetQuads(), 1000);
  const auto target = [&filter](unsigned block)
  { return blockOf(filter, block)->GetFieldData()->GetArray("TargetQuads")->GetTuple1(0); };
  EXPECT_EQ(target(0), 200); // the areas are 1 to 4
  EXPECT_EQ(target(1), 800);
  filter->SetQuadsAreToPerBlock();
  filter->Update();
  EXPECT_EQ(target(0), 1000);
  EXPECT_EQ(target(1), 1000);
}

/// A curve is a feature of the block that it lies on, and of no other.
TEST(Blocks, CurvesGoToTheNearestBlock)
{
  vtkNew<vtkMultiBlockDataSet> input;
  setBlock(input, 0, test::toPolyData(test::gridPlane(20, 20)), "Low");
  const vtkSmartPointer<vtkPolyData> high = test::toPolyData(test::gridPlane(20, 20));
  double bounds[6];
  high->GetBounds(bounds);
  vtkNew<vtkPolyData> curves;
  vtkNew<vtkPoints> points;
  const double middle = 0.5 * (bounds[2] + bounds[3]);
  points->InsertNextPoint(bounds[0], middle, 0.9);
  points->InsertNextPoint(bounds[1], middle, 0.9);
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 0, 1 });
  curves->SetPoints(points);
  curves->SetLines(lines);
  for (vtkIdType i = 0; i < high->GetNumberOfPoints(); ++i)
  {
    const double* p = high->GetPoint(i);
    high->GetPoints()->SetPoint(i, p[0], p[1], p[2] + 1);
  }
  setBlock(input, 1, high, "High");
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(input);
  filter->SetCurvesData(curves);
  filter->SetTargetTypeToNumberOfQuads();
  filter->SetNumberOfQuads(400);
  filter->Update();
  ASSERT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded) << filter->GetOutcomeText();
  const auto innerLines = [&filter](unsigned block)
  {
    vtkDataArray* boundary = blockOf(filter, block, 2)->GetCellData()->GetArray("Boundary");
    return boundary->GetRange()[0] == 0;
  };
  EXPECT_FALSE(innerLines(0));
  EXPECT_TRUE(innerLines(1));
}

} // namespace
} // namespace quadrille

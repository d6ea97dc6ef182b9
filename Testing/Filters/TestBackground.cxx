// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "TestSurfaces.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkPoints.h>
#include <vtkQuadRemesh.h>
#include <vtkTrivialProducer.h>

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

namespace quadrille
{
namespace
{

std::vector<double> placesOf(vtkPolyData* data)
{
  std::vector<double> places;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    const double* p = data->GetPoint(i);
    places.insert(places.end(), p, p + 3);
  }
  return places;
}

void wait(vtkQuadRemesh* filter)
{
  while (filter->GetIsUnderway())
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

/// As the window does it.
void updateInBackground(vtkQuadRemesh* filter)
{
  filter->SetInBackground(1);
  filter->Update();
  wait(filter);
  filter->TakeUnderway();
  filter->Update();
}

TEST(QuadsInBackground, AreTheSame)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(60, 30));
  for (const vtkIdType quads : { 400, 900 })
  {
    vtkNew<vtkQuadRemesh> here;
    here->SetInputData(input);
    here->SetNumberOfQuads(quads);
    here->Update();
    vtkNew<vtkQuadRemesh> background;
    background->SetInputData(input);
    background->SetNumberOfQuads(quads);
    updateInBackground(background);
    EXPECT_EQ(background->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
    EXPECT_EQ(placesOf(here->GetOutput()), placesOf(background->GetOutput()));
    EXPECT_EQ(placesOf(here->GetMappedSurface()), placesOf(background->GetMappedSurface()));
    EXPECT_STREQ(here->GetResultText(), background->GetResultText());
    EXPECT_STREQ(here->GetNoticesText(), background->GetNoticesText());
  }
}

TEST(QuadsInBackground, TellWhatIsToldOfTheirInputs)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(60, 30));
  vtkNew<vtkDoubleArray> sizes; // of cells, where those of points are read
  sizes->SetName("Sizing");
  sizes->SetNumberOfTuples(input->GetNumberOfCells());
  sizes->Fill(1);
  input->GetCellData()->AddArray(sizes);
  std::vector<std::string> notices, warnings;
  for (const bool isBeside : { false, true })
  {
    vtkNew<vtkQuadRemesh> filter;
    const test::Messages messages(filter);
    filter->SetInputData(input);
    filter->SetNumberOfQuads(400);
    isBeside ? updateInBackground(filter) : filter->Update();
    notices.emplace_back(filter->GetNoticesText());
    warnings.push_back(messages.warnings.substr(messages.warnings.find("array")));
  }
  EXPECT_NE(notices[0].find("Sizing"), std::string::npos);
  EXPECT_EQ(notices[0], notices[1]);
  EXPECT_EQ(warnings[0], warnings[1]);
}

/// What was read of a surface is read again where an array of it has changed.
TEST(QuadsInBackground, FollowChangesOfTheSurfaceThatConstraintsLieOn)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::sphere(4));
  vtkNew<vtkPoints> places;
  places->InsertNextPoint(input->GetPoint(100));
  vtkNew<vtkPolyData> valences;
  valences->SetPoints(places);
  vtkNew<vtkQuadRemesh> kept;
  for (const double factor : { 1.0, 1.25, 0.5 })
  {
    for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
    {
      const double* p = input->GetPoint(i);
      input->GetPoints()->SetPoint(i, p[0], p[1], factor * p[2]);
    }
    input->GetPoints()->Modified();
    vtkNew<vtkQuadRemesh> fresh;
    for (vtkQuadRemesh* filter : { kept.Get(), fresh.Get() })
    {
      filter->SetInputData(input);
      filter->SetInputData(3, valences);
      filter->SetNumberOfQuads(400);
    }
    fresh->Update();
    updateInBackground(kept);
    EXPECT_EQ(kept->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
    EXPECT_EQ(placesOf(fresh->GetOutput()), placesOf(kept->GetOutput()));
    EXPECT_EQ(placesOf(fresh->GetConstraints()), placesOf(kept->GetConstraints()));
  }
}

TEST(QuadsInBackground, DoNotReadWhatThePipelineChangesMeanwhile)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(200, 100));
  const vtkSmartPointer<vtkPoints> points = input->GetPoints();
  const vtkSmartPointer<vtkCellArray> polys = input->GetPolys();
  vtkNew<vtkQuadRemesh> here, beside;
  for (vtkQuadRemesh* filter : { here.Get(), beside.Get() })
  {
    filter->SetInputData(input);
    filter->SetNumberOfQuads(400);
  }
  here->Update();
  beside->SetInBackground(1);
  beside->Update();
  const vtkMTimeType before = points->GetMTime();
  input->Initialize(); // as a source does it before it fills its output again
  wait(beside);
  input->SetPoints(points);
  input->SetPolys(polys);
  EXPECT_EQ(points->GetMTime(), before); // by which the filter knows them again
  beside->TakeUnderway();
  beside->Update();
  EXPECT_EQ(beside->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  EXPECT_EQ(placesOf(here->GetOutput()), placesOf(beside->GetOutput()));
}

TEST(QuadsInBackground, LeaveTheOutputsAsTheyWereUntilTheyAreTaken)
{
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(test::toPolyData(test::torus(60, 30)));
  filter->SetNumberOfQuads(400);
  filter->Update();
  const std::vector<double> before = placesOf(filter->GetOutput());
  filter->SetInBackground(1);
  filter->SetNumberOfQuads(900);
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Underway);
  EXPECT_TRUE(filter->GetIsToBeTaken());
  EXPECT_EQ(placesOf(filter->GetOutput()), before);
  EXPECT_GT(filter->GetRememberedMegabytes(), 0);
  filter->TakeUnderway();
  filter->Update(); // waits
  EXPECT_FALSE(filter->GetIsToBeTaken());
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  EXPECT_NE(placesOf(filter->GetOutput()), before);
}

TEST(QuadsInBackground, OfOtherPropertiesTakeTheirPlace)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(60, 30));
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(input);
  filter->SetInBackground(1);
  for (const vtkIdType quads : { 20000, 400 })
  {
    filter->SetNumberOfQuads(quads);
    filter->Update();
  }
  wait(filter);
  filter->TakeUnderway();
  filter->Update();
  vtkNew<vtkQuadRemesh> here;
  here->SetInputData(input);
  here->SetNumberOfQuads(400);
  here->Update();
  EXPECT_EQ(placesOf(here->GetOutput()), placesOf(filter->GetOutput()));
}

TEST(QuadsInBackground, CanBeStopped)
{
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(test::toPolyData(test::torus(200, 100)));
  filter->SetNumberOfQuads(400);
  filter->Update();
  const std::vector<double> before = placesOf(filter->GetOutput());
  filter->SetInBackground(1);
  filter->SetNumberOfQuads(30000);
  filter->Update();
  filter->StopUnderway();
  wait(filter);
  filter->SetNumberOfQuads(400); // taken back
  filter->TakeUnderway();
  filter->Update();
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
  EXPECT_EQ(placesOf(filter->GetOutput()), before);
}

TEST(QuadsInBackground, ThatAreLeftHoldNothingUp)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::torus(60, 30));
  vtkNew<vtkQuadRemesh> filter;
  filter->SetInputData(input);
  filter->SetNumberOfQuads(400);
  filter->Update();
  const std::vector<double> before = placesOf(filter->GetOutput());
  filter->SetInBackground(1);
  for (const vtkIdType quads :
    { 20000, 30000, 25000 }) // each waits for the one before, but not here
  {
    filter->SetNumberOfQuads(quads);
    filter->Update();
    EXPECT_TRUE(filter->GetIsUnderway());
  }
  filter->SetNumberOfQuads(400); // known
  filter->Update();
  EXPECT_FALSE(filter->GetIsUnderway());
  EXPECT_EQ(placesOf(filter->GetOutput()), before);
  filter->SetInBackground(0);
  filter->SetNumberOfQuads(900);
  filter->Update(); // has the same memory, so that it waits
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::Succeeded);
}

TEST(QuadsInBackground, ThatFailAreToldWhenTheyAreTaken)
{
  const vtkSmartPointer<vtkPolyData> input = test::toPolyData(test::gridPlane(4, 4));
  vtkNew<vtkQuadRemesh> filter;
  const test::Messages messages(filter);
  filter->SetInputData(input);
  filter->SetMaximumNumberOfQuads(10);
  filter->SetNumberOfQuads(1000);
  updateInBackground(filter);
  EXPECT_EQ(filter->GetOutcome(), vtkQuadrilleAlgorithm::TooLarge);
  EXPECT_NE(messages.errors.find(filter->GetOutcomeText()), std::string::npos);

  vtkNew<vtkQuadRemesh> broken; // found when the thread reads it
  const test::Messages told(broken);
  input->GetPoints()->SetPoint(7, 0, std::nan(""), 0);
  input->Modified();
  broken->SetInputData(input);
  updateInBackground(broken);
  EXPECT_EQ(broken->GetOutcome(), vtkQuadrilleAlgorithm::BadInput);
}

} // namespace
} // namespace quadrille

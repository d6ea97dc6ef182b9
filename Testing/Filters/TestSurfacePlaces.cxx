// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadSurfacePlaces.h"

#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPlaneSource.h>
#include <vtkSelectionNode.h>
#include <vtkSelectionSource.h>

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

namespace
{

/// Four unit squares in the plane z = 0, of which some are selected.
struct Squares
{
  explicit Squares(std::initializer_list<vtkIdType> selected)
  {
    plane->SetXResolution(2);
    plane->SetYResolution(2);
    plane->SetOrigin(0, 0, 0);
    plane->SetPoint1(2, 0, 0);
    plane->SetPoint2(0, 2, 0);
    selection->SetContentType(vtkSelectionNode::INDICES);
    selection->SetFieldType(vtkSelectionNode::CELL);
    for (const vtkIdType id : selected)
    {
      selection->AddID(-1, id);
    }
    places->SetInput(plane);
    places->SetSelection(selection);
  }

  /// Where a ray along -z hits.
  void drop(vtkIdType ray, double x, double y) { places->SetRay(ray, x, y, 3, x, y, -5); }

  double at(vtkIdType ray, int coordinate)
  {
    return places->GetPlaces()->GetValue(3 * ray + coordinate);
  }

  vtkNew<vtkPlaneSource> plane;
  vtkNew<vtkSelectionSource> selection;
  vtkNew<vtkQuadSurfacePlaces> places;
};

} // namespace

TEST(SurfacePlaces, RaysHitSelectedCellsAlone)
{
  Squares squares({ 0, 3 }); // lower left and upper right
  squares.places->SetNumberOfRays(3);
  squares.drop(0, 0.25, 0.75);
  squares.drop(1, 1.5, 0.5);
  squares.drop(2, 1.25, 1.75);
  squares.places->Compute();
  ASSERT_EQ(squares.places->GetPlaces()->GetNumberOfValues(), 9);
  EXPECT_NEAR(squares.at(0, 0), 0.25, 1e-12);
  EXPECT_NEAR(squares.at(0, 1), 0.75, 1e-12);
  EXPECT_NEAR(squares.at(0, 2), 0, 1e-12);
  EXPECT_TRUE(std::isnan(squares.at(1, 0)));
  EXPECT_NEAR(squares.at(2, 0), 1.25, 1e-12);
}

TEST(SurfacePlaces, RaysDoNotSlipThroughAtAVertex)
{
  Squares squares({ 0, 1, 2, 3 });
  squares.places->SetNumberOfRays(1);
  for (const double off : { 0.0, 1e-9, -1e-9 })
  {
    squares.drop(0, 1 + off, 1 - off);
    squares.places->Compute();
    EXPECT_NEAR(squares.at(0, 2), 0, 1e-9);
  }
}

TEST(SurfacePlaces, OfASurfaceThatIsHeldStayWhereTheyAre)
{
  Squares squares({});
  squares.plane->Update();
  squares.places->Hold();
  squares.plane->SetCenter(1, 1, -2);
  squares.plane->Update();
  squares.places->SetNumberOfRays(2);
  squares.drop(0, 1.5, 0.5);
  squares.drop(1, 2.5, 0.5);
  squares.places->Compute();
  EXPECT_NEAR(squares.at(0, 2), 0, 1e-12);
  EXPECT_TRUE(std::isnan(squares.at(1, 0)));
  squares.places->Hold();
  squares.places->Compute();
  EXPECT_NEAR(squares.at(0, 2), -2, 1e-12);
}

TEST(SurfacePlaces, WithoutASelectionThereIsNoPlace)
{
  vtkNew<vtkQuadSurfacePlaces> places;
  places->SetRay(0, 0, 0, 1, 0, 0, -1);
  places->Compute();
  ASSERT_EQ(places->GetPlaces()->GetNumberOfValues(), 3);
  EXPECT_TRUE(std::isnan(places->GetPlaces()->GetValue(0)));
}

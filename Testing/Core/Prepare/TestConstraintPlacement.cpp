// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is drawn goes to places of the surface, wherever its vertices are.
#include "Prepare/ConstraintPlacement.h"

#include "Base/Error.h"
#include "MeshInput.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <string>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

/// A cube of 12 triangles.
class PlacementOnACube : public ::testing::Test
{
protected:
  PlacementOnACube()
    : input_(toInput(unitCube(1))), places_(input_), paths_(input_),
      placement_(input_, places_, paths_, 0.001)
  {
  }

  SurfaceInput input_;
  SurfacePlaces places_;
  SurfacePaths paths_;
  ConstraintPlacement placement_;
};

TEST_F(PlacementOnACube, PointsStayWhereTheyAreGiven)
{
  placement_.addValence(0, { 0.5, 0.4, 1.2 }, 3);
  placement_.addSize(0, { 0.25, 0.375, 1.125 }, 0.1, 0.5, 7);
  const DrawnRequests& drawn = placement_.requests();
  ASSERT_EQ(drawn.valences.size(), 1U);
  EXPECT_EQ(drawn.valences[0], (ValencePlace{ { 0.5, 0.4, 1 }, 3 }));
  ASSERT_EQ(drawn.sizes.size(), 1U);
  EXPECT_EQ(drawn.sizes[0], (SizeRequest{ { 0.25, 0.375, 1 }, 0.1, 0.5, 7 }));
  EXPECT_NEAR(placement_.result().placed[0].distance, 0.2, 1e-12);
  EXPECT_EQ(placement_.result().placed[1].distance, 0.125);
  EXPECT_EQ(placement_.result().placed[1].factor, 0.5);
  EXPECT_THROW(placement_.addSize(1, { 0.2, 0.3, 1 }, 0.1, 0), InvalidInput);
  EXPECT_THROW(placement_.addSize(1, { 0.2, 0.3, 1 }, -1, 0.5), InvalidInput);
}

TEST_F(PlacementOnACube, ALineRunsStraightOverAnEdge)
{
  placement_.addFeature({ 4, { { 0.5, 0.1, 1 }, { 1, 0.9, 0.5 } } });
  const DrawnRequests& drawn = placement_.requests();
  ASSERT_EQ(drawn.features.size(), 1U);
  EXPECT_EQ(drawn.features[0].points.size(), 2U);
  const std::vector<Vector3>& path = placement_.result().placed[0].path;
  EXPECT_EQ(path.front(), Vector3(0.5, 0.1, 1));
  EXPECT_EQ(path.back(), Vector3(1, 0.9, 0.5));
  // Laid out side by side the two sides make one straight line.
  bool isAtEdge = false;
  for (const Vector3& p : path)
  {
    const double along = p.z() > 1 - 1e-12 ? p.x() - 0.5 : 0.5 + 1 - p.z();
    EXPECT_NEAR(p.y(), 0.1 + 0.8 * along, 1e-9) << p.transpose();
    isAtEdge = isAtEdge || (p - Vector3(1, 0.5, 1)).norm() < 1e-9;
  }
  EXPECT_TRUE(isAtEdge);
}

TEST_F(PlacementOnACube, OfTwoValencesAtOnePlaceTheSecondIsRefused)
{
  placement_.addValence(0, { 0.5, 0.4, 1 }, 3);
  placement_.addValence(1, { 0.5004, 0.4, 1 }, 3); // the same again
  EXPECT_EQ(placement_.requests().valences.size(), 1U);
  EXPECT_THROW(placement_.addValence(2, { 0.5004, 0.4, 1 }, 5), InvalidInput);
  placement_.addValence(3, { 0.51, 0.4, 1 }, 5);
  EXPECT_EQ(placement_.requests().valences.size(), 2U);
}

TEST_F(PlacementOnACube, AnArrayOfValencesCountsToo)
{
  input_.targetValences.assign(input_.points.size(), 0);
  input_.targetValences[0] = 3;
  EXPECT_THROW(placement_.addValence(0, input_.points[0], 4), InvalidInput);
  EXPECT_NO_THROW(placement_.addValence(1, input_.points[1], 4));
}

TEST_F(PlacementOnACube, LinesWithoutLengthAreNotFollowed)
{
  placement_.addStroke({ 0, { { 0.5, 0.5, 1 }, { 0.5, 0.5, 1.5 } } }, 1);
  placement_.addFeature({ 1, { { 0.5, 0.5, 1 } } });
  EXPECT_TRUE(placement_.requests().empty());
  ASSERT_EQ(placement_.result().notices.size(), 2U);
  EXPECT_EQ(placement_.result().placed[1].path.size(), 1U);
}

TEST_F(PlacementOnACube, ACycleIsClosedOverAllSides)
{
  placement_.addCurve(0, CurveKind::Cycle,
    { { 0.5, 0.5, 1 }, { 1, 0.5, 0.5 }, { 0.5, 0.5, 0 }, { 0, 0.5, 0.5 }, { 0.5, 0.5, 1 } });
  EXPECT_EQ(placement_.curves()[0].points.size(), 4U);
  const std::vector<Vector3>& path = placement_.result().placed[0].path;
  EXPECT_EQ(path.front(), path.back());
  for (const Vector3& p : path)
  {
    EXPECT_NEAR(p.y(), 0.5, 1e-9);
    EXPECT_NEAR((p - Vector3::Constant(0.5)).cwiseAbs().maxCoeff(), 0.5, 1e-9);
  }
}

/// As two bodies that touch.
class PlacementOnTwoPlates : public ::testing::Test
{
protected:
  const SurfaceInput input_ =
    toInput(disjointUnion(gridPlane(2, 2), gridPlane(2, 2), Vector3(0, 0, 5)));
  const SurfacePlaces places_{ input_ };
  const SurfacePaths paths_{ input_ };
  ConstraintPlacement placement_{ input_, places_, paths_ };
};

TEST_F(PlacementOnTwoPlates, ALineOverTwoPartsIsFollowedOnBoth)
{
  const DrawnLine line{ 3, { { 0.5, 0, 0 }, { 0.5, 1, 0 }, { 0.5, 1, 5 }, { 0.5, 2, 5 } } };
  placement_.addFeature(line);
  placement_.addStroke(line, 1, 0.1);
  ASSERT_EQ(placement_.requests().features.size(), 1U);
  EXPECT_EQ(placement_.requests().features[0].points, line.points);
  const std::vector<PlacedConstraint>& placed = placement_.result().placed;
  ASSERT_EQ(placed.size(), 2U);
  for (const PlacedConstraint& constraint : placed)
  {
    EXPECT_EQ(constraint.whyNot, "");
    EXPECT_NE(constraint.remark.find("from (0.5, 1, 0) to (0.5, 1, 5)"), std::string::npos)
      << constraint.remark;
  }
  ASSERT_FALSE(placed[1].guided.empty());
  for (const GuidedPlace& guided : placed[1].guided)
  {
    EXPECT_NEAR(std::abs(guided.direction.y()), 1, 1e-9); // none between the two
  }
}

/// Of a line with a point on each there is none on any.
TEST_F(PlacementOnTwoPlates, ALineFromOnePartToAnotherRunsOverNone)
{
  placement_.addStroke({ 3, { { 0.5, 0, 0 }, { 0.5, 0, 5 } } }, 1, 0.1);
  EXPECT_TRUE(placement_.result().placed[0].guided.empty());
}

TEST(ConstraintPlacement, ValenceTwoIsRefusedOnTheBoundaryOnly)
{
  const SurfaceInput input = toInput(gridPlane(2, 2));
  const SurfacePlaces places(input);
  const SurfacePaths paths(input);
  ConstraintPlacement placement(input, places, paths);
  EXPECT_THROW(placement.addValence(0, { 0.3, 0, 0 }, 2), InvalidInput);
  EXPECT_NO_THROW(placement.addValence(0, { 0.3, 0.3, 0 }, 2));
  EXPECT_NO_THROW(placement.addValence(0, { 0.3, 0, 0 }, 3));
}

} // namespace
} // namespace quadrille

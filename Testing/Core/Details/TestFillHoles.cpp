// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/FillHoles.h"

#include "Mesh/Topology.h"
#include "SurfaceInputs.h"

namespace quadrille
{
namespace
{

/// Three holes of one cell each, 4 long round.
Mesh plateWithTinyHoles()
{
  return test::planeCells(20, 20,
    [](int x, int y)
    { return !((x == 4 && y == 4) || (x == 12 && y == 5) || (x == 9 && y == 15)); });
}

std::vector<HandleLoop> shortLoops(const Mesh& mesh)
{
  return measureBoundary(mesh, 10).tooShort;
}

TEST(FillHoles, HolesOfAPlateAreGone)
{
  PreparedSurface surface = test::prepare(test::toInput(plateWithTinyHoles()));
  const std::uint64_t hash = surface.hash;
  EXPECT_EQ(fillHoles(surface, shortLoops(surface.mesh)), (std::vector<std::size_t>{ 0, 1, 2 }));
  EXPECT_EQ(validate(surface.mesh), "");
  const TopologySummary topology = summarizeTopology(surface.mesh);
  EXPECT_EQ(topology.eulerCharacteristic, 1);
  EXPECT_EQ(topology.boundaryLoops, 1U);
  // Cells of area 1 are exact here.
  EXPECT_EQ(surface.area, 400);
  EXPECT_EQ(test::area(surface.mesh), 400);
  EXPECT_EQ(surface.repair.filledHoles, 3U);
  EXPECT_TRUE(test::contains(surface.repair.text(), "3 small holes filled"));
  EXPECT_NE(surface.hash, hash);
}

TEST(FillHoles, FillingsTakeTheSourcesOfTheFacesBesideThem)
{
  const SurfaceInput input = test::toInput(plateWithTinyHoles());
  PreparedSurface surface = test::prepare(input);
  fillHoles(surface, shortLoops(surface.mesh));
  ASSERT_EQ(surface.sourcePolygon.size(), surface.mesh.faceCount());
  std::size_t off = 0;
  for (Index f = 0; f < surface.mesh.faceCount(); ++f)
  {
    ASSERT_LT(surface.sourcePolygon[f], input.polygonOffsets.size() - 1);
    for (Index corner = 0; corner < 3; ++corner)
    {
      std::array<double, 3> weights{};
      weights[corner] = 1;
      const SourceLocation source = surface.locate(f, weights);
      Vector3 place = Vector3::Zero();
      for (std::size_t i = 0; i < 3; ++i)
      {
        place += source.weights[i] * input.points[source.points[i]];
      }
      off += (place - surface.mesh.position[surface.mesh.origin[3 * f + corner]]).norm() > 1e-12;
    }
  }
  // Only the middles of the three fans, in four faces each, lie off their sources.
  EXPECT_EQ(off, 12U);
}

TEST(FillHoles, FeaturesOfALoopGoWithIt)
{
  SurfaceInput input = test::toInput(plateWithTinyHoles());
  input.featureEdges.assign(input.polygonOffsets.size() - 1, 7); // every edge
  PreparedSurface surface = test::prepare(input);
  fillHoles(surface, shortLoops(surface.mesh));
  // Not those from the middle of a fan, nor the four of its loop.
  for (Index h = 0; h < surface.mesh.halfEdgeCount(); ++h)
  {
    const Vector3 middle = (surface.mesh.position[surface.mesh.origin[h]] +
                             surface.mesh.position[surface.mesh.target(h)]) /
      2;
    const auto isAt = [&](double x, double y) { return (middle - Vector3(x, y, 0)).norm() < 0.51; };
    const bool isOnLoop = isAt(4.5, 4.5) || isAt(12.5, 5.5) || isAt(9.5, 15.5);
    EXPECT_EQ(surface.mesh.isFeature(h), !isOnLoop) << middle.transpose();
  }
}

TEST(FillHoles, SlitsStayOpen)
{
  // A vertex inside the plate is doubled for one side of the straight line through it, by less than a triangle needs.
  SurfaceInput input = test::toInput(test::gridPlane(8, 8));
  Index centre = kInvalidIndex;
  for (Index p = 0; p < input.points.size(); ++p)
  {
    centre = input.points[p] == Vector3(4, 4, 0) ? p : centre;
  }
  const Index copy = static_cast<Index>(input.points.size());
  input.points.emplace_back(4, 4 - 1e-9, 0);
  for (std::size_t f = 0; f + 1 < input.polygonOffsets.size(); ++f)
  {
    Index* corners = &input.polygonPoints.edit()[3 * f];
    const double y =
      (input.points[corners[0]] + input.points[corners[1]] + input.points[corners[2]]).y() / 3;
    for (int i = 0; i < 3; ++i)
    {
      corners[i] = corners[i] == centre && y < 4 ? copy : corners[i];
    }
  }
  PreparedSurface surface = test::prepare(input);
  ASSERT_EQ(shortLoops(surface.mesh).size(), 1U);
  const std::uint64_t hash = surface.hash;
  EXPECT_TRUE(fillHoles(surface, shortLoops(surface.mesh)).empty());
  EXPECT_EQ(surface.hash, hash);
  EXPECT_EQ(surface.repair.filledHoles, 0U);
}

TEST(FillHoles, WhatIsNoLoopOfTheBoundaryStays)
{
  PreparedSurface surface = test::prepare(test::toInput(test::sphere(2)));
  EXPECT_TRUE(fillHoles(surface, { { { 0, 1, 2 }, 1.0 } }).empty());
  EXPECT_TRUE(fillHoles(surface, {}).empty());
}

} // namespace
} // namespace quadrille

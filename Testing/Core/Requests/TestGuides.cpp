// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/Prepare.h"
#include "Prepare/Refine.h"
#include "Requests/Guides.h"
#include "SurfaceInputs.h"

#include <map>
#include <string>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

std::string messageOf(const SurfaceInput& input)
{
  try
  {
    prepareSurface(input, {});
  }
  catch (const InvalidInput& error)
  {
    return error.what();
  }
  return {};
}

SurfaceInput guidedInput(const Mesh& mesh)
{
  SurfaceInput input = toInput(mesh);
  input.guideDirections.assign(mesh.faceCount(), Vector3::Zero());
  return input;
}

TEST(Guides, CostNothingWhereNoneAreAsked)
{
  const PreparedSurface surface = prepareSurface(toInput(sphere(2)), {});
  EXPECT_EQ(surface.polygonGuides.capacity(), 0u);
  EXPECT_EQ(surface.valenceRequests.capacity(), 0u);
  EXPECT_TRUE(surfaceGuides(surface, 1).faces.empty());
}

TEST(Guides, DoNotChangeTheFinestLevel)
{
  // The log of a decimation belongs to the surface, whatever the guides.
  SurfaceInput input = guidedInput(sphere(2));
  const std::uint64_t hash = prepareSurface(input, {}).hash;
  input.guideDirections[3] = Vector3(1, 2, 3);
  input.targetValences.assign(input.points.size(), 0);
  input.targetValences[5] = 3;
  EXPECT_EQ(prepareSurface(input, {}).hash, hash);
}

TEST(Guides, FollowTheirPolygonsThroughOrderAndRefinement)
{
  // Every third triangle of a shuffled soup is guided along the position of its first corner, which names it.
  SurfaceInput input = toSoup(sphere(2));
  const std::size_t polygons = input.polygonOffsets.size() - 1;
  input.guideDirections.assign(polygons, Vector3::Zero());
  input.guideWeights.assign(polygons, 0.0); // out of range, but only where nothing is guided
  for (std::size_t i = 0; i < polygons; i += 3)
  {
    const Vector3 along = input.points[3 * i + 1] - input.points[3 * i];
    input.guideDirections[i] = 7 * along + 0.1 * input.points[3 * i]; // leaves the plane a little
    input.guideWeights[i] = 0.25 + 0.5 * double(i) / double(polygons);
  }
  PreparedSurface surface = prepareSurface(input, {});
  for (const bool refined : { false, true })
  {
    if (refined)
    {
      refineSurface(surface, 0.1, {});
    }
    const SurfaceGuides guides = surfaceGuides(surface, 1);
    EXPECT_EQ(guides.dropped, 0u);
    std::map<Index, Guide> guideOf;
    for (const FaceGuide& guide : guides.faces)
    {
      guideOf[guide.face] = guide.guide;
    }
    std::size_t found = 0;
    for (Index f = 0; f < surface.mesh.faceCount(); ++f)
    {
      const Index polygon = surface.sourcePolygon[f];
      ASSERT_EQ(guideOf.count(f), polygon % 3 == 0 ? 1u : 0u);
      if (polygon % 3 != 0)
      {
        continue;
      }
      ++found;
      const Guide& guide = guideOf[f];
      const Vector3 along =
        (input.points[3 * polygon + 1] - input.points[3 * polygon]).normalized();
      EXPECT_NEAR(guide.direction.norm(), 1, 1e-12);
      EXPECT_NEAR(guide.direction.dot(faceNormal(surface.mesh, f)), 0, 1e-12);
      EXPECT_GT(guide.direction.dot(along), 0.99);
      EXPECT_FLOAT_EQ(guide.weight, static_cast<float>(input.guideWeights[polygon]));
    }
    EXPECT_GT(found, refined ? polygons : polygons / 3 - 1);
  }
}

TEST(Guides, OfAPolygonHoldForAllItsTriangles)
{
  SurfaceInput input = makeInput(
    { { 0, 0, 0 }, { 2, 0, 0 }, { 3, 1, 0 }, { 2, 2, 0 }, { 0, 2, 0 } }, { { 0, 1, 2, 3, 4 } });
  input.guideDirections = { Vector3(0, 5, 0) };
  const PreparedSurface surface = prepareSurface(input, {});
  const SurfaceGuides guides = surfaceGuides(surface, 1);
  ASSERT_EQ(guides.faces.size(), 3u);
  for (const FaceGuide& guide : guides.faces)
  {
    EXPECT_EQ(guide.guide.direction, Vector3(0, 1, 0));
    EXPECT_EQ(guide.guide.weight, 1.0F);
  }
}

TEST(Guides, NormalToTheFaceAreDroppedAndTold)
{
  SurfaceInput input = guidedInput(gridPlane(3, 3));
  input.guideDirections[4] = Vector3(0, 0, 1);
  input.guideDirections[5] = Vector3(1, 0, 1);
  const PreparedSurface surface = prepareSurface(input, {});
  const SurfaceGuides guides = surfaceGuides(surface, 1);
  EXPECT_EQ(guides.faces.size(), 1u);
  EXPECT_EQ(guides.dropped, 1u);
  ASSERT_EQ(requestNotices(surface, guides).size(), 1u);
}

TEST(Guides, NonsenseIsRefusedWithItsElement)
{
  const Mesh mesh = gridPlane(3, 3);
  SurfaceInput input = guidedInput(mesh);
  input.guideDirections[7] = Vector3(1, std::nan(""), 0);
  EXPECT_NE(messageOf(input).find("polygon 7"), std::string::npos);

  for (const double weight : { 0.0, -1.0, 1.5, std::nan("") })
  {
    input = guidedInput(mesh);
    input.guideDirections[2] = Vector3(1, 0, 0);
    input.guideWeights.assign(mesh.faceCount(), 1.0);
    input.guideWeights[2] = weight;
    EXPECT_NE(messageOf(input).find("polygon 2"), std::string::npos) << weight;
  }
  for (const int valence : { -1, 1, 9, 1000000 })
  {
    input = toInput(mesh);
    input.targetValences.assign(input.points.size(), 0);
    input.targetValences[6] = valence;
    EXPECT_NE(messageOf(input).find("point 6"), std::string::npos) << valence;
  }
  input = toInput(mesh);
  input.targetValences.assign(input.points.size(), 0);
  input.targetValences[0] = 2; // on the boundary
  EXPECT_NE(messageOf(input).find("point 0"), std::string::npos);
  input = toInput(mesh);
  input.guideDirections.resize(2);
  EXPECT_NE(messageOf(input), "");
  input = toInput(mesh);
  input.targetValences.resize(2);
  EXPECT_NE(messageOf(input), "");
}

/// The request at a position; kInvalidIndex for none, and a failure for several.
int requestAt(const PreparedSurface& surface, const Vector3& p)
{
  int valence = 0;
  for (const ValenceRequest& request : surface.valenceRequests)
  {
    if (surface.mesh.position[request.vertex] == p)
    {
      EXPECT_EQ(valence, 0);
      valence = request.valence;
    }
  }
  return valence;
}

TEST(TargetValence, FollowsItsPointThroughMergingOrderAndRefinement)
{
  SurfaceInput input = toSoup(sphere(2));
  input.targetValences.assign(input.points.size(), 0);
  input.targetValences[10] = 3;
  input.targetValences[100] = 5; // only one of the copies of each point asks
  PreparedSurface surface = prepareSurface(input, {});
  ASSERT_GT(surface.repair.mergedPoints, 0u);
  for (const bool refined : { false, true })
  {
    if (refined)
    {
      refineSurface(surface, 0.1, {});
      ASSERT_GT(surface.repair.refinedFaces, 0u);
    }
    EXPECT_EQ(surface.valenceRequests.size(), 2u);
    EXPECT_EQ(requestAt(surface, input.points[10]), 3);
    EXPECT_EQ(requestAt(surface, input.points[100]), 5);
    EXPECT_TRUE(std::is_sorted(surface.valenceRequests.begin(), surface.valenceRequests.end(),
      [](const ValenceRequest& a, const ValenceRequest& b) { return a.vertex < b.vertex; }));
  }
}

TEST(TargetValence, ContradictionsOfMergedPointsAreRefused)
{
  SurfaceInput input = toSoup(sphere(1));
  input.targetValences.assign(input.points.size(), 0);
  const Vector3 p = input.points[20];
  std::vector<std::size_t> copies;
  for (std::size_t i = 0; i < input.points.size(); ++i)
  {
    if (input.points[i] == p)
    {
      copies.push_back(i);
    }
  }
  ASSERT_GE(copies.size(), 2u);
  input.targetValences[copies[0]] = input.targetValences[copies[1]] = 3;
  EXPECT_EQ(messageOf(input), "");
  input.targetValences[copies[1]] = 5;
  EXPECT_NE(messageOf(input).find(
              "points " + std::to_string(copies[0]) + " and " + std::to_string(copies[1])),
    std::string::npos);
}

TEST(TargetValence, OfIsolatedPointsIsTold)
{
  SurfaceInput input = toInput(sphere(1));
  input.points.push_back(Vector3(9, 9, 9));
  input.targetValences.assign(input.points.size(), 0);
  input.targetValences.back() = 3;
  const PreparedSurface surface = prepareSurface(input, {});
  EXPECT_TRUE(surface.valenceRequests.empty());
  EXPECT_EQ(surface.unusedValences, 1u);
  EXPECT_EQ(requestNotices(surface, surfaceGuides(surface, 1)).size(), 1u);
}

} // namespace
} // namespace quadrille

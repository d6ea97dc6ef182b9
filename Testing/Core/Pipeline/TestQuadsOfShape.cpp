// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/QuadsOfShape.h"

#include "MeshInput.h"
#include "Pipeline/Pipeline.h"
#include "Pipeline/SizedSurface.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace quadrille
{
namespace
{

RemeshOptions byShape()
{
  RemeshOptions options;
  askForQuadsOfShape(options);
  options.threads = 1;
  return options;
}

/// The number that the surface is sized for.
SizedSurface sizedFor(const Mesh& mesh, const RemeshOptions& options, const KnownInput& known = {})
{
  SurfaceInput input = test::toInput(mesh);
  return sizeSurface(input, options, known);
}

/// Of such a radius that an edge of the square root of the area over `quads` is 45 degrees of its tube:
/// sqrt(4 pi^2 r / quads) / r = pi / 4.
Mesh torusFor(double quads)
{
  return test::torus(600, 24, 1, 64 / quads);
}

/// Of the run or the sized surface.
bool tellsOfShape(const std::vector<std::string>& notices)
{
  return std::any_of(notices.begin(), notices.end(),
    [](const std::string& notice)
    { return notice.find("nobody has said how many") != std::string::npos; });
}

TEST(QuadsOfShape, StayWhereNothingMelts)
{
  for (const Mesh& mesh : { test::sphere(4), test::unitCube(8), test::torus(60, 30) })
  {
    const SizedSurface sized = sizedFor(mesh, byShape());
    EXPECT_EQ(sized.targetQuads, kLeastQuadsOfShape);
    EXPECT_FALSE(tellsOfShape(sized.notices));
  }
}

TEST(QuadsOfShape, GrowUntilAnEdgeTurnsByLess)
{
  // A little more than what its tube asks for, so that the 24 sides do not decide.
  for (const auto& [needed, made] :
    { std::pair(4500.0, 5000U), std::pair(6300.0, 7000U), std::pair(9000.0, 10000U),
      std::pair(12500.0, 14000U), std::pair(18000.0, 20000U), std::pair(60000.0, 20000U) })
  {
    const SizedSurface sized = sizedFor(torusFor(needed), byShape());
    EXPECT_EQ(sized.targetQuads, made) << needed;
    EXPECT_EQ(tellsOfShape(sized.notices), made > kLeastQuadsOfShape);
  }
}

TEST(QuadsOfShape, ShareIsThatOfTheArea)
{
  // A thick torus beside a thin one, and both with the same edge length.
  const Mesh thin = test::torus(300, 24, 1, 0.02), thick = test::torus(120, 60, 1, 0.3);
  const Mesh both = test::disjointUnion(thin, thick, Vector3(4, 0, 0));
  const double share = 0.02 / 0.32;
  EXPECT_NEAR(shareThatTurns(both, 0.025, radians(45), 1), share, 0.002);
  EXPECT_EQ(shareThatTurns(both, 0.01, radians(45), 1), 0);
  EXPECT_NEAR(shareThatTurns(both, 0.4, radians(45), 1), 1, 0.05);
  EXPECT_EQ(
    shareThatTurns(both, 0.025, radians(45), 1), shareThatTurns(both, 0.025, radians(45), 3));
}

TEST(QuadsOfShape, FeaturesAreFollowedAndTurnByNothing)
{
  const Mesh cube = test::unitCube(40);
  EXPECT_GT(shareThatTurns(cube, 0.1, radians(45), 1), 0.1);
  EXPECT_EQ(shareThatTurns(test::markFeatures(cube, radians(40)), 0.1, radians(45), 1), 0);
}

TEST(QuadsOfShape, NumberThatIsGivenStays)
{
  RemeshOptions options;
  options.quads = kLeastQuadsOfShape;
  options.threads = 1;
  const SizedSurface given = sizedFor(torusFor(12500), options);
  EXPECT_EQ(given.targetQuads, kLeastQuadsOfShape);
  EXPECT_FALSE(tellsOfShape(given.notices));
  // A limit of quads near the largest number goes before, and sizes that follow the shape need no more.
  options = byShape();
  options.maximumNumberOfQuads = 39999;
  EXPECT_EQ(sizedFor(torusFor(12500), options).targetQuads, kLeastQuadsOfShape);
  options.maximumNumberOfQuads = 40000;
  EXPECT_EQ(sizedFor(torusFor(12500), options).targetQuads, 14000U);
  options = byShape();
  options.sizes.turn = radians(30);
  EXPECT_EQ(sizedFor(torusFor(12500), options).targetQuads, kLeastQuadsOfShape);
}

TEST(QuadsOfShape, StoreKeepsNumberAndWordsApart)
{
  const Mesh mesh = torusFor(6300);
  ResultStore store;
  const SizedSurface first = sizedFor(mesh, byShape(), { &store, 1 });
  const SizedSurface again = sizedFor(mesh, byShape(), { &store, 1 });
  EXPECT_EQ(first.targetQuads, 7000U);
  EXPECT_EQ(again.targetQuads, 7000U);
  EXPECT_EQ(again.notices, first.notices);
  EXPECT_EQ(again.reused.back(), "refine");
  RemeshOptions given;
  given.quads = 7000;
  const SizedSurface same = sizedFor(mesh, given, { &store, 1 });
  EXPECT_EQ(same.key, first.key);
  EXPECT_FALSE(tellsOfShape(same.notices));
}

TEST(QuadsOfShape, RunHasThatMany)
{
  const RemeshResult result = remesh(test::toInput(torusFor(6300)), byShape());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.targetQuads, 7000U);
  EXPECT_TRUE(tellsOfShape(result.notices));
  RemeshOptions given = byShape();
  given.quads = 7000;
  given.growsWithShape = false;
  const RemeshResult same = remesh(test::toInput(torusFor(6300)), given);
  EXPECT_EQ(same.quads.points, result.quads.points);
  EXPECT_EQ(same.quads.quads, result.quads.quads);
}

} // namespace
} // namespace quadrille

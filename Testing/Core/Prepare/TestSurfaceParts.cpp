// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A surface in parts, and parts as one surface again.
#include "Mesh/SurfaceParts.h"

#include "Mesh/ComponentSizes.h"
#include "Mesh/FlatSources.h"
#include "Mesh/Topology.h"
#include "MeshInput.h"
#include "Prepare/Prepare.h"
#include "Prepare/Refine.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace quadrille
{
namespace
{

constexpr Index kFree = kInvalidIndex;

/// A box of twelve triangles, whose long sides refinement flips.
Mesh longBox()
{
  Mesh box = test::unitCube(1);
  for (Vector3& p : box.position.editAll())
  {
    p.y() *= 5;
  }
  return box;
}

/// Two boxes and a sphere.
SurfaceInput threeBodies()
{
  const Mesh cubes = test::disjointUnion(longBox(), longBox(), Vector3(3, 0, 0));
  return test::toInput(test::disjointUnion(cubes, test::sphere(2), Vector3(8, 0, 0)));
}

std::vector<ComponentPart> partsOf(const PreparedSurface& surface)
{
  const ComponentSizes sizes = measureComponents(surface.mesh);
  return splitSurface(surface, sizes.componentOfFace, sizes.area.size(), 1);
}

/// That sources tell where faces lie on the input.
void expectSources(const PreparedSurface& surface, const SurfaceInput& input)
{
  for (Index f = 0; f < surface.mesh.faceCount(); ++f)
  {
    const std::array<double, 3> weights{ 0.5, 0.3, 0.2 };
    const SourceLocation location = surface.locate(f, weights);
    Vector3 here = Vector3::Zero(), there = Vector3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
    {
      here += weights[k] * surface.mesh.position[surface.mesh.origin[3 * f + k]];
      there += location.weights[k] * input.points[location.points[k]];
    }
    ASSERT_LE((here - there).norm(), 1e-9) << f;
  }
}

TEST(SurfaceParts, AreTheComponentsAndMakeTheWholeAgain)
{
  const SurfaceInput input = threeBodies();
  const PreparedSurface whole = prepareSurface(input, {});
  std::vector<ComponentPart> parts = partsOf(whole);
  ASSERT_EQ(parts.size(), 3U);
  PreparedSurface joined = withoutElements(whole);
  for (ComponentPart& part : parts)
  {
    EXPECT_EQ(validate(part.surface.mesh), "");
    EXPECT_EQ(summarizeTopology(part.surface.mesh).components, 1U);
    expectSources(part.surface, input);
    part.surface.components = 1;
    appendSurface(part.surface, joined);
  }
  EXPECT_EQ(validate(joined.mesh), "");
  EXPECT_EQ(joined.components, 3U);
  EXPECT_EQ(joined.mesh.faceCount(), whole.mesh.faceCount());
  EXPECT_EQ(joined.mesh.vertexCount(), whole.mesh.vertexCount());
  EXPECT_NEAR(joined.area, whole.area, 1e-12 * whole.area);
  EXPECT_EQ(std::count(joined.mesh.flags.begin(), joined.mesh.flags.end(), 0),
    std::count(whole.mesh.flags.begin(), whole.mesh.flags.end(), 0));
  std::vector<Index> polygons = joined.sourcePolygon;
  std::sort(polygons.begin(), polygons.end());
  std::vector<Index> before = whole.sourcePolygon;
  std::sort(before.begin(), before.end());
  EXPECT_EQ(polygons, before);
  expectSources(joined, input);
}

TEST(SurfaceParts, FlipsOfBothAreKnownInTheWhole)
{
  const SurfaceInput input = threeBodies();
  PreparedSurface whole = prepareSurface(input, {});
  refineSurface(whole, 0.5, {});
  PreparedSurface joined = withoutElements(whole);
  for (ComponentPart& part : partsOf(whole))
  {
    refineSurface(part.surface, 0.2, {}); // each with flips of its own
    EXPECT_NE(part.surface.beforeFlips, nullptr);
    appendSurface(part.surface, joined);
  }
  ASSERT_NE(joined.beforeFlips, nullptr);
  EXPECT_GE(joined.beforeFlips->level(), 3U); // the common ones, and those of either cube
  EXPECT_EQ(validate(joined.mesh), "");
  EXPECT_EQ(joined.refinedEntry.size(), joined.mesh.faceCount());
  expectSources(joined, input);
}

TEST(SurfaceParts, RequestsGoWhereTheyAreAsked)
{
  PreparedSurface whole = prepareSurface(threeBodies(), {});
  const auto nearest = [&](const Vector3& p)
  {
    const auto& at = whole.mesh.position;
    return static_cast<Index>(std::min_element(at.begin(), at.end(),
                                [&](const Vector3& a, const Vector3& b)
                                { return (a - p).squaredNorm() < (b - p).squaredNorm(); }) -
      at.begin());
  };
  const Index atCube = nearest(Vector3(4, 5, 1)), atSphere = nearest(Vector3(8, 0, 1));
  whole.valenceRequests = { { std::min(atCube, atSphere), 3, kFree },
    { std::max(atCube, atSphere), 3, kFree } };
  whole.curves = { { CurveKind::Cycle, { { 8, 0, 1 }, { 8, 1, 0 }, { 9, 0, 0 } } },
    { CurveKind::Connection, { { 3, 0, 0 }, { 4, 5, 1 } } } };
  whole.sizes = { { Vector3(0, 0, 0), 0.1, 0.5, 0 } };
  std::vector<ComponentPart> parts = partsOf(whole);
  PreparedSurface joined = withoutElements(whole);
  std::size_t valences = 0;
  for (const ComponentPart& part : parts)
  {
    const double middle = part.surface.mesh.middleOfFace(0).x();
    const bool isFirst = middle<2, isSphere = middle> 6;
    ASSERT_EQ(part.surface.curves.size(), isFirst ? 0U : 1U);
    EXPECT_EQ(
      part.curves, isFirst ? std::vector<Index>{} : std::vector<Index>{ isSphere ? 0U : 1U });
    EXPECT_EQ(part.surface.sizes.size(), isFirst ? 1U : 0U);
    EXPECT_EQ(part.surface.valenceRequests.size(), isFirst ? 0U : 1U);
    for (const ValenceRequest& request : part.surface.valenceRequests)
    {
      EXPECT_EQ(part.surface.mesh.position[request.vertex],
        whole.mesh.position[isSphere ? atSphere : atCube]);
      ++valences;
    }
    appendSurface(part.surface, joined);
  }
  EXPECT_EQ(valences, 2U);
  ASSERT_EQ(joined.valenceRequests.size(), 2U);
  EXPECT_EQ(joined.curves.size(), 2U);
  for (const ValenceRequest& request : joined.valenceRequests)
  {
    const Vector3& p = joined.mesh.position[request.vertex];
    EXPECT_TRUE(p == whole.mesh.position[atCube] || p == whole.mesh.position[atSphere]);
  }
}

} // namespace
} // namespace quadrille

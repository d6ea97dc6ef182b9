// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Angles.h"
#include "Base/Error.h"
#include "GridMap/Embed.h"
#include "GridMap/GridMap.h"
#include "GridMap/MapShape.h"
#include "GridMap/MeshParts.h"
#include "Mesh/Topology.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

using namespace quadrille;

namespace
{

/// Sheared, so that its map takes some steps; sharp edges are features.
Mesh shearedCube(int n, double shear = 0.2)
{
  Mesh mesh = test::unitCube(n);
  for (Vector3& p : mesh.position.editAll())
  {
    p.x() += shear * (p.y() + 0.5 * std::sin(5 * p.z()));
  }
  return test::markFeatures(std::move(mesh), 0.6);
}

Mesh row(const Mesh& one, int count)
{
  Mesh mesh = one;
  for (int i = 1; i < count; ++i)
  {
    mesh = test::disjointUnion(std::move(mesh), one, Vector3(4.0 * i, 0, 0));
  }
  return mesh;
}

GridMapResult mapOf(const Mesh& mesh, double quads)
{
  GridMapOptions options;
  options.edgeLength = 0.25;
  options.targetQuads = quads;
  return computeGridMap(mesh, options);
}

/// Of each boundary loop, in quads.
std::vector<double> loopLengths(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  std::vector<double> lengths;
  std::vector<bool> seen(mesh.halfEdgeCount(), false);
  for (Index first = 0; first < mesh.halfEdgeCount(); ++first)
  {
    if (!mesh.isBoundary(first) || seen[first])
    {
      continue;
    }
    std::int64_t length = 0;
    for (Index h = first; !seen[h];)
    {
      seen[h] = true;
      const FixedVec2 along = uv[Mesh::next(h)] - uv[h];
      length += std::abs(along.u) + std::abs(along.v);
      h = Mesh::next(h);
      while (!mesh.isBoundary(h))
      {
        h = Mesh::next(mesh.twin[h]);
      }
    }
    lengths.push_back(static_cast<double>(length) / static_cast<double>(kOne));
  }
  return lengths;
}

} // namespace

/// Two quads round a loop would be joined along it, one with itself.
TEST(GridMap, BoundaryLoopsHaveThreeQuads)
{
  for (const double circumference : { 0.2, 1.0, 1.4, 2.2 })
  {
    const double radius = circumference / (2 * test::kPi);
    const Mesh mesh = test::openCylinder(12, 60, radius, 5);
    GridMapOptions options;
    options.edgeLength = 1;
    options.targetQuads = 5 * std::max(1.0, circumference);
    const GridMapResult result = computeGridMap(mesh, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    const std::vector<double> lengths = loopLengths(mesh, result.uv);
    ASSERT_EQ(lengths.size(), 2U);
    EXPECT_GE(*std::min_element(lengths.begin(), lengths.end()), 3) << circumference;
  }
}

TEST(GridMap, ManyComponentsCostTheirSum)
{
  constexpr int kCount = 39;
  constexpr double kQuads = 110;
  const Mesh easy = test::gridPlane(8, 8);
  const Mesh hard = shearedCube(4, 0.8);
  const std::size_t easyWork = mapOf(easy, kQuads).work;
  const std::size_t hardWork = mapOf(hard, kQuads).work;
  // Else a solve of everything at once, which goes on as long as its hardest part, would cost no more.
  ASSERT_GE(hardWork, 2 * easyWork);
  const Mesh mesh = test::disjointUnion(row(easy, kCount), hard, Vector3(-4, 0, 0));
  const GridMapResult many = mapOf(mesh, (kCount + 1) * kQuads);
  ASSERT_TRUE(many.status.ok()) << many.status.message;
  EXPECT_TRUE(many.certificate.valid()) << many.certificate.text();
  EXPECT_EQ(many.components, static_cast<std::size_t>(kCount + 1));
  EXPECT_EQ(many.failedComponents, 0U);
  // The components have other places and scales than alone, which may cost or save some steps of the hard one.
  EXPECT_LE(many.work, kCount * easyWork + 2 * hardWork);
}

TEST(GridMap, ComponentsGetQuadsByTheirArea)
{
  Mesh big = shearedCube(8);
  for (Vector3& p : big.position.editAll())
  {
    p *= 4;
  }
  const Mesh mesh = test::disjointUnion(big, shearedCube(4), Vector3(16, 0, 0));
  const GridMapResult result = mapOf(mesh, 17 * 110);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  double area[2] = { 0, 0 };
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const FixedVec2* p = &result.uv[3 * f];
    area[f < big.faceCount() ? 0 : 1] +=
      static_cast<double>(determinant(p[0], p[1], p[2])) / double(kOne) / double(kOne) / 2;
  }
  // 16 : 1 on the surface; the small cube rounds its twelve edges to whole numbers of about 4 quads.
  EXPECT_NEAR(area[0], 16 * 110, 0.06 * 16 * 110);
  EXPECT_NEAR(area[1], 110, 0.3 * 110);
}

TEST(GridMap, AMeshThatIsNoCoarseLevelIsRefusedAtOnce)
{
  const Mesh mesh = test::torus(30, 15);
  GridMapOptions options;
  options.edgeLength = 0.3;
  options.maximumVertices = 449;
  const GridMapResult refused = computeGridMap(mesh, options);
  EXPECT_EQ(refused.status.code, StatusCode::TooLarge);
  EXPECT_NE(refused.status.message.find("450 vertices"), std::string::npos)
    << refused.status.message;
  EXPECT_TRUE(refused.uv.empty());
  options.maximumVertices = 450;
  const GridMapResult result = computeGridMap(mesh, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.certificate.valid()) << result.certificate.text();
}

TEST(GridMap, MethodsKeepWhatTheyPromise)
{
  const Mesh mesh = test::disjointUnion(shearedCube(8), test::sphere(3), Vector3(4, 0, 0));
  GridMapOptions options;
  options.edgeLength = 0.25;
  options.targetQuads = 400;
  for (const MapMethod method :
    { MapMethod::ScaleAware, MapMethod::MixedInteger, MapMethod::QuadCover, MapMethod::Seamless })
  {
    options.method = method;
    const GridMapResult result = computeGridMap(mesh, options);
    const Certificate& c = result.certificate;
    EXPECT_TRUE(result.status.ok()) << nameOf(method) << ": " << result.status.message;
    EXPECT_TRUE(hasPromised(c, method)) << nameOf(method) << ": " << c.text();
    EXPECT_EQ(c.whole(), method != MapMethod::Seamless) << nameOf(method) << ": " << c.text();
    EXPECT_NEAR(c.area, 400, method == MapMethod::Seamless ? 1e-2 : 0.1 * 400) << nameOf(method);
    EXPECT_EQ(computeGridMap(mesh, options).uv, result.uv) << nameOf(method);
  }
}

TEST(GridMap, RoundingMayFoldWhereTheScaleAwareMethodDoesNot)
{
  const Mesh mesh = test::markFeatures(test::doubleTorus(3), 0.7);
  GridMapOptions options;
  options.edgeLength = 1;
  options.targetQuads = 37;
  for (const MapMethod method : { MapMethod::MixedInteger, MapMethod::QuadCover })
  {
    options.method = method;
    const GridMapResult result = computeGridMap(mesh, options);
    EXPECT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_GT(result.certificate.notPositive, 0u) << nameOf(method);
    EXPECT_TRUE(result.certificate.whole()) << result.certificate.text();
  }
  options.method = MapMethod::ScaleAware;
  const GridMapResult result = computeGridMap(mesh, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.certificate.valid()) << result.certificate.text();
}

TEST(GridMap, AnAnisotropyLimitLowersTheShareBeyondIt)
{
  constexpr double kLimit = 2;
  const Mesh mesh =
    test::disjointUnion(shearedCube(8, 0.8), test::gridPlane(6, 6), Vector3(4, 0, 0));
  GridMapOptions options;
  options.edgeLength = 0.25;
  options.targetQuads = 900;
  for (const MapMethod method : { MapMethod::ScaleAware, MapMethod::Seamless })
  {
    options.method = method;
    options.anisotropyLimit = 0;
    const GridMapResult off = computeGridMap(mesh, options);
    options.anisotropyLimit = kLimit;
    const GridMapResult on = computeGridMap(mesh, options);
    ASSERT_TRUE(off.status.ok() && on.status.ok()) << on.status.message;
    EXPECT_TRUE(hasPromised(on.certificate, method)) << on.certificate.text();
    const double before = shareBeyondRatio(mesh, off.uv, kLimit);
    EXPECT_GT(before, 0.01) << nameOf(method);
    EXPECT_EQ(on.beyondAnisotropyLimit, shareBeyondRatio(mesh, on.uv, kLimit));
    EXPECT_LT(on.beyondAnisotropyLimit, 0.7 * before) << nameOf(method);
    EXPECT_EQ(off.beyondAnisotropyLimit, 0);
    EXPECT_EQ(computeGridMap(mesh, options).uv, on.uv);
  }
}

TEST(GridMap, TheEmbeddingKeepsTheLimitToo)
{
  const Mesh mesh = shearedCube(8, 0.8);
  GridMapOptions options;
  options.edgeLength = 0.25;
  options.targetQuads = 400;
  const GridMapResult map = computeGridMap(mesh, options);
  ASSERT_TRUE(map.status.ok());
  EmbedOptions embedOptions;
  embedOptions.edgeLength = options.edgeLength;
  const EmbedResult off = embedMap(mesh, map.field, map.uv, embedOptions);
  embedOptions.anisotropyLimit = 1.8;
  const EmbedResult on = embedMap(mesh, map.field, map.uv, embedOptions);
  ASSERT_TRUE(off.status.ok() && on.status.ok());
  EXPECT_GT(on.newtonSteps, off.newtonSteps);
  EXPECT_LT(shareBeyondRatio(mesh, on.uv, 1.8), 0.9 * shareBeyondRatio(mesh, off.uv, 1.8));
}

TEST(GridMap, RefusesAnAnisotropyLimitThatIsNone)
{
  const Mesh mesh = test::gridPlane(4, 4);
  GridMapOptions options;
  options.edgeLength = 1;
  for (const double limit : { 0.5, -2.0, std::numeric_limits<double>::infinity(),
         std::numeric_limits<double>::quiet_NaN() })
  {
    options.anisotropyLimit = limit;
    EXPECT_THROW(computeGridMap(mesh, options), InvalidInput) << limit;
  }
  options.anisotropyLimit = 2;
  options.method = MapMethod::QuadCover;
  EXPECT_THROW(computeGridMap(mesh, options), InvalidInput);
  EXPECT_THROW(shareBeyondRatio(mesh, {}, 2), InvalidInput);
}

TEST(GridMap, TheShareBeyondARatioIsThatOfTheArea)
{
  Mesh mesh = test::gridPlane(4, 1);
  std::vector<FixedVec2> uv(mesh.origin.size());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    // The first of four columns is three times as wide as it should be, the others keep their shape.
    const Vector3& p = mesh.position[mesh.origin[h]];
    const double first = mesh.position[1].x() - mesh.position[0].x();
    uv[h] = toFixed(Vector2(p.x() > 0.5 * first ? p.x() + 2 * first : p.x(), p.y()));
  }
  EXPECT_NEAR(shareBeyondRatio(mesh, uv, 2.9), 0.25, 1e-9);
  EXPECT_NEAR(shareBeyondRatio(mesh, uv, 3.1), 0, 1e-9);
}

TEST(MeshParts, KeepTheMeshAndTheField)
{
  const Mesh one = shearedCube(3);
  const Mesh mesh = test::disjointUnion(one, test::gridPlane(4, 3), Vector3(4, 0, 0));
  CrossFieldOptions options;
  options.targetEdgeLength = 0.3;
  const CrossField field = computeCrossField(mesh, options);
  ASSERT_TRUE(field.status.ok()) << field.status.message;
  const std::vector<MeshPart> parts = splitIntoParts(mesh, field);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].mesh.faceCount() + parts[1].mesh.faceCount(), mesh.faceCount());
  EXPECT_EQ(parts[0].mesh.vertexCount(), one.vertexCount());
  for (const MeshPart& part : parts)
  {
    EXPECT_EQ(validate(part.mesh), "");
    for (Index h = 0; h < part.mesh.halfEdgeCount(); ++h)
    {
      const Index whole = 3 * part.face[Mesh::face(h)] + h % 3;
      EXPECT_EQ(part.vertex[part.mesh.origin[h]], mesh.origin[whole]);
      EXPECT_EQ(part.mesh.isConstrained(h), mesh.isConstrained(whole));
      EXPECT_EQ(part.field.matching[h], field.matching[whole]);
      EXPECT_EQ(part.field.alignment[h], field.alignment[whole]);
      EXPECT_EQ(part.field.sectorTurns[h], field.sectorTurns[whole]);
      EXPECT_EQ(part.field.turns[part.mesh.origin[h]], field.turns[mesh.origin[whole]]);
    }
  }
}

namespace
{

GridMapResult coarsest(const Mesh& mesh, double quads, double pull = 0)
{
  GridMapOptions options;
  options.edgeLength = 0.25;
  options.targetQuads = quads;
  options.pull = pull;
  return computeGridMap(mesh, options);
}

} // namespace

TEST(GridMap, SmallestIntegersOfABoxAreOneQuadASide)
{
  const Mesh box =
    test::markFeatures(test::voxelSurface({ 3, 2, 1 }, 3, [](int, int, int) { return true; }), 0.6);
  const GridMapResult few = coarsest(box, 500);
  ASSERT_TRUE(few.status.ok()) << few.status.message;
  EXPECT_TRUE(few.certificate.valid()) << few.certificate.text();
  EXPECT_EQ(few.certificate.area, 6);
  const GridMapResult many = coarsest(box, 500, 1);
  ASSERT_TRUE(many.status.ok()) << many.status.message;
  EXPECT_NEAR(many.certificate.area, 500, 75);
  const GridMapResult between = coarsest(box, 500, 0.5);
  ASSERT_TRUE(between.status.ok()) << between.status.message;
  EXPECT_NEAR(between.certificate.area, 125, 40);
}

TEST(GridMap, SmallestIntegersAreValidOnCurvedSurfaces)
{
  const Mesh cylinder = test::openCylinder(24, 8);
  const Mesh ball = test::sphere(3);
  const Mesh ring = test::torus(24, 12);
  for (const Mesh* mesh : { &cylinder, &ball, &ring })
  {
    const GridMapResult few = coarsest(*mesh, 400);
    ASSERT_TRUE(few.status.ok()) << few.status.message;
    EXPECT_TRUE(few.certificate.valid()) << few.certificate.text();
    EXPECT_LE(few.certificate.area, 30);
  }
}

namespace
{

/// In the planes of the faces of a mesh in the plane z = 0: `factor` along the x axis.
std::vector<Eigen::Matrix2d> stretchAlongX(const Mesh& mesh, double factor)
{
  std::vector<Eigen::Matrix2d> stretch;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector3 axis = mesh.edgeVector(3 * f).normalized();
    const Vector2 x(axis.x(), -axis.y());
    stretch.emplace_back(Eigen::Matrix2d::Identity() + (factor - 1) * x * x.transpose());
  }
  return stretch;
}

} // namespace

TEST(GridMap, AStretchedPlaneGetsQuadsForWhatItStandsFor)
{
  const Mesh mesh = test::gridPlane(10, 10);
  GridMapOptions options;
  options.edgeLength = 1;
  options.targetQuads = 200;
  options.stretch = stretchAlongX(mesh, 2);
  const GridMapResult map = computeGridMap(mesh, options);
  ASSERT_TRUE(map.status.ok()) << map.status.message;
  EXPECT_NEAR(map.certificate.area, 200, 1e-9);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3 edge = mesh.edgeVector(h);
    const Vector2 mapped = toDouble(map.uv[Mesh::next(h)] - map.uv[h]);
    EXPECT_NEAR(mapped.squaredNorm(), 4 * edge.x() * edge.x() + edge.y() * edge.y(), 1e-4);
  }
}

TEST(GridMap, ComponentsShareQuadsByWhatTheyStandFor)
{
  const Mesh one = test::gridPlane(10, 10);
  const Mesh mesh = test::disjointUnion(one, one, Vector3(20, 0, 0));
  GridMapOptions options;
  options.edgeLength = 1;
  options.targetQuads = 500;
  options.stretch.assign(mesh.faceCount(), Eigen::Matrix2d::Identity());
  for (Index f = one.faceCount(); f < mesh.faceCount(); ++f)
  {
    options.stretch[f] *= 2;
  }
  const GridMapResult map = computeGridMap(mesh, options);
  ASSERT_TRUE(map.status.ok()) << map.status.message;
  double areas[2] = {};
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector2 p = toDouble(map.uv[3 * f + 1] - map.uv[3 * f]);
    const Vector2 q = toDouble(map.uv[3 * f + 2] - map.uv[3 * f]);
    areas[f < one.faceCount() ? 0 : 1] += 0.5 * (p.x() * q.y() - p.y() * q.x());
  }
  EXPECT_NEAR(areas[0], 100, 1e-9);
  EXPECT_NEAR(areas[1], 400, 1e-9);
}

TEST(GridMap, AStretchForEachFaceOrNone)
{
  const Mesh mesh = test::gridPlane(4, 4);
  GridMapOptions options;
  options.edgeLength = 1;
  options.stretch.assign(3, Eigen::Matrix2d::Identity());
  EXPECT_THROW(computeGridMap(mesh, options), InvalidInput);
}

TEST(GridMap, AUniformStretchChangesNothing)
{
  const Mesh mesh = shearedCube(4);
  GridMapOptions options;
  options.edgeLength = 0.25;
  options.targetQuads = 150;
  const GridMapResult flat = computeGridMap(mesh, options);
  ASSERT_TRUE(flat.status.ok()) << flat.status.message;
  options.stretch.assign(mesh.faceCount(), 2 * Eigen::Matrix2d::Identity());
  const GridMapResult stretched = computeGridMap(mesh, options);
  ASSERT_TRUE(stretched.status.ok()) << stretched.status.message;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    EXPECT_LT(toDouble(stretched.uv[h] - flat.uv[h]).norm(), 1e-6);
  }
}

/// A circle of six quads would be a hexagon, and is one where it is rounded to the nearest whole number. As many quads
/// are asked for as fit the length, so that those on the circle are a little longer than it would have them.
TEST(GridMap, SmallCirclesGetMoreEdges)
{
  struct Tube
  {
    double radius, least, most;
  };
  for (const Tube& circle : { Tube{ 1, 8, 10 }, Tube{ 1.5, 10, 12 }, Tube{ 4, 24, 26 } })
  {
    const Mesh mesh = test::openCylinder(24, 12, circle.radius, 6);
    GridMapOptions options;
    options.edgeLength = 1;
    options.targetQuads = 2 * kPi * circle.radius * 6;
    const GridMapResult result = computeGridMap(mesh, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    for (const double edges : loopLengths(mesh, result.uv))
    {
      EXPECT_GE(edges, circle.least) << circle.radius;
      EXPECT_LE(edges, circle.most) << circle.radius;
    }
  }
}

TEST(GridMap, AnEdgeIsAsLongAsBothItsFacesMakeIt)
{
  const Mesh mesh = test::gridPlane(2, 1);
  CrossField field;
  field.stretch = stretchAlongX(mesh, 2);
  const Index last = mesh.faceCount() - 1;
  field.stretch[last] = Eigen::Matrix2d::Identity();
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3 edge = mesh.edgeVector(h);
    const double twice = std::hypot(2 * edge.x(), edge.y());
    const double own = Mesh::face(h) == last ? edge.norm() : twice;
    const bool mixed =
      !mesh.isBoundary(h) && (Mesh::face(h) == last || Mesh::face(mesh.twin[h]) == last);
    EXPECT_NEAR(stretchedLength(mesh, field, h), mixed ? 0.5 * (edge.norm() + twice) : own, 1e-12);
  }
  field.stretch.clear();
  EXPECT_EQ(stretchedLength(mesh, field, 0), mesh.edgeVector(0).norm());
}

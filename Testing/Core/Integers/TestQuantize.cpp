// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/MapCheck.h"
#include "Integers/LockedVertices.h"
#include "Integers/Quantize.h"
#include "Integers/QuantizeIntegers.h"
#include "Integers/UvDecimation.h"
#include "SyntheticMaps.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace quadrille::test
{
namespace
{

struct Case
{
  std::string name;
  SyntheticMap map;
};

/// blockLength: about how many quads a block of the shape is long.
std::vector<Case> cases(double blockLength)
{
  const double b = blockLength;
  std::vector<Case> result;
  result.push_back({ "cube", axisAlignedMap(unitCube(5), 1, 5, b, 1) });
  result.push_back(
    { "cube with features", axisAlignedMap(markFeatures(unitCube(5), 0.7), 1, 5, b, 1) });
  result.push_back({ "staircase", staircaseMap(4, 4, 4, 4, b, false, 2) });
  result.push_back({ "staircase with features", staircaseMap(4, 4, 4, 4, b, true, 2) });
  result.push_back({ "genus 2", axisAlignedMap(doubleTorus(4), 5, 4, b, 3) });
  result.push_back(
    { "genus 2 with features", axisAlignedMap(markFeatures(doubleTorus(4), 0.7), 5, 4, b, 3) });
  result.push_back({ "plate with hole", plateMap(plateWithHole(5), 3, 5, b, 4) });
  result.push_back({ "plate L", plateMap(plateL(6), 2, 6, b, 5) });
  result.push_back(
    { "torus", torusMap(24, 12, Vector2(5.3 * b, 1.7 * b), Vector2(-0.9 * b, 3.4 * b), 6) });
  return result;
}

double uvArea(const std::vector<FixedVec2>& uv)
{
  double area = 0;
  for (std::size_t h = 0; h < uv.size(); h += 3)
  {
    const Vector2 a = toDouble(uv[h + 1] - uv[h]), b = toDouble(uv[h + 2] - uv[h]);
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return area;
}

/// Transitions whole and exact, isolines whole, integer vertices at integers: all but the determinants.
void expectWhole(const SyntheticMap& map, const std::vector<FixedVec2>& uv)
{
  const std::vector<std::uint8_t> integer = integerVertices(map.mesh, map.field);
  for (Index h = 0; h < map.mesh.halfEdgeCount(); ++h)
  {
    const FixedVec2 a = uv[h], b = uv[Mesh::next(h)];
    if (integer[map.mesh.origin[h]])
    {
      EXPECT_TRUE(isInteger(a)) << "corner " << h;
    }
    if (map.mesh.isConstrained(h))
    {
      const int axis = map.field.alignment[h];
      EXPECT_TRUE(axis % 2 == 0 ? a.v == b.v && isInteger(a.v) : a.u == b.u && isInteger(a.u)) << h;
      // Along the axis it was aligned with, never backwards.
      const FixedVec2 turned = rotate(b - a, -axis);
      EXPECT_GT(turned.u, 0) << h;
    }
    if (!map.mesh.isBoundary(h))
    {
      const Index g = map.mesh.twin[h];
      const int r = map.field.matching[h];
      const FixedVec2 translation = uv[Mesh::next(g)] - rotate(a, r);
      EXPECT_TRUE(isInteger(translation)) << h;
      EXPECT_EQ(uv[g], rotate(b, r) + translation) << h;
    }
  }
}

TEST(UvMesh, UndoRestoresTheMap)
{
  for (const Case& c : cases(6.3))
  {
    SCOPED_TRACE(c.name);
    UvMesh mesh = UvMesh::from(c.map.mesh, c.map.field, c.map.uv);
    const UvMesh before = mesh;
    UvEditor editor(mesh);
    LockedVertices locked =
      lockedVertices(c.map.mesh, mesh, integerVertices(c.map.mesh, c.map.field), {});
    decimateInUv(mesh, editor, locked.keep);
    editor.undoTo(0, locked.keep);
    EXPECT_EQ(mesh.origin, before.origin);
    EXPECT_EQ(mesh.twin, before.twin);
    EXPECT_EQ(mesh.rotation, before.rotation);
    EXPECT_EQ(mesh.flags, before.flags);
    EXPECT_EQ(mesh.alive, before.alive);
    std::int64_t farthest = 0;
    for (Index h = 0; h < mesh.origin.size(); ++h)
    {
      const FixedVec2 d = mesh.vector(h) - before.vector(h);
      farthest = std::max({ farthest, std::abs(d.u), std::abs(d.v) });
    }
    // Every removed vertex is rounded once from corners that were rounded themselves, some fifty levels deep,
    // and its weights (2^-32) are exact to 2^-8 grid steps per quad of length.
    EXPECT_LE(farthest, 64);
  }
}

TEST(UvMesh, DecimationKeepsWhatItMust)
{
  for (const Case& c : cases(6.3))
  {
    SCOPED_TRACE(c.name);
    UvMesh mesh = UvMesh::from(c.map.mesh, c.map.field, c.map.uv);
    UvEditor editor(mesh);
    const std::vector<std::uint8_t> integer = integerVertices(c.map.mesh, c.map.field);
    std::vector<std::uint8_t> keep = lockedVertices(c.map.mesh, mesh, integer, {}).keep;
    const auto wanted = std::count(keep.begin(), keep.end(), 1);
    decimateInUv(mesh, editor, keep);
    for (Index v = 0; v < keep.size(); ++v)
    {
      EXPECT_TRUE(!integer[v] || keep[v]) << v;
    }
    // Only where a star touches itself may another vertex stay.
    EXPECT_LE(std::count(keep.begin(), keep.end(), 1), wanted + 2);
    for (Index h = 0; h < mesh.origin.size(); ++h)
    {
      if (!mesh.alive[Mesh::face(h)])
      {
        continue;
      }
      EXPECT_GT(mesh.faceDeterminant(Mesh::face(h)), 0);
      const Index g = mesh.twin[h];
      if (g != kInvalidIndex)
      {
        EXPECT_EQ(mesh.twin[g], h);
        EXPECT_EQ(mesh.target(g), mesh.origin[h]);
        EXPECT_EQ(mesh.vector(g), -rotate(mesh.vector(h), mesh.rotation[h]));
        EXPECT_EQ(mesh.flags[g], mesh.flags[h]);
      }
      if ((mesh.flags[h] & kUvConstrained) != 0)
      {
        EXPECT_TRUE(mesh.vector(h).u == 0 || mesh.vector(h).v == 0);
      }
    }
  }
}

TEST(Quantize, IntegersAreClosedPositiveAndWind)
{
  for (const double blockLength : { 0.5, 1.0, 2.9 })
  {
    for (const Case& c : cases(blockLength))
    {
      SCOPED_TRACE(c.name + " " + std::to_string(blockLength));
      UvMesh mesh = UvMesh::from(c.map.mesh, c.map.field, c.map.uv);
      UvEditor editor(mesh);
      LockedVertices locked =
        lockedVertices(c.map.mesh, mesh, integerVertices(c.map.mesh, c.map.field), {});
      decimateInUv(mesh, editor, locked.keep);
      IntegerMap integers(mesh, editor, locked.integer);
      ASSERT_TRUE(findValidIntegers(integers, {}).valid);
      EXPECT_TRUE(integers.isValid());
      const double energy = integers.energy();
      improveIntegers(integers, {});
      EXPECT_TRUE(integers.isValid());
      // A new triangulation measures other edges; otherwise it only falls.
      EXPECT_LE(integers.energy(), 1.5 * energy + 1);
      for (const Index f : integers.faces())
      {
        for (Index h = 3 * f; h < 3 * f + 3; ++h)
        {
          if (mesh.twin[h] != kInvalidIndex)
          {
            EXPECT_EQ(integers[mesh.twin[h]], -rotate(integers[h], mesh.rotation[h]));
          }
          EXPECT_TRUE(!locked.integer[mesh.origin[h]] || !locked.integer[mesh.target(h)] ||
            (integers[h].u % kGrain == 0 && integers[h].v % kGrain == 0))
            << h;
        }
      }
    }
  }
}

/// On a staircase of boundary corners a step backwards would leave every triangle positive, with corners of one and
/// three quarter turns exchanged.
TEST(Quantize, CurvesAreNeverRunBackwards)
{
  const SyntheticMap map = staircaseMap(4, 4, 4, 3, 3.3, true, 8);
  UvMesh mesh = UvMesh::from(map.mesh, map.field, map.uv);
  UvEditor editor(mesh);
  LockedVertices locked = lockedVertices(map.mesh, mesh, integerVertices(map.mesh, map.field), {});
  decimateInUv(mesh, editor, locked.keep);
  IntegerMap integers(mesh, editor, locked.integer);
  integers.round(1);
  int edges = 0;
  for (const Index f : integers.faces())
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      if ((mesh.flags[h] & kUvConstrained) != 0)
      {
        ++edges;
        const FixedVec2 q = integers[h];
        EXPECT_TRUE(integers.mayShift(h, q)) << h;
        EXPECT_FALSE(integers.mayShift(h, -q)) << h;
        EXPECT_FALSE(integers.mayShift(h, FixedVec2{ -2 * q.u, -2 * q.v })) << h;
        EXPECT_FALSE(integers.mayShift(h, FixedVec2{ q.v, q.u })) << h;
      }
    }
  }
  EXPECT_GT(edges, 10);
}

TEST(Quantize, ShrinksAStartThatIsTooLarge)
{
  const SyntheticMap map = staircaseMap(4, 4, 4, 3, 3.3, true, 8);
  const auto areaFrom = [&](double scale)
  {
    UvMesh mesh = UvMesh::from(map.mesh, map.field, map.uv);
    UvEditor editor(mesh);
    LockedVertices locked =
      lockedVertices(map.mesh, mesh, integerVertices(map.mesh, map.field), {});
    decimateInUv(mesh, editor, locked.keep);
    IntegerMap integers(mesh, editor, locked.integer);
    integers.round(scale);
    EXPECT_TRUE(repairIntegers(integers).valid);
    EXPECT_GT(integers.area(), 0.5 * scale * scale * uvArea(map.uv));
    improveIntegers(integers, {});
    EXPECT_TRUE(integers.isValid());
    return integers.area();
  };
  // A local search need not end in the same place; within a fifth of the area it has done its work.
  EXPECT_NEAR(areaFrom(8) / areaFrom(1), 1, 0.2);
}

TEST(Quantize, ResultIsWholeAndNearTheWantedSize)
{
  for (const double blockLength : { 0.5, 1.0, 2.9, 8.0 })
  {
    for (const Case& c : cases(blockLength))
    {
      SCOPED_TRACE(c.name + " " + std::to_string(blockLength));
      const QuantizeResult result = quantizeMap(c.map.mesh, c.map.field, c.map.uv, {});
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      expectWhole(c.map, result.uv);
      EXPECT_GE(result.refinement, 1);
      if (blockLength > 7)
      {
        // Errors are half a quad of about eight, in both directions of some of the fewest blocks.
        EXPECT_NEAR(uvArea(result.uv) / uvArea(c.map.uv), 1, 0.2);
      }
    }
  }
}

TEST(Quantize, KeepsAMapThatIsWholeAlready)
{
  SyntheticMap map = plateMap(plateWithHole(4), 3, 4, 5, 4);
  const QuantizeResult first = quantizeMap(map.mesh, map.field, map.uv, {});
  ASSERT_TRUE(first.status.ok());
  map.uv = first.uv;
  const QuantizeResult second = quantizeMap(map.mesh, map.field, map.uv, {});
  ASSERT_TRUE(second.status.ok());
  EXPECT_EQ(uvArea(first.uv), uvArea(second.uv));
  EXPECT_EQ(second.refinement, 1);
}

TEST(Quantize, IntegersLeaveRoomForWatchedVertices)
{
  for (const double length : { 0.6, 1.3, 2.4 })
  {
    for (const Case& c : cases(length))
    {
      SCOPED_TRACE(c.name + " " + std::to_string(length));
      QuantizeResult result = quantizeMap(c.map.mesh, c.map.field, c.map.uv, {});
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      QuantizeOptions options;
      options.anew = false;
      const auto badFaces = [&] { return findNotPositive(c.map.mesh, result.uv); };
      for (std::vector<Index> bad = badFaces(); !bad.empty(); bad = badFaces())
      {
        ASSERT_LT(options.watched.size(), 12U) << "few vertices have no place";
        for (const Index f : bad)
        {
          const auto corner = c.map.mesh.origin.begin() + 3 * f;
          options.watched.insert(options.watched.end(), corner, corner + 3);
        }
        const std::vector<FixedVec2> before = result.uv;
        options.previousUv = &before;
        result = quantizeMap(c.map.mesh, c.map.field, c.map.uv, options);
        ASSERT_TRUE(result.status.ok()) << result.status.message;
        EXPECT_TRUE(result.startedFromPrevious);
        expectWhole(c.map, result.uv);
      }
    }
  }
}

TEST(Quantize, IntegersOfAnotherScaleAreAStart)
{
  const std::vector<Case> large = cases(4.7), small = cases(2.9);
  for (std::size_t i = 0; i < large.size(); ++i)
  {
    SCOPED_TRACE(large[i].name);
    const QuantizeResult first =
      quantizeMap(large[i].map.mesh, large[i].map.field, large[i].map.uv, {});
    ASSERT_TRUE(first.status.ok());
    QuantizeOptions options;
    options.previousUv = &first.uv;
    options.anew = false;
    const QuantizeResult second =
      quantizeMap(small[i].map.mesh, small[i].map.field, small[i].map.uv, options);
    ASSERT_TRUE(second.status.ok()) << second.status.message;
    EXPECT_TRUE(second.startedFromPrevious);
    expectWhole(small[i].map, second.uv);
    const double wanted = uvArea(small[i].map.uv);
    EXPECT_LT(std::abs(uvArea(second.uv) / wanted - 1), 0.5);
  }
}

TEST(Quantize, OneSearchHasTheIntegersOfEachNumber)
{
  for (const Case& c : cases(6.3))
  {
    SCOPED_TRACE(c.name);
    Quantizer quantizer(c.map.mesh, c.map.field, c.map.uv, {});
    ASSERT_TRUE(quantizer.status().ok()) << quantizer.status().message;
    EXPECT_FALSE(quantizer.startedFromPrevious());
    for (const double pull : { 1.0, 0.6, 0.4, 1.0 })
    {
      SCOPED_TRACE(pull);
      quantizer.improve(pull, {});
      const QuantizeResult result = quantizer.result();
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      expectWhole(c.map, result.uv);
      EXPECT_NEAR(uvArea(result.uv), quantizer.area(), 1e-6 * quantizer.area());
      EXPECT_NEAR(quantizer.area() / (pull * pull * uvArea(c.map.uv)), 1, 0.35);
    }
  }
}

TEST(IntegerMap, CurvesThatBendKeepTheirNumber)
{
  const SyntheticMap map = plateMap(plateWithHole(4), 3, 4, 5, 4);
  UvMesh uvMesh = UvMesh::from(map.mesh, map.field, map.uv);
  UvEditor editor(uvMesh);
  std::vector<CurveShare> shares(uvMesh.origin.size());
  shares[0] = { 1.5, 0.25 };
  IntegerMap integers(uvMesh, editor, integerVertices(map.mesh, map.field), shares);
  const Vector2 bent = toDouble(uvMesh.vector(0)), other = toDouble(uvMesh.vector(1));
  EXPECT_EQ(integers.target(0), 1.75 * bent);
  EXPECT_EQ(integers.target(1), other);
  integers.setPull(0.5);
  EXPECT_EQ(integers.target(0), 1.625 * bent);
  EXPECT_EQ(integers.target(1), 0.5 * other);
}

/// A fan of eight sound triangles that goes round its middle twice: what is told is where that is.
TEST(IntegerMap, TrianglesThatWindTwiceAreTold)
{
  std::vector<Vector3> points{ Vector3(0, 0, 0) };
  std::vector<Triangle> triangles;
  const std::vector<std::pair<int, int>> ring{ { 1, -1 }, { 1, 0 }, { 1, 1 }, { 0, 1 }, { -1, 1 },
    { -1, 0 }, { -1, -1 }, { 0, -1 } };
  for (const auto& [x, y] : ring)
  {
    const auto k = static_cast<Index>(points.size());
    points.emplace_back(x, y, 0);
    triangles.push_back({ 0, k, k % 8 + 1 });
  }
  SyntheticMap map;
  map.mesh = makeMesh(points, triangles);
  for (Index h = 0; h < map.mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = map.mesh.position[map.mesh.origin[h]];
    map.uv.push_back(toFixed(Vector2(p.x(), p.y())));
  }
  map.field = fieldOf(map.mesh, map.uv);
  UvMesh uvMesh = UvMesh::from(map.mesh, map.field, map.uv);
  UvEditor editor(uvMesh);
  IntegerMap integers(uvMesh, editor, std::vector<std::uint8_t>(9, 1));
  integers.round(1);
  ASSERT_TRUE(integers.isValid());
  EXPECT_TRUE(integers.wrongWindings().empty());
  EXPECT_TRUE(brokenFaces(integers).empty());

  const auto spoke = [](Index k) { return rotate(FixedVec2{ kGrain, 0 }, static_cast<int>(k)); };
  for (Index h = 0; h < map.mesh.halfEdgeCount(); ++h)
  {
    const Index a = map.mesh.origin[h], b = map.mesh.target(h);
    if (a == 0 || map.mesh.isBoundary(h))
    {
      const FixedVec2 wanted = a == 0 ? spoke(b) : spoke(b) - spoke(a);
      integers.shift(h, wanted - integers[h]);
    }
  }
  for (const Index f : integers.faces())
  {
    EXPECT_EQ(integers.residual(f), FixedVec2{});
    EXPECT_TRUE(integers.isSound(f));
  }
  EXPECT_FALSE(integers.isValid());
  // The middle, and the vertices where the boundary went straight on.
  EXPECT_EQ(integers.wrongWindings(), (std::vector<Index>{ 0, 2, 4, 6, 8 }));
  EXPECT_EQ(brokenFaces(integers).size(), 8U);
}

TEST(IntegerMap, TrianglesOfAnotherMapCloseInAnyCharts)
{
  SyntheticMap map;
  map.mesh = plateL(3);
  std::vector<std::uint8_t> onBoundary(map.mesh.vertexCount(), 0);
  for (Index h = 0; h < map.mesh.halfEdgeCount(); ++h)
  {
    onBoundary[map.mesh.origin[h]] |= map.mesh.isBoundary(h) ? 1 : 0;
  }
  for (const bool isTurned : { false, true })
  {
    SCOPED_TRACE(isTurned);
    map.uv.clear();
    for (Index h = 0; h < map.mesh.halfEdgeCount(); ++h)
    {
      const Index v = map.mesh.origin[h];
      const Vector3& p = map.mesh.position[v];
      FixedVec2 corner = toFixed(Vector2(p.x(), p.y()));
      if (onBoundary[v] == 0)
      {
        // As far from one sixteenth as from the next.
        corner = corner + FixedVec2{ kOne / 32, 3 * kOne / 32 };
      }
      map.uv.push_back(rotate(corner, isTurned ? static_cast<int>(Mesh::face(h) % 4) : 0));
    }
    map.field = fieldOf(map.mesh, map.uv);
    UvMesh uvMesh = UvMesh::from(map.mesh, map.field, map.uv);
    UvEditor editor(uvMesh);
    IntegerMap integers(uvMesh, editor, integerVertices(map.mesh, map.field));
    ASSERT_TRUE(integers.adopt(map.uv));
    for (const Index f : integers.faces())
    {
      EXPECT_EQ(integers.residual(f), FixedVec2{}) << f;
    }
    EXPECT_TRUE(repairIntegers(integers).valid);
  }
}

TEST(Quantize, IsDeterministic)
{
  const SyntheticMap map = staircaseMap(4, 4, 4, 4, 2.2, true, 9);
  EXPECT_EQ(quantizeMap(map.mesh, map.field, map.uv, {}).uv,
    quantizeMap(map.mesh, map.field, map.uv, {}).uv);
}

TEST(Quantize, TellsTheGrowth)
{
  // Blocks of a fiftieth of a quad must become at least one quad.
  const SyntheticMap map = staircaseMap(4, 4, 4, 3, 0.02, true, 2);
  const QuantizeResult result = quantizeMap(map.mesh, map.field, map.uv, {});
  EXPECT_GT(result.refinement, 8);
  EXPECT_EQ(result.status.code, StatusCode::NotConverged);
  expectWhole(map, result.uv);
}

TEST(Quantize, RefusesWhatIsNotSeamless)
{
  SyntheticMap map = plateMap(plateL(4), 2, 4, 3, 5);
  auto folded = map.uv;
  std::swap(folded[0], folded[1]);
  EXPECT_EQ(quantizeMap(map.mesh, map.field, folded, {}).status.code, StatusCode::Infeasible);
  auto torn = map.uv;
  torn[0].u += 1;
  EXPECT_EQ(quantizeMap(map.mesh, map.field, torn, {}).status.code, StatusCode::Infeasible);
  EXPECT_THROW(quantizeMap(map.mesh, map.field, {}, {}), InvalidInput);
}

TEST(Quantize, CanBeCancelled)
{
  const SyntheticMap map = plateMap(plateL(4), 2, 4, 3, 5);
  QuantizeOptions options;
  options.progress = [](double, const std::string&) { return false; };
  EXPECT_THROW(quantizeMap(map.mesh, map.field, map.uv, options), Cancelled);
}

} // namespace
} // namespace quadrille::test

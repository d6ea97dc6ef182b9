// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/PreviousMap.h"

#include "Base/Error.h"
#include "GridMap/GridMap.h"
#include "GridMap/MapShape.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <numeric>

using namespace quadrille;

namespace
{

constexpr double kLength = 0.25;

/// Sheared, so that its map takes some steps; sharp edges are features.
Mesh slantedCube(int n)
{
  Mesh mesh = test::unitCube(n);
  for (Vector3& p : mesh.position.editAll())
  {
    p.x() += 0.4 * (p.y() + 0.5 * std::sin(5 * p.z()));
  }
  return test::markFeatures(std::move(mesh), 0.6);
}

/// A torus with waves, so that its field has irregular vertices.
Mesh wavyTorus()
{
  Mesh mesh = test::torus(40, 20);
  for (Vector3& p : mesh.position.editAll())
  {
    p += 0.12 * Vector3(std::sin(4 * p.z()), std::sin(3 * p.x()), std::cos(4 * p.y()));
  }
  return mesh;
}

std::vector<Index> ownIds(const Mesh& mesh)
{
  std::vector<Index> ids(mesh.vertexCount());
  std::iota(ids.begin(), ids.end(), Index{ 7 });
  return ids;
}

GridMapOptions optionsOf(const Mesh& mesh)
{
  GridMapOptions options;
  options.edgeLength = kLength;
  options.vertexIds = ownIds(mesh);
  return options;
}

/// The first `count` faces are guided along their first half-edge, turned by `turn` radians.
std::vector<Guide> guidesOf(const Mesh& mesh, Index count, double turn)
{
  std::vector<Guide> guides(mesh.faceCount());
  for (Index f = 0; f < count; ++f)
  {
    const Vector3 axis = mesh.edgeVector(3 * f).normalized();
    guides[f].direction = Eigen::AngleAxisd(turn, test::faceNormal(mesh, f)) * axis;
    guides[f].weight = 1;
  }
  return guides;
}

GridMapResult requireMap(const Mesh& mesh, const GridMapOptions& options)
{
  GridMapResult map = computeGridMap(mesh, options);
  EXPECT_TRUE(map.status.ok()) << map.status.message;
  EXPECT_TRUE(map.certificate.valid()) << map.certificate.text();
  return map;
}

/// The field in charts that are turned by any quarter turns.
CrossField turnedCharts(const Mesh& mesh, CrossField field)
{
  const auto turnsOf = [](Index f) { return static_cast<int>(f * 7 % 4); };
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const int here = turnsOf(Mesh::face(h));
    if (field.alignment[h] >= 0)
    {
      field.alignment[h] = static_cast<std::int8_t>((field.alignment[h] + here) & 3);
    }
    if (!mesh.isBoundary(h))
    {
      const int there = turnsOf(Mesh::face(mesh.twin[h]));
      field.matching[h] = static_cast<std::int8_t>((field.matching[h] + there - here) & 3);
    }
  }
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    field.angle[f] -= turnsOf(f) * test::kPi / 2;
  }
  return field;
}

/// The mesh with one inner edge flipped.
Mesh flipped(Mesh mesh, Index h)
{
  const Index g = mesh.twin[h];
  const std::array<Index, 4> v = { mesh.origin[h], mesh.target(h), mesh.origin[Mesh::previous(h)],
    mesh.origin[Mesh::previous(g)] };
  const auto set = [&](Index f, const std::array<Index, 3>& corners)
  { std::copy(corners.begin(), corners.end(), mesh.origin.edit() + 3 * f); };
  set(Mesh::face(h), { v[0], v[3], v[2] });
  set(Mesh::face(g), { v[1], v[2], v[3] });
  mesh.twin = pairHalfEdges(mesh.origin, mesh.vertexCount());
  mesh.flags.assign(mesh.origin.size(), 0);
  return mesh;
}

} // namespace

TEST(PreviousMap, CarriedIntoTurnedChartsItIsAMapAlongThem)
{
  for (const Mesh& mesh : { slantedCube(6), wavyTorus() })
  {
    const GridMapResult map = requireMap(mesh, optionsOf(mesh));
    const PreviousMap previous = previousMap(mesh, map, ownIds(mesh));
    const CrossField turned = turnedCharts(mesh, map.field);
    const CarriedMap carried = MapCarrier(previous).carry(mesh, turned, ownIds(mesh));
    EXPECT_TRUE(carried.isMap);
    EXPECT_EQ(carried.knownFaces, mesh.faceCount());
    EXPECT_NE(carried.uv, map.uv);
    EXPECT_EQ(matchingOf(mesh, carried.uv, 1), turned.matching);
    const Certificate certificate =
      certify(mesh, carried.uv, turned.turns, integerVertices(mesh, turned));
    EXPECT_TRUE(certificate.valid()) << certificate.text();
  }
}

TEST(PreviousMap, ShapesTurnWithTheField)
{
  constexpr double kTurn = 0.3;
  const Mesh mesh = wavyTorus();
  const GridMapResult map = requireMap(mesh, optionsOf(mesh));
  const PreviousMap previous = previousMap(mesh, map, ownIds(mesh));
  CrossField turned = map.field;
  for (double& angle : turned.angle)
  {
    angle -= kTurn;
  }
  const CarriedMap carried = MapCarrier(previous).carry(mesh, turned, ownIds(mesh));
  ASSERT_TRUE(carried.isMap);
  ASSERT_EQ(carried.knownFaces, mesh.faceCount());
  const auto directionOf = [](const UntangleProblem& problem, Index f)
  {
    const Eigen::Matrix2d reference = problem.inverseReference[f].inverse();
    return std::atan2(reference(1, 0), reference(0, 0));
  };
  UntangleProblem before, after;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    addTriangle(before, { 3 * f, 3 * f + 1, 3 * f + 2 }, mesh, map.field, f, 0, kLength);
    addTriangle(after, { 3 * f, 3 * f + 1, 3 * f + 2 }, mesh, turned, f, 0, kLength);
  }
  const UntangleProblem nearby = referToMap(after, carried, carried.uv, {}, 1);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const double wanted = directionOf(after, f) - directionOf(before, f);
    const Vector2 edge = toDouble(map.uv[3 * f + 1] - map.uv[3 * f]);
    const double moved = directionOf(nearby, f) - std::atan2(edge.y(), edge.x());
    EXPECT_NEAR(std::remainder(moved - wanted, 2 * test::kPi), 0, 1e-9) << f;
  }
}

TEST(PreviousMap, OtherTurnsOrEdgesAreNoMap)
{
  const Mesh mesh = wavyTorus();
  const GridMapResult map = requireMap(mesh, optionsOf(mesh));
  const PreviousMap previous = previousMap(mesh, map, ownIds(mesh));
  const MapCarrier carrier(previous);
  CrossField other = map.field;
  other.turns[3] += 4; // what the matchings cannot tell
  EXPECT_FALSE(carrier.carry(mesh, other, ownIds(mesh)).isMap);
  other = map.field;
  const Index h = 30;
  other.matching[h] = static_cast<std::int8_t>((other.matching[h] + 1) & 3);
  other.matching[mesh.twin[h]] = static_cast<std::int8_t>((other.matching[mesh.twin[h]] + 3) & 3);
  EXPECT_FALSE(carrier.carry(mesh, other, ownIds(mesh)).isMap);
  const CarriedMap some = carrier.carry(flipped(mesh, h), map.field, ownIds(mesh));
  EXPECT_FALSE(some.isMap);
  EXPECT_EQ(some.knownFaces, mesh.faceCount() - 2);
  Mesh moved = mesh;
  moved.position.edit()[0].x() += 1e-9;
  EXPECT_LT(carrier.carry(moved, map.field, ownIds(mesh)).knownFaces, mesh.faceCount());
}

TEST(PreviousMap, TheSameAgainKeepsItsIntegers)
{
  for (const Mesh& mesh : { slantedCube(6), wavyTorus() })
  {
    GridMapOptions options = optionsOf(mesh);
    const GridMapResult cold = requireMap(mesh, options);
    const PreviousMap previous = previousMap(mesh, cold, options.vertexIds);
    options.previous = &previous;
    const GridMapResult warm = requireMap(mesh, options);
    EXPECT_EQ(warm.reuse.faces, mesh.faceCount());
    EXPECT_EQ(warm.reuse.seamless, 1U);
    EXPECT_EQ(warm.reuse.integers, 1U);
    EXPECT_DOUBLE_EQ(warm.certificate.area, cold.certificate.area);
    EXPECT_LE(warm.seamlessSteps, cold.seamlessSteps);
    EXPECT_EQ(requireMap(mesh, options).uv, warm.uv) << "the same bytes every time";
  }
}

TEST(PreviousMap, ATurnedGuideStartsFromTheMapBefore)
{
  const Mesh mesh = wavyTorus();
  GridMapOptions options = optionsOf(mesh);
  options.guides = guidesOf(mesh, 12, 0);
  const GridMapResult before = requireMap(mesh, options);
  const PreviousMap previous = previousMap(mesh, before, options.vertexIds);
  options.guides = guidesOf(mesh, 12, 0.3);
  options.previous = &previous;
  const GridMapResult warm = requireMap(mesh, options);
  EXPECT_EQ(warm.reuse.faces, mesh.faceCount());
  EXPECT_EQ(warm.reuse.seamless, 1U);
}

TEST(PreviousMap, AnotherTriangulationKnowsTheOtherFaces)
{
  const Mesh mesh = wavyTorus();
  const GridMapResult before = requireMap(mesh, optionsOf(mesh));
  const PreviousMap previous = previousMap(mesh, before, ownIds(mesh));
  const Mesh changed = flipped(mesh, 600);
  GridMapOptions options = optionsOf(changed);
  options.previous = &previous;
  const GridMapResult warm = requireMap(changed, options);
  EXPECT_GT(warm.reuse.faces, mesh.faceCount() / 2);
  EXPECT_EQ(warm.reuse.integers, 0U);
}

TEST(PreviousMap, NothingOfItIsTrusted)
{
  const Mesh mesh = slantedCube(6);
  GridMapOptions options = optionsOf(mesh);
  const GridMapResult cold = requireMap(mesh, options);
  PreviousMap previous = previousMap(mesh, cold, options.vertexIds);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    // Positive triangles that fit nowhere.
    const int corner = static_cast<int>(h % 3);
    const std::int64_t size = kOne * (1 + Mesh::face(h) * 31 % 9);
    previous.uv[h] = { corner == 1 ? size : 0, corner == 2 ? 3 * size : 0 };
    previous.seamlessUv[h] = previous.uv[h];
  }
  options.previous = &previous;
  const GridMapResult warm = requireMap(mesh, options);
  EXPECT_GT(warm.reuse.faces, 0U);
  EXPECT_EQ(warm.reuse.integers, 0U);
  EXPECT_NEAR(warm.certificate.area, cold.certificate.area, 0.2 * cold.certificate.area);
}

TEST(PreviousMap, WrongSizesAreRefused)
{
  const Mesh mesh = slantedCube(4);
  GridMapOptions options = optionsOf(mesh);
  const GridMapResult map = requireMap(mesh, options);
  PreviousMap previous = previousMap(mesh, map, options.vertexIds);
  options.previous = &previous;
  options.vertexIds.pop_back();
  EXPECT_THROW(computeGridMap(mesh, options), InvalidInput);
  options.vertexIds = ownIds(mesh);
  previous.uv.pop_back();
  EXPECT_THROW(computeGridMap(mesh, options), InvalidInput);
}

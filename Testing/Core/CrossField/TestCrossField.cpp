// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/AngleStructure.h"
#include "CrossField/CrossField.h"
#include "CrossField/PowerField.h"
#include "CrossField/TurnRepair.h"
#include "CrossField/Turns.h"
#include "Mesh/Topology.h"
#include "TestMeshes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

constexpr double kFeatureAngle = 40 * kPi / 180;

CrossField fieldOf(const Mesh& mesh, double edgeLength = 0.2)
{
  CrossFieldOptions options;
  options.targetEdgeLength = edgeLength;
  return computeCrossField(mesh, options);
}

// Sum over interior (4 - turns) + boundary (2 - turns): 4 chi by Poincare and Hopf.
long long indexSum(const Mesh& mesh, const CrossField& field)
{
  const std::vector<std::uint8_t> boundary = boundaryVertices(mesh);
  long long sum = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    sum += (boundary[v] != 0 ? 2 : 4) - field.turns[v];
  }
  return sum;
}

// Sectors by their turns.
std::map<int, int> sectorHistogram(const Mesh& mesh, const CrossField& field)
{
  std::map<int, int> histogram;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isConstrained(h))
    {
      ++histogram[field.sectorTurns[h]];
    }
  }
  return histogram;
}

// The rotation that matchings and alignments make round vertices and within sectors has to be
// the turns modulo 4: this is what a map built on the field will see.
void expectTurnsMatchTransitions(const Mesh& mesh, const CrossField& field)
{
  std::vector<int> rotation(mesh.vertexCount(), 0);
  std::vector<int> sectorSum(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    rotation[mesh.target(h)] -= field.matching[h];
    sectorSum[mesh.origin[h]] += field.sectorTurns[h];
    if (!mesh.isConstrained(h))
    {
      ASSERT_EQ(field.sectorTurns[h], 0);
      ASSERT_EQ(field.alignment[h], -1);
      ASSERT_EQ((field.matching[h] + field.matching[mesh.twin[h]]) & 3, 0);
      continue;
    }
    Index corner = h;
    int turns = -field.alignment[h];
    while (!mesh.isConstrained(Mesh::previous(corner)))
    {
      turns -= field.matching[Mesh::previous(corner)];
      corner = mesh.rotateCounterclockwise(corner);
    }
    turns += field.alignment[Mesh::previous(corner)] + 2;
    ASSERT_EQ(turns & 3, field.sectorTurns[h] & 3) << "sector at half-edge " << h;
    if (mesh.isFeature(h) && !mesh.isBoundary(h))
    {
      ASSERT_EQ(field.matching[h], (field.alignment[mesh.twin[h]] + 2 - field.alignment[h]) & 3);
    }
  }
  const std::vector<std::uint8_t> boundary = boundaryVertices(mesh);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (boundary[v] == 0)
    {
      ASSERT_EQ(rotation[v] & 3, field.turns[v] & 3) << "vertex " << v;
    }
    if (sectorSum[v] != 0)
    {
      ASSERT_EQ(sectorSum[v], field.turns[v]) << "vertex " << v;
    }
  }
}

void expectValid(const Mesh& mesh, const CrossField& field)
{
  EXPECT_TRUE(field.status.ok()) << field.status.message;
  const TopologySummary summary = summarizeTopology(mesh);
  EXPECT_EQ(indexSum(mesh, field), 4 * summary.eulerCharacteristic);
  expectTurnsMatchTransitions(mesh, field);
}

TEST(CrossField, ClosedSurfacesHaveIndexSumFourChi)
{
  for (const Mesh& mesh :
    { sphere(3), torus(24, 12), doubleTorus(2), squareTorus(2), unitCube(4), twoComponents() })
  {
    const CrossField field = fieldOf(mesh);
    expectValid(mesh, field);
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      EXPECT_GE(field.turns[v], 3);
      EXPECT_LE(field.turns[v], 5);
    }
  }
}

// Scans have such faces at their smallest components: the turns round their vertices are counts all the same.
TEST(CrossField, FacesWithCornersInOnePlaceKeepTurnsAndMatchingsTogether)
{
  for (const bool wholeFace : { false, true })
  {
    for (Mesh mesh : { sphere(1), torus(8, 6), twoComponents() })
    {
      mesh.position.edit()[mesh.target(0)] = mesh.position[mesh.origin[0]];
      if (wholeFace)
      {
        mesh.position.edit()[mesh.origin[2]] = mesh.position[mesh.origin[0]];
      }
      expectValid(mesh, fieldOf(mesh));
    }
  }
}

TEST(CrossField, SphereHasEightIrregularVertices)
{
  const CrossField field = fieldOf(sphere(3));
  EXPECT_EQ(std::count(field.turns.begin(), field.turns.end(), 3), 8);
  EXPECT_EQ(std::count(field.turns.begin(), field.turns.end(), 5), 0);
}

TEST(CrossField, CubeHasOneQuarterTurnPerSideAtCorners)
{
  const Mesh mesh = markFeatures(unitCube(4), kFeatureAngle);
  const CrossField field = fieldOf(mesh);
  expectValid(mesh, field);
  const std::map<int, int> sectors = sectorHistogram(mesh, field);
  EXPECT_EQ(sectors.at(1), 8 * 3);
  EXPECT_EQ(sectors.size(), 2u); // and straight ones
  EXPECT_EQ(std::count(field.turns.begin(), field.turns.end(), 3), 8);
  const std::vector<std::uint8_t> integer = integerVertices(mesh, field);
  EXPECT_EQ(std::count(integer.begin(), integer.end(), 1), 8);
}

TEST(CrossField, CylinderIsRegular)
{
  const Mesh mesh = openCylinder(24, 8);
  const CrossField field = fieldOf(mesh);
  expectValid(mesh, field);
  const std::vector<std::uint8_t> integer = integerVertices(mesh, field);
  EXPECT_EQ(std::count(integer.begin(), integer.end(), 1), 0);
}

TEST(CrossField, PlatesHaveTheirCornersAndNothingElse)
{
  const Mesh square = gridPlane(8, 8);
  const CrossField squareField = fieldOf(square, 1);
  expectValid(square, squareField);
  EXPECT_EQ(sectorHistogram(square, squareField).at(1), 4);

  const Mesh holed = plateWithHole(3);
  const CrossField holedField = fieldOf(holed, 1);
  expectValid(holed, holedField);
  EXPECT_EQ(sectorHistogram(holed, holedField).at(1), 4);
  EXPECT_EQ(sectorHistogram(holed, holedField).at(3), 4);

  const Mesh bent = plateL(4);
  const CrossField bentField = fieldOf(bent, 1);
  expectValid(bent, bentField);
  EXPECT_EQ(sectorHistogram(bent, bentField).at(1), 5);
  EXPECT_EQ(sectorHistogram(bent, bentField).at(3), 1);
  const std::vector<std::uint8_t> integer = integerVertices(bent, bentField);
  EXPECT_EQ(std::count(integer.begin(), integer.end(), 1), 6);
}

TEST(CrossField, ConstrainedFacesFollowTheirEdge)
{
  const Mesh mesh = markFeatures(unitCube(4), kFeatureAngle);
  const CrossField field = fieldOf(mesh);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isConstrained(h) && !mesh.isConstrained(Mesh::next(h)) &&
      !mesh.isConstrained(Mesh::previous(h)))
    {
      const Index f = Mesh::face(h);
      const Vector3 x = mesh.edgeVector(3 * f).normalized();
      const Vector3 y = faceNormal(mesh, f).cross(x);
      const double axis = field.angle[f] + field.alignment[h] * kPi / 2;
      const Vector3 direction = std::cos(axis) * x + std::sin(axis) * y;
      // Rounding of a handful of double operations.
      EXPECT_NEAR(direction.dot(mesh.edgeVector(h).normalized()), 1, 1e-12);
    }
  }
}

TEST(CrossField, TorusFollowsItsPrincipalDirections)
{
  const CrossField field = fieldOf(torus(40, 20, 1, 0.5), 0.1);
  EXPECT_EQ(std::count(field.turns.begin(), field.turns.end(), 4), 800);
}

// Moves every second boundary vertex out and the others in; corners stay.
Mesh zigzagPlane(int cells, double amplitude)
{
  Mesh mesh = gridPlane(cells, cells);
  for (Vector3& p : mesh.position.editAll())
  {
    const double sign = static_cast<int>(p.x() + p.y()) % 2 == 0 ? 1.0 : -1.0;
    const bool onX = p.x() == 0 || p.x() == cells;
    const bool onY = p.y() == 0 || p.y() == cells;
    p.x() += onX && !onY ? sign * amplitude : 0.0;
    p.y() += onY && !onX ? sign * amplitude : 0.0;
  }
  return mesh;
}

TEST(CrossField, ZigzagBoundaryIsStraight)
{
  // Turns of 62 degrees left and right: each alone would round to a corner.
  const Mesh mesh = zigzagPlane(10, 0.3);
  const CrossField field = fieldOf(mesh, 2);
  expectValid(mesh, field);
  EXPECT_EQ(sectorHistogram(mesh, field).at(1), 4);
  const std::vector<std::uint8_t> integer = integerVertices(mesh, field);
  EXPECT_EQ(std::count(integer.begin(), integer.end(), 1), 4);
}

TEST(CrossField, ClosedInTriangleIsInfeasible)
{
  Mesh mesh = unitCube(2);
  for (Index h = 0; h < 3; ++h)
  {
    mesh.flags.edit()[h] |= kFeatureEdge;
    mesh.flags.edit()[mesh.twin[h]] |= kFeatureEdge;
  }
  const CrossField field = fieldOf(mesh);
  EXPECT_EQ(field.status.code, StatusCode::Infeasible);
  EXPECT_NE(field.status.message.find("three constrained edges"), std::string::npos);
  EXPECT_EQ(indexSum(mesh, field), 8);
}

TEST(CrossField, TriangleWithTwoConstrainedEdgesCarriesOneQuarterTurn)
{
  // A single quad cut along its diagonal: two corners are single triangles, two have two.
  const Mesh mesh = gridPlane(1, 1);
  const CrossField field = fieldOf(mesh, 1);
  expectValid(mesh, field);
  EXPECT_EQ(sectorHistogram(mesh, field).at(1), 4);
}

// An ellipsoid with dents, without symmetry, so that no two choices tie.
Mesh dentedEllipsoid()
{
  Mesh mesh = sphere(3);
  for (Vector3& p : mesh.position.editAll())
  {
    const double dent = 1 + 0.1 * std::sin(3 * p.x() + 1) * std::cos(4 * p.y()) + 0.05 * p.z();
    p = dent * Vector3(1.7 * p.x(), 1.2 * p.y(), p.z());
  }
  return mesh;
}

// Reverses the order of vertices and faces, starts faces at another corner, and turns the mesh in space.
Mesh shuffled(const Mesh& mesh)
{
  const Index last = mesh.vertexCount() - 1;
  const Eigen::AngleAxisd turn(0.7, Vector3(1, 2, 3).normalized());
  std::vector<Vector3> points(mesh.position.begin(), mesh.position.end());
  std::reverse(points.begin(), points.end());
  for (Vector3& p : points)
  {
    p = turn * p;
  }
  std::vector<Triangle> triangles;
  for (Index f = mesh.faceCount(); f-- > 0;)
  {
    Triangle t{ last - mesh.origin[3 * f], last - mesh.origin[3 * f + 1],
      last - mesh.origin[3 * f + 2] };
    std::rotate(t.begin(), t.begin() + f % 3, t.end());
    triangles.push_back(t);
  }
  return makeMesh(std::move(points), triangles);
}

TEST(CrossField, TurnsDoNotDependOnOrderOrPosition)
{
  const Mesh bumpyPlate = []
  {
    Mesh mesh = plateL(6);
    for (Vector3& p : mesh.position.editAll())
    {
      p.z() = 0.8 * std::sin(0.7 * p.x()) * std::cos(0.9 * p.y());
    }
    return mesh;
  }();
  for (const Mesh& mesh : { dentedEllipsoid(), bumpyPlate })
  {
    const CrossField field = fieldOf(mesh, 0.3);
    const CrossField other = fieldOf(shuffled(mesh), 0.3);
    std::vector<int> back(other.turns.rbegin(), other.turns.rend());
    EXPECT_EQ(field.turns, back);
  }
}

TEST(CrossField, RunsGiveTheSameBytes)
{
  const Mesh mesh = dentedEllipsoid();
  const CrossField first = fieldOf(mesh);
  const CrossField second = fieldOf(mesh);
  EXPECT_EQ(first.angle, second.angle);
  EXPECT_EQ(first.matching, second.matching);
  EXPECT_EQ(first.turns, second.turns);
}

TEST(CrossField, RepairMakesAnyJumpsRealizable)
{
  const Mesh mesh = dentedEllipsoid();
  const FieldTopology topology = buildFieldTopology(mesh);
  const FieldConstraints constraints = fieldConstraints(mesh, topology);
  const std::vector<double> angle =
    powerFields(mesh, topology, constraints, { 0.2, {} }).candidates.front();
  std::vector<int> jump = roundJumps(mesh, topology, angle);
  std::mt19937 random(3);
  for (const std::array<Index, 2>& edge : topology.edges)
  {
    const int noise = static_cast<int>(random() % 3) - 1;
    jump[edge[0]] += noise;
    jump[edge[1]] -= noise;
  }
  const std::vector<int> turns = countTurns(mesh, topology, constraints, angle, jump);
  EXPECT_LT(*std::min_element(turns.begin(), turns.end()), 1); // so there is something to repair
  std::vector<double> residual;
  for (const std::array<Index, 2>& edge : topology.edges)
  {
    residual.push_back(edgeResidual(topology, angle, mesh, edge[0], jump[edge[0]]));
  }
  const std::vector<double> natural = naturalTurns(topology, 0.2);
  const TurnRepairResult repair = repairTurns({ &topology, &residual, &turns, &natural, 0.2 });
  for (std::size_t e = 0; e < topology.edges.size(); ++e)
  {
    jump[topology.edges[e][0]] += repair.shift[e];
    jump[topology.edges[e][1]] -= repair.shift[e];
  }
  EXPECT_EQ(countTurns(mesh, topology, constraints, angle, jump), repair.turns);
  for (const int t : repair.turns)
  {
    EXPECT_GE(t, 3);
    EXPECT_LE(t, 5);
  }
}

// Turns per fan as the field stores them.
std::vector<int> turnsOf(const FieldTopology& topology, const CrossField& field)
{
  std::vector<int> turns;
  for (const Fan& fan : topology.fans)
  {
    turns.push_back(fan.sector ? field.sectorTurns[fan.first] : field.turns[fan.vertex]);
  }
  return turns;
}

// A 4 x 4 plate with a flat bump on its upper side, closed off by the chord a-d:
//
//        b-------c
//      /   \ e /   \       e is joined to a, b, c, d
//    a------------d
Mesh plateWithEar()
{
  const Mesh plate = gridPlane(4, 4);
  std::vector<Vector3> points = plate.position;
  const auto find = [&](double x, double y)
  {
    return static_cast<Index>(
      std::find(points.begin(), points.end(), Vector3(x, y, 0)) - points.begin());
  };
  const Index a = find(1, 4), d = find(2, 4), b = plate.vertexCount(), c = b + 1, e = b + 2;
  points.insert(
    points.end(), { Vector3(1.3, 4.1, 0), Vector3(1.7, 4.1, 0), Vector3(1.5, 4.05, 0) });
  std::vector<Triangle> triangles;
  for (Index f = 0; f < plate.faceCount(); ++f)
  {
    triangles.push_back({ plate.origin[3 * f], plate.origin[3 * f + 1], plate.origin[3 * f + 2] });
  }
  triangles.insert(triangles.end(), { { a, d, e }, { d, c, e }, { c, b, e }, { b, a, e } });
  return makeMesh(std::move(points), triangles);
}

TEST(AngleStructure, ChordOfAStraightBorderIsFoundAndGetsACorner)
{
  const Mesh mesh = plateWithEar();
  const FieldTopology topology = buildFieldTopology(mesh);
  const Index b = mesh.vertexCount() - 3;
  // As rounding would have it: corners at the plate's corners, straight and regular elsewhere.
  std::vector<int> turns;
  for (const Fan& fan : topology.fans)
  {
    turns.push_back(fan.sector ? static_cast<int>(std::lround(fan.angle / (kPi / 2))) : 4);
  }
  const AngleStructure structure = findAngleStructure(mesh, topology, turns);
  EXPECT_FALSE(structure.feasible);
  for (std::size_t i = 0; i < turns.size(); ++i)
  {
    EXPECT_EQ(structure.tooMany[i] != 0, topology.fans[i].vertex >= b);
  }
  const CrossField field = fieldOf(mesh, 1);
  expectValid(mesh, field);
  EXPECT_TRUE(findAngleStructure(mesh, topology, turnsOf(topology, field)).feasible);
}

TEST(AngleStructure, ExistsForAnyGoodField)
{
  for (const Mesh& mesh : { sphere(3), torus(24, 12), markFeatures(unitCube(3), kFeatureAngle),
         plateWithHole(3), plateL(4), openCylinder(24, 8) })
  {
    const FieldTopology topology = buildFieldTopology(mesh);
    EXPECT_TRUE(findAngleStructure(mesh, topology, turnsOf(topology, fieldOf(mesh))).feasible);
  }
}

TEST(AngleStructure, FindsAVertexWithTooManyTurns)
{
  // The five triangles of an apex have ten quarter turns; with nine at the apex one is left for their other ten
  // corners, with ten none.
  const Mesh mesh = sphere(0);
  const FieldTopology topology = buildFieldTopology(mesh);
  const auto feasible = [&](int apex)
  {
    // 20 triangles carry 40 quarter turns: the other eleven vertices get 2 or 3 each.
    std::vector<int> turns;
    int threes = 40 - apex - 11 * 2;
    for (const Fan& fan : topology.fans)
    {
      turns.push_back(fan.vertex == 0 ? apex : (threes-- > 0 ? 3 : 2));
    }
    return findAngleStructure(mesh, topology, turns).feasible;
  };
  EXPECT_TRUE(feasible(9));
  EXPECT_FALSE(feasible(10));
}

TEST(CrossField, RefusesBadInput)
{
  EXPECT_THROW(fieldOf(Mesh{}), InvalidInput);
  EXPECT_THROW(fieldOf(unitCube(1), 0), InvalidInput);
}

} // namespace
} // namespace quadrille

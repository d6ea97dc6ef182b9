// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/CrossField.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
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

std::vector<std::uint8_t> boundaryVertices(const Mesh& mesh)
{
  std::vector<std::uint8_t> boundary(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    boundary[mesh.origin[h]] |= mesh.isBoundary(h) ? 1 : 0;
  }
  return boundary;
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

TEST(CrossField, RefusesBadInput)
{
  EXPECT_THROW(fieldOf(Mesh{}), InvalidInput);
  EXPECT_THROW(fieldOf(unitCube(1), 0), InvalidInput);
}

} // namespace
} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Guides and target valences at the level of the field.
#include "CrossField/CrossField.h"
#include "CrossField/FieldTopology.h"
#include "CrossField/TurnRepair.h"
#include "Mesh/Topology.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

namespace quadrille
{
namespace
{

using namespace quadrille::test;

constexpr double kEdgeLength = 0.2;

std::vector<Mesh> models()
{
  const double angle = 40 * kPi / 180;
  return { sphere(3), torus(32, 16), doubleTorus(3), markFeatures(doubleTorus(4), angle),
    markFeatures(unitCube(6), angle), gridPlane(12, 12), plateWithHole(5), plateL(6),
    openCylinder(30, 14), twoComponents() };
}

/// Guide of weight w along `direction` in the faces that `wants` it, by their middle.
std::vector<Guide> guidesAlong(const Mesh& mesh, const Vector3& direction, double weight,
  const std::function<bool(const Vector3&)>& wants)
{
  std::vector<Guide> guides(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector3 middle =
      (mesh.position[mesh.origin[3 * f]] + mesh.position[mesh.origin[3 * f + 1]] +
        mesh.position[mesh.origin[3 * f + 2]]) /
      3;
    const Vector3 n = faceNormal(mesh, f);
    if (wants(middle))
    {
      guides[f] = { (direction - n * n.dot(direction)).normalized(), static_cast<float>(weight) };
    }
  }
  return guides;
}

/// Angle between the cross of a face and a direction in it, in [0, pi / 4].
double crossAngle(const Mesh& mesh, const CrossField& field, Index f, const Vector3& direction)
{
  const Vector3 x = mesh.edgeVector(3 * f).normalized();
  const Vector3 y = faceNormal(mesh, f).cross(x);
  const double away = field.angle[f] - std::atan2(direction.dot(y), direction.dot(x));
  return std::abs(away - kPi / 2 * std::round(away / (kPi / 2)));
}

double largestAngle(const Mesh& mesh, const CrossField& field, const std::vector<Guide>& guides)
{
  double largest = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    largest =
      std::max(largest, guides[f].isFree() ? 0.0 : crossAngle(mesh, field, f, guides[f].direction));
  }
  return largest;
}

TEST(Guides, TurnTheFieldOfATorus)
{
  const Mesh mesh = torus(48, 24);
  CrossFieldOptions options;
  options.targetEdgeLength = kEdgeLength;
  // Everywhere along a helix, 30 degrees off the circles that the field takes by itself.
  std::vector<Guide> guides(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector3 n = faceNormal(mesh, f);
    const Vector3 p = mesh.position[mesh.origin[3 * f]];
    const Vector3 around = Vector3(-p.y(), p.x(), 0).normalized();
    const Vector3 across = n.cross(around - n * n.dot(around)).normalized();
    guides[f] = { std::cos(kPi / 6) * across.cross(n).normalized() + std::sin(kPi / 6) * across,
      1 };
  }
  const CrossField without = computeCrossField(mesh, options);
  EXPECT_GT(largestAngle(mesh, without, guides), 25 * kPi / 180);
  options.guides = guides;
  const CrossField with = computeCrossField(mesh, options);
  ASSERT_TRUE(with.status.ok()) << with.status.message;
  // The guides are smooth but for facets of 7.5 degrees, which the field may even out.
  EXPECT_LT(largestAngle(mesh, with, guides), 8 * kPi / 180);
  EXPECT_EQ(std::count(with.turns.begin(), with.turns.end(), 4), mesh.vertexCount());
}

TEST(Guides, WeightSaysHowFarSmoothnessPrevails)
{
  // A closed surface without features, so that only guides fix the field; two regions that contradict each other.
  const Mesh mesh = torus(60, 24);
  CrossFieldOptions options;
  options.targetEdgeLength = kEdgeLength;
  double before = 0;
  for (const double weight : { 1.0, 0.1, 0.01 })
  {
    options.guides = guidesAlong(mesh, Vector3::UnitZ() + Vector3::UnitX(), weight,
      [](const Vector3& p) { return p.y() > 1.2 && std::abs(p.x()) < 0.25; });
    const CrossField field = computeCrossField(mesh, options);
    ASSERT_TRUE(field.status.ok()) << field.status.message;
    const double angle = largestAngle(mesh, field, options.guides);
    EXPECT_GT(angle, before) << weight;
    before = angle;
  }
}

TEST(Guides, FeaturesAndBoundariesComeFirst)
{
  const Mesh mesh = gridPlane(8, 8);
  CrossFieldOptions options;
  options.targetEdgeLength = 1;
  options.guides = guidesAlong(mesh, Vector3(1, 1, 0), 1, [](const Vector3&) { return true; });
  const CrossField field = computeCrossField(mesh, options);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (constrainedEdges(mesh, f) == 1)
    {
      EXPECT_LT(crossAngle(mesh, field, f, Vector3::UnitX()), 1e-9);
    }
  }
}

TEST(Guides, WrongSizeIsRefused)
{
  CrossFieldOptions options;
  options.targetEdgeLength = 1;
  options.guides.resize(3);
  EXPECT_THROW(computeCrossField(sphere(2), options), InvalidInput);
  options.guides.clear();
  options.targetValences = { 3 };
  EXPECT_THROW(computeCrossField(sphere(2), options), InvalidInput);
}

/// Random changes of the valences that the field has by itself, which keep their sum: pairs of 3 and 5 made, irregular
/// vertices moved, sometimes 6 and 2 with their makeweights.
std::vector<int> randomRequests(const Mesh& mesh, const CrossField& plain, std::mt19937& random)
{
  const std::vector<std::uint8_t> constrained = constrainedVertices(mesh);
  Index components = 0;
  const std::vector<Index> component = faceComponents(mesh, components);
  std::vector<Index> componentOf(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    componentOf[mesh.origin[h]] = component[Mesh::face(h)];
  }
  std::vector<int> target(mesh.vertexCount(), 0);
  const auto pick = [&](int valence, Index where)
  {
    std::vector<Index> free;
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      if (constrained[v] == 0 && target[v] == 0 && plain.turns[v] == 4 && componentOf[v] == where)
      {
        free.push_back(v);
      }
    }
    if (!free.empty())
    {
      target[free[random() % free.size()]] = valence;
    }
  };
  const int changes = 1 + static_cast<int>(random() % 3);
  for (int i = 0; i < changes; ++i)
  {
    const Index where = random() % components;
    switch (random() % 4)
    {
      case 0:
        pick(3, where);
        pick(5, where);
        break;
      case 1:
        pick(6, where);
        pick(3, where);
        pick(3, where);
        break;
      case 2:
        pick(4, where);
        pick(random() % 2 == 0 ? 3 : 5, where); // the field has to find the makeweight
        break;
      default:
        for (Index v = 0; v < mesh.vertexCount(); ++v)
        {
          if (constrained[v] == 0 && plain.turns[v] != 4 && target[v] == 0)
          {
            target[v] = 4;
            pick(plain.turns[v], componentOf[v]);
            break;
          }
        }
    }
  }
  return target;
}

TEST(Prescription, RandomRequestsAreMetExactly)
{
  // More cases in a run by hand: QUADRILLE_TEST_CASES=100 (of each of the ten models).
  const char* asked = std::getenv("QUADRILLE_TEST_CASES");
  const int cases = asked != nullptr ? std::atoi(asked) : 4;
  std::mt19937 random(7);
  std::size_t requests = 0;
  int model = 0;
  for (const Mesh& mesh : models())
  {
    CrossFieldOptions options;
    options.targetEdgeLength = kEdgeLength;
    const CrossField plain = computeCrossField(mesh, options);
    const std::vector<std::uint8_t> constrained = constrainedVertices(mesh);
    for (int i = 0; i < cases; ++i)
    {
      options.targetValences = randomRequests(mesh, plain, random);
      const CrossField field = computeCrossField(mesh, options);
      ASSERT_TRUE(field.status.ok()) << "model " << model << ": " << field.status.message;
      long sum = 0;
      for (Index v = 0; v < mesh.vertexCount(); ++v)
      {
        const int target = options.targetValences[v];
        requests += target != 0;
        if (target != 0)
        {
          ASSERT_EQ(field.turns[v], target) << "model " << model << ", vertex " << v;
        }
        else if (constrained[v] == 0)
        {
          // Valences beyond 3 and 5 only where they are asked for.
          ASSERT_GE(field.turns[v], 3) << "model " << model << ", vertex " << v;
          ASSERT_LE(field.turns[v], 5) << "model " << model << ", vertex " << v;
        }
        sum += field.turns[v];
      }
      long plainSum = 0;
      for (const int turns : plain.turns)
      {
        plainSum += turns;
      }
      ASSERT_EQ(sum, plainSum);
    }
    ++model;
  }
  EXPECT_GT(requests, 10u * static_cast<std::size_t>(cases));
}

TEST(Prescription, LaterMovesLeaveItAlone)
{
  // Twelve turns in six triangles are more than they can carry, so a turn has to go, unless they are asked for.
  const Mesh mesh = torus(24, 12);
  const FieldTopology topology = buildFieldTopology(mesh);
  const std::vector<double> residual(topology.edges.size(), 0.0);
  const std::vector<double> natural(topology.fans.size(), 4.0);
  TurnRepairResult result{ std::vector<int>(topology.edges.size(), 0),
    std::vector<int>(topology.fans.size(), 4) };
  const Index high = 5;
  result.turns[high] = 12;
  for (Index i = 0; i < 8; ++i)
  {
    result.turns[100 + 20 * i] = 3; // the sum stays
  }
  const std::vector<int> before = result.turns;
  TurnPrescription prescription;
  prescription.groupOfFan.assign(topology.fans.size(), kInvalidIndex);
  prescription.groupOfFan[high] = 0;
  prescription.turns = { 12 };
  TurnRepairInput input{ &topology, &residual, &before, &natural, 0.5, &prescription, nullptr };
  TurnRepairResult asked = result;
  EXPECT_FALSE(completeTurns(mesh, input, asked).empty());
  EXPECT_EQ(asked.turns[high], 12);
  input.prescription = nullptr;
  completeTurns(mesh, input, result);
  EXPECT_LT(result.turns[high], 12);
}

TEST(Guides, TurnsGoRoundTheirRegions)
{
  // A 3 and a 5 on both sides of a guided band that does not go all the way round; across it would be shorter.
  const Mesh mesh = gridPlane(40, 24);
  const auto at = [&](double x, double y)
  {
    Index nearest = 0;
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      const Vector3 p(x, y, 0);
      nearest = (mesh.position[v] - p).norm() < (mesh.position[nearest] - p).norm() ? v : nearest;
    }
    return nearest;
  };
  CrossFieldOptions options;
  options.targetEdgeLength = 2;
  options.targetValences.assign(mesh.vertexCount(), 0);
  options.targetValences[at(17, 12)] = 3;
  options.targetValences[at(23, 12)] = 5;
  options.guides = guidesAlong(mesh, Vector3::UnitX(), 1,
    [](const Vector3& p) { return std::abs(p.x() - 20) < 1 && std::abs(p.y() - 12) < 5; });
  const CrossField field = computeCrossField(mesh, options);
  ASSERT_TRUE(field.status.ok()) << field.status.message;
  EXPECT_LT(largestAngle(mesh, field, options.guides), 10 * kPi / 180);
}

TEST(Prescription, BoundaryAndFeatureVertices)
{
  const Mesh plate = gridPlane(10, 10);
  CrossFieldOptions options;
  options.targetEdgeLength = 1;
  options.targetValences.assign(plate.vertexCount(), 0);
  const auto at = [&](const Mesh& mesh, const Vector3& p)
  {
    Index nearest = 0;
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      nearest = (mesh.position[v] - p).norm() < (mesh.position[nearest] - p).norm() ? v : nearest;
    }
    return nearest;
  };
  // A straight border point as a corner, a corner as a straight point, a reflex point.
  const std::vector<std::pair<Vector3, int>> border{ { { 5, 0, 0 }, 3 }, { { 0, 0, 0 }, 4 },
    { { 0, 5, 0 }, 5 } };
  for (const auto& [p, valence] : border)
  {
    options.targetValences[at(plate, p)] = valence;
  }
  const CrossField field = computeCrossField(plate, options);
  ASSERT_TRUE(field.status.ok()) << field.status.message;
  for (const auto& [p, valence] : border)
  {
    EXPECT_EQ(field.turns[at(plate, p)], valence - 2) << p.transpose();
  }

  const Mesh cube = markFeatures(unitCube(6), 40 * kPi / 180);
  options.targetEdgeLength = kEdgeLength;
  options.targetValences.assign(cube.vertexCount(), 0);
  const Index middle = at(cube, { 0.5, 0, 0 });
  options.targetValences[middle] = 5;
  const CrossField bent = computeCrossField(cube, options);
  ASSERT_TRUE(bent.status.ok()) << bent.status.message;
  EXPECT_EQ(bent.turns[middle], 5); // of its two sectors together
}

TEST(Prescription, WhatCannotBeCompletedIsRefusedWithTheSum)
{
  const Mesh mesh = disjointUnion(torus(24, 12), sphere(2), Vector3(5, 0, 0));
  CrossFieldOptions options;
  options.targetEdgeLength = kEdgeLength;
  options.targetValences.assign(mesh.vertexCount(), 4);
  const CrossField regular = computeCrossField(mesh, options);
  EXPECT_EQ(regular.status.code, StatusCode::Infeasible);
  EXPECT_TRUE(regular.failedAt.empty());
  EXPECT_NE(regular.status.message.find("4 - valence has to sum up to 8"), std::string::npos)
    << regular.status.message;
  EXPECT_NE(regular.status.message.find("sum up to 0"), std::string::npos);
  EXPECT_NE(regular.status.message.find("missing 8"), std::string::npos);
  // The place is on the sphere, not on the torus.
  EXPECT_NE(regular.status.message.find("near ("), std::string::npos);

  // With eight vertices of the sphere left to it, it can be done, and in one way only.
  const CrossField plain = computeCrossField(sphere(2), { kEdgeLength, {}, {}, {}, {}, {}, {} });
  const Index first = torus(24, 12).vertexCount();
  for (Index v = 0; v < plain.turns.size(); ++v)
  {
    options.targetValences[first + v] = plain.turns[v] == 4 ? 4 : 0;
  }
  const CrossField done = computeCrossField(mesh, options);
  ASSERT_TRUE(done.status.ok()) << done.status.message;
  for (Index v = 0; v < plain.turns.size(); ++v)
  {
    EXPECT_EQ(done.turns[first + v], plain.turns[v]);
  }
  // One of them taken away: the others cannot make up for it above valence 3.
  options.targetValences[first +
    static_cast<Index>(
      std::find(plain.turns.begin(), plain.turns.end(), 3) - plain.turns.begin())] = 4;
  const CrossField missing = computeCrossField(mesh, options);
  EXPECT_EQ(missing.status.code, StatusCode::Infeasible);
  EXPECT_NE(missing.status.message.find(": 1 are missing"), std::string::npos)
    << missing.status.message;
}

} // namespace
} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "BothPhases.h"
#include "Hierarchy/Hierarchy.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

HierarchyOptions automaticOptions(double edgeLength, Index coarseVertices)
{
  HierarchyOptions options;
  options.targetEdgeLength = edgeLength;
  options.coarseVertices = coarseVertices;
  return options;
}

/// The unit sphere with waves of this height.
Mesh wavySphere(int level, double height)
{
  Mesh mesh = sphere(level);
  for (Vector3& p : mesh.position.editAll())
  {
    p *= 1 + height * std::sin(7 * p.x()) * std::cos(6 * p.y() + p.z());
  }
  return mesh;
}

/// Vertices of the coarse level with a coordinate x below 2 and above.
std::array<Index, 2> countSides(const Mesh& mesh)
{
  std::array<Index, 2> count{};
  for (const Vector3& p : mesh.position)
  {
    ++count[p.x() < 2 ? 0 : 1];
  }
  return count;
}

} // namespace

TEST(AutomaticBudget, EndsWhereTheCurvatureWouldMoveTooFar)
{
  const Mesh mesh = wavySphere(5, 0.1);
  for (const double s : { 0.09, 0.14 })
  {
    for (const DecimationCost cost : { DecimationCost::Gaussian, DecimationCost::GaussianMemory })
    {
      HierarchyOptions options = automaticOptions(s, 0);
      options.cost = cost;
      Redecimation levels(mesh, 1, options);
      const Hierarchy found = levels.update(options);
      const Index vertices = found.coarse.mesh.vertexCount();
      EXPECT_LE(found.curvatureShift, kCurvatureShift);
      EXPECT_GT(vertices, kLeastCoarseVertices);
      EXPECT_LT(vertices, found.intermediate.mesh.vertexCount());
      EXPECT_EQ(found.notice, "");
      // The next removal would have gone over the limit, so a twentieth of the vertices fewer do by far.
      options.coarseVertices = vertices - vertices / 20;
      EXPECT_GT(levels.update(options).curvatureShift, kCurvatureShift);
      // Nothing of a budget between is left.
      options.coarseVertices = 0;
      EXPECT_EQ(levels.update(options).log.serialize(), found.log.serialize());
    }
  }
}

TEST(AutomaticBudget, DoesNotDependOnTheUnit)
{
  // A power of two changes no digit of any number.
  Mesh mesh = wavySphere(4, 0.1);
  const DecimationLog log = buildHierarchy(mesh, 1, automaticOptions(0.12, 0)).log;
  for (Vector3& p : mesh.position.editAll())
  {
    p *= 1024;
  }
  EXPECT_EQ(
    buildHierarchy(mesh, 1, automaticOptions(0.12 * 1024, 0)).log.serialize(), log.serialize());
}

TEST(AutomaticBudget, RougherSurfacesGetMoreVertices)
{
  // Both have about as many quads; half of the rough one's curvature is in waves of a few quads.
  const double s = 0.08;
  const Index smooth =
    buildHierarchy(wavySphere(5, 0.0), 1, automaticOptions(s, 0)).coarse.mesh.vertexCount();
  const Index rough =
    buildHierarchy(wavySphere(5, 0.12), 1, automaticOptions(s, 0)).coarse.mesh.vertexCount();
  EXPECT_LT(smooth, rough);
}

TEST(AutomaticBudget, StaysInsideItsLimits)
{
  // A plane has no curvature to move but at its corners, and would keep nothing.
  const Mesh plane = gridPlane(60, 60);
  EXPECT_EQ(buildHierarchy(plane, 1, automaticOptions(3, 0)).coarse.mesh.vertexCount(),
    kLeastCoarseVertices);
  // Noise as large as the edges moves too far with the first vertex, but is not all kept.
  Mesh noise = sphere(6);
  std::uint32_t random = 1;
  for (Vector3& p : noise.position.editAll())
  {
    random = random * 1664525U + 1013904223U;
    p *= 1 + 0.01 * (static_cast<double>(random) / 4294967296.0);
  }
  const Hierarchy levels = buildHierarchy(noise, 1, automaticOptions(0.03, 0));
  ASSERT_GT(levels.intermediate.mesh.vertexCount(), kMostCoarseVertices);
  EXPECT_EQ(levels.coarse.mesh.vertexCount(), kMostCoarseVertices);
}

TEST(AutomaticBudget, ComponentsShareItByNeed)
{
  // The same shape twice, once with waves: it needs more, whether the budget is given or not.
  const Mesh mesh = disjointUnion(wavySphere(5, 0.12), sphere(5), Vector3(4, 0, 0));
  for (const Index budget : { 0U, 1200U })
  {
    const Hierarchy levels = buildHierarchy(mesh, 1, automaticOptions(0.1, budget));
    const std::array<Index, 2> before = countSides(levels.intermediate.mesh);
    const std::array<Index, 2> after = countSides(levels.coarse.mesh);
    const double roughShare = static_cast<double>(after[0]) / before[0];
    const double smoothShare = static_cast<double>(after[1]) / before[1];
    EXPECT_GT(roughShare, 1.2 * smoothShare) << after[0] << " and " << after[1];
    EXPECT_GE(after[1], 12U) << "the least of a component";
  }
}

TEST(AutomaticBudget, NeedsACostOfCurvature)
{
  const Mesh mesh = sphere(3);
  for (const DecimationCost cost : { DecimationCost::Quadric, DecimationCost::Uniform })
  {
    HierarchyOptions options = automaticOptions(0.3, 0);
    options.cost = cost;
    EXPECT_THROW(buildHierarchy(mesh, 1, options), InvalidInput);
    options.coarseVertices = 50;
    Redecimation levels(mesh, 1, options);
    options.coarseVertices = 0;
    EXPECT_THROW(levels.update(options), InvalidInput);
  }
}

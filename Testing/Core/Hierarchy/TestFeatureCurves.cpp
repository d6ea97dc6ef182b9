// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/FeatureCurves.h"

#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// Marks the unit edges from a to b, along an axis.
void markWay(Mesh& mesh, const Vector3& a, const Vector3& b)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = mesh.position[mesh.origin[h]];
    const Vector3& q = mesh.position[mesh.target(h)];
    const auto between = [&](const Vector3& x)
    { return (x - a).norm() + (b - x).norm() <= (b - a).norm() + 1e-9; };
    if (!mesh.isBoundary(h) && between(p) && between(q))
    {
      mesh.flags.edit()[h] |= kFeatureEdge;
      mesh.flags.edit()[mesh.twin[h]] |= kFeatureEdge;
    }
  }
}

VertexKind kindAt(const Mesh& mesh, const FeatureCurves& curves, const Vector3& place)
{
  const auto found = std::find(mesh.position.begin(), mesh.position.end(), place);
  return curves.kind[static_cast<std::size_t>(found - mesh.position.begin())];
}

/// A straight curve, and one that leaves it, turns at right angles after `steps` and goes on beside it.
Mesh branchWithBend(int steps)
{
  Mesh mesh = test::gridPlane(40, 24);
  markWay(mesh, { 2, 4, 0 }, { 38, 4, 0 });
  markWay(mesh, { 10, 4, 0 }, { 10, 4.0 + steps, 0 });
  markWay(mesh, { 10, 4.0 + steps, 0 }, { 30, 4.0 + steps, 0 });
  return mesh;
}

TEST(FeatureCurves, ABendNextToAJunctionIsNoCornerOfItsOwn)
{
  // Vertices within scale / 2 of each other are one corner, and the junction is there in any case.
  const double scale = 8;
  for (const int steps : { 1, 2, 3 })
  {
    const Mesh mesh = branchWithBend(steps);
    const FeatureCurves curves = traceFeatureCurves(mesh, scale);
    EXPECT_EQ(kindAt(mesh, curves, { 10, 4, 0 }), VertexKind::Protected);
    EXPECT_EQ(kindAt(mesh, curves, { 10, 4.0 + steps, 0 }), VertexKind::Curve) << steps;
  }
  for (const int steps : { 4, 9 })
  {
    const Mesh mesh = branchWithBend(steps);
    const FeatureCurves curves = traceFeatureCurves(mesh, scale);
    EXPECT_EQ(kindAt(mesh, curves, { 10, 4, 0 }), VertexKind::Protected);
    EXPECT_EQ(kindAt(mesh, curves, { 10, 4.0 + steps, 0 }), VertexKind::Protected) << steps;
  }
}

TEST(FeatureCurves, BendsOfAClosedCurveAreCornersAsBefore)
{
  Mesh mesh = test::gridPlane(24, 24);
  for (const auto& [a, b] :
    { std::pair<Vector3, Vector3>{ { 4, 4, 0 }, { 16, 4, 0 } }, { { 16, 4, 0 }, { 16, 16, 0 } },
      { { 16, 16, 0 }, { 4, 16, 0 } }, { { 4, 16, 0 }, { 4, 4, 0 } } })
  {
    markWay(mesh, a, b);
  }
  const FeatureCurves curves = traceFeatureCurves(mesh, 8);
  for (const Vector3& corner :
    { Vector3(4, 4, 0), Vector3(16, 4, 0), Vector3(16, 16, 0), Vector3(4, 16, 0) })
  {
    EXPECT_EQ(kindAt(mesh, curves, corner), VertexKind::Protected);
  }
}

} // namespace
} // namespace quadrille

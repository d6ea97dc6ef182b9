// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "GridMap/Certificate.h"
#include "GridMap/CutGraph.h"
#include "GridMap/MapCheck.h"
#include "GridMap/SeamlessMap.h"
#include "MapModels.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <functional>

using namespace quadrille;
using namespace quadrille::test;

namespace
{

SeamlessResult seamlessMapOf(const Mesh& mesh, const CrossField& field, double edgeLength)
{
  SeamlessOptions options;
  options.edgeLength = edgeLength;
  return computeSeamlessMap(mesh, field, options);
}

} // namespace

TEST(SeamlessMap, IsExactAndPositiveOnEveryKindOfSurface)
{
  for (const Model& model : models())
  {
    const Mesh mesh = model.make();
    const double length = std::sqrt(areaOf(mesh) / 500);
    const CrossField field = fieldOf(mesh, length);
    ASSERT_TRUE(field.status.ok()) << model.name << ": " << field.status.message;
    const SeamlessResult result = seamlessMapOf(mesh, field, length);
    EXPECT_TRUE(result.status.ok()) << model.name << ": " << result.status.message;
    const Certificate c = certify(mesh, result.uv, field.turns, integerVertices(mesh, field));
    EXPECT_EQ(c.notPositive, 0u) << model.name;
    EXPECT_EQ(c.wrongTurns, 0u) << model.name;
    EXPECT_EQ(c.seamResiduals, 0u) << model.name;
    EXPECT_EQ(c.offAxes, 0u) << model.name;
    EXPECT_TRUE(findDefects(mesh, field, result.uv).none()) << model.name;
    // Half the area is lost only where the map is far from the wanted size.
    EXPECT_NEAR(c.area, 500, 250) << model.name;
  }
}

TEST(SeamlessMap, TransitionsTurnAsTheFieldMatches)
{
  const Mesh mesh = test::sphere(3);
  const CrossField field = fieldOf(mesh, 0.2);
  const SeamlessResult result = seamlessMapOf(mesh, field, 0.2);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    EXPECT_EQ(transitionOf(mesh, result.uv, h).rotation, field.matching[h]);
  }
}

TEST(SeamlessMap, AFlatPlateIsMappedWithoutDistortion)
{
  const Mesh mesh = test::gridPlane(6, 4);
  const CrossField field = fieldOf(mesh, 1);
  const SeamlessResult result = seamlessMapOf(mesh, field, 1);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const double length = toDouble(result.uv[Mesh::next(h)] - result.uv[h]).norm();
    // The minimum is the identity; Newton stops near it, and the grid has 2^-24.
    EXPECT_NEAR(length, mesh.edgeVector(h).norm(), 1e-5);
  }
}

TEST(SeamlessMap, MeetsATargetArea)
{
  const Mesh mesh = test::markFeatures(test::unitCube(6), 0.7);
  const CrossField field = fieldOf(mesh, 0.1);
  SeamlessOptions options;
  options.edgeLength = 0.1;
  options.targetQuads = 1234;
  const SeamlessResult result = computeSeamlessMap(mesh, field, options);
  const Certificate c = certify(mesh, result.uv, field.turns, integerVertices(mesh, field));
  EXPECT_TRUE(c.seamless()) << c.text();
  EXPECT_NEAR(c.area, 1234, 1e-2); // the grid moves each of some hundred triangles by 2^-24 or so
}

TEST(SeamlessMap, SameBytesEveryTime)
{
  const Mesh mesh = test::sphere(3);
  const CrossField field = fieldOf(mesh, 0.3);
  EXPECT_EQ(seamlessMapOf(mesh, field, 0.3).uv, seamlessMapOf(mesh, field, 0.3).uv);
}

TEST(SeamlessMap, NamesVerticesWithTooFewTriangles)
{
  // A tetrahedron: three triangles at each vertex. Ask for one more turn than they can make.
  const Mesh mesh = test::makeMesh({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
    { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 1, 2, 3 } });
  CrossField field = fieldOf(mesh, 0.5);
  field.turns[0] += 4; // the equations only know it modulo 4
  const SeamlessResult result = seamlessMapOf(mesh, field, 0.5);
  EXPECT_EQ(result.status.code, StatusCode::Infeasible);
  EXPECT_EQ(result.failedAt, std::vector<Index>{ 0 });
}

TEST(SeamlessMap, RefusesABrokenField)
{
  const Mesh mesh = test::sphere(1);
  CrossField field = fieldOf(mesh, 0.5);
  field.matching[0] = static_cast<std::int8_t>((field.matching[0] + 1) & 3);
  EXPECT_THROW(seamlessMapOf(mesh, field, 0.5), InvalidInput);
  EXPECT_THROW(seamlessMapOf(mesh, fieldOf(mesh, 0.5), 0), InvalidInput);
}

TEST(CutGraph, LeavesOneDiskAndClosesEndsWithoutSingularity)
{
  const Mesh mesh = test::gridPlane(6, 6);
  const CutGraph graph = cutAlongField(mesh, fieldOf(mesh, 1));
  EXPECT_TRUE(graph.path.empty()); // a flat plate has no singularity and is a disk
  EXPECT_EQ(graph.wedges, mesh.vertexCount());
  EXPECT_EQ(graph.components, 1u);
}

TEST(CutGraph, CombedChartsAgreeAcrossEveryEdgeThatIsNotCut)
{
  const Mesh mesh = test::sphere(3);
  const CrossField field = fieldOf(mesh, 0.3);
  const CutGraph graph = cutAlongField(mesh, field);
  std::vector<bool> cut(mesh.origin.size(), false);
  for (const Index h : graph.path)
  {
    cut[h] = cut[mesh.twin[h]] = true;
    const int rotation =
      (graph.comb[Mesh::face(mesh.twin[h])] + field.matching[h] - graph.comb[Mesh::face(h)]) & 3;
    EXPECT_EQ(rotation, graph.rotation[graph.segment[h]]);
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Index g = mesh.twin[h];
    if (!cut[h])
    {
      EXPECT_EQ(graph.comb[Mesh::face(h)], (graph.comb[Mesh::face(g)] + field.matching[h]) & 3);
      EXPECT_EQ(graph.wedge[h], graph.wedge[Mesh::next(g)]);
    }
  }
}

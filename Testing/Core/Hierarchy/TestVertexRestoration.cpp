// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "BothPhases.h"
#include "Hierarchy/DecimationMesh.h"
#include "Hierarchy/Hierarchy.h"
#include "Hierarchy/UniformDecimation.h"
#include "Hierarchy/VertexRestoration.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadrille
{
namespace
{

using test::buildHierarchy;
using test::markFeatures;
using test::unitCube;

Mesh dentedBall(int subdivisions)
{
  Mesh mesh = test::sphere(subdivisions);
  for (Vector3& p : mesh.position.editAll())
  {
    p *= 1 + 0.05 * std::sin(7 * p.x()) * std::sin(5 * p.y() + p.z());
  }
  return mesh;
}

/// Closed and open, smooth and with features.
std::vector<Mesh> meshes()
{
  return { dentedBall(4), markFeatures(unitCube(14), radians(40)), test::plateWithHole(12) };
}

double diameter(const Mesh& mesh)
{
  Vector3 low = mesh.position.front(), high = low;
  for (const Vector3& p : mesh.position)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

HierarchyOptions optionsOf(const Mesh& mesh, double share)
{
  HierarchyOptions options;
  options.targetEdgeLength = share * diameter(mesh);
  options.coarseVertices = 100;
  return options;
}

/// The mesh after phase 1, with its log.
struct Thinned
{
  Level level;
  std::vector<float> curveError;
  DecimationLog log;
};

Thinned thinOut(const Mesh& mesh, double edgeLength)
{
  DecimationMesh working(mesh, traceFeatureCurves(mesh, 0.25 * edgeLength));
  UniformOptions options;
  options.edgeLength = 0.5 * edgeLength;
  options.curveTolerance = 0.1 * edgeLength;
  LogBuilder builder;
  decimateUniformly(working, options, builder);
  Thinned thinned;
  thinned.level = working.extract();
  for (const Index v : thinned.level.fineVertex)
  {
    thinned.curveError.push_back(working.curveError[v]);
  }
  thinned.log = builder.finish();
  thinned.log.fineFaces = mesh.faceCount();
  return thinned;
}

std::vector<Index> removedVertices(const Mesh& mesh, const Level& level)
{
  std::vector<Index> removed;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (!std::binary_search(level.fineVertex.begin(), level.fineVertex.end(), v))
    {
      removed.push_back(v);
    }
  }
  return removed;
}

bool has(const Level& level, Index v)
{
  return std::binary_search(level.fineVertex.begin(), level.fineVertex.end(), v);
}

TEST(VertexRestoration, AllRemovalsUndoneGiveTheFinestMesh)
{
  for (const Mesh& mesh : meshes())
  {
    const Thinned thinned = thinOut(mesh, 0.15 * diameter(mesh));
    const std::vector<Index> removed = removedVertices(mesh, thinned.level);
    ASSERT_GT(removed.size(), mesh.position.size() / 2);
    const auto removals = removalsFrom(thinned.log, removed);
    EXPECT_EQ(removals.size(), thinned.log.collapses);
    const RestoredLevel restored =
      undoRemovals(mesh, thinned.level, thinned.curveError, thinned.log, removals);
    EXPECT_EQ(restored.level.mesh.origin, mesh.origin);
    EXPECT_EQ(restored.level.mesh.twin, mesh.twin);
    EXPECT_EQ(restored.level.mesh.flags, mesh.flags);
    EXPECT_EQ(restored.level.mesh.position, mesh.position);
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      ASSERT_EQ(restored.level.fineFace[f], f);
    }
  }
}

TEST(VertexRestoration, UndoesWhatDependsOnAVertexOnly)
{
  for (const Mesh& mesh : meshes())
  {
    const Thinned thinned = thinOut(mesh, 0.12 * diameter(mesh));
    const std::vector<Index> removed = removedVertices(mesh, thinned.level);
    for (std::size_t i = 3; i < removed.size(); i += removed.size() / 7)
    {
      const auto removals = removalsFrom(thinned.log, { removed[i] });
      EXPECT_LT(removals.size(), removed.size()) << "of vertex " << removed[i];
      const RestoredLevel restored =
        undoRemovals(mesh, thinned.level, thinned.curveError, thinned.log, removals);
      EXPECT_TRUE(has(restored.level, removed[i]));
      EXPECT_EQ(
        restored.level.mesh.position.size(), thinned.level.mesh.position.size() + removals.size());
      EXPECT_EQ(validate(restored.level.mesh), "");
      for (const Index v : thinned.level.fineVertex)
      {
        ASSERT_TRUE(has(restored.level, v));
      }
    }
  }
}

/// The replay rewrites an affine map of a plane exactly where weights are barycentric, so it tells a log that does not
/// belong to its level.
TEST(VertexRestoration, TheLogWithoutRemovalsLeadsToTheLevel)
{
  const Mesh mesh = test::plateWithHole(12);
  const Thinned thinned = thinOut(mesh, 0.1 * diameter(mesh));
  const std::vector<Index> removed = removedVertices(mesh, thinned.level);
  const auto removals = removalsFrom(thinned.log, { removed[removed.size() / 2] });
  const RestoredLevel restored =
    undoRemovals(mesh, thinned.level, thinned.curveError, thinned.log, removals);
  DecimationLog rest = thinned.log;
  const auto originals = takeOut(rest, removals);
  EXPECT_EQ(rest.collapses + removals.size(), thinned.log.collapses);
  // What is left undone as well leads to the finest mesh, so the rest was a log of just this level.
  std::vector<Index> stillRemoved = removedVertices(mesh, restored.level);
  const auto others = removalsFrom(rest, stillRemoved);
  EXPECT_EQ(others.size(), rest.collapses);
  const RestoredLevel finest =
    undoRemovals(mesh, restored.level, restored.curveError, rest, others);
  EXPECT_EQ(finest.level.mesh.origin, mesh.origin);
  EXPECT_EQ(finest.level.mesh.twin, mesh.twin);
  for (const auto& [block, records] : originals)
  {
    rest.blocks[block] = records;
  }
  EXPECT_EQ(rest.blocks, thinned.log.blocks);
}

TEST(VertexRestoration, BringsVerticesBackToAllLevels)
{
  for (const Mesh& mesh : meshes())
  {
    HierarchyOptions options = optionsOf(mesh, 0.15);
    Redecimation levels(mesh, 5, options);
    const std::vector<std::uint8_t> pure = levels.update(options).log.serialize();
    const std::vector<Index> removed = removedVertices(mesh, levels.hierarchy().intermediate);
    options.keepVertices = { removed[removed.size() / 3] };
    const Hierarchy& kept = levels.update(options);
    EXPECT_TRUE(has(kept.intermediate, options.keepVertices[0]));
    EXPECT_TRUE(has(kept.coarse, options.keepVertices[0]));
    EXPECT_EQ(validate(kept.intermediate.mesh), "");
    EXPECT_EQ(validate(kept.coarse.mesh), "");
    const std::vector<std::uint8_t> bytes = kept.log.serialize();
    EXPECT_NO_THROW(DecimationLog::deserialize(bytes, 5));
    EXPECT_EQ(bytes, buildHierarchy(mesh, 5, options).log.serialize()) << "as from the start";
    // As thin as before, but for the vertex and its surroundings.
    const std::size_t vertices = kept.intermediate.mesh.position.size();
    const std::size_t before = mesh.position.size() - removed.size();
    EXPECT_LT(vertices, before + 10);
    EXPECT_GT(vertices + 10, before);
    options.keepVertices.clear();
    EXPECT_EQ(levels.update(options).log.serialize(), pure) << "and back again";
  }
}

TEST(VertexRestoration, ManyVerticesAreLeftByPhase1)
{
  const Mesh mesh = dentedBall(4);
  HierarchyOptions options = optionsOf(mesh, 0.15);
  for (Index v = 0; v < mesh.vertexCount(); v += 9)
  {
    options.keepVertices.push_back(v);
  }
  ASSERT_FALSE(isLocalChange(mesh, {}, options.keepVertices.size()));
  const Hierarchy kept = buildHierarchy(mesh, 5, options);
  const Hierarchy same = Redecimation(mesh, 5, options).update(options);
  EXPECT_EQ(kept.log.serialize(), same.log.serialize());
  for (const Index v : options.keepVertices)
  {
    ASSERT_TRUE(has(kept.coarse, v));
  }
}

/// Where quads are to be smaller than they were in phase 1, and nowhere else.
TEST(VertexRestoration, SmallerSizesBringVerticesBack)
{
  for (Mesh mesh : meshes())
  {
    const HierarchyOptions options = optionsOf(mesh, 0.15);
    Redecimation levels(mesh, 5, options);
    const std::vector<std::uint8_t> pure = levels.update(options).log.serialize();
    const Level before = levels.hierarchy().intermediate;
    const Vector3 place = mesh.position[mesh.position.size() / 2];
    const double reach = 0.15 * diameter(mesh);
    const auto isNear = [&](const Vector3& p, double factor)
    { return (p - place).norm() < factor * reach; };
    std::vector<float> sizes(mesh.position.size(), 1.0F);
    for (std::size_t v = 0; v < sizes.size(); ++v)
    {
      sizes[v] = isNear(mesh.position[v], 1) ? 0.4F : 1.0F;
    }
    mesh.sizing = sizes;
    levels.setSizes(mesh.sizing);
    ASSERT_TRUE(isLocalChange(mesh, {}, 0));
    const Hierarchy& finer = levels.update(options);
    const auto countNear = [&](const Level& level)
    {
      return std::count_if(level.mesh.position.begin(), level.mesh.position.end(),
        [&](const Vector3& p) { return isNear(p, 1); });
    };
    EXPECT_GT(countNear(finer.intermediate), 2 * countNear(before));
    EXPECT_EQ(validate(finer.intermediate.mesh), "");
    EXPECT_EQ(finer.intermediate.mesh.sizing.size(), finer.intermediate.mesh.position.size());
    for (const Index v : before.fineVertex)
    {
      EXPECT_TRUE(isNear(mesh.position[v], 3) || has(finer.intermediate, v)) << v;
    }
    EXPECT_NO_THROW(DecimationLog::deserialize(finer.log.serialize(), 5));
    mesh.sizing.clear();
    levels.setSizes(mesh.sizing);
    EXPECT_EQ(levels.update(options).log.serialize(), pure) << "and back again";
  }
}

TEST(VertexRestoration, StoppedOnTheWayNothingIsLost)
{
  const Mesh mesh = dentedBall(5);
  HierarchyOptions options = optionsOf(mesh, 0.05);
  Redecimation levels(mesh, 5, options);
  const std::vector<std::uint8_t> pure = levels.update(options).log.serialize();
  const std::vector<Index> removed = removedVertices(mesh, levels.hierarchy().intermediate);
  HierarchyOptions kept = options;
  kept.keepVertices = { removed.front(), removed.back() };
  const std::vector<std::uint8_t> wanted = buildHierarchy(mesh, 5, kept).log.serialize();
  for (int steps = 0; steps < 6; ++steps)
  {
    HierarchyOptions stopped = kept;
    int left = steps;
    stopped.progress = [&left](double, const std::string&) { return left-- > 0; };
    try
    {
      levels.update(stopped);
    }
    catch (const Cancelled&)
    {
    }
    EXPECT_EQ(levels.update(options).log.serialize(), pure);
  }
  EXPECT_EQ(levels.update(kept).log.serialize(), wanted);
}

} // namespace
} // namespace quadrille

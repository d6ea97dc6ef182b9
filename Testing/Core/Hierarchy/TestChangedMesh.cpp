// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Levels that are taken along when places of their finest mesh are changed.
#include "Details/CloseHandles.h"
#include "Details/FillHoles.h"
#include "Details/Handles.h"
#include "Hierarchy/Hierarchy.h"
#include "Hierarchy/VertexRestoration.h"
#include "Mesh/Topology.h"
#include "MeshInput.h"
#include "Prepare/Prepare.h"
#include "Prepare/Refine.h"
#include "TestHandleMeshes.h"
#include "TestMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace quadrille
{
namespace
{

HierarchyOptions levelOptionsOf(double edgeLength, int threads)
{
  HierarchyOptions options;
  options.targetEdgeLength = edgeLength;
  options.coarseVertices = 100;
  options.threads = threads;
  return options;
}

PreparedSurface prepared(const Mesh& mesh)
{
  PrepareOptions options;
  options.featureAngle = 0.7;
  return prepareSurface(test::toInput(mesh), options);
}

/// The log leads from the finest mesh to the intermediate level: undone, it gives the finest mesh back.
void expectLogOf(const Mesh& fine, const Hierarchy& hierarchy)
{
  DecimationLog log = hierarchy.log;
  ASSERT_EQ(log.fineFaces, fine.faceCount());
  ASSERT_EQ(log.rounds.size(), log.intermediateRounds);
  EXPECT_EQ(log.collapses + hierarchy.intermediate.mesh.vertexCount(), fine.vertexCount());
  const std::vector<Index>& stayed = hierarchy.intermediate.fineVertex;
  EXPECT_TRUE(std::is_sorted(stayed.begin(), stayed.end()));
  std::vector<Index> removed;
  for (Index v = 0; v < fine.vertexCount(); ++v)
  {
    if (!std::binary_search(stayed.begin(), stayed.end(), v))
    {
      removed.push_back(v);
    }
  }
  const std::vector<float> noError(stayed.size(), 0.0F);
  const RestoredLevel finest = undoRemovals(
    fine, hierarchy.intermediate, noError, log, removalsFrom(log, LogPlaces(log), removed));
  EXPECT_EQ(finest.level.mesh.origin, fine.origin);
  EXPECT_EQ(finest.level.mesh.twin, fine.twin);
  EXPECT_EQ(finest.level.mesh.position, fine.position);
}

/// Levels that follow a change of the surface are levels of the changed one, and about as coarse as new ones.
void expectToFollow(
  PreparedSurface surface, double edgeLength, const std::function<bool(PreparedSurface&)>& change)
{
  Redecimation levels(surface.mesh, surface.hash, levelOptionsOf(edgeLength, 1));
  levels.update(levelOptionsOf(edgeLength, 1)); // what phase 2 has made does not matter
  surface.namesBefore = NamesBefore::of(surface.mesh.vertexCount(), surface.mesh.faceCount());
  ASSERT_TRUE(change(surface));
  const NamesBefore names = *surface.namesBefore;
  ASSERT_EQ(names.vertex.size(), surface.mesh.vertexCount());
  ASSERT_EQ(names.face.size(), surface.mesh.faceCount());
  ASSERT_TRUE(levels.follow(surface.mesh, surface.hash, names, levelOptionsOf(edgeLength, 2)));

  const Level& level = levels.hierarchy().intermediate;
  EXPECT_EQ(validate(level.mesh), "");
  EXPECT_EQ(levels.hierarchy().log.fineHash, surface.hash);
  expectLogOf(surface.mesh, levels.hierarchy());
  const TopologySummary fine = summarizeTopology(surface.mesh),
                        coarse = summarizeTopology(level.mesh);
  EXPECT_EQ(coarse.eulerCharacteristic, fine.eulerCharacteristic);
  EXPECT_EQ(coarse.boundaryLoops, fine.boundaryLoops);
  EXPECT_EQ(coarse.components, fine.components);

  const Redecimation anew(surface.mesh, surface.hash, levelOptionsOf(edgeLength, 1));
  const double vertices = anew.hierarchy().intermediate.mesh.vertexCount();
  EXPECT_NEAR(level.mesh.vertexCount(), vertices, 0.05 * vertices);

  const Hierarchy& both = levels.update(levelOptionsOf(edgeLength, 1));
  EXPECT_EQ(validate(both.coarse.mesh), "");
  EXPECT_EQ(summarizeTopology(both.coarse.mesh).eulerCharacteristic, fine.eulerCharacteristic);
}

std::vector<std::vector<Index>> handlesShorterThan(const Mesh& mesh, double limit)
{
  std::vector<std::vector<Index>> places;
  for (const HandleLoop& loop : findHandles(mesh, limit).loops)
  {
    places.push_back(loop.vertices);
  }
  return places;
}

TEST(ChangedMesh, LevelsFollowACutHandle)
{
  const test::SphereWithHandle model = test::sphereWithHandle(6, Vector3(1, 2, 3).normalized());
  const double limit = 1.5 * model.mouthLength;
  expectToFollow(prepared(model.mesh), 0.15,
    [&](PreparedSurface& surface) {
      return closeHandles(surface, handlesShorterThan(surface.mesh, limit), 2 * limit).size() == 1;
    });
}

TEST(ChangedMesh, LevelsFollowACutHandleAndSmallerTriangles)
{
  const test::SphereWithHandle model = test::sphereWithHandle(6, Vector3(1, 2, 3).normalized());
  const double limit = 1.5 * model.mouthLength;
  expectToFollow(prepared(model.mesh), 0.15,
    [&](PreparedSurface& surface)
    {
      const bool isCut =
        closeHandles(surface, handlesShorterThan(surface.mesh, limit), 2 * limit).size() == 1;
      // Of the two steps, each of which has an order of its own, the second one splits a few edges only.
      double longest = 0;
      for (Index h = 0; h < surface.mesh.halfEdgeCount(); ++h)
      {
        longest = std::max(longest, surface.mesh.edgeVector(h).norm());
      }
      const Index before = surface.mesh.faceCount();
      refineSurface(surface, 0.999 * longest, {});
      return isCut && surface.mesh.faceCount() > before;
    });
}

TEST(ChangedMesh, LevelsFollowAFilledHole)
{
  Mesh plate = test::plateWithHole(40);
  expectToFollow(prepared(plate), 0.3 * test::plateWithHole(1).edgeVector(0).norm(),
    [&](PreparedSurface& surface)
    {
      std::vector<HandleLoop> loops = measureBoundary(surface.mesh, 1e9).tooShort;
      std::sort(loops.begin(), loops.end(),
        [](const HandleLoop& a, const HandleLoop& b) { return a.length < b.length; });
      loops.resize(1);
      return fillHoles(surface, loops).size() == 1;
    });
}

TEST(ChangedMesh, NothingChangedIsNothingToDo)
{
  PreparedSurface surface = prepared(test::sphere(5));
  Redecimation levels(surface.mesh, surface.hash, levelOptionsOf(0.2, 1));
  const Hierarchy before = levels.hierarchy();
  ASSERT_TRUE(levels.follow(surface.mesh, surface.hash,
    NamesBefore::of(surface.mesh.vertexCount(), surface.mesh.faceCount()), levelOptionsOf(0.2, 1)));
  EXPECT_EQ(levels.hierarchy().log.blocks, before.log.blocks);
  EXPECT_EQ(levels.hierarchy().intermediate.fineFace, before.intermediate.fineFace);
  EXPECT_EQ(levels.hierarchy().intermediate.mesh.origin, before.intermediate.mesh.origin);
  EXPECT_EQ(levels.hierarchy().intermediate.mesh.twin, before.intermediate.mesh.twin);
}

TEST(ChangedMesh, WhereMuchHasChangedNewLevelsAreLess)
{
  PreparedSurface surface = prepared(test::sphere(3));
  Redecimation levels(surface.mesh, surface.hash, levelOptionsOf(0.5, 1));
  surface.namesBefore = NamesBefore::of(surface.mesh.vertexCount(), surface.mesh.faceCount());
  refineSurface(surface, 0.1, {}); // splits all edges
  EXPECT_FALSE(
    levels.follow(surface.mesh, surface.hash, *surface.namesBefore, levelOptionsOf(0.5, 1)));
}

} // namespace
} // namespace quadrille

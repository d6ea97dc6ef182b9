// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMaps.h"

#include "Extraction/Extraction.h"
#include "Extraction/HoleFilling.h"
#include "Quads/QuadTopology.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace quadrille::test
{
namespace
{

QuadMesh extractUnsmoothed(const GridMapCase& c)
{
  ExtractionOptions options;
  options.smoothingSteps = 0;
  return extractQuads(c.mesh, c.uv, options).mesh;
}

void removeQuads(QuadMesh& mesh, const std::vector<Index>& ids)
{
  for (auto id = ids.rbegin(); id != ids.rend(); ++id)
  {
    mesh.quads.erase(mesh.quads.begin() + *id);
    mesh.quadSourceFace.erase(mesh.quadSourceFace.begin() + *id);
    mesh.quadSourceWeights.erase(mesh.quadSourceWeights.begin() + *id);
  }
}

QuadTopology analyze(const QuadMesh& mesh)
{
  return analyzeQuads(mesh.quads, mesh.points.size());
}

bool sameQuad(std::array<Index, 4> a, std::array<Index, 4> b)
{
  std::rotate(a.begin(), std::min_element(a.begin(), a.end()), a.end());
  std::rotate(b.begin(), std::min_element(b.begin(), b.end()), b.end());
  return a == b;
}

} // namespace

TEST(HoleFilling, RestoresAnyMissingQuad)
{
  const QuadMesh whole = extractUnsmoothed(squares("", unitCube(2), 2));
  for (Index q = 0; q < whole.quads.size(); ++q)
  {
    QuadMesh mesh = whole;
    removeQuads(mesh, { q });
    EXPECT_EQ(fillHoles(mesh), 1u);
    ASSERT_EQ(mesh.quads.size(), whole.quads.size());
    EXPECT_EQ(mesh.quadSourceFace.size(), mesh.quads.size());
    EXPECT_EQ(mesh.quadSourceWeights.size(), mesh.quads.size());
    EXPECT_TRUE(sameQuad(mesh.quads.back(), whole.quads[q]));
  }
}

// Two neighbours: six sides, and of the three ways to cut them only the old one is convex on a
// plane.
TEST(HoleFilling, RestoresTwoMissingQuads)
{
  const QuadMesh whole = extractUnsmoothed(squares("", gridPlane(4, 4), 1));
  const QuadTopology topology = analyze(whole);
  int pairs = 0;
  for (Index h = 0; h < topology.twin.size(); ++h)
  {
    const Index g = topology.twin[h];
    const auto inside = [&](Index q)
    {
      return std::all_of(whole.quads[q].begin(), whole.quads[q].end(),
        [&](Index p) { return topology.onBoundary[p] == 0; });
    };
    if (g == kInvalidIndex || g < h || !inside(h / 4) || !inside(g / 4))
    {
      continue;
    }
    ++pairs;
    QuadMesh mesh = whole;
    removeQuads(mesh, { std::min(h / 4, g / 4), std::max(h / 4, g / 4) });
    EXPECT_EQ(fillHoles(mesh), 1u);
    ASSERT_EQ(mesh.quads.size(), whole.quads.size());
    for (std::size_t i = mesh.quads.size() - 2; i < mesh.quads.size(); ++i)
    {
      EXPECT_TRUE(
        sameQuad(mesh.quads[i], whole.quads[h / 4]) || sameQuad(mesh.quads[i], whole.quads[g / 4]));
    }
  }
  EXPECT_EQ(pairs, 4); // the inner 2 x 2 cells
}

TEST(HoleFilling, LeavesTheInputsHoles)
{
  // The hole of the plate has 8 sides, few enough to be filled were it not a boundary of the input.
  QuadMesh mesh = extractUnsmoothed(squares("", plateWithHole(2), 1));
  const std::size_t quads = mesh.quads.size();
  EXPECT_EQ(fillHoles(mesh), 0u);
  EXPECT_EQ(mesh.quads.size(), quads);
  EXPECT_EQ(analyze(mesh).boundaryLoops, 2u);
}

// A cube without two opposite sides could be closed by quads inside out or over existing edges only
// where that makes no manifold; whatever is done, the result is a manifold.
TEST(HoleFilling, NeverMakesNonManifolds)
{
  const QuadMesh whole = extractUnsmoothed(squares("", unitCube(1), 2));
  Random random(11);
  for (int round = 0; round < 300; ++round)
  {
    QuadMesh mesh = whole;
    std::vector<Index> ids;
    for (Index q = 0; q < mesh.quads.size(); ++q)
    {
      if (pick(random, 5) == 0)
      {
        ids.push_back(q);
      }
    }
    removeQuads(mesh, ids);
    const QuadTopology before = analyze(mesh);
    fillHoles(mesh);
    const QuadTopology after = analyze(mesh);
    EXPECT_LE(after.nonManifoldEdges, before.nonManifoldEdges);
    EXPECT_EQ(after.degenerateQuads, 0u);
  }
}

} // namespace quadrille::test

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMaps.h"

#include "Extraction/Extraction.h"
#include "Extraction/QuadCoverage.h"

#include <gtest/gtest.h>

#include <cmath>

namespace quadrille::test
{
namespace
{

QuadMesh quadsOf(const GridMapCase& c, int smoothingSteps = 0)
{
  ExtractionOptions options;
  options.smoothingSteps = smoothingSteps;
  ExtractionResult result = extractQuads(c.mesh, c.uv, options);
  EXPECT_TRUE(result.status.ok()) << c.name << ": " << result.status.message;
  return result.mesh;
}

/// Each face is shared out among the quads by its area in the map, and each quad is covered once.
void expectPartition(const GridMapCase& c, const QuadCoverage& coverage, const QuadMesh& quads)
{
  std::vector<double> area(c.mesh.faceCount(), 0);
  ASSERT_EQ(coverage.first.size(), quads.quads.size() + 1);
  for (std::size_t q = 0; q < quads.quads.size(); ++q)
  {
    EXPECT_EQ(coverage.shares[coverage.first[q]].face, quads.quadSourceFace[q]);
    double sum = 0;
    for (std::size_t i = coverage.first[q]; i < coverage.first[q + 1]; ++i)
    {
      sum += coverage.shares[i].weight;
      area[coverage.shares[i].face] += coverage.shares[i].weight;
      EXPECT_GT(coverage.shares[i].weight, 0);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
  for (Index f = 0; f < c.mesh.faceCount(); ++f)
  {
    const Vector2 p = toDouble(c.uv[3 * f + 1] - c.uv[3 * f]);
    const Vector2 q = toDouble(c.uv[3 * f + 2] - c.uv[3 * f]);
    EXPECT_NEAR(
      area[f], std::abs(p.x() * q.y() - p.y() * q.x()) / 2, 1e-9); // rounding of clipped corners
  }
}

} // namespace

TEST(QuadCoverage, SharesAllOfTheMapOut)
{
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    SCOPED_TRACE(seed);
    Random random(seed);
    for (GridMapCase& c : allCases(1 + static_cast<int>(seed % 3)))
    {
      SCOPED_TRACE(c.name);
      MapEditor editor(c);
      editor.shuffleCharts(random);
      editor.refine(random, 20 << (seed % 4));
      editor.shuffleCharts(random);
      const QuadMesh quads = quadsOf(c);
      expectPartition(c, coverQuads(c.mesh, c.uv, quads, 1), quads);

      for (FixedVec2& p : c.uv) // mirrored: every triangle is inverted
      {
        p.u = -p.u;
      }
      const QuadMesh mirrored = quadsOf(c);
      expectPartition(c, coverQuads(c.mesh, c.uv, mirrored, 1), mirrored);
    }
    if (HasFailure())
    {
      return;
    }
  }
}

// The square is that of the map: other charts, and points that smoothing has moved, change nothing.
TEST(QuadCoverage, DependsOnTheMapOnly)
{
  Random random(3);
  GridMapCase c = squares("", tripod(2), 2);
  MapEditor(c).refine(random, 400, false);
  const QuadMesh quads = quadsOf(c);
  const QuadCoverage before = coverQuads(c.mesh, c.uv, quads, 1);
  const QuadMesh smooth = quadsOf(c, 5);
  EXPECT_NE(smooth.points, quads.points);
  MapEditor(c).shuffleCharts(random);
  const QuadCoverage after = coverQuads(c.mesh, c.uv, smooth, 2);
  EXPECT_EQ(before.first, after.first);
  for (std::size_t i = 0; i < before.shares.size(); ++i)
  {
    EXPECT_EQ(before.shares[i].face, after.shares[i].face);
    EXPECT_NEAR(before.shares[i].weight, after.shares[i].weight, 1e-12);
  }
}

// A feature may cut a quad only where the map is folded or no integer-grid map; here it is put there by hand.
TEST(QuadCoverage, NothingFromBeyondAFeatureCounts)
{
  GridMapCase c = squares("", gridPlane(2, 2), 1);
  const QuadMesh quads = quadsOf(c);
  for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h) // all diagonals
  {
    c.mesh.flags.edit()[h] |= h % 6 == 2 || h % 6 == 3 ? kFeatureEdge : 0;
  }
  const QuadCoverage coverage = coverQuads(c.mesh, c.uv, quads, 1);
  for (std::size_t q = 0; q < quads.quads.size(); ++q)
  {
    ASSERT_EQ(coverage.first[q + 1] - coverage.first[q], 1u);
    EXPECT_EQ(coverage.shares[coverage.first[q]].face, quads.quadSourceFace[q]);
    EXPECT_EQ(coverage.shares[coverage.first[q]].weight, 1);
  }
}

TEST(QuadCoverage, AQuadWithoutASquareHasItsFace)
{
  const GridMapCase c = squares("", gridPlane(2, 2), 1);
  QuadMesh quads = quadsOf(c);
  quads.quadSourceWeights[1] = {};
  const QuadCoverage coverage = coverQuads(c.mesh, c.uv, quads, 1);
  EXPECT_EQ(coverage.first[2] - coverage.first[1], 1u);
  EXPECT_EQ(coverage.first[1] - coverage.first[0], 2u);
  quads.quadSourceWeights.pop_back();
  EXPECT_THROW(coverQuads(c.mesh, c.uv, quads, 1), InvalidInput);
}

} // namespace quadrille::test

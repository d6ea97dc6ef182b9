// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/StripInsertion.h"

#include "Quads/QuadTopology.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace quadrille
{
namespace
{

/// columns x rows unit quads; point (x, y) is y (columns + 1) + x.
QuadMesh quadGrid(Index columns, Index rows)
{
  QuadMesh mesh;
  for (Index y = 0; y <= rows; ++y)
  {
    for (Index x = 0; x <= columns; ++x)
    {
      mesh.points.emplace_back(x, y, 0);
      mesh.sourceFace.push_back(0);
      mesh.sourceWeights.push_back({ 1, 0, 0 });
    }
  }
  for (Index y = 0; y < rows; ++y)
  {
    for (Index x = 0; x < columns; ++x)
    {
      const Index p = y * (columns + 1) + x;
      mesh.quads.push_back({ p, p + 1, p + columns + 2, p + columns + 1 });
      mesh.quadSourceFace.push_back(x + 10 * y);
      mesh.quadSourceWeights.push_back({ 1, 0, 0 });
    }
  }
  const QuadTopology topology = analyzeQuads(mesh.quads, mesh.points.size());
  mesh.valence = topology.valence;
  mesh.onBoundary = topology.onBoundary;
  return mesh;
}

int irregularInside(const QuadMesh& mesh)
{
  int count = 0;
  for (std::size_t p = 0; p < mesh.points.size(); ++p)
  {
    const bool isInside = mesh.onBoundary[p] == 0 && mesh.valence[p] != 0;
    count += isInside && mesh.valence[p] != 4 ? 1 : 0;
  }
  return count;
}

void expectDiscOf(const QuadMesh& mesh, std::size_t quads, std::size_t boundaryEdges)
{
  const QuadTopology topology = analyzeQuads(mesh.quads, mesh.points.size());
  EXPECT_TRUE(topology.manifold()) << topology.text();
  EXPECT_EQ(mesh.quads.size(), quads);
  EXPECT_EQ(topology.boundaryEdges, boundaryEdges);
  EXPECT_EQ(topology.eulerCharacteristic, 1);
  EXPECT_EQ(mesh.quadSourceFace.size(), quads);
  EXPECT_EQ(mesh.quadSourceWeights.size(), quads);
  EXPECT_EQ(mesh.sourceFace.size(), mesh.points.size());
  EXPECT_EQ(mesh.valence, topology.valence);
  EXPECT_EQ(mesh.onBoundary, topology.onBoundary);
}

std::optional<double> endsAt(const std::vector<Index>& ends, Index end)
{
  return std::find(ends.begin(), ends.end(), end) == ends.end() ? std::nullopt
                                                                : std::optional<double>(0);
}

TEST(StripInsertion, AStraightPathKeepsAllRegular)
{
  QuadMesh mesh = quadGrid(4, 3);
  // From the third point of the lower side to the upper one.
  const auto path = findStripPath(mesh, { { 2, 0.0 } },
    [](Index, Index end) {
      return endsAt({ 15, 16, 17, 18, 19 }, end);
    });
  ASSERT_TRUE(path);
  EXPECT_EQ(path->size(), 3U);
  const InsertedStrip strip = insertStrip(mesh, *path);
  ASSERT_EQ(strip.points.size(), 4U);
  EXPECT_EQ(strip.points.front().first, 2U);
  EXPECT_EQ(strip.points.back().first, 17U);
  expectDiscOf(mesh, 4 * 3 + 3, 14 + 2);
  EXPECT_EQ(irregularInside(mesh), 0);
  // Left of the way up are the lower x: there points keep their ids.
  EXPECT_EQ(mesh.quads[1], (std::array<Index, 4>{ 1, 2, 7, 6 }));
  EXPECT_EQ(
    mesh.quads[2], (std::array<Index, 4>{ strip.points[0].second, 3, 8, strip.points[1].second }));
  for (std::size_t q = 12; q < 15; ++q)
  {
    EXPECT_EQ(mesh.quadSourceFace[q], 1 + 10 * (q - 12)); // that of the quad on the left
  }
}

TEST(StripInsertion, ATurnMakesAPairOfIrregularPoints)
{
  QuadMesh mesh = quadGrid(4, 4);
  const auto path =
    findStripPath(mesh, { { 2, 0.0 } }, [](Index, Index end) { return endsAt({ 10 }, end); });
  ASSERT_TRUE(path);
  EXPECT_EQ(path->size(), 4U); // up two and left two
  insertStrip(mesh, *path);
  expectDiscOf(mesh, 16 + 4, 16 + 2);
  EXPECT_EQ(irregularInside(mesh), 2);
}

/// Costs decide among starts and ends; a start is no end of its own path.
TEST(StripInsertion, CostsChooseThePath)
{
  const QuadMesh mesh = quadGrid(4, 3);
  const auto path = findStripPath(mesh, { { 1, 5.0 }, { 2, 9.0 }, { 3, 4.5 } },
    [](Index start, Index end)
    {
      EXPECT_NE(start, end);
      return end == 16 ? std::optional<double>(0)
        : end == 18    ? std::optional<double>(3)
                       : std::nullopt;
    });
  ASSERT_TRUE(path);
  EXPECT_EQ(mesh.quads[path->front() / 4][path->front() % 4], 1U);
  EXPECT_FALSE(findStripPath(mesh, { { 1, 0.0 } }, [](Index, Index) { return std::nullopt; }));
}

TEST(StripInsertion, LinesAreCrossedButNotFollowed)
{
  QuadMesh mesh = quadGrid(4, 4);
  for (Index x = 0; x < 4; ++x)
  {
    mesh.lines.push_back({ 10 + x, 11 + x, x, false }); // across the middle
  }
  for (Index y = 0; y < 4; ++y)
  {
    mesh.lines.push_back({ 2 + 5 * y, 7 + 5 * y, 10 + y, false }); // up the middle
  }
  EXPECT_FALSE(findStripPath(mesh, { { 2, 0.0 } }, [](Index, Index) { return 0.0; }));
  const auto path =
    findStripPath(mesh, { { 1, 0.0 } }, [](Index, Index end) { return endsAt({ 21 }, end); });
  ASSERT_TRUE(path);
  const InsertedStrip strip = insertStrip(mesh, *path);
  expectDiscOf(mesh, 20, 18);
  // The line across goes on over the strip, from the left border to the right one.
  std::size_t across = 0;
  for (const QuadLine& line : mesh.lines)
  {
    across += !line.boundary && line.halfEdge < 10 ? 1 : 0;
    const bool isThere = std::any_of(mesh.quads.begin(), mesh.quads.end(),
      [&](const std::array<Index, 4>& quad)
      {
        for (std::size_t i = 0; i < 4; ++i)
        {
          const Index a = quad[i], b = quad[(i + 1) % 4];
          if ((a == line.a && b == line.b) || (a == line.b && b == line.a))
          {
            return true;
          }
        }
        return false;
      });
    EXPECT_TRUE(isThere) << line.a << " " << line.b;
  }
  EXPECT_EQ(across, 5U);
  EXPECT_EQ(std::count_if(mesh.lines.begin(), mesh.lines.end(),
              [](const QuadLine& line) { return line.boundary; }),
    2); // the two new edges of the boundary
  EXPECT_EQ(strip.points.size(), 5U);
}

TEST(StripInsertion, AChordIsSplitLengthwise)
{
  QuadMesh mesh = quadGrid(4, 3);
  mesh.lines.push_back({ 5, 6, 0, false }); // crossed by the chord
  mesh.lines.push_back({ 2, 7, 1, false }); // not
  // From the first edge of the lower side upwards.
  const auto chord = chordFrom(analyzeQuads(mesh.quads, mesh.points.size()).twin, 0);
  ASSERT_TRUE(chord);
  EXPECT_EQ(chord->size(), 3U);
  const InsertedStrip strip = splitChord(mesh, *chord);
  EXPECT_EQ(strip.points.size(), 4U);
  expectDiscOf(mesh, 12 + 3, 14 + 2);
  EXPECT_EQ(irregularInside(mesh), 0);
  EXPECT_EQ(mesh.lines.size(), 3U);
  EXPECT_EQ(mesh.lines[1].a, 2U);
  EXPECT_EQ(mesh.lines[1].b, 7U);
  EXPECT_EQ(mesh.lines[0].b, strip.points[1].second);
  EXPECT_EQ(mesh.lines[2].a, strip.points[1].second);
}

TEST(StripInsertion, AChordIsTakenOut)
{
  QuadMesh mesh = quadGrid(4, 3);
  const auto chord = chordFrom(analyzeQuads(mesh.quads, mesh.points.size()).twin, 0);
  ASSERT_TRUE(chord);
  removeChord(mesh, *chord, [](Index p) { return p == 0 ? 1 : 0; });
  EXPECT_EQ(mesh.quads.size(), 9U);
  EXPECT_EQ(mesh.quadSourceFace.size(), 9U);
  const QuadTopology topology = analyzeQuads(mesh.quads, mesh.points.size());
  EXPECT_EQ(topology.boundaryEdges, 12U);
  EXPECT_EQ(topology.nonManifoldEdges + topology.nonManifoldVertices, 0U);
  EXPECT_EQ(topology.isolatedPoints, 4U);
  EXPECT_EQ(irregularInside(mesh), 0);
  EXPECT_EQ(mesh.points[0], Vector3(0, 0, 0)); // is of higher rank
  EXPECT_EQ(mesh.points[5], Vector3(0.5, 1, 0));
}

} // namespace
} // namespace quadrille

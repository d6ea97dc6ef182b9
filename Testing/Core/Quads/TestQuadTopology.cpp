// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadChecks.h"

#include "Quads/QuadTopology.h"

namespace quadrille::test
{
namespace
{

using Quads = std::vector<std::array<Index, 4>>;

/// columns x rows quads, closed both ways: (columns rows) points.
Quads torusOfQuads(Index columns, Index rows)
{
  Quads quads;
  const auto point = [=](Index i, Index j) { return j % rows * columns + i % columns; };
  for (Index j = 0; j < rows; ++j)
  {
    for (Index i = 0; i < columns; ++i)
    {
      quads.push_back({ point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1) });
    }
  }
  return quads;
}

void expectSameTopology(const QuadTopology& a, const QuadTopology& b)
{
  EXPECT_EQ(a.twin, b.twin);
  EXPECT_EQ(a.valence, b.valence);
  EXPECT_EQ(a.onBoundary, b.onBoundary);
  EXPECT_EQ(a.text(), b.text());
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_EQ(a.components, b.components);
  EXPECT_EQ(a.boundaryEdges, b.boundaryEdges);
  EXPECT_EQ(a.boundaryLoops, b.boundaryLoops);
  EXPECT_EQ(a.eulerCharacteristic, b.eulerCharacteristic);
  EXPECT_EQ(a.defectPoints, b.defectPoints);
}

} // namespace

TEST(QuadTopology, ClosedAndOpen)
{
  const QuadTopology torus = analyzeQuads(torusOfQuads(4, 3), 12);
  EXPECT_TRUE(torus.manifold());
  EXPECT_TRUE(torus.closed());
  EXPECT_EQ(torus.eulerCharacteristic, 0);
  EXPECT_EQ(torus.components, 1u);
  EXPECT_EQ(torus.valence, std::vector<int>(12, 4));

  Quads open = torusOfQuads(4, 3);
  open.pop_back(); // 11, 8, 0, 3
  const QuadTopology hole = analyzeQuads(open, 12);
  EXPECT_TRUE(hole.manifold());
  EXPECT_EQ(hole.boundaryEdges, 4u);
  EXPECT_EQ(hole.boundaryLoops, 1u);
  EXPECT_EQ(hole.eulerCharacteristic, -1);
  EXPECT_EQ(hole.valence, std::vector<int>(12, 4));
  EXPECT_EQ(hole.onBoundary, (std::vector<std::uint8_t>{ 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1 }));
}

TEST(QuadTopology, NamesWhatIsNoManifold)
{
  // Three quads along edge (0, 1).
  const QuadTopology book = analyzeQuads({ { 0, 1, 2, 3 }, { 1, 0, 4, 5 }, { 0, 1, 6, 7 } }, 8);
  EXPECT_EQ(book.nonManifoldEdges, 2u);
  EXPECT_EQ(book.defectPoints.front(), 0u);
  // Two quads that run along edge (0, 1) the same way.
  EXPECT_EQ(analyzeQuads({ { 0, 1, 2, 3 }, { 0, 1, 4, 5 } }, 6).nonManifoldEdges, 2u);
  // Two quads that touch in point 0 only.
  const QuadTopology bow = analyzeQuads({ { 0, 1, 2, 3 }, { 0, 4, 5, 6 } }, 7);
  EXPECT_EQ(bow.nonManifoldVertices, 1u);
  EXPECT_EQ(bow.defectPoints, std::vector<Index>{ 0 });
  EXPECT_EQ(bow.components, 1u);
  const QuadTopology pinched = analyzeQuads({ { 0, 1, 0, 2 } }, 4);
  EXPECT_EQ(pinched.degenerateQuads, 1u);
  EXPECT_EQ(pinched.isolatedPoints, 1u);
  EXPECT_EQ(pinched.components, 1u);
  EXPECT_FALSE(pinched.manifold());
  try
  {
    analyzeQuads({ { 0, 1, 2, 3 }, { 1, 0, 4, 5 } }, 5);
    FAIL();
  }
  catch (const InvalidInput& error)
  {
    EXPECT_NE(std::string(error.what()).find("quad 1 refers to point 5 of 5"), std::string::npos);
  }
}

// Damaged meshes of more quads than a thread takes at once.
TEST(QuadTopology, SameForAnyNumberOfThreads)
{
  Random random(11);
  Quads quads = torusOfQuads(200, 150);
  for (int i = 0; i < 400; ++i)
  {
    const std::size_t q = static_cast<std::size_t>(pick(random, static_cast<int>(quads.size())));
    switch (pick(random, 3))
    {
      case 0:
        quads.erase(quads.begin() + static_cast<std::ptrdiff_t>(q));
        break;
      case 1:
        quads.push_back(quads[q]);
        break;
      default:
        quads[q][static_cast<std::size_t>(pick(random, 4))] =
          static_cast<Index>(pick(random, 30000));
    }
  }
  const QuadTopology one = analyzeQuads(quads, 30000, 1);
  EXPECT_GT(one.nonManifoldEdges, 0u);
  EXPECT_GT(one.nonManifoldVertices, 0u);
  EXPECT_GT(one.boundaryEdges, 0u);
  expectSameTopology(one, analyzeQuads(quads, 30000, 2));
  expectSameTopology(one, analyzeQuads(quads, 30000, 5));
  quads = torusOfQuads(200, 150);
  quads.erase(quads.begin() + 70);
  expectSameTopology(analyzeQuads(quads, 30000, 1), analyzeQuads(quads, 30000, 3));
}

// Time that grows with the square of a valence would not end here.
TEST(QuadTopology, PointWithVeryManyQuads)
{
  const Index spokes = 400000;
  Quads quads;
  for (Index i = 0; i < spokes; ++i)
  {
    quads.push_back({ 0, 1 + 2 * i, 2 + 2 * i, 1 + 2 * ((i + 1) % spokes) });
  }
  const QuadTopology fan = analyzeQuads(quads, 1 + 2 * std::size_t{ spokes });
  EXPECT_TRUE(fan.manifold());
  EXPECT_EQ(fan.valence[0], static_cast<int>(spokes));
  EXPECT_EQ(fan.boundaryEdges, 2 * std::size_t{ spokes });
  EXPECT_EQ(fan.boundaryLoops, 1u);
}

} // namespace quadrille::test

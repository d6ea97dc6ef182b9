// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadChecks.h"

#include <algorithm>
#include <numeric>

namespace quadrille::test
{
namespace
{

void expectPerfect(const GridMapCase& c)
{
  SCOPED_TRACE(c.name);
  ASSERT_EQ(validate(c.mesh), "");
  const ExtractionResult result = extract(c);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.mesh.quads.size(), c.quads);
  EXPECT_EQ(result.mesh.lines.size(), c.lines);
  EXPECT_EQ(result.openPorts, 0u);
  EXPECT_EQ(result.droppedFaces, 0u);
  EXPECT_EQ(result.mergedVertices, 0u);
  expectTopologyOfInput(c.mesh, result.mesh);
  expectConsistentAttributes(c.mesh, result.mesh);
  expectSameOnBothPaths(c);
}

void expectSame(const QuadMesh& a, const QuadMesh& b)
{
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.quads, b.quads);
  EXPECT_EQ(a.sourceFace, b.sourceFace);
  EXPECT_EQ(a.sourceWeights, b.sourceWeights);
  EXPECT_EQ(a.quadSourceFace, b.quadSourceFace);
  EXPECT_EQ(a.quadSourceWeights, b.quadSourceWeights);
  EXPECT_EQ(a.valence, b.valence);
  EXPECT_EQ(a.onBoundary, b.onBoundary);
  ASSERT_EQ(a.lines.size(), b.lines.size());
  for (std::size_t i = 0; i < a.lines.size(); ++i)
  {
    EXPECT_EQ(a.lines[i].a, b.lines[i].a);
    EXPECT_EQ(a.lines[i].b, b.lines[i].b);
    EXPECT_EQ(a.lines[i].halfEdge, b.lines[i].halfEdge);
    EXPECT_EQ(a.lines[i].boundary, b.lines[i].boundary);
  }
}

std::map<int, int> interiorValences(const QuadMesh& mesh)
{
  std::map<int, int> count;
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
  {
    if (!mesh.onBoundary[i])
    {
      ++count[mesh.valence[i]];
    }
  }
  return count;
}

} // namespace

// A map is the same in any charts, so are its quads, their order and every bit of their points.
TEST(Extraction, QuadsDoNotDependOnCharts)
{
  Random random(11);
  for (const int k : { 1, 3, 7 })
  {
    for (GridMapCase c : allCases(k))
    {
      for (const bool folded : { false, true })
      {
        SCOPED_TRACE(c.name + (folded ? " with folds" : ""));
        MapEditor editor(c);
        folded ? editor.tangle(random, 3) : editor.refine(random, 60, false);
        GridMapCase shuffled = c;
        MapEditor(shuffled).shuffleCharts(random);
        expectSame(extract(c).mesh, extract(shuffled).mesh);
        ExtractionOptions smooth;
        smooth.threads = 1;
        expectSame(extractQuads(c.mesh, c.uv, smooth).mesh,
          extractQuads(shuffled.mesh, shuffled.uv, smooth).mesh);
      }
    }
  }
}

// Every grid vertex on a mesh vertex, and grid lines along mesh edges only.
TEST(Extraction, UnitSquares)
{
  for (const GridMapCase& c : allCases(1))
  {
    expectPerfect(c);
  }
}

// Grid vertices inside edges (the diagonals, too) and faces.
TEST(Extraction, SquaresOfSeveralUnits)
{
  for (const int k : { 2, 3, 7 })
  {
    for (const GridMapCase& c : allCases(k))
    {
      expectPerfect(c);
    }
  }
}

TEST(Extraction, IrregularVerticesOfPolycubes)
{
  // Theory: the corners of a cube have valence 3; the tripod has one vertex with six faces round
  // it.
  const auto cube = interiorValences(extract(squares("", unitCube(1), 3)).mesh);
  EXPECT_EQ(cube.at(3), 8);
  EXPECT_EQ(cube.size(), 2u);
  const auto cushion = interiorValences(extract(squares("", pillow(2), 3)).mesh);
  EXPECT_EQ(cushion.at(2), 4);
  EXPECT_EQ(cushion.size(), 2u);
  const auto legs = interiorValences(extract(squares("", tripod(1), 2)).mesh);
  EXPECT_EQ(legs.at(6), 1);
  // sum of (4 - valence) = 4 chi = 8
  int sum = 0;
  for (const auto& [valence, count] : legs)
  {
    sum += (4 - valence) * count;
  }
  EXPECT_EQ(sum, 8);
}

// On flat squares the centre of a quad in the map is the mean of its corners in space.
TEST(Extraction, CentresOfQuads)
{
  Random random(5);
  for (const Mesh& mesh : { gridPlane(5, 3), unitCube(2), tripod(1) })
  {
    GridMapCase c = squares("", mesh, 3);
    MapEditor(c).shuffleCharts(random);
    const QuadMesh quads = extract(c).mesh;
    for (std::size_t q = 0; q < quads.quads.size(); ++q)
    {
      Vector3 centre = Vector3::Zero();
      Vector3 mean = Vector3::Zero();
      for (Index i = 0; i < 3; ++i)
      {
        centre += quads.quadSourceWeights[q][i] *
          c.mesh.position[c.mesh.origin[3 * quads.quadSourceFace[q] + i]];
      }
      for (const Index p : quads.quads[q])
      {
        mean += quads.points[p] / 4;
      }
      EXPECT_LT((centre - mean).norm(), 1e-12); // rounding
    }
  }
}

TEST(Extraction, RandomChartsAndTriangulations)
{
  for (unsigned seed = 0; seed < 30; ++seed)
  {
    SCOPED_TRACE(seed);
    Random random(seed);
    for (GridMapCase& c : allCases(1 + static_cast<int>(seed % 4)))
    {
      MapEditor editor(c);
      editor.shuffleCharts(random);
      editor.refine(random, 50 << (seed % 4));
      editor.shuffleCharts(random);
      expectPerfect(c);
    }
    if (HasFailure())
    {
      return;
    }
  }
}

// Inverted triangles here and there: exactly the quads of the map without them.
TEST(Extraction, FoldsDoNotShow)
{
  int folded = 0;
  for (unsigned seed = 0; seed < 40; ++seed)
  {
    SCOPED_TRACE(seed);
    Random random(1000 + seed);
    for (GridMapCase& c : allCases(2 + static_cast<int>(seed % 3)))
    {
      SCOPED_TRACE(c.name);
      MapEditor editor(c);
      editor.refine(random, 400);
      editor.shuffleCharts(random);
      editor.tangle(random, 1 + static_cast<int>(seed / 4));
      folded += isPositive(c) ? 0 : 1;
      const ExtractionResult result = extract(c);
      EXPECT_TRUE(result.status.ok()) << result.status.message;
      EXPECT_EQ(result.mesh.quads.size(), c.quads);
      EXPECT_EQ(result.mesh.lines.size(), c.lines);
      EXPECT_EQ(result.filledHoles + result.openPorts + result.droppedFaces, 0u);
      expectTopologyOfInput(c.mesh, result.mesh);
      expectConsistentAttributes(c.mesh, result.mesh);
    }
  }
  EXPECT_GT(folded, 100);
}

// Texture coordinates often are mirrored: all triangles inverted is no fold.
TEST(Extraction, MirroredMaps)
{
  Random random(12);
  for (GridMapCase& c : allCases(3))
  {
    SCOPED_TRACE(c.name);
    MapEditor editor(c);
    editor.refine(random, 200);
    editor.shuffleCharts(random);
    const ExtractionResult upright = extract(c);
    for (FixedVec2& p : c.uv)
    {
      p.u = -p.u;
    }
    const ExtractionResult mirrored = extract(c);
    EXPECT_TRUE(mirrored.status.ok()) << mirrored.status.message;
    EXPECT_TRUE(QuadSet(mirrored.mesh) == QuadSet(upright.mesh));
    EXPECT_EQ(mirrored.mergedVertices + mirrored.cancelledQuads, 0u);
    expectTopologyOfInput(c.mesh, mirrored.mesh);
  }
}

// One vertex of a torus is drawn ever further over its neighbours: the quads stay.
TEST(Extraction, CountsWhatFoldsAdd)
{
  std::size_t cancelled = 0;
  for (int du = 0; du <= 8; ++du)
  {
    for (int dv = 0; dv <= du; ++dv)
    {
      SCOPED_TRACE(std::to_string(du) + " " + std::to_string(dv));
      GridMapCase c = squares("", torus(12, 12), 1);
      const FixedVec2 way{ kOne / 2 * du + kOne / 4, kOne / 2 * dv + kOne / 8 };
      ASSERT_TRUE(MapEditor(c).moveVertex(0, way, true));
      const ExtractionResult result = extract(c, 1, ExtractionPath::Folded);
      EXPECT_TRUE(result.status.ok()) << result.status.message;
      EXPECT_EQ(result.mesh.quads.size(), c.quads);
      EXPECT_EQ(result.filledHoles + result.openPorts + result.droppedFaces, 0u);
      expectTopologyOfInput(c.mesh, result.mesh);
      cancelled += result.cancelledQuads;
      if (du == 2 && dv == 0) // the fold just covers the next grid vertex
      {
        EXPECT_EQ(result.mergedVertices, 1u);
        EXPECT_EQ(result.zeroSides, 4u);
        EXPECT_EQ(result.zippedSides, 1u);
      }
    }
  }
  EXPECT_GT(cancelled, 0u);
}

// A fold round the whole tube cannot be told from a longer tube: the map has 14 columns there, not 12.
TEST(Extraction, FoldsAllRoundStay)
{
  GridMapCase c = squares("", torus(12, 12), 1);
  MapEditor editor(c);
  const std::vector<Index> outgoing = outgoingHalfEdges(c.mesh);
  for (Index v = 0; v < c.mesh.vertexCount(); ++v)
  {
    const Vector3& p = c.mesh.position[v];
    if (std::abs(std::atan2(p.y(), p.x()) - kPi / 2) < 1e-6)
    {
      ASSERT_TRUE(editor.moveVertex(outgoing[v], { 5 * kOne / 2, 0 }, true));
    }
  }
  const ExtractionResult result = extract(c);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.mesh.quads.size(), 14 * 12u);
  expectTopologyOfInput(c.mesh, result.mesh);
}

TEST(Extraction, RefusesGarbage)
{
  const GridMapCase good = squares("", unitCube(2), 2);
  EXPECT_THROW(extractQuads(Mesh{}, {}, {}), InvalidInput);
  EXPECT_THROW(extractQuads(good.mesh, {}, {}), InvalidInput);

  GridMapCase far = good;
  far.uv[5].u = std::int64_t{ 1 } << 45;
  EXPECT_THROW(extract(far), InvalidInput);
  far.uv[5].u = std::numeric_limits<std::int64_t>::min();
  EXPECT_THROW(extract(far), InvalidInput);

  // Random numbers are no map: the edges' images do not match.
  Random random(3);
  GridMapCase noise = good;
  for (FixedVec2& p : noise.uv)
  {
    p = { static_cast<std::int64_t>(random() % (5 * kOne)),
      static_cast<std::int64_t>(random() % (5 * kOne)) };
  }
  EXPECT_EQ(extract(noise).status.code, StatusCode::NotConverged);

  // Everything on one point.
  GridMapCase nothing = good;
  nothing.uv.assign(nothing.uv.size(), FixedVec2{});
  EXPECT_EQ(extract(nothing).status.code, StatusCode::NotConverged);
}

// A seamless map that is folded all over covers the grid many times; it ends with a report, in time linear in
// what it covers.
TEST(Extraction, ReportsMapsFoldedAllOver)
{
  Random random(31);
  GridMapCase c = squares("", torus(20, 20), 1);
  MapEditor editor(c);
  for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h)
  {
    editor.moveVertex(
      h, { kOne / 10 * (pick(random, 401) - 200), kOne / 10 * (pick(random, 401) - 200) }, true);
  }
  const ExtractionResult result = extract(c);
  EXPECT_EQ(result.status.code, StatusCode::NotConverged);
  EXPECT_NE(result.status.message.find("inverted"), std::string::npos) << result.status.message;
}

// Round a tube whose length is no whole number, isolines wind without end.
TEST(Extraction, EndsOnIsolinesThatWindRound)
{
  GridMapCase c = squares("", openCylinder(5, 3), 1);
  for (FixedVec2& p : c.uv)
  {
    p.u = p.u == kOne ? 1 : p.u; // five triangles round make 5 * 2^-24
  }
  const ExtractionResult result = extract(c);
  EXPECT_EQ(result.status.code, StatusCode::NotConverged);
  EXPECT_TRUE(result.mesh.quads.empty());
}

TEST(Extraction, TheFastPathRefusesFolds)
{
  GridMapCase c = squares("", torus(5, 5), 2);
  MapEditor(c).moveVertex(0, { 3 * kOne, 0 }, true);
  ASSERT_FALSE(isPositive(c));
  EXPECT_THROW(extract(c, 1, ExtractionPath::Fast), InvalidInput);
}

TEST(Extraction, RefusesTooManyQuadsBeforeTheyAreMade)
{
  const GridMapCase c = squares("", unitCube(2), 100000);
  const ExtractionResult result = extract(c);
  EXPECT_EQ(result.status.code, StatusCode::TooLarge);
  EXPECT_TRUE(result.mesh.quads.empty());
  // 24 squares of 10^10 cells
  EXPECT_NE(result.status.message.find("240000000000"), std::string::npos);

  ExtractionOptions options;
  const GridMapCase small = squares("", unitCube(2), 2);
  options.maximumNumberOfQuads = small.quads;
  EXPECT_TRUE(extractQuads(small.mesh, small.uv, options).status.ok());
  options.maximumNumberOfQuads = small.quads - 1;
  EXPECT_EQ(extractQuads(small.mesh, small.uv, options).status.code, StatusCode::TooLarge);
}

// A boundary between isolines cannot be reproduced, and cells that it cuts are left out.
TEST(Extraction, ReportsBoundaryOffTheGrid)
{
  GridMapCase c = squares("", gridPlane(1, 1), 4);
  for (FixedVec2& p : c.uv)
  {
    p = p + FixedVec2{ kOne / 3, 0 };
  }
  const ExtractionResult result = extract(c);
  EXPECT_EQ(result.status.code, StatusCode::NotConverged);
  EXPECT_EQ(result.mesh.quads.size(), 12u); // 3 of 4 columns are whole
  EXPECT_GT(result.openPorts, 0u);
}

TEST(Extraction, CancelsWhenAsked)
{
  const GridMapCase c = squares("", unitCube(2), 2);
  ExtractionOptions options;
  options.progress = [](double fraction, const std::string&) { return fraction < 0.5; };
  EXPECT_THROW(extractQuads(c.mesh, c.uv, options), Cancelled);
}

TEST(Extraction, SameBytesForAnyNumberOfThreads)
{
  Random random(7);
  GridMapCase c = squares("", markFeatures(doubleTorus(2), 0.7), 20);
  MapEditor editor(c);
  editor.refine(random, 20000);
  editor.shuffleCharts(random);
  const ExtractionResult one = extract(c, 1);
  ASSERT_TRUE(one.status.ok()) << one.status.message;
  expectSame(one.mesh, extract(c, 2).mesh);
  expectSame(one.mesh, extract(c, 3).mesh);
}

// A square round one vertex with very many triangles, their ids ascending, descending or shuffled round it: time that
// grows with the square of their number would not end here.
TEST(Extraction, VertexWithVeryManyTriangles)
{
  constexpr Index kSide = 50000;
  for (const int arrangement : { 0, 1, 2 })
  {
    std::vector<Index> order(4 * kSide);
    std::iota(order.begin(), order.end(), Index{ 0 });
    if (arrangement == 1)
    {
      std::reverse(order.begin(), order.end());
    }
    else if (arrangement == 2)
    {
      std::shuffle(order.begin(), order.end(), Random(1));
    }
    const auto onRim = [](Index i)
    {
      const std::int64_t t = 4 * kOne * (i % kSide) / kSide;
      return rotate({ 2 * kOne, t - 2 * kOne }, static_cast<int>(i / kSide % 4));
    };
    std::vector<Vector3> points;
    std::vector<Triangle> triangles;
    GridMapCase c;
    for (Index i = 0; i < 4 * kSide; ++i)
    {
      const Vector2 p = toDouble(onRim(i));
      points.emplace_back(p.x(), p.y(), 0);
    }
    points.emplace_back(0, 0, 0);
    for (const Index i : order)
    {
      triangles.push_back({ 4 * kSide, i, (i + 1) % (4 * kSide) });
      c.uv.insert(c.uv.end(), { FixedVec2{}, onRim(i), onRim(i + 1) });
    }
    c.mesh = makeMesh(std::move(points), triangles);
    const ExtractionResult result = extract(c);
    EXPECT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(result.mesh.quads.size(), 16u);
  }
}

} // namespace quadrille::test

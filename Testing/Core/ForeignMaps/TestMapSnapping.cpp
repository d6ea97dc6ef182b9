// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadChecks.h"

#include "Base/Error.h"
#include "Extraction/ExactMap.h"
#include "Extraction/Extraction.h"
#include "ForeignMaps/MapSnapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace quadrille::test
{
namespace
{

/// The map in doubles, each corner off by up to `noise` on its own: no edge's images match any
/// more.
std::vector<Vector2> noisy(const GridMapCase& c, double noise, Random& random)
{
  std::vector<Vector2> uv;
  for (const FixedVec2& p : c.uv)
  {
    uv.push_back(
      toDouble(p) + noise / 1000 * Vector2(pick(random, 2001) - 1000, pick(random, 2001) - 1000));
  }
  return uv;
}

std::vector<Vector2> inDoubles(const GridMapCase& c)
{
  Random unused(0);
  return noisy(c, 0, unused);
}

/// Quarter turns over every half-edge, as the images have them.
std::vector<std::int8_t> matchingOf(const GridMapCase& c)
{
  const ExactMap map{ c.mesh, c.uv };
  std::vector<std::int8_t> matching;
  for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h)
  {
    Transition t;
    map.transition(h, t);
    matching.push_back(static_cast<std::int8_t>(t.rotation));
  }
  return matching;
}

/// The message of the InvalidInput that snapMap throws; empty where it throws none.
std::string refusal(
  const GridMapCase& c, const std::vector<Vector2>& uv, const SnapOptions& options = {})
{
  try
  {
    snapMap(c.mesh, uv, options);
  }
  catch (const InvalidInput& error)
  {
    return error.what();
  }
  return {};
}

/// An edge over which the chart turns.
Index turningEdge(const GridMapCase& c)
{
  const std::vector<std::int8_t> matching = matchingOf(c);
  return static_cast<Index>(std::find(matching.begin(), matching.end(), 1) - matching.begin());
}

} // namespace

TEST(MapSnapping, NoisyMapsBecomeExact)
{
  Random random(21);
  for (GridMapCase& c : allCases(3))
  {
    SCOPED_TRACE(c.name);
    MapEditor(c).shuffleCharts(random);
    const double noise = 1e-4;
    const SnapResult snapped = snapMap(c.mesh, noisy(c, noise, random));
    EXPECT_EQ(snapped.inconsistent, 0u);
    // The chosen corner keeps its place; others have their own noise and that of the chosen one.
    EXPECT_LT(snapped.largestMove, 3 * noise);
    const ExtractionResult result = extractQuads(c.mesh, snapped.uv, {});
    EXPECT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(result.mesh.quads.size(), c.quads);
    EXPECT_EQ(result.mesh.lines.size(), c.lines);
  }
}

TEST(MapSnapping, ExactMapsStay)
{
  Random random(22);
  for (GridMapCase& c : allCases(2))
  {
    SCOPED_TRACE(c.name);
    MapEditor editor(c);
    editor.refine(random, 300);
    editor.shuffleCharts(random);
    const SnapResult snapped = snapMap(c.mesh, noisy(c, 0, random));
    EXPECT_EQ(snapped.uv, c.uv);
    EXPECT_EQ(snapped.largestMove, 0);
  }
}

TEST(MapSnapping, RefusesGarbage)
{
  const GridMapCase c = squares("", unitCube(1), 1);
  Random random(23);
  std::vector<Vector2> uv = noisy(c, 0, random);
  EXPECT_THROW(snapMap(c.mesh, {}), InvalidInput);
  uv[7].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(snapMap(c.mesh, uv), InvalidInput);
  uv[7].x() = 9.2e18;
  EXPECT_THROW(snapMap(c.mesh, uv), InvalidInput);
}

// Images of length zero tell no turn, but a map that fits needs none.
TEST(MapSnapping, ExactMapsWithFlatTrianglesStay)
{
  Random random(30);
  for (GridMapCase& c : allCases(2))
  {
    SCOPED_TRACE(c.name);
    MapEditor editor(c);
    editor.refine(random, 200);
    editor.shuffleCharts(random);
    for (Index h = 0; h < c.mesh.halfEdgeCount(); h += 5)
    {
      GridMapCase flat = c; // the editor knows no turns over images of length zero
      MapEditor(flat).moveVertex(h, c.uv[Mesh::next(h)] - c.uv[h], true);
      EXPECT_EQ(snapMap(flat.mesh, inDoubles(flat)).uv, flat.uv);
    }
  }
}

TEST(MapSnapping, SameBytesForAnyNumberOfThreads)
{
  Random random(24);
  GridMapCase c = squares("", markFeatures(doubleTorus(2), 0.7), 6);
  MapEditor(c).refine(random, 40000);
  MapEditor(c).shuffleCharts(random);
  const std::vector<Vector2> uv = noisy(c, 1e-4, random);
  SnapOptions options;
  options.threads = 1;
  const SnapResult one = snapMap(c.mesh, uv, options);
  for (const int threads : { 2, 5 })
  {
    options.threads = threads;
    const SnapResult many = snapMap(c.mesh, uv, options);
    EXPECT_EQ(many.uv, one.uv);
    EXPECT_EQ(many.largestMove, one.largestMove);
    EXPECT_EQ(many.largestMoveCorner, one.largestMoveCorner);
    EXPECT_EQ(many.snappedToFixedPoint, one.snappedToFixedPoint);
  }
}

// Coordinates of another unit, as texture coordinates that were scaled to the unit square.
TEST(MapSnapping, AsksForTheScale)
{
  GridMapCase c = squares("", unitCube(2), 3);
  Random random(25);
  MapEditor(c).shuffleCharts(random);
  std::vector<Vector2> uv = inDoubles(c);
  for (Vector2& p : uv)
  {
    p *= 0.17;
  }
  const std::string text = refusal(c, uv);
  EXPECT_NE(text.find("not whole"), std::string::npos) << text;
  EXPECT_NE(text.find("one unit is one quad"), std::string::npos) << text;
  EXPECT_NE(text.find("of cell"), std::string::npos) << text;
  for (Vector2& p : uv)
  {
    p /= 0.17;
  }
  EXPECT_EQ(snapMap(c.mesh, uv).uv, c.uv);
}

// Charts of a texture atlas are turned by any angle.
TEST(MapSnapping, RefusesAnAtlas)
{
  const GridMapCase c = squares("", unitCube(2), 3);
  std::vector<Vector2> uv = inDoubles(c);
  const Eigen::Rotation2Dd turn(0.5);
  for (std::size_t h = 24; h < 36; ++h)
  {
    uv[h] = turn * uv[h];
  }
  const std::string text = refusal(c, uv);
  EXPECT_NE(text.find("no quarter turn"), std::string::npos) << text;
  EXPECT_NE(text.find("of cell"), std::string::npos) << text;
}

TEST(MapSnapping, TakesAMatchingThatFits)
{
  Random random(26);
  for (GridMapCase& c : allCases(2))
  {
    SCOPED_TRACE(c.name);
    MapEditor editor(c);
    editor.refine(random, 200);
    editor.shuffleCharts(random);
    SnapOptions options;
    options.matching = matchingOf(c);
    EXPECT_EQ(snapMap(c.mesh, inDoubles(c), options).uv, c.uv);
    const std::vector<Vector2> uv = noisy(c, 1e-6, random);
    const SnapResult given = snapMap(c.mesh, uv, options);
    EXPECT_EQ(given.uv, snapMap(c.mesh, uv).uv);
    for (std::int8_t& turns : options.matching)
    {
      turns = static_cast<std::int8_t>(turns - 4); // the same modulo 4
    }
    EXPECT_EQ(snapMap(c.mesh, uv, options).uv, given.uv);
  }
}

// Beside a corner of the cube an edge is far shorter than the noise, and all turns leave its
// translation whole: only the matching knows which one it is.
TEST(MapSnapping, MatchingDecidesWhereImagesAreTooShort)
{
  GridMapCase c = squares("", unitCube(1), 2);
  const std::vector<std::int8_t> before = matchingOf(c);
  std::vector<Index> split;
  for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h)
  {
    if (c.uv[h] == FixedVec2{} && before[h] != 0)
    {
      split.push_back(h);
    }
  }
  ASSERT_FALSE(split.empty());
  MapEditor editor(c);
  for (const Index h : split)
  {
    const FixedVec2 e = c.uv[Mesh::next(h)] - c.uv[h];
    editor.splitEdge(h, { e.u / (1 << 14), e.v / (1 << 14) });
  }
  Random random(27);
  SnapOptions options;
  options.matching = matchingOf(c);
  options.valueError = 1e-3;
  const std::vector<Vector2> uv = noisy(c, 1e-3, random);
  const SnapResult snapped = snapMap(c.mesh, uv, options);
  EXPECT_EQ(snapped.inconsistent, 0u);
  EXPECT_EQ(snapped.snappedToFixedPoint, 8u); // the corners of the cube
  options.matching.clear();
  EXPECT_NE(snapMap(c.mesh, uv, options).snappedToFixedPoint, 8u);
}

TEST(MapSnapping, RefusesAMatchingThatContradictsTheImages)
{
  Random random(28);
  GridMapCase c = squares("", unitCube(2), 2);
  MapEditor(c).shuffleCharts(random);
  const Index h = turningEdge(c);
  const Index g = c.mesh.twin[h];
  for (const double noise : { 0.0, 1e-5 }) // maps that fit exactly, and others
  {
    const std::vector<Vector2> uv = noisy(c, noise, random);
    SnapOptions options;
    options.matching = matchingOf(c);
    options.matching[h] = 3; // the way back
    options.matching[g] = 1;
    std::string text = refusal(c, uv, options);
    EXPECT_NE(text.find("differ by"), std::string::npos) << text;
    const Index lower = std::min(h, g);
    EXPECT_NE(
      text.find("edge " + std::to_string(lower % 3) + " of cell " + std::to_string(lower / 3)),
      std::string::npos)
      << text;
    options.matching[g] = 3;
    text = refusal(c, uv, options);
    EXPECT_NE(text.find("add up"), std::string::npos) << text;
    options.matching.pop_back();
    EXPECT_FALSE(refusal(c, uv, options).empty());
  }
}

// Charts far from zero, in single precision: neighbouring values are 1/256 apart.
TEST(MapSnapping, KnowsTheErrorOfSinglePrecision)
{
  Random random(29);
  for (GridMapCase& c : allCases(2))
  {
    SCOPED_TRACE(c.name);
    MapEditor(c).shuffleCharts(random);
    const auto rounded = [](double x)
    {
      constexpr double kShift = 40000.302; // a boundary comes to lie 0.0012 beside its isoline
      const volatile float single = static_cast<float>(x + kShift);
      return static_cast<double>(single) - kShift + 40000;
    };
    std::vector<Vector2> uv;
    for (const FixedVec2& p : c.uv)
    {
      uv.emplace_back(rounded(toDouble(p.u)), rounded(toDouble(p.v)));
    }
    ASSERT_NE(uv[0].x(), std::round(uv[0].x()));
    SnapOptions options;
    options.valueError = 1.0 / 256;
    const ExtractionResult result = extractQuads(c.mesh, snapMap(c.mesh, uv, options).uv, {});
    EXPECT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(result.mesh.quads.size(), c.quads);
    options.valueError = 0.1;
    EXPECT_NE(refusal(c, uv, options).find("double precision"), std::string::npos);
  }
}

#ifdef QUADRILLE_SHARED_DATA

struct ForeignMap
{
  Mesh mesh;
  std::vector<Vector2> uv;
};

/// A map of igm/ in the shared data; none without them.
std::optional<ForeignMap> loadForeignMap(const std::string& name)
{
  const std::string path = QUADRILLE_SHARED_DATA "/igm/" + name;
  std::ifstream file(path);
  const std::optional<Mesh> mesh = loadObj(path);
  if (!file || !mesh)
  {
    return std::nullopt;
  }
  ForeignMap map{ *mesh, {} };
  std::vector<Vector2> points;
  for (std::string line; std::getline(file, line);)
  {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "vt")
    {
      Vector2 p;
      words >> p.x() >> p.y();
      points.push_back(p);
    }
    for (std::string corner; kind == "f" && words >> corner;)
    {
      map.uv.push_back(points[std::stoul(corner.substr(corner.find('/') + 1)) - 1]);
    }
  }
  return map;
}

std::map<int, int> countValences(const QuadMesh& mesh)
{
  std::map<int, int> valences;
  for (const int v : mesh.valence)
  {
    ++valences[v];
  }
  return valences;
}

// A map by another program with 9 inverted triangles. The counts are those of the reference
// extraction [Ebke et al. 2013] of the same map, made by its authors.
TEST(MapSnapping, FandiskOfAnotherProgram)
{
  const std::optional<ForeignMap> map = loadForeignMap("qex_fandisk_param.obj");
  if (!map)
  {
    GTEST_SKIP() << "no shared data";
  }
  const ExtractionResult result = extractQuads(map->mesh, snapMap(map->mesh, map->uv).uv, {});
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.mesh.quads.size(), 897u);
  EXPECT_GT(result.mergedVertices, 0u);
  EXPECT_EQ(result.filledHoles + result.droppedFaces, 0u);
  EXPECT_EQ(countValences(result.mesh), (std::map<int, int>{ { 3, 18 }, { 4, 871 }, { 5, 10 } }));
}

// 18 to 239 inverted triangles, and vertices round which the map winds twice inside of a cell: such cells
// are holes, which are closed.
TEST(MapSnapping, DucksOfAnotherProgram)
{
  struct Expected
  {
    const char* name;
    std::size_t quads, holes;
  };
  for (const Expected& expected : { Expected{ "qex_duck_miq_4_param.obj", 1073, 1 },
         Expected{ "qex_duck_qc_8_param.obj", 274, 2 },
         Expected{ "qex_duck_miq_16_param.obj", 59, 3 } })
  {
    SCOPED_TRACE(expected.name);
    const std::optional<ForeignMap> map = loadForeignMap(expected.name);
    if (!map)
    {
      GTEST_SKIP() << "no shared data";
    }
    const ExtractionResult result = extractQuads(map->mesh, snapMap(map->mesh, map->uv).uv, {});
    EXPECT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(result.mesh.quads.size(), expected.quads);
    EXPECT_EQ(result.filledHoles, expected.holes);
    expectTopologyOfInput(map->mesh, result.mesh);
  }
}

#endif

} // namespace quadrille::test

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMaps.h"

#include "Base/Error.h"
#include "Extraction/Extraction.h"
#include "Extraction/MapSnapping.h"

#include <gtest/gtest.h>

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

#ifdef QUADRILLE_SHARED_DATA

// A map by another program with 9 inverted triangles. The counts are those of the reference
// extraction [Ebke et al. 2013] of the same map, made by its authors.
TEST(MapSnapping, FandiskOfAnotherProgram)
{
  const std::string path = QUADRILLE_SHARED_DATA "/igm/qex_fandisk_param.obj";
  std::ifstream file(path);
  const std::optional<Mesh> mesh = loadObj(path);
  if (!file || !mesh)
  {
    GTEST_SKIP() << "no " << path;
  }
  std::vector<Vector2> points;
  std::vector<Vector2> uv;
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
      uv.push_back(points[std::stoul(corner.substr(corner.find('/') + 1)) - 1]);
    }
  }
  const ExtractionResult result = extractQuads(*mesh, snapMap(*mesh, uv).uv, {});
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.mesh.quads.size(), 897u);
  EXPECT_GT(result.mergedVertices, 0u);
  std::map<int, int> valences;
  for (const int v : result.mesh.valence)
  {
    ++valences[v];
  }
  EXPECT_EQ(valences, (std::map<int, int>{ { 3, 18 }, { 4, 871 }, { 5, 10 } }));
}

#endif

} // namespace quadrille::test

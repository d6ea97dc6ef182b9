// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
// Ten thousand random maps: whatever comes, the extraction ends, throws nothing, and what it calls a
// quad mesh of the surface is one.
#include "FuzzMaps.h"
#include "QuadChecks.h"

namespace quadrille::test
{
namespace
{

const std::vector<GridMapCase>& startingCases()
{
  static const std::vector<GridMapCase> cases = []()
  {
    std::vector<GridMapCase> all;
    for (const int k : { 1, 2, 3 })
    {
      for (GridMapCase& c : casesWithCones(k))
      {
        all.push_back(std::move(c));
      }
    }
    return all;
  }();
  return cases;
}

/// A valid map in random charts and a random triangulation.
GridMapCase randomCase(Random& random)
{
  const auto& cases = startingCases();
  GridMapCase c = cases[static_cast<std::size_t>(pick(random, static_cast<int>(cases.size())))];
  MapEditor editor(c);
  editor.shuffleCharts(random);
  editor.refine(random, pick(random, 4) == 0 ? 0 : pick(random, 150));
  return c;
}

/// 2^-24 to 2 units.
std::int64_t randomReach(Random& random)
{
  return std::int64_t{ 1 } << pick(random, kFractionBits + 2);
}

/// Points exactly on edges, on vertices and on the grid, while all triangles stay positive.
void perturb(GridMapCase& c, Random& random)
{
  MapFolder folder(c, random);
  for (int i = pick(random, 60); i > 0; --i)
  {
    const Index h = folder.randomCorner();
    folder.putPositive(h,
      pick(random, 2) == 0 ? folder.ontoGrid(h)
                           : folder.at(h) + folder.randomDelta(randomReach(random)));
  }
}

/// Triangles with an empty inside: edges of length zero, stars on a point, vertices on the edge
/// across.
void flatten(GridMapCase& c, Random& random)
{
  MapFolder folder(c, random);
  for (int i = 1 + pick(random, 1 << pick(random, 5)); i > 0; --i)
  {
    const Index h = folder.randomCorner();
    switch (pick(random, 5))
    {
      case 0:
        folder.collapseRun(h, 1 + pick(random, 8));
        break;
      case 1:
        folder.collapseStar(h);
        break;
      case 2:
        folder.put(h, folder.ontoGrid(h));
        break;
      default:
        folder.put(h, folder.ontoOppositeEdge(h));
    }
  }
}

void fold(GridMapCase& c, Random& random)
{
  MapFolder folder(c, random);
  if (pick(random, 4) == 0)
  {
    folder.jitter(randomReach(random));
  }
  for (int i = 1 + pick(random, 1 << pick(random, 7)); i > 0; --i)
  {
    const Index h = folder.randomCorner();
    switch (pick(random, 4))
    {
      case 0:
        folder.put(h, folder.at(h) + folder.randomDelta(randomReach(random)));
        break;
      case 1:
        folder.put(h, folder.at(h) + folder.randomDelta(2 * kOne));
        break;
      case 2:
        folder.put(h, folder.ontoGrid(h) + rotate({ kOne, 0 }, pick(random, 4)));
        break;
      default:
        folder.invertStar(h);
    }
  }
}

/// No map at all: corners torn off, charts off the grid, features where there is no isoline.
void breakMap(GridMapCase& c, Random& random)
{
  const auto corner = [&]() -> FixedVec2&
  { return c.uv[static_cast<std::size_t>(pick(random, static_cast<int>(c.uv.size())))]; };
  for (int i = 1 + pick(random, 5); i > 0; --i)
  {
    const FixedVec2 delta{ randomReach(random), pick(random, 2) * randomReach(random) };
    const Index h = static_cast<Index>(pick(random, static_cast<int>(c.uv.size())));
    switch (pick(random, 4))
    {
      case 0:
        corner() = corner() + delta;
        break;
      case 1:
        for (Index g = h / 3 * 3; g < h / 3 * 3 + 3; ++g)
        {
          c.uv[g] = c.uv[g] + delta;
        }
        break;
      case 2:
        c.mesh.flags.edit()[h] = kFeatureEdge;
        if (!c.mesh.isBoundary(h))
        {
          c.mesh.flags.edit()[c.mesh.twin[h]] = kFeatureEdge;
        }
        break;
      default:
        for (FixedVec2& p : c.uv)
        {
          p = p + delta;
        }
    }
  }
}

/// sum (4 - valence), 3 - valence on the boundary, per component of the mesh.
std::vector<long long> indexSums(const Mesh& mesh, const QuadMesh& quads)
{
  Index count = 0;
  const std::vector<Index> component = faceComponents(mesh, count);
  std::vector<long long> sums(count, 0);
  for (std::size_t i = 0; i < quads.points.size(); ++i)
  {
    sums[component[quads.sourceFace[i]]] += (quads.onBoundary[i] ? 3 : 4) - quads.valence[i];
  }
  return sums;
}

/// Euler characteristic per component.
std::vector<long long> eulerCharacteristics(const Mesh& mesh)
{
  Index count = 0;
  const std::vector<Index> component = faceComponents(mesh, count);
  std::vector<long long> chi(count, 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const long long edges = mesh.isBoundary(h) || h < mesh.twin[h] ? 1 : 0;
    chi[component[h / 3]] += (h % 3 == 0 ? 1 : 0) - edges;
  }
  for (const Index h : outgoingHalfEdges(mesh))
  {
    ++chi[component[h / 3]];
  }
  return chi;
}

/// Whatever the status: nothing points outside.
void expectNoGarbage(const Mesh& mesh, const QuadMesh& quads)
{
  const std::size_t points = quads.points.size();
  ASSERT_EQ(quads.sourceFace.size(), points);
  ASSERT_EQ(quads.sourceWeights.size(), points);
  ASSERT_EQ(quads.quadSourceFace.size(), quads.quads.size());
  for (std::size_t i = 0; i < points; ++i)
  {
    ASSERT_LT(quads.sourceFace[i], mesh.faceCount());
    ASSERT_TRUE(quads.points[i].allFinite());
    for (const double w : quads.sourceWeights[i])
    {
      ASSERT_TRUE(w >= 0 && w <= 1);
    }
  }
  for (std::size_t q = 0; q < quads.quads.size(); ++q)
  {
    ASSERT_LT(quads.quadSourceFace[q], mesh.faceCount());
    for (const Index p : quads.quads[q])
    {
      ASSERT_LT(p, points);
    }
  }
  for (const QuadLine& line : quads.lines)
  {
    ASSERT_LT(line.a, points);
    ASSERT_LT(line.b, points);
    ASSERT_LT(line.halfEdge, mesh.halfEdgeCount());
  }
}

void expectSurface(const GridMapCase& c, const ExtractionResult& result)
{
  expectTopologyOfInput(c.mesh, result.mesh);
  expectConsistentAttributes(c.mesh, result.mesh);
  std::vector<long long> wanted;
  for (const long long chi : eulerCharacteristics(c.mesh))
  {
    wanted.push_back(4 * chi);
  }
  EXPECT_EQ(indexSums(c.mesh, result.mesh), wanted);
}

/// Every quad vertex on a mesh vertex has its turns, every other one is regular.
void expectValencesOfMap(const GridMapCase& c, const std::vector<int>& turns, const QuadMesh& quads)
{
  for (Index p = 0; p < quads.points.size(); ++p)
  {
    const int boundary = quads.onBoundary[p] ? 1 : 0;
    const std::optional<Index> corner = meshCorner(quads, p);
    const int expected = corner ? turns[c.mesh.origin[*corner]] : boundary ? 2 : 4;
    EXPECT_EQ(quads.valence[p] - boundary, expected) << "point " << p;
  }
}

/// Maps by how much of them is folded or flat; maps that are no maps at all count by that, too.
enum Kind
{
  kValid, ///< all triangles positive and all turns as they were
  kMild,  ///< at most one triangle in fifty is not positive
  kMedium,
  kHeavy, ///< more than one in four
  kKinds
};

struct Tally
{
  std::array<int, kKinds> cases{};
  std::array<int, kKinds> surfaces{}; ///< cases that gave the surface
  std::array<int, kKinds> exact{};    ///< with as many quads as the map has, and its valences

  void record() const
  {
    static const char* const kNames[kKinds] = { "valid", "mild", "medium", "heavy" };
    for (std::size_t kind = 0; kind < kKinds; ++kind)
    {
      const std::string name = kNames[kind];
      ::testing::Test::RecordProperty(name, cases[kind]);
      ::testing::Test::RecordProperty(name + "_surfaces", surfaces[kind]);
      ::testing::Test::RecordProperty(name + "_exact", exact[kind]);
    }
  }
};

Kind kindOf(const GridMapCase& c, const std::vector<int>& turns)
{
  std::size_t flat = 0;
  for (std::size_t h = 0; h < c.uv.size(); h += 3)
  {
    flat += orientation(c.uv[h], c.uv[h + 1], c.uv[h + 2]) <= 0 ? 1 : 0;
  }
  const std::size_t faces = c.mesh.faceCount();
  return flat > faces / 4            ? kHeavy
    : flat > faces / 50              ? kMedium
    : flat > 0                       ? kMild
    : turnsOf(c.mesh, c.uv) == turns ? kValid
                                     : kMild;
}

/// As many quads as the map has, and as many of each irregular valence, inside and on the boundary.
bool isExact(const GridMapCase& c, const std::vector<int>& turns, const QuadMesh& quads)
{
  std::map<std::pair<bool, int>, int> excess;
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    const bool boundary = quads.onBoundary[p] != 0;
    ++excess[{ boundary, quads.valence[p] - (boundary ? 1 : 0) }];
  }
  const std::vector<Index> outgoing = outgoingHalfEdges(c.mesh);
  for (std::size_t v = 0; v < turns.size(); ++v)
  {
    --excess[{ c.mesh.isBoundary(outgoing[v]), turns[v] }];
  }
  excess.erase({ false, 4 });
  excess.erase({ true, 2 });
  return quads.quads.size() == c.quads &&
    std::all_of(excess.begin(), excess.end(), [](const auto& entry) { return entry.second == 0; });
}

/// Extracts, and asks of the result what the map promises.
void check(const GridMapCase& c, const std::vector<int>& turns, bool map, Tally& tally)
{
  SCOPED_TRACE(c.name);
  const ExtractionResult result = extract(c);
  const Kind kind = kindOf(c, turns);
  ++tally.cases[kind];
  expectNoGarbage(c.mesh, result.mesh);
  EXPECT_EQ(result.status.ok(), result.status.message.empty());
  EXPECT_TRUE(result.status.ok() || result.status.code == StatusCode::NotConverged);
  if (result.status.ok())
  {
    expectSurface(c, result);
    ++tally.surfaces[kind];
    tally.exact[kind] += isExact(c, turns, result.mesh) ? 1 : 0;
  }
  if (map && kind == kValid)
  {
    EXPECT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(result.mesh.quads.size(), c.quads);
    EXPECT_EQ(result.mesh.lines.size(), c.lines);
    EXPECT_EQ(result.mergedVertices, 0u);
    expectValencesOfMap(c, turns, result.mesh);
    expectSameOnBothPaths(c);
  }
}

using Edit = void (*)(GridMapCase&, Random&);

/// `count` cases from `seed` on.
Tally fuzz(unsigned seed, int count, bool map, Edit edit)
{
  Tally tally;
  for (int i = 0; i < count && !::testing::Test::HasFailure(); ++i)
  {
    SCOPED_TRACE(seed + static_cast<unsigned>(i));
    Random random(seed + static_cast<unsigned>(i));
    GridMapCase c = randomCase(random);
    const std::vector<int> turns = turnsOf(c.mesh, c.uv);
    edit(c, random);
    MapEditor(c).shuffleCharts(random);
    check(c, turns, map, tally);
  }
  tally.record();
  return tally;
}

} // namespace

TEST(ExtractionFuzz, StartingCasesAreMeshes)
{
  for (const GridMapCase& c : casesWithCones(1))
  {
    EXPECT_EQ(validate(c.mesh), "") << c.name;
  }
  const auto valences = [](const Mesh& mesh)
  {
    const GridMapCase c = squares("", mesh, 1);
    std::map<int, int> count;
    for (const int turns : turnsOf(c.mesh, c.uv))
    {
      ++count[turns];
    }
    return count;
  };
  // 4 chi = 8, 8, 8, -8, -8
  EXPECT_EQ(
    valences(twoWheels(7, true, 2)), (std::map<int, int>{ { 3, 14 }, { 4, 42 }, { 7, 2 } }));
  EXPECT_EQ(valences(twoWheels(8, false, 2)).at(2), 8);
  EXPECT_EQ(valences(twoWheels(8, false, 2)).at(8), 2);
  EXPECT_EQ(valences(squareTiled({ 1, 0, 3, 2 }, { 2, 1, 0, 3 }, 3)).at(8), 2);
  EXPECT_EQ(valences(squareTiled({ 1, 0, 2 }, { 2, 1, 0 }, 3)).at(12), 1);
}

// Integer-grid maps give exactly their quads.
TEST(ExtractionFuzz, ValidMaps)
{
  const Tally tally = fuzz(10000, 2500, true, perturb);
  EXPECT_EQ(tally.exact[kValid], 2500);
}

// The seeds are fixed. The shares of surfaces and of exact ones are what is reached today, rounded
// down. Where nearly everything is folded, there is often more than one mesh that the map could mean.
TEST(ExtractionFuzz, FlatTriangles)
{
  const Tally tally = fuzz(20000, 2500, true, flatten);
  EXPECT_EQ(tally.exact[kValid], tally.cases[kValid]);
  EXPECT_EQ(tally.surfaces[kMild], tally.cases[kMild]);
  EXPECT_EQ(tally.exact[kMild], tally.cases[kMild]);
  EXPECT_EQ(tally.surfaces[kMedium], tally.cases[kMedium]);
  EXPECT_GE(tally.exact[kMedium], tally.cases[kMedium] * 90 / 100);
  EXPECT_EQ(tally.surfaces[kHeavy], tally.cases[kHeavy]);
}

TEST(ExtractionFuzz, FoldedMaps)
{
  const Tally tally = fuzz(30000, 4000, true, fold);
  EXPECT_EQ(tally.exact[kValid], tally.cases[kValid]);
  EXPECT_EQ(tally.surfaces[kMild], tally.cases[kMild]);
  EXPECT_GE(tally.exact[kMild], tally.cases[kMild] * 98 / 100);
  EXPECT_GE(tally.surfaces[kMedium], tally.cases[kMedium] * 99 / 100);
  EXPECT_GE(tally.exact[kMedium], tally.cases[kMedium] * 70 / 100);
  EXPECT_GE(tally.surfaces[kHeavy], tally.cases[kHeavy] * 97 / 100);
}

// A vertex round which the map winds twice, inside of a cell: no triangle is inverted, but the cell has eight sides.
TEST(ExtractionFuzz, TurnsInsideOfACell)
{
  const Mesh mesh = squareTiled({ 1, 0, 3, 2 }, { 2, 1, 0, 3 }, 3);
  GridMapCase c = squares("slit tori", mesh, 3);
  const std::vector<int> turns = turnsOf(c.mesh, c.uv);
  const std::vector<Index> outgoing = outgoingHalfEdges(c.mesh);
  int moved = 0;
  for (std::size_t v = 0; v < turns.size(); ++v)
  {
    if (turns[v] == 8)
    {
      moved += MapEditor(c).moveVertex(outgoing[v], { kOne / 3, kOne / 5 }, true) ? 1 : 0;
    }
  }
  ASSERT_EQ(moved, 2);
  ASSERT_TRUE(isPositive(c));
  const ExtractionResult result = extract(c);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.droppedFaces, 2u);
  EXPECT_EQ(result.filledHoles, 2u);
  EXPECT_EQ(result.mesh.quads.size(), c.quads + 2); // three quads for two cells, twice
  expectTopologyOfInput(c.mesh, result.mesh);
  EXPECT_EQ(extract(c, 1, ExtractionPath::Folded).filledHoles, 2u);
}

TEST(ExtractionFuzz, BrokenMaps)
{
  // Only what was moved by whole units is still a map.
  const Tally tally = fuzz(40000, 1000, false, breakMap);
  EXPECT_EQ(tally.surfaces[kValid], tally.exact[kValid]);
}

} // namespace quadrille::test

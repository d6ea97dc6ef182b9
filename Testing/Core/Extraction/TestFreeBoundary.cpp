// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
// Boundaries off the isolines: trimmed, or kept as polygons.
#include "GridMaps.h"

#include "Base/Error.h"
#include "Extraction/Extraction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace quadrille::test
{
namespace
{

using Cells = std::vector<std::vector<Index>>;

Cells cellsOf(const QuadMesh& mesh)
{
  Cells cells;
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    cells.emplace_back(quad.begin(), quad.end());
  }
  for (std::size_t i = 0; i + 1 < mesh.polygonOffsets.size(); ++i)
  {
    cells.emplace_back(mesh.polygonPoints.begin() + mesh.polygonOffsets[i],
      mesh.polygonPoints.begin() + mesh.polygonOffsets[i + 1]);
  }
  return cells;
}

/// Topology of a mesh of polygons by maps and sets, on purpose by other means than the library's.
struct PolygonCheck
{
  std::size_t edges = 0, boundaryLoops = 0, components = 0, usedPoints = 0;
  bool manifold = true;
  long long eulerCharacteristic = 0;

  explicit PolygonCheck(const Cells& cells)
  {
    std::map<std::pair<Index, Index>, std::size_t> directed;
    std::map<Index, std::map<Index, Index>> links; // round a point: next -> previous
    std::map<Index, Index> root;
    const auto find = [&root](Index p)
    {
      while (root[p] != p)
      {
        p = root[p];
      }
      return p;
    };
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      const std::vector<Index>& cell = cells[c];
      const std::size_t n = cell.size();
      manifold = manifold && n >= 3 && std::set<Index>(cell.begin(), cell.end()).size() == n;
      for (std::size_t i = 0; i < n; ++i)
      {
        const Index a = cell[i], b = cell[(i + 1) % n], z = cell[(i + n - 1) % n];
        manifold = directed.emplace(std::make_pair(a, b), c).second && manifold;
        manifold = links[a].emplace(b, z).second && manifold;
        root.emplace(a, a);
        root.emplace(b, b);
        root[find(a)] = find(b);
      }
    }
    std::map<Index, Index> border;
    for (const auto& [edge, cell] : directed)
    {
      const bool inside = directed.count({ edge.second, edge.first }) > 0;
      edges += !inside || edge.first < edge.second;
      manifold = (inside || border.emplace(edge).second) && manifold;
    }
    for (const auto& [p, link] : links)
    {
      ++usedPoints;
      components += root[p] == p;
      manifold = isOneFan(link) && manifold;
    }
    while (manifold && !border.empty())
    {
      ++boundaryLoops;
      for (auto found = border.begin(); found != border.end();)
      {
        const Index next = found->second;
        border.erase(found);
        found = border.find(next);
      }
    }
    eulerCharacteristic = static_cast<long long>(usedPoints) - static_cast<long long>(edges) +
      static_cast<long long>(cells.size());
  }

private:
  static bool isOneFan(const std::map<Index, Index>& link)
  {
    std::set<Index> reached;
    for (const auto& [next, previous] : link)
    {
      reached.insert(previous);
    }
    Index start = link.begin()->first;
    for (const auto& [next, previous] : link)
    {
      start = reached.count(next) == 0 ? next : start;
    }
    std::size_t count = 0;
    for (Index p = start; link.count(p) != 0 && count <= link.size(); p = link.at(p))
    {
      ++count;
      if (link.at(p) == start)
      {
        break;
      }
    }
    return count == link.size();
  }
};

ExtractionResult extract(const GridMapCase& c, BoundaryMode mode, int threads = 1, int steps = 0)
{
  ExtractionOptions options;
  options.boundary = mode;
  options.threads = threads;
  options.smoothingSteps = steps;
  return extractQuads(c.mesh, c.uv, options);
}

// ------------------------------------------------------------------ plane maps

struct Affine
{
  std::array<std::int64_t, 4> matrix; ///< rows, in units of 2^-24
  FixedVec2 shift;

  FixedVec2 apply(const Vector3& p) const
  {
    const auto x = static_cast<std::int64_t>(std::llround(p.x()));
    const auto y = static_cast<std::int64_t>(std::llround(p.y()));
    return { matrix[0] * x + matrix[1] * y + shift.u, matrix[2] * x + matrix[3] * y + shift.v };
  }
};

/// A flat lattice mesh with an affine map in one chart.
GridMapCase planeCase(std::string name, Mesh mesh, const Affine& map)
{
  GridMapCase c{ std::move(name), std::move(mesh), {}, 0, 0 };
  for (const Index v : c.mesh.origin)
  {
    c.uv.push_back(map.apply(c.mesh.position[v]));
  }
  return c;
}

/// Places every vertex at its image, so that lengths, areas and angles in space are those of the
/// map.
void putOnImages(GridMapCase& c)
{
  for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h)
  {
    const Vector2 p = toDouble(c.uv[h]);
    c.mesh.position.edit()[c.mesh.origin[h]] = Vector3(p.x(), p.y(), 0);
  }
}

double areaOf(const GridMapCase& c)
{
  double area = 0;
  for (std::size_t h = 0; h < c.uv.size(); h += 3)
  {
    area += static_cast<double>(determinant(c.uv[h], c.uv[h + 1], c.uv[h + 2])) / 2 /
      (static_cast<double>(kOne) * static_cast<double>(kOne));
  }
  return area;
}

double areaOf(const std::vector<Index>& cell, const QuadMesh& mesh)
{
  double area = 0;
  for (std::size_t i = 0; i < cell.size(); ++i)
  {
    const Vector3& a = mesh.points[cell[i]];
    const Vector3& b = mesh.points[cell[(i + 1) % cell.size()]];
    area += (a.x() * b.y() - a.y() * b.x()) / 2;
  }
  return area;
}

bool cross(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d)
{
  const auto side = [](const Vector3& p, const Vector3& q, const Vector3& r)
  { return (q - p).cross(r - p).z(); };
  return side(a, b, c) * side(a, b, d) < -kRounding && side(c, d, a) * side(c, d, b) < -kRounding;
}

void expectSimple(const std::vector<Index>& cell, const QuadMesh& mesh)
{
  EXPECT_GT(areaOf(cell, mesh), -1e-12); // slivers of 2^-48 quads are nothing in doubles
  const std::size_t n = cell.size();
  for (std::size_t i = 0; i < n; ++i)
  {
    for (std::size_t k = i + 1; k < n; ++k)
    {
      EXPECT_FALSE(cross(mesh.points[cell[i]], mesh.points[cell[(i + 1) % n]], mesh.points[cell[k]],
        mesh.points[cell[(k + 1) % n]]));
    }
  }
}

/// Sources lie in their faces and give the positions; lines are edges.
void expectConsistent(const Mesh& mesh, const QuadMesh& quads)
{
  ASSERT_EQ(quads.sourceFace.size(), quads.points.size());
  ASSERT_EQ(quads.sourceWeights.size(), quads.points.size());
  ASSERT_EQ(quads.valence.size(), quads.points.size());
  ASSERT_EQ(quads.onBoundary.size(), quads.points.size());
  ASSERT_EQ(quads.quadSourceFace.size(), quads.quads.size());
  ASSERT_EQ(quads.quadSourceWeights.size(), quads.quads.size());
  if (!quads.polygonOffsets.empty())
  {
    ASSERT_EQ(quads.polygonSourceFace.size() + 1, quads.polygonOffsets.size());
  }
  for (std::size_t i = 0; i < quads.points.size(); ++i)
  {
    Vector3 p = Vector3::Zero();
    for (Index k = 0; k < 3; ++k)
    {
      EXPECT_GE(quads.sourceWeights[i][k], 0);
      p += quads.sourceWeights[i][k] * mesh.position[mesh.origin[3 * quads.sourceFace[i] + k]];
    }
    EXPECT_NEAR((p - quads.points[i]).norm(), 0, 1e-11);
  }
  std::set<std::pair<Index, Index>> edges;
  std::map<Index, std::set<Index>> neighbours;
  for (const std::vector<Index>& cell : cellsOf(quads))
  {
    for (std::size_t i = 0; i < cell.size(); ++i)
    {
      const Index a = cell[i], b = cell[(i + 1) % cell.size()];
      edges.emplace(a, b);
      neighbours[a].insert(b);
      neighbours[b].insert(a);
    }
  }
  std::size_t boundaryEdges = 0, boundaryLines = 0;
  for (const auto& [a, b] : edges)
  {
    boundaryEdges += edges.count({ b, a }) == 0;
  }
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    EXPECT_EQ(static_cast<std::size_t>(quads.valence[p]), neighbours[static_cast<Index>(p)].size());
  }
  for (const QuadLine& line : quads.lines)
  {
    EXPECT_TRUE(edges.count({ line.a, line.b }) > 0 || edges.count({ line.b, line.a }) > 0);
    EXPECT_EQ(mesh.isBoundary(line.halfEdge), line.boundary);
    boundaryLines += line.boundary;
  }
  if (!quads.polygonOffsets.empty())
  {
    EXPECT_EQ(boundaryLines, boundaryEdges);
  }
}

/// The cells are the surface but for loops inside of one cell.
void expectTopologyOf(const Mesh& mesh, const ExtractionResult& result)
{
  const PolygonCheck check(cellsOf(result.mesh));
  const TopologySummary wanted = summarizeTopology(mesh);
  EXPECT_TRUE(check.manifold);
  EXPECT_EQ(check.components, wanted.components);
  EXPECT_EQ(check.boundaryLoops + result.loopsInCells, wanted.boundaryLoops);
  EXPECT_EQ(check.eulerCharacteristic - static_cast<long long>(result.loopsInCells),
    wanted.eulerCharacteristic);
  EXPECT_EQ(check.usedPoints, result.mesh.points.size());
}

void expectManifoldOfWholeCells(const GridMapCase& c, const ExtractionResult& result)
{
  EXPECT_TRUE(result.mesh.polygonOffsets.empty());
  const PolygonCheck check(cellsOf(result.mesh));
  EXPECT_TRUE(check.manifold);
  EXPECT_EQ(check.usedPoints, result.mesh.points.size());
  expectConsistent(c.mesh, result.mesh);
}

/// A flat case in space as in the map: cells tile the surface exactly.
void expectTiles(const GridMapCase& c, double area)
{
  SCOPED_TRACE(c.name);
  const ExtractionResult polygons = extract(c, BoundaryMode::Polygons);
  ASSERT_TRUE(polygons.status.ok()) << polygons.status.message;
  double sum = 0;
  for (const std::vector<Index>& cell : cellsOf(polygons.mesh))
  {
    expectSimple(cell, polygons.mesh);
    sum += areaOf(cell, polygons.mesh);
  }
  if (polygons.loopsInCells == 0)
  {
    EXPECT_NEAR(sum, area, 1e-9 * area); // crossings are rounded to doubles
  }
  expectTopologyOf(c.mesh, polygons);
  expectConsistent(c.mesh, polygons.mesh);
  const ExtractionResult trimmed = extract(c, BoundaryMode::Trimmed);
  EXPECT_LE(trimmed.mesh.quads.size(), polygons.mesh.quads.size() + cellsOf(polygons.mesh).size());
  EXPECT_TRUE(trimmed.status.ok() || trimmed.mesh.quads.empty()) << trimmed.status.message;
  expectManifoldOfWholeCells(c, trimmed);
  for (const std::array<Index, 4>& quad : trimmed.mesh.quads)
  {
    EXPECT_NEAR(areaOf({ quad.begin(), quad.end() }, trimmed.mesh), 1, 1e-9);
  }
}

std::vector<std::pair<std::string, Mesh>> plates()
{
  return { { "plane", gridPlane(5, 3) }, { "plate with hole", plateWithHole(1) },
    { "plate L", plateL(1) } };
}

std::int64_t randomValue(Random& random, std::int64_t unit, int range)
{
  return unit * (pick(random, 2 * range + 1) - range);
}

/// Any map of positive determinant whose entries are whole multiples of a random power of two and
/// which leaves a right angle above 35 degrees: below 30 a boundary's turn may be cut short.
Affine randomAffine(Random& random)
{
  Affine map{};
  const auto isGood = [&map]()
  {
    const Vector2 x = toDouble(FixedVec2{ map.matrix[0], map.matrix[2] });
    const Vector2 y = toDouble(FixedVec2{ map.matrix[1], map.matrix[3] });
    return x.x() * y.y() - x.y() * y.x() > std::sin(0.61) * x.norm() * y.norm();
  };
  while (!isGood())
  {
    const std::int64_t unit = kOne >> pick(random, 5);
    for (std::int64_t& entry : map.matrix)
    {
      entry = randomValue(random, unit, 5);
    }
  }
  const std::int64_t fine = pick(random, 2) == 0 ? kOne / 4 : kOne / 3 + 1;
  map.shift = { randomValue(random, fine, 6), randomValue(random, fine, 6) };
  return map;
}

/// A random part of a lattice plane: with holes, and vertices where cells touch taken apart.
Mesh randomPlate(Random& random)
{
  const int columns = 2 + pick(random, 5), rows = 2 + pick(random, 5);
  std::vector<std::uint8_t> keep(static_cast<std::size_t>(columns * rows));
  const int rate = 2 + pick(random, 6);
  for (std::uint8_t& cell : keep)
  {
    cell = pick(random, rate) != 0;
  }
  keep[0] = 1;
  return planeCells(columns, rows,
    [&](int i, int j) { return keep[static_cast<std::size_t>(j * columns + i)] != 0; });
}

/// The faces to keep, each fan with a vertex of its own.
GridMapCase partOf(const GridMapCase& whole, const std::vector<std::uint8_t>& keep)
{
  GridMapCase part{ whole.name, {}, {}, 0, 0 };
  std::vector<Index> id(whole.mesh.halfEdgeCount(), kInvalidIndex);
  Index next = 0;
  for (Index h = 0; h < id.size(); ++h)
  {
    id[h] = keep[h / 3] ? next++ : kInvalidIndex;
  }
  for (Index h = 0; h < id.size(); ++h)
  {
    if (keep[h / 3])
    {
      const Index g = whole.mesh.twin[h];
      part.mesh.twin.push_back(g == kInvalidIndex ? kInvalidIndex : id[g]);
      part.mesh.flags.push_back(0);
      part.uv.push_back(whole.uv[h]);
    }
  }
  part.mesh.origin.assign(next, kInvalidIndex);
  for (Index h = 0; h < id.size(); ++h)
  {
    if (!keep[h / 3] || part.mesh.origin[id[h]] != kInvalidIndex)
    {
      continue;
    }
    const Index v = part.mesh.vertexCount();
    part.mesh.position.push_back(whole.mesh.position[whole.mesh.origin[h]]);
    for (const bool left : { true, false })
    {
      Index g = id[h];
      do
      {
        part.mesh.origin.edit()[g] = v;
        g = left ? part.mesh.rotateCounterclockwise(g) : part.mesh.rotateClockwise(g);
      } while (g != kInvalidIndex && part.mesh.origin[g] != v);
    }
  }
  return part;
}

GridMapCase partOf(const GridMapCase& whole)
{
  return partOf(whole, std::vector<std::uint8_t>(whole.mesh.faceCount(), 1));
}

/// By atan(4/3), scaled by 5 `scale`.
Affine turned(std::int64_t scale, FixedVec2 shift)
{
  return { { 3 * scale, -4 * scale, 4 * scale, 3 * scale }, shift };
}

} // namespace

TEST(FreeBoundary, TurnedPlatesAreTiled)
{
  for (const std::int64_t scale : { kOne / 8, kOne / 4, kOne / 2, kOne })
  {
    for (const FixedVec2 shift : { FixedVec2{}, FixedVec2{ kOne / 2, kOne / 4 },
           FixedVec2{ kOne / 3, kOne / 7 }, FixedVec2{ 1, -1 } })
    {
      for (auto& [name, mesh] : plates())
      {
        GridMapCase c = planeCase(name, mesh, turned(scale, shift));
        SCOPED_TRACE(scale);
        putOnImages(c);
        expectTiles(c, areaOf(c));
      }
    }
  }
}

// Lattice planes with holes under any affine map: boundaries of any slope, through grid points and
// along isolines, random triangulations and charts.
TEST(FreeBoundary, RandomPlatesAreTiled)
{
  for (unsigned seed = 0; seed < 1500 && !HasFailure(); ++seed)
  {
    SCOPED_TRACE(seed);
    Random random(5000 + seed);
    Mesh mesh;
    try
    {
      mesh = randomPlate(random);
    }
    catch (const InvalidInput&)
    {
      continue;
    }
    GridMapCase c = partOf(planeCase("plate", mesh, randomAffine(random)));
    MapEditor editor(c);
    editor.refine(random, pick(random, 4) == 0 ? 0 : 60);
    putOnImages(c);
    const double area = areaOf(c);
    editor.shuffleCharts(random);
    ASSERT_EQ(validate(c.mesh), "");
    expectTiles(c, area);
  }
}

// Random faces taken out of closed and open surfaces with irregular vertices: boundaries along
// diagonals and isolines, through grid points and everywhere else.
TEST(FreeBoundary, TornSurfacesKeepTheirTopology)
{
  for (unsigned seed = 0; seed < 64 && !HasFailure(); ++seed)
  {
    Random random(9000 + seed);
    for (GridMapCase& whole : allCases(1 + static_cast<int>(seed % 4)))
    {
      SCOPED_TRACE(whole.name + " " + std::to_string(seed));
      MapEditor editor(whole);
      editor.refine(random, pick(random, 3) == 0 ? 0 : 150);
      editor.shuffleCharts(random);
      std::vector<std::uint8_t> keep(whole.mesh.faceCount());
      const int rate = 3 + pick(random, 30);
      for (std::uint8_t& face : keep)
      {
        face = pick(random, rate) != 0;
      }
      keep[0] = 1;
      const GridMapCase c = partOf(whole, keep);
      const ExtractionResult polygons = extract(c, BoundaryMode::Polygons);
      EXPECT_TRUE(polygons.status.ok()) << polygons.status.message;
      expectTopologyOf(c.mesh, polygons);
      expectConsistent(c.mesh, polygons.mesh);
      const ExtractionResult trimmed = extract(c, BoundaryMode::Trimmed);
      EXPECT_TRUE(trimmed.status.ok() || trimmed.mesh.quads.empty()) << trimmed.status.message;
      expectManifoldOfWholeCells(c, trimmed);
      if (HasFailure())
      {
        break;
      }
    }
  }
}

// Folds and a free boundary: the result is a manifold of whole cells, or the status says why not.
TEST(FreeBoundary, FoldedMapsAreTrimmedOrReported)
{
  int trimmed = 0;
  for (unsigned seed = 0; seed < 40; ++seed)
  {
    SCOPED_TRACE(seed);
    Random random(300 + seed);
    GridMapCase whole = squares("plane", gridPlane(6, 6), 2);
    for (FixedVec2& p : whole.uv)
    {
      p = p + FixedVec2{ kOne / 3, kOne / 5 };
    }
    MapEditor editor(whole);
    editor.refine(random, 300);
    editor.tangle(random, 3);
    const ExtractionResult result = extract(whole, BoundaryMode::Trimmed);
    EXPECT_EQ(result.status.ok(), result.status.message.empty());
    trimmed += result.status.ok() ? 1 : 0;
    if (result.status.ok())
    {
      expectManifoldOfWholeCells(whole, result);
      EXPECT_EQ(result.mesh.quads.size(), 121u); // 11 x 11 of 12 x 12
    }
    // Exact pieces need a valid map.
    const bool valid = std::all_of(whole.uv.begin(), whole.uv.end(),
      [&, h = std::size_t{ 0 }](const FixedVec2&) mutable
      {
        const std::size_t f = 3 * (h++ / 3);
        return orientation(whole.uv[f], whole.uv[f + 1], whole.uv[f + 2]) > 0;
      });
    const ExtractionResult polygons = extract(whole, BoundaryMode::Polygons);
    EXPECT_EQ(polygons.status.ok(), valid) << polygons.status.message;
  }
  EXPECT_GT(trimmed, 20);
}

// A boundary on isolines is what it was, in all modes.
TEST(FreeBoundary, AlignedBoundariesStay)
{
  Random random(77);
  for (GridMapCase& c : allCases(2))
  {
    SCOPED_TRACE(c.name);
    MapEditor editor(c);
    editor.refine(random, 200);
    editor.shuffleCharts(random);
    const QuadMesh aligned = extract(c, BoundaryMode::Aligned).mesh;
    for (const BoundaryMode mode : { BoundaryMode::Trimmed, BoundaryMode::Polygons })
    {
      const ExtractionResult result = extract(c, mode);
      EXPECT_TRUE(result.status.ok()) << result.status.message;
      EXPECT_EQ(result.mesh.quads, aligned.quads);
      EXPECT_EQ(result.mesh.points, aligned.points);
      EXPECT_EQ(result.mesh.lines.size(), aligned.lines.size());
      EXPECT_TRUE(result.mesh.polygonPoints.empty());
      EXPECT_EQ(result.separatedFans, 0u);
    }
  }
}

// Of a fine, straight boundary only its ends and the crossings are corners: a half plane u + v < 5
// - 1/2 cuts cells into triangles, pentagons and one corner each at both ends.
TEST(FreeBoundary, FineBoundariesHaveFewCorners)
{
  GridMapCase c{ "triangle", {}, {}, 0, 0 };
  const std::int64_t size = 9 * kOne / 2;
  c.mesh = makeMesh({ { 0, 0, 0 }, { 4.5, 0, 0 }, { 0, 4.5, 0 } }, { { 0, 1, 2 } });
  c.uv = { { 0, 0 }, { size, 0 }, { 0, size } };
  const ExtractionResult coarse = extract(c, BoundaryMode::Polygons);
  MapEditor editor(c);
  for (int level = 0; level < 6; ++level)
  {
    const Index count = c.mesh.halfEdgeCount();
    for (Index h = 0; h < count; ++h)
    {
      const FixedVec2 a = c.uv[h], b = c.uv[Mesh::next(h)];
      if (c.mesh.isBoundary(h))
      {
        editor.splitEdge(h, { (a.u + b.u) / 2, (a.v + b.v) / 2 });
      }
    }
  }
  putOnImages(c);
  const ExtractionResult fine = extract(c, BoundaryMode::Polygons);
  for (const ExtractionResult& result : { coarse, fine })
  {
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(result.mesh.quads.size(), 6u); // 3 + 2 + 1
    std::map<std::size_t, int> corners;
    for (std::size_t i = 0; i + 1 < result.mesh.polygonOffsets.size(); ++i)
    {
      ++corners[result.mesh.polygonOffsets[i + 1] - result.mesh.polygonOffsets[i]];
    }
    // Cells i + j = 3 lose a corner; those of i + j = 4 keep one.
    EXPECT_EQ(corners, (std::map<std::size_t, int>{ { 3, 5 }, { 5, 4 } }));
    expectTopologyOf(c.mesh, result);
  }
}

// A round hole over one grid point: polygons stay within a tenth of a quad of it with a few corners.
TEST(FreeBoundary, RoundBoundariesAreFollowed)
{
  constexpr int kRound = 240;
  constexpr double kRadius = 0.4;
  std::vector<Vector3> points;
  std::vector<Triangle> triangles;
  for (int i = 0; i < kRound; ++i)
  {
    const double angle = 2 * kPi * i / kRound;
    const Vector3 direction(std::cos(angle), std::sin(angle), 0);
    points.push_back(kRadius * direction);
    points.push_back(2.2 * direction / direction.lpNorm<Eigen::Infinity>());
  }
  for (Index i = 0; i < kRound; ++i)
  {
    const Index a = 2 * i, b = 2 * ((i + 1) % kRound);
    triangles.push_back({ a, a + 1, b + 1 });
    triangles.push_back({ a, b + 1, b });
  }
  GridMapCase c{ "", makeMesh(points, triangles), {}, 0, 0 };
  for (const Index v : c.mesh.origin)
  {
    c.uv.push_back(toFixed(Vector2(c.mesh.position[v].head<2>())));
  }
  const ExtractionResult result = extract(c, BoundaryMode::Polygons);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  std::size_t corners = 0;
  for (const QuadLine& line : result.mesh.lines)
  {
    const Vector3 middle = (result.mesh.points[line.a] + result.mesh.points[line.b]) / 2;
    if (middle.norm() < 1)
    {
      ++corners;
      EXPECT_GT(middle.norm(), kRadius - 0.1);
    }
  }
  EXPECT_GT(corners, 4u); // without the rule there are only the crossings
  EXPECT_LT(corners, 20u);
  double area = 0;
  for (const std::vector<Index>& cell : cellsOf(result.mesh))
  {
    expectSimple(cell, result.mesh);
    area += areaOf(cell, result.mesh);
  }
  EXPECT_NEAR(area, areaOf(c), 0.2);
}

// A hole inside of one cell, that touches a side or not: covered by a polygon mesh, trimmed away
// with its cell.
TEST(FreeBoundary, HolesInsideOfACell)
{
  // Squares of a quarter quad without one; turned, the hole touches u = 0 in one point from within
  // the cell.
  const std::vector<Affine> maps{ { { kOne / 4, 0, 0, kOne / 4 }, { kOne / 3, kOne / 3 } },
    { { kOne / 4, 0, 0, kOne / 4 }, { kOne / 4, kOne / 4 } },
    { { kOne / 4, -kOne / 4, kOne / 4, kOne / 4 }, { kOne / 4, -kOne / 8 } } };
  for (std::size_t i = 0; i < maps.size(); ++i)
  {
    SCOPED_TRACE(i);
    const auto plate = [&](bool hole)
    {
      GridMapCase c = planeCase("",
        planeCells(12, 12, [hole](int x, int y) { return !hole || x != 5 || y != 5; }), maps[i]);
      putOnImages(c);
      return c;
    };
    const GridMapCase c = plate(true);
    const ExtractionResult polygons = extract(c, BoundaryMode::Polygons);
    ASSERT_TRUE(polygons.status.ok()) << polygons.status.message;
    EXPECT_EQ(polygons.loopsInCells, 1u);
    expectTopologyOf(c.mesh, polygons);
    const ExtractionResult trimmed = extract(c, BoundaryMode::Trimmed);
    ASSERT_TRUE(trimmed.status.ok()) << trimmed.status.message;
    EXPECT_EQ(trimmed.mesh.quads.size() + 1,
      extract(plate(false), BoundaryMode::Trimmed).mesh.quads.size());
    expectManifoldOfWholeCells(c, trimmed);
  }
}

// Two holes in one cell, in all positions to each other: the way out of one leads to the other.
TEST(FreeBoundary, SeveralHolesInOneCell)
{
  for (const auto& [x, y] : { std::pair(2, 0), std::pair(0, 2), std::pair(2, 1), std::pair(-2, 1) })
  {
    const auto plate = [dx = x, dy = y](bool holes)
    {
      GridMapCase c = planeCase("",
        planeCells(24, 24,
          [&](int i, int j)
          { return !holes || ((i != 11 || j != 10) && (i != 11 + dx || j != 10 + dy)); }),
        { { kOne / 8, 0, 0, kOne / 8 }, { 0, 0 } });
      putOnImages(c);
      return c;
    };
    for (unsigned seed = 0; seed < 40; ++seed) // charts in which both ways lead to the other hole
    {
      Random random(80 + seed);
      GridMapCase turnedCharts = plate(true);
      MapEditor(turnedCharts).shuffleCharts(random);
      const ExtractionResult result = extract(turnedCharts, BoundaryMode::Trimmed);
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      EXPECT_EQ(result.loopsInCells, 2u);
      EXPECT_EQ(result.mesh.quads.size(), 8u);
    }
    const GridMapCase c = plate(true);
    const ExtractionResult polygons = extract(c, BoundaryMode::Polygons);
    ASSERT_TRUE(polygons.status.ok()) << polygons.status.message;
    EXPECT_EQ(polygons.loopsInCells, 2u);
    EXPECT_EQ(polygons.mesh.quads.size(), 9u);
  }
}

// Trimmed quads cannot be compared with the surface, so folds all over are refused.
TEST(FreeBoundary, FoldsAllOverAreNoFreeBoundary)
{
  Random random(81);
  GridMapCase c = squares("", gridPlane(30, 30), 1);
  MapEditor editor(c);
  for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h)
  {
    editor.moveVertex(
      h, { kOne / 100 * (pick(random, 201) - 100), kOne / 100 * (pick(random, 201) - 100) }, true);
  }
  const ExtractionResult result = extract(c, BoundaryMode::Trimmed);
  EXPECT_EQ(result.status.code, StatusCode::NotConverged);
  EXPECT_FALSE(result.status.message.empty());
}

// Whole cells that touch in a corner only: both stay, with a copy of the point.
TEST(FreeBoundary, TrimmedFansAreTakenApart)
{
  // The two cells (0, 0) and (1, 1), and a triangle that keeps the surface together at (1, 1).
  const auto at = [](int x, int y) { return Vector3(x, y, 0); };
  GridMapCase c{ "", {}, {}, 0, 0 };
  c.mesh = makeMesh(
    { at(0, 0), at(1, 0), at(1, 1), at(0, 1), at(2, 1), at(2, 2), at(1, 2), Vector3(1.5, 0.5, 0) },
    { { 0, 1, 2 }, { 0, 2, 3 }, { 2, 4, 5 }, { 2, 5, 6 }, { 1, 7, 2 }, { 7, 4, 2 } });
  for (const Index v : c.mesh.origin)
  {
    c.uv.push_back(toFixed(Vector2(c.mesh.position[v].head<2>())));
  }
  const ExtractionResult trimmed = extract(c, BoundaryMode::Trimmed);
  ASSERT_TRUE(trimmed.status.ok()) << trimmed.status.message;
  EXPECT_EQ(trimmed.mesh.quads.size(), 2u);
  EXPECT_EQ(trimmed.mesh.points.size(), 8u);
  EXPECT_EQ(trimmed.separatedFans, 1u);
  expectManifoldOfWholeCells(c, trimmed);
}

TEST(FreeBoundary, SameBytesForAnyNumberOfThreads)
{
  Random random(78);
  GridMapCase c = planeCase("", plateWithHole(4), turned(kOne / 2, { kOne / 3, kOne / 5 }));
  MapEditor editor(c);
  editor.refine(random, 4000);
  putOnImages(c);
  editor.shuffleCharts(random);
  for (const BoundaryMode mode : { BoundaryMode::Trimmed, BoundaryMode::Polygons })
  {
    const ExtractionResult one = extract(c, mode, 1, 3);
    ASSERT_TRUE(one.status.ok()) << one.status.message;
    for (const int threads : { 2, 3 })
    {
      const ExtractionResult many = extract(c, mode, threads, 3);
      EXPECT_EQ(many.mesh.points, one.mesh.points);
      EXPECT_EQ(many.mesh.quads, one.mesh.quads);
      EXPECT_EQ(many.mesh.polygonPoints, one.mesh.polygonPoints);
      EXPECT_EQ(many.mesh.polygonOffsets, one.mesh.polygonOffsets);
      EXPECT_EQ(many.mesh.sourceWeights, one.mesh.sourceWeights);
    }
  }
}

// Smoothing moves inner points of a warped surface and leaves those of polygons and of a trimmed
// boundary.
TEST(FreeBoundary, SmoothingLeavesTheFreeBoundary)
{
  Random random(79);
  GridMapCase c = planeCase("", gridPlane(12, 12), turned(kOne / 4, { kOne / 3, kOne / 5 }));
  for (Vector3& p : c.mesh.position.editAll())
  {
    p += 0.35 * Vector3(std::sin(1.7 * p.y()), std::sin(2.1 * p.x()), 0);
  }
  for (const BoundaryMode mode : { BoundaryMode::Trimmed, BoundaryMode::Polygons })
  {
    const ExtractionResult before = extract(c, mode, 1, 0);
    const ExtractionResult after = extract(c, mode, 1, 5);
    ASSERT_TRUE(after.status.ok()) << after.status.message;
    ASSERT_EQ(after.mesh.points.size(), before.mesh.points.size());
    std::set<Index> still(before.mesh.polygonPoints.begin(), before.mesh.polygonPoints.end());
    std::size_t moved = 0;
    for (Index p = 0; p < before.mesh.points.size(); ++p)
    {
      const bool stays = still.count(p) > 0 || before.mesh.onBoundary[p];
      moved += before.mesh.points[p] != after.mesh.points[p];
      EXPECT_TRUE(!stays || before.mesh.points[p] == after.mesh.points[p]);
    }
    EXPECT_GT(moved, 0u);
    expectConsistent(c.mesh, after.mesh);
  }
}

// Features that end inside, at a boundary off the grid, or lie off the isolines.
TEST(FreeBoundary, EndsOfFeaturesAreReported)
{
  // Squares of half a quad; a feature along y = 2 from x = 1 to 5, that is, u = 1/2 to 5/2.
  GridMapCase c = planeCase("", gridPlane(6, 4), { { kOne / 2, 0, 0, kOne / 2 }, { 0, 0 } });
  const auto mark = [&c](const Vector3& a, const Vector3& b)
  {
    for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h)
    {
      if ((c.mesh.position[c.mesh.origin[h]] == a && c.mesh.position[c.mesh.target(h)] == b) ||
        (c.mesh.position[c.mesh.origin[h]] == b && c.mesh.position[c.mesh.target(h)] == a))
      {
        c.mesh.flags.edit()[h] |= kFeatureEdge;
      }
    }
  };
  for (int x = 1; x < 5; ++x)
  {
    mark(Vector3(x, 2, 0), Vector3(x + 1, 2, 0));
  }
  const ExtractionResult aligned = extract(c, BoundaryMode::Aligned);
  EXPECT_EQ(aligned.status.code, StatusCode::NotConverged);
  const ExtractionResult trimmed = extract(c, BoundaryMode::Trimmed);
  EXPECT_TRUE(trimmed.status.ok()) << trimmed.status.message;
  ASSERT_EQ(trimmed.features.nonInteger.size(), 2u);
  EXPECT_EQ(c.mesh.position[trimmed.features.nonInteger[0]], Vector3(1, 2, 0));
  EXPECT_EQ(c.mesh.position[trimmed.features.nonInteger[1]], Vector3(5, 2, 0));
  EXPECT_TRUE(trimmed.features.offIsolines.empty());
  // The part from u = 1 to 2 is an edge of the quads.
  EXPECT_EQ(std::count_if(trimmed.mesh.lines.begin(), trimmed.mesh.lines.end(),
              [](const QuadLine& line) { return !line.boundary; }),
    1);

  mark(Vector3(2, 1, 0), Vector3(3, 1, 0)); // v = 1/2
  for (const BoundaryMode mode :
    { BoundaryMode::Trimmed, BoundaryMode::Polygons, BoundaryMode::Aligned })
  {
    const ExtractionResult off = extract(c, mode);
    EXPECT_EQ(off.status.code, StatusCode::NotConverged);
    EXPECT_EQ(off.features.offIsolines.size(), 1u);
    EXPECT_NE(off.status.message.find("off the integer isolines"), std::string::npos);
  }
}

// A feature that runs to a free boundary is an edge of the polygons up to there.
TEST(FreeBoundary, PolygonsKeepFeaturesToTheBoundary)
{
  GridMapCase c = planeCase("", gridPlane(6, 4), { { kOne / 2, 0, 0, kOne / 2 }, { kOne / 4, 0 } });
  for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h)
  {
    if (c.mesh.position[c.mesh.origin[h]].y() == 2 && c.mesh.position[c.mesh.target(h)].y() == 2)
    {
      c.mesh.flags.edit()[h] |= kFeatureEdge;
    }
  }
  putOnImages(c);
  const ExtractionResult result = extract(c, BoundaryMode::Polygons);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  double length = 0;
  for (const QuadLine& line : result.mesh.lines)
  {
    length += line.boundary ? 0 : (result.mesh.points[line.a] - result.mesh.points[line.b]).norm();
  }
  EXPECT_DOUBLE_EQ(length, 3);
  expectConsistent(c.mesh, result.mesh);
}

} // namespace quadrille::test

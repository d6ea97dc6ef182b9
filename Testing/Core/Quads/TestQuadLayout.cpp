// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMaps.h"

#include "Extraction/Extraction.h"
#include "Quads/QuadLayout.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <set>

namespace quadrille::test
{
namespace
{

QuadMesh layoutQuadsOf(const GridMapCase& c)
{
  ExtractionOptions options;
  options.smoothingSteps = 0;
  ExtractionResult result = extractQuads(c.mesh, c.uv, options);
  EXPECT_TRUE(result.status.ok()) << c.name << ": " << result.status.message;
  return result.mesh;
}

/// Makes features of the lattice edges, never the diagonals, whose two ends `wants` both.
Mesh withFeatures(Mesh mesh, const std::function<bool(const Vector3& a, const Vector3& b)>& wants)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    // Corners 0 and 2 of both triangles of a square are the ends of the diagonal.
    const bool diagonal = Mesh::face(h) % 2 == 0 ? h % 3 == 2 : h % 3 == 0;
    const Vector3& a = mesh.position[mesh.origin[h]];
    const Vector3& b = mesh.position[mesh.target(h)];
    if (!mesh.isBoundary(h) && !diagonal && wants(a, b))
    {
      mesh.flags.edit()[h] |= kFeatureEdge;
      mesh.flags.edit()[mesh.twin[h]] |= kFeatureEdge;
    }
  }
  return mesh;
}

using Edge = std::pair<Index, Index>;

Edge edgeOf(Index a, Index b)
{
  return { std::min(a, b), std::max(a, b) };
}

/// Checks a layout from its arrays alone, without the code that made it.
class LayoutCheck
{
public:
  LayoutCheck(const QuadMesh& mesh, const QuadLayout& layout) : mesh_(mesh), layout_(layout)
  {
    for (Index q = 0; q < mesh.quads.size(); ++q)
    {
      for (Index i = 0; i < 4; ++i)
      {
        sides_[edgeOf(mesh.quads[q][i], mesh.quads[q][(i + 1) % 4])].push_back(4 * q + i);
      }
    }
    for (const LayoutLine& line : layout.lines)
    {
      for (std::size_t i = line.first; i + 1 < line.first + line.count; ++i)
      {
        const Edge edge = edgeOf(layout.linePoints[i], layout.linePoints[i + 1]);
        EXPECT_TRUE(walls_.insert(edge).second) << "an edge twice";
        EXPECT_EQ(sides_[edge].size(), 2u) << "a line on the boundary, or along no edge";
      }
    }
  }

  void run()
  {
    checkNumbers();
    checkWalls();
    checkCrossings();
    checkLines();
    for (Index patch = 0; patch < layout_.patches.size(); ++patch)
    {
      checkGrid(patch);
    }
  }

private:
  bool isWall(Index side) const
  {
    const Edge edge = edgeAt(side);
    return walls_.count(edge) != 0 || sides_.at(edge).size() == 1;
  }
  Edge edgeAt(Index side) const
  {
    return edgeOf(mesh_.quads[side / 4][side % 4], mesh_.quads[side / 4][(side + 1) % 4]);
  }
  Index acrossOf(Index side) const
  {
    const std::vector<Index>& both = sides_.at(edgeAt(side));
    return both[0] == side ? both[1] : both[0];
  }

  void checkNumbers() const
  {
    ASSERT_EQ(layout_.patchOf.size(), mesh_.quads.size());
    Index next = 0;
    for (Index q = 0; q < mesh_.quads.size(); ++q)
    {
      ASSERT_LE(layout_.patchOf[q], next);
      if (layout_.patchOf[q] == next)
      {
        ASSERT_LT(next, layout_.patches.size());
        EXPECT_EQ(layout_.patches[next].firstQuad, q);
        ++next;
      }
    }
    EXPECT_EQ(next, layout_.patches.size());
  }

  /// Patches differ only across walls, and all features and all edges at irregular vertices are walls.
  void checkWalls() const
  {
    for (const auto& [edge, both] : sides_)
    {
      if (both.size() == 2 && walls_.count(edge) == 0)
      {
        EXPECT_EQ(layout_.patchOf[both[0] / 4], layout_.patchOf[both[1] / 4]);
        for (const Index p : { edge.first, edge.second })
        {
          EXPECT_FALSE(mesh_.onBoundary[p] ? mesh_.valence[p] > 3 : mesh_.valence[p] != 4);
        }
      }
    }
    ASSERT_EQ(layout_.patchesOfLine.size(), mesh_.lines.size());
    for (std::size_t i = 0; i < mesh_.lines.size(); ++i)
    {
      const Edge edge = edgeOf(mesh_.lines[i].a, mesh_.lines[i].b);
      EXPECT_EQ(walls_.count(edge), mesh_.lines[i].boundary ? 0u : 1u);
      std::array<Index, 2> patches{ layout_.patchOf[sides_.at(edge).front() / 4],
        layout_.patchOf[sides_.at(edge).back() / 4] };
      std::sort(patches.begin(), patches.end());
      EXPECT_EQ(layout_.patchesOfLine[i], patches);
    }
  }

  /// At a regular vertex inside no wall ends or turns, so that sides of patches match as a whole.
  void checkCrossings() const
  {
    std::map<Index, std::vector<Edge>> wallsAt;
    for (const Edge& wall : walls_)
    {
      wallsAt[wall.first].push_back(wall);
      wallsAt[wall.second].push_back(wall);
    }
    for (const auto& [p, walls] : wallsAt)
    {
      if (mesh_.onBoundary[p] || mesh_.valence[p] != 4)
      {
        continue;
      }
      ASSERT_TRUE(walls.size() == 2 || walls.size() == 4);
      for (const Index side : sides_.at(walls[0]))
      {
        const auto both = sides_.at(walls[1]);
        EXPECT_TRUE(walls.size() == 4 || (side / 4 != both[0] / 4 && side / 4 != both[1] / 4));
      }
    }
  }

  void checkLines() const
  {
    std::set<Edge> features;
    for (const QuadLine& line : mesh_.lines)
    {
      features.insert(edgeOf(line.a, line.b));
    }
    std::map<Edge, bool> separatrix;
    for (const LayoutLine& line : layout_.lines)
    {
      const Index* p = layout_.linePoints.data() + line.first;
      ASSERT_GE(line.count, 2u);
      for (std::size_t i = 0; i + 1 < line.count; ++i)
      {
        EXPECT_EQ(features.count(edgeOf(p[i], p[i + 1])), line.feature ? 1u : 0u);
        separatrix[edgeOf(p[i], p[i + 1])] = line.separatrix;
        EXPECT_TRUE(i == 0 || (mesh_.valence[p[i]] == 4 && !mesh_.onBoundary[p[i]]));
      }
      checkEnd(line.start, p[0]);
      checkEnd(line.end, p[line.count - 1]);
      const bool closed = line.start == LineEnd::Closed;
      EXPECT_EQ(closed, line.end == LineEnd::Closed);
      EXPECT_TRUE(!closed || p[0] == p[line.count - 1]);
      const bool irregular = line.start == LineEnd::Irregular || line.end == LineEnd::Irregular;
      EXPECT_TRUE(!irregular || line.separatrix);
    }
    ASSERT_EQ(layout_.lineOnSeparatrix.size(), mesh_.lines.size());
    for (std::size_t i = 0; i < mesh_.lines.size(); ++i)
    {
      const auto found = separatrix.find(edgeOf(mesh_.lines[i].a, mesh_.lines[i].b));
      EXPECT_EQ(layout_.lineOnSeparatrix[i] != 0, found != separatrix.end() && found->second);
    }
  }

  void checkEnd(LineEnd kind, Index p) const
  {
    const bool boundary = mesh_.onBoundary[p] != 0;
    const int valence = mesh_.valence[p];
    switch (kind)
    {
      case LineEnd::Irregular:
        EXPECT_TRUE(boundary ? valence > 3 : valence != 4);
        break;
      case LineEnd::Boundary:
        EXPECT_TRUE(boundary && valence == 3);
        break;
      default:
        EXPECT_TRUE(!boundary && valence == 4);
    }
  }

  /// A quad's place in its patch; `east` is the side of the quad that looks along the first axis.
  struct Place
  {
    int x, y;
    Index east;
  };

  /// Lays the quads of the patch out in the plane: they must fill n x m places, each once.
  void checkGrid(Index patch) const
  {
    const LayoutPatch& p = layout_.patches[patch];
    const std::map<Index, Place> placed = layOut(patch);
    const int n = static_cast<int>(p.size[0]);
    const int m = static_cast<int>(p.size[1]);
    EXPECT_EQ(placed.size(), std::size_t(n) * std::size_t(m));
    EXPECT_EQ(placed.size(),
      static_cast<std::size_t>(std::count(layout_.patchOf.begin(), layout_.patchOf.end(), patch)));
    if (p.shape == PatchShape::Torus)
    {
      for (const auto& [q, place] : placed)
      {
        EXPECT_FALSE(isWall(4 * q) || isWall(4 * q + 1) || isWall(4 * q + 2) || isWall(4 * q + 3));
      }
      return;
    }
    int lowX = 0, lowY = 0;
    for (const auto& [q, place] : placed)
    {
      lowX = std::min(lowX, place.x);
      lowY = std::min(lowY, place.y);
    }
    std::set<std::pair<int, int>> seen;
    for (const auto& [q, place] : placed)
    {
      int x = place.x - lowX;
      int y = place.y - lowY;
      const std::array<bool, 4> wall{ isWall(place.east), isWall(turned(place.east, 1)),
        isWall(turned(place.east, 2)), isWall(turned(place.east, 3)) }; // east, north, west, south
      if (p.shape == PatchShape::Ring)
      {
        const bool roundX = !wall[0] && !wall[2];
        EXPECT_TRUE(roundX || (!wall[1] && !wall[3]));
        x = ringAlongX(placed) ? ((x % n) + n) % n : x;
        y = ringAlongX(placed) ? y : ((y % n) + n) % n;
        EXPECT_LT(ringAlongX(placed) ? y : x, m);
      }
      else
      {
        const bool swapped = !(wall[0] == (x == n - 1) && wall[1] == (y == m - 1));
        EXPECT_FALSE(swapped) << "patch " << patch << " of " << n << " x " << m << " at " << x
                              << ", " << y;
        EXPECT_EQ(wall[2], x == 0);
        EXPECT_EQ(wall[3], y == 0);
      }
      EXPECT_TRUE(seen.insert({ x, y }).second);
    }
  }

  /// Which axis of a laid out ring closes: the one without walls.
  bool ringAlongX(const std::map<Index, Place>& placed) const
  {
    for (const auto& [q, place] : placed)
    {
      if (isWall(place.east) || isWall(turned(place.east, 2)))
      {
        return false;
      }
    }
    return true;
  }

  static Index turned(Index side, Index quarters) { return side / 4 * 4 + (side + quarters) % 4; }

  std::map<Index, Place> layOut(Index patch) const
  {
    // Side 0 of the first quad runs east, so side 1 looks east.
    const Index first = layout_.patches[patch].firstQuad;
    std::map<Index, Place> placed{ { first, { 0, 0, 4 * first + 1 } } };
    std::vector<Index> stack{ first };
    while (!stack.empty())
    {
      const Place here = placed.at(stack.back());
      stack.pop_back();
      for (Index quarter = 0; quarter < 4; ++quarter)
      {
        const Index side = turned(here.east, quarter);
        if (isWall(side))
        {
          continue;
        }
        static constexpr std::array<int, 4> kX{ 1, 0, -1, 0 };
        static constexpr std::array<int, 4> kY{ 0, 1, 0, -1 };
        const Index entry = acrossOf(side); // looks back
        const Place next{ here.x + kX[quarter], here.y + kY[quarter], turned(entry, 6 - quarter) };
        if (placed.try_emplace(entry / 4, next).second)
        {
          stack.push_back(entry / 4);
        }
        else
        {
          EXPECT_EQ(placed.at(entry / 4).east, next.east) << "the axes do not agree";
          if (layout_.patches[patch].shape == PatchShape::Rectangle)
          {
            EXPECT_EQ(placed.at(entry / 4).x, next.x);
            EXPECT_EQ(placed.at(entry / 4).y, next.y);
          }
        }
      }
    }
    return placed;
  }

  const QuadMesh& mesh_;
  const QuadLayout& layout_;
  std::map<Edge, std::vector<Index>> sides_;
  std::set<Edge> walls_;
};

/// The layout of a case, checked.
QuadLayout checkedLayout(const GridMapCase& c)
{
  SCOPED_TRACE(c.name);
  const QuadMesh mesh = layoutQuadsOf(c);
  QuadLayout layout = layoutOf(mesh);
  LayoutCheck(mesh, layout).run();
  return layout;
}

std::size_t countShapes(const QuadLayout& layout, PatchShape shape)
{
  return static_cast<std::size_t>(std::count_if(layout.patches.begin(), layout.patches.end(),
    [shape](const LayoutPatch& p) { return p.shape == shape; }));
}

std::map<std::pair<LineEnd, LineEnd>, int> countEnds(const QuadLayout& layout)
{
  std::map<std::pair<LineEnd, LineEnd>, int> count;
  for (const LayoutLine& line : layout.lines)
  {
    ++count[std::minmax(line.start, line.end)];
  }
  return count;
}

} // namespace

TEST(QuadLayout, PolycubesHaveTheirFaces)
{
  for (const bool features : { false, true })
  {
    const Mesh cube = features ? markFeatures(unitCube(2), 0.7) : unitCube(2);
    const QuadLayout layout = checkedLayout(squares("cube", cube, 3));
    ASSERT_EQ(layout.patches.size(), 6u);
    EXPECT_EQ(layout.lines.size(), 12u);
    for (const LayoutPatch& patch : layout.patches)
    {
      EXPECT_EQ(patch.shape, PatchShape::Rectangle);
      EXPECT_EQ(patch.size, (std::array<Index, 2>{ 6, 6 }));
    }
    for (const LayoutLine& line : layout.lines)
    {
      EXPECT_EQ(line.count, 7u);
      EXPECT_EQ(line.feature, features);
      EXPECT_TRUE(line.separatrix);
      EXPECT_EQ(line.start, LineEnd::Irregular);
      EXPECT_EQ(line.end, LineEnd::Irregular);
    }
  }
  // The 18 sides of the voxels that can be seen: all edges of the voxels begin or end in irregular vertices.
  EXPECT_EQ(checkedLayout(squares("tripod", tripod(2), 1)).patches.size(), 18u);
  EXPECT_EQ(checkedLayout(squares("pillow", pillow(3), 2)).patches.size(), 2u);
}

TEST(QuadLayout, OpenPlates)
{
  const QuadLayout plane = checkedLayout(squares("plane", gridPlane(5, 3), 2));
  ASSERT_EQ(plane.patches.size(), 1u);
  EXPECT_TRUE(plane.lines.empty());
  EXPECT_EQ(plane.patches[0].size[0] * plane.patches[0].size[1], 60u);
  EXPECT_EQ(std::max(plane.patches[0].size[0], plane.patches[0].size[1]), 10u);

  // A reflex corner emits the straight continuations of its two sides.
  const QuadLayout bend = checkedLayout(squares("L", plateL(2), 2));
  EXPECT_EQ(bend.patches.size(), 3u);
  EXPECT_EQ((countEnds(bend)[{ LineEnd::Irregular, LineEnd::Boundary }]), 2);
  EXPECT_EQ(bend.lines.size(), 2u);

  EXPECT_EQ(checkedLayout(squares("hole", plateWithHole(2), 2)).patches.size(), 8u);
}

TEST(QuadLayout, RingsAndToriHaveNoCorners)
{
  const QuadLayout whole = checkedLayout(squares("torus", torus(5, 4), 2));
  ASSERT_EQ(whole.patches.size(), 1u);
  EXPECT_EQ(whole.patches[0].shape, PatchShape::Torus);
  EXPECT_EQ(whole.patches[0].size[0] * whole.patches[0].size[1], 80u);
  EXPECT_TRUE(whole.lines.empty());

  const QuadLayout tube = checkedLayout(squares("cylinder", openCylinder(5, 3), 2));
  ASSERT_EQ(tube.patches.size(), 1u);
  EXPECT_EQ(tube.patches[0].shape, PatchShape::Ring);
  EXPECT_EQ(tube.patches[0].size, (std::array<Index, 2>{ 10, 6 }));

  const QuadLayout two =
    checkedLayout(squares("two", disjointUnion(unitCube(1), torus(4, 3), Vector3(3, 0, 0)), 2));
  EXPECT_EQ(countShapes(two, PatchShape::Rectangle), 6u);
  EXPECT_EQ(countShapes(two, PatchShape::Torus), 1u);
}

TEST(QuadLayout, AFeatureThatEndsGoesOnAsALine)
{
  const auto half = [](const Vector3& a, const Vector3& b)
  { return a.y() == 2 && b.y() == 2 && a.x() <= 3 && b.x() <= 3; };
  const QuadLayout layout = checkedLayout(squares("slit", withFeatures(gridPlane(6, 4), half), 1));
  EXPECT_EQ(layout.patches.size(), 2u);
  ASSERT_EQ(layout.lines.size(), 2u);
  for (const LayoutLine& line : layout.lines)
  {
    EXPECT_EQ(std::min(line.start, line.end), LineEnd::Boundary);
    EXPECT_EQ(std::max(line.start, line.end), LineEnd::Feature);
    EXPECT_EQ(line.count, 4u);
    EXPECT_FALSE(line.separatrix);
  }
  EXPECT_NE(layout.lines[0].feature, layout.lines[1].feature);
}

TEST(QuadLayout, AFeatureThatTurnsGoesOnBothWays)
{
  const auto corner = [](const Vector3& a, const Vector3& b)
  {
    return (a.y() == 2 && b.y() == 2 && a.x() <= 3 && b.x() <= 3) ||
      (a.x() == 3 && b.x() == 3 && a.y() <= 2 && b.y() <= 2);
  };
  const QuadLayout layout =
    checkedLayout(squares("bend", withFeatures(gridPlane(6, 4), corner), 1));
  EXPECT_EQ(layout.patches.size(), 4u);
  EXPECT_EQ((countEnds(layout)[{ LineEnd::Boundary, LineEnd::Feature }]), 4);
}

TEST(QuadLayout, ClosedLines)
{
  const double r = 1.4; // the outer equator of the torus
  const auto equator = [r](const Vector3& a, const Vector3& b)
  { return std::abs(a.head<2>().norm() - r) < 1e-9 && std::abs(b.head<2>().norm() - r) < 1e-9; };
  const QuadLayout cut = checkedLayout(squares("cut", withFeatures(torus(6, 4), equator), 1));
  ASSERT_EQ(cut.patches.size(), 1u);
  EXPECT_EQ(cut.patches[0].shape, PatchShape::Ring);
  EXPECT_EQ(cut.patches[0].size, (std::array<Index, 2>{ 6, 4 }));
  ASSERT_EQ(cut.lines.size(), 1u);
  EXPECT_EQ(cut.lines[0].start, LineEnd::Closed);
  EXPECT_EQ(cut.lines[0].count, 7u);
  EXPECT_TRUE(cut.lines[0].feature);

  // Three of its six edges, from anywhere on: two pieces, wherever the search begins.
  for (int begin = 0; begin < 6; ++begin)
  {
    const auto isPart = [&](const Vector3& p)
    {
      const int place = static_cast<int>(std::lround(std::atan2(p.y(), p.x()) / (kPi / 3)));
      return (place + 12 - begin) % 6 <= 3;
    };
    const auto part = [&](const Vector3& a, const Vector3& b)
    { return equator(a, b) && isPart(a) && isPart(b); };
    const QuadLayout open = checkedLayout(squares("part", withFeatures(torus(6, 4), part), 1));
    EXPECT_EQ(open.patches.size(), 1u);
    ASSERT_EQ(open.lines.size(), 2u);
    EXPECT_EQ((countEnds(open)[{ LineEnd::Feature, LineEnd::Feature }]), 2);
    EXPECT_NE(open.lines[0].feature, open.lines[1].feature);
    EXPECT_EQ(open.lines[0].count, 4u);
  }
}

// A closed feature round the middle of a cube: the four upright sides fall in two, and no line ends at it.
TEST(QuadLayout, LinesCrossFeatures)
{
  const auto belt = [](const Vector3& a, const Vector3& b)
  { return std::abs(a.z() - 0.5) < 1e-9 && std::abs(b.z() - 0.5) < 1e-9; };
  const QuadLayout layout = checkedLayout(squares("belt", withFeatures(unitCube(2), belt), 2));
  EXPECT_EQ(layout.patches.size(), 10u);
  EXPECT_EQ((countEnds(layout)[{ LineEnd::Irregular, LineEnd::Irregular }]), 12);
  EXPECT_EQ((countEnds(layout)[{ LineEnd::Closed, LineEnd::Closed }]), 1);
  EXPECT_EQ(layout.lines.size(), 13u);
}

TEST(QuadLayout, AnyFeaturesLeaveGrids)
{
  for (unsigned seed = 0; seed < 20; ++seed)
  {
    SCOPED_TRACE(seed);
    Random random(seed);
    for (const GridMapCase& c : allCases(1 + static_cast<int>(seed % 3)))
    {
      const int one = 2 + pick(random, 30); // one edge in so many
      GridMapCase marked = c;
      marked.mesh = withFeatures(
        c.mesh, [&](const Vector3&, const Vector3&) { return pick(random, one) == 0; });
      checkedLayout(marked);
    }
  }
}

/// Two plates that touch in a corner, and a point that no quad has: each plate is a patch.
TEST(QuadLayout, FansThatTouchAreApart)
{
  QuadMesh mesh;
  mesh.points.resize(18);
  const auto addPlate = [&](Index corner) // 3 x 3 points, the first one shared
  {
    const auto point = [&](Index i, Index j) { return i + j == 0 ? 0 : corner + 3 * j + i; };
    for (Index j = 0; j < 2; ++j)
    {
      for (Index i = 0; i < 2; ++i)
      {
        mesh.quads.push_back(
          { point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1) });
      }
    }
  };
  addPlate(0);
  addPlate(8);
  mesh.lines.push_back({ 0, 1, 0, true });
  mesh.lines.push_back({ 0, 9, 0, true });
  mesh.lines.push_back({ 1, 17, 0, false });
  const QuadLayout layout = layoutOf(mesh);
  EXPECT_EQ(layout.patchOf, (std::vector<Index>{ 0, 0, 0, 0, 1, 1, 1, 1 }));
  for (const LayoutPatch& patch : layout.patches)
  {
    EXPECT_EQ(patch.shape, PatchShape::Rectangle);
    EXPECT_EQ(patch.size, (std::array<Index, 2>{ 2, 2 }));
  }
  EXPECT_TRUE(layout.lines.empty());
  EXPECT_EQ(layout.patchesOfLine[0], (std::array<Index, 2>{ 0, 0 }));
  EXPECT_EQ(layout.patchesOfLine[1], (std::array<Index, 2>{ 1, 1 }));
  EXPECT_EQ(layout.patchesOfLine[2], (std::array<Index, 2>{ kInvalidIndex, kInvalidIndex }));
}

/// Three plates along an edge: they are cut there.
TEST(QuadLayout, SheetsAreCutWhereMoreThanTwoMeet)
{
  QuadMesh mesh;
  mesh.points.resize(8);
  mesh.quads = { { 0, 1, 2, 3 }, { 1, 0, 4, 5 }, { 0, 1, 6, 7 } };
  mesh.lines.push_back({ 0, 1, 0, false });
  const QuadLayout layout = layoutOf(mesh);
  EXPECT_EQ(layout.patchOf, (std::vector<Index>{ 0, 1, 2 }));
  EXPECT_EQ(layout.patchesOfLine[0][0], layout.patchesOfLine[0][1]);
}

TEST(QuadLayout, RefusesQuadsWithAPointTwice)
{
  QuadMesh mesh = layoutQuadsOf(squares("", unitCube(2), 1));
  mesh.quads[5][2] = mesh.quads[5][0];
  EXPECT_THROW(layoutOf(mesh), InvalidInput);
}

} // namespace quadrille::test

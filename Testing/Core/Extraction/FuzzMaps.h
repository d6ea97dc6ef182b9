// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Surfaces glued from squares, with cones of any valence, and edits that fold, flatten and break
/// their maps: the random cases of the extraction.
#pragma once

#include "GridMaps.h"

#include "Extraction/ExactMap.h"

#include <numeric>

namespace quadrille::test
{

/// Side i of square q, from its corner i to the next, glued to that of another square, reversed;
/// none on the boundary.
using SideGluing = std::function<std::optional<std::pair<int, int>>(int q, int side)>;

/// The surface that `count` squares make when their sides are glued, each cut into n x n cells; a
/// cell at a corner of a square is cut through that corner, so that two cells of a vertex of
/// valence 2 do not share their diagonal. It need not fit into space: vertices lie on a spiral.
class GluedSquares
{
public:
  GluedSquares(int count, int n, const SideGluing& glued) : n_(n)
  {
    root_.resize(static_cast<std::size_t>(count * (n + 1) * (n + 1)));
    std::iota(root_.begin(), root_.end(), Index{ 0 });
    for (int q = 0; q < count; ++q)
    {
      for (int side = 0; side < 4; ++side)
      {
        if (const auto other = glued(q, side))
        {
          for (int t = 0; t <= n; ++t)
          {
            join(onSide(q, side, t), onSide(other->first, other->second, n - t));
          }
        }
      }
    }
    for (int q = 0; q < count; ++q)
    {
      addCells(q);
    }
  }

  Mesh mesh()
  {
    std::vector<Vector3> points;
    for (std::size_t i = 0; i < ids_.size(); ++i)
    {
      const double t = static_cast<double>(i);
      points.emplace_back(t * std::cos(t), t * std::sin(t), 0.1 * t * t);
    }
    return makeMesh(std::move(points), triangles_);
  }

private:
  Index point(int q, int x, int y) const
  {
    return static_cast<Index>((q * (n_ + 1) + y) * (n_ + 1) + x);
  }
  Index onSide(int q, int side, int t) const
  {
    switch (side)
    {
      case 0:
        return point(q, t, 0);
      case 1:
        return point(q, n_, t);
      case 2:
        return point(q, n_ - t, n_);
      default:
        return point(q, 0, n_ - t);
    }
  }
  Index find(Index p) const { return root_[p] == p ? p : find(root_[p]); }
  void join(Index a, Index b)
  {
    const Index rootA = find(a);
    const Index rootB = find(b);
    root_[std::max(rootA, rootB)] = std::min(rootA, rootB);
  }
  Index id(int q, int x, int y)
  {
    return ids_.try_emplace(find(point(q, x, y)), static_cast<Index>(ids_.size())).first->second;
  }
  void addCells(int q)
  {
    for (int y = 0; y < n_; ++y)
    {
      for (int x = 0; x < n_; ++x)
      {
        std::array<Index, 4> c{ id(q, x, y), id(q, x + 1, y), id(q, x + 1, y + 1),
          id(q, x, y + 1) };
        const bool rising = (x == 0 && y == 0) || (x == n_ - 1 && y == n_ - 1);
        const bool falling = (x == n_ - 1 && y == 0) || (x == 0 && y == n_ - 1);
        if (falling && !rising)
        {
          std::rotate(c.begin(), c.begin() + 1, c.end());
        }
        triangles_.push_back({ c[0], c[1], c[2] });
        triangles_.push_back({ c[0], c[2], c[3] });
      }
    }
  }

  int n_;
  std::vector<Index> root_;
  std::map<Index, Index> ids_;
  std::vector<Triangle> triangles_;
};

/// Two wheels of `spokes` squares glued along their rims: two vertices of that valence, and 2
/// spokes of valence 3 when the wheels are turned against each other, else `spokes` of valence 2.
/// chi 2.
inline Mesh twoWheels(int spokes, bool turned, int n)
{
  const int rim = 2 * spokes;
  const auto glued = [=](int q, int side) -> std::optional<std::pair<int, int>>
  {
    const int first = q < spokes ? 0 : spokes;
    const int i = q - first;
    switch (side)
    {
      case 0: // from the centre along a spoke
        return std::pair{ first + (i + spokes - 1) % spokes, 3 };
      case 3:
        return std::pair{ first + (i + 1) % spokes, 0 };
      default: // the rim, the other wheel's runs the other way
        const int e = (2 * i + side - 1);
        const int other = ((turned ? 0 : 1) - e + 2 * rim) % rim;
        return std::pair{ spokes - first + other / 2, 1 + other % 2 };
    }
  };
  return GluedSquares(2 * spokes, n, glued).mesh();
}

/// A translation surface: square right[q] is to the right of q, up[q] above it. All vertices have
/// a valence that is a multiple of 4.
inline Mesh squareTiled(const std::vector<int>& right, const std::vector<int>& up, int n)
{
  const auto inverse = [](const std::vector<int>& p, int q)
  { return static_cast<int>(std::find(p.begin(), p.end(), q) - p.begin()); };
  const auto glued = [&](int q, int side) -> std::optional<std::pair<int, int>>
  {
    switch (side)
    {
      case 0:
        return std::pair{ inverse(up, q), 2 };
      case 1:
        return std::pair{ right[static_cast<std::size_t>(q)], 3 };
      case 2:
        return std::pair{ up[static_cast<std::size_t>(q)], 0 };
      default:
        return std::pair{ inverse(right, q), 1 };
    }
  };
  return GluedSquares(static_cast<int>(right.size()), n, glued).mesh();
}

/// allCases(k) and surfaces with cones of valence 2, 7, 8 and 12.
inline std::vector<GridMapCase> casesWithCones(int k)
{
  std::vector<GridMapCase> cases = allCases(k);
  cases.push_back(squares("wheels of 7", twoWheels(7, true, 2), k));
  cases.push_back(squares("wheels of 8", twoWheels(8, true, 2), k));
  cases.push_back(squares("flat wheels of 8", twoWheels(8, false, 2), k));
  cases.push_back(squares("wheels of 2", twoWheels(2, true, 2), k));
  // Two tori, slit and glued crosswise: genus 2, two vertices of valence 8.
  cases.push_back(squares("slit tori", squareTiled({ 1, 0, 3, 2 }, { 2, 1, 0, 3 }, 3), k));
  // Three squares in an L: genus 2, one vertex of valence 12.
  cases.push_back(squares("L of three", squareTiled({ 1, 0, 2 }, { 2, 1, 0 }, 3), k));
  return cases;
}

inline double angleBetween(FixedVec2 from, FixedVec2 to)
{
  const Vector2 a = toDouble(from);
  const Vector2 b = toDouble(to);
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

/// Quarter turns of the map round each vertex, by angles; only for maps without inverted triangles.
inline std::vector<int> turnsOf(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  std::vector<double> angle(mesh.position.size(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    angle[mesh.origin[h]] += angleBetween(uv[Mesh::next(h)] - uv[h], uv[Mesh::previous(h)] - uv[h]);
  }
  std::vector<int> turns;
  for (const double sum : angle)
  {
    turns.push_back(static_cast<int>(std::lround(sum / (kPi / 2))));
  }
  return turns;
}

/// Moves vertices of a mapped mesh anywhere without ever losing the transitions, which are those of
/// the map at the start: what comes is folded, but seamless. Cones and corners stay, vertices of
/// curves keep to their isoline.
class MapFolder
{
public:
  MapFolder(GridMapCase& target, Random& random)
    : mesh_(target.mesh), uv_(target.uv), random_(random), chart_(uv_.size()),
      first_(outgoingHalfEdges(mesh_)), freedom_(first_.size(), Freedom::None)
  {
    const std::vector<int> turns = turnsOf(mesh_, uv_);
    for (Index v = 0; v < mesh_.vertexCount(); ++v)
    {
      walkFan(v, turns[v]);
    }
  }

  Index randomCorner() { return static_cast<Index>(pick(random_, static_cast<int>(uv_.size()))); }

  /// Moves the vertex of corner h to p (chart of h's face), as far as it is free.
  void put(Index h, FixedVec2 p)
  {
    const Index v = mesh_.origin[h];
    const Index start = first_[v];
    FixedVec2 q = chart_[h].inverse().apply(p);
    q.u = freedom_[v] == Freedom::V ? uv_[start].u : q.u;
    q.v = freedom_[v] == Freedom::U ? uv_[start].v : q.v;
    Index g = start;
    do
    {
      if (freedom_[v] != Freedom::None)
      {
        uv_[g] = chart_[g].apply(q);
      }
      g = mesh_.rotateCounterclockwise(g);
    } while (g != start && g != kInvalidIndex);
  }

  /// put(), taken back when a triangle round the vertex would not be positive.
  void putPositive(Index h, FixedVec2 p)
  {
    const FixedVec2 before = uv_[h];
    put(h, p);
    if (!isStarPositive(h))
    {
      put(h, before);
    }
  }

  FixedVec2 at(Index h) const { return uv_[h]; }

  /// Up to `reach` in each coordinate.
  FixedVec2 randomDelta(std::int64_t reach)
  {
    const auto coordinate = [&]()
    {
      const std::int64_t range = 2 * reach + 1;
      return static_cast<std::int64_t>(random_()) % range - reach;
    };
    const std::int64_t u = coordinate();
    return { u, coordinate() };
  }

  /// A grid point, or a point on a grid line, next to the vertex of h.
  FixedVec2 ontoGrid(Index h)
  {
    FixedVec2 p = uv_[h];
    const int kind = pick(random_, 4);
    const std::int64_t unit = kind == 3 ? kOne / 2 : kOne;
    const auto round = [unit](std::int64_t x) { return (x + unit / 2) & ~(unit - 1); };
    p.u = kind != 1 ? round(p.u) : p.u;
    p.v = kind != 2 ? round(p.v) : p.v;
    return p;
  }

  /// A point exactly on the edge opposite to corner h, its ends included.
  FixedVec2 ontoOppositeEdge(Index h)
  {
    const FixedVec2 a = uv_[Mesh::next(h)];
    const FixedVec2 e = uv_[Mesh::previous(h)] - a;
    const std::int64_t parts = std::gcd(e.u, e.v);
    const std::int64_t j = parts == 0 ? 0 : static_cast<std::int64_t>(random_()) % (parts + 1);
    return parts == 0 ? a : a + FixedVec2{ e.u / parts * j, e.v / parts * j };
  }

  void jitter(std::int64_t reach)
  {
    for (const Index h : first_)
    {
      put(h, uv_[h] + randomDelta(reach));
    }
  }

  /// The vertex of h on its neighbour, that one's neighbour there, too, and so on.
  void collapseRun(Index h, int length)
  {
    for (int i = 0; i < length; ++i)
    {
      put(h, uv_[Mesh::next(h)]);
      h = Mesh::next(h);
      for (int turns = pick(random_, 4); turns > 0 && !mesh_.isBoundary(h); --turns)
      {
        h = mesh_.rotateClockwise(h);
      }
    }
  }

  /// All neighbours of the vertex of h on its point.
  void collapseStar(Index h)
  {
    forEachInStar(h, [this](Index g) { put(Mesh::next(g), uv_[g]); });
  }

  /// Neighbours exchange their places round the vertex of h, which may be a cone.
  void invertStar(Index h)
  {
    forEachInStar(h,
      [this](Index g)
      {
        const FixedVec2 a = uv_[Mesh::next(g)];
        const FixedVec2 b = uv_[Mesh::previous(g)];
        put(Mesh::next(g), b);
        put(Mesh::previous(g), a);
      });
  }

private:
  enum class Freedom
  {
    None,
    U, ///< along its isoline only, that runs along u of the first corner's chart
    V,
    All
  };

  /// Charts and freedom of vertex v. Where two constrained edges run straight on through it, it may
  /// move along them.
  void walkFan(Index v, int turns)
  {
    const ExactMap map{ mesh_, uv_ };
    for (Index h = first_[v]; h != kInvalidIndex && !mesh_.isConstrained(first_[v]);)
    {
      h = mesh_.rotateCounterclockwise(h);
      if (h == first_[v])
      {
        break;
      }
      first_[v] = mesh_.isConstrained(h) ? h : first_[v];
    }
    const Index start = first_[v];
    const FixedVec2 along = map.edge(start);
    const auto runsOn = [along](FixedVec2 e) {
      return orientation(along, e) == 0 && (along.u > 0) == (e.u > 0) && (along.v > 0) == (e.v > 0);
    };
    int constrained = 0;
    int straight = 0;
    Transition whole;
    Index h = start;
    do
    {
      chart_[h] = whole;
      if (h != start && mesh_.isConstrained(h))
      {
        ++constrained;
        straight += runsOn(-rotate(map.edge(h), 4 - whole.rotation)) ? 1 : 0;
      }
      const Index incoming = Mesh::previous(h);
      if (mesh_.isBoundary(incoming))
      {
        ++constrained;
        straight += runsOn(rotate(map.edge(incoming), 4 - whole.rotation)) ? 1 : 0;
      }
      Transition t;
      map.transition(incoming, t);
      whole = t.after(whole);
      h = mesh_.rotateCounterclockwise(h);
    } while (h != start && h != kInvalidIndex);
    if (turns == (h == start ? 4 : 2) && (!mesh_.isConstrained(start) || constrained == 1))
    {
      const bool all = !mesh_.isConstrained(start);
      freedom_[v] = all ? Freedom::All
        : straight == 1 ? (along.v == 0 ? Freedom::U : Freedom::V)
                        : Freedom::None;
    }
  }

  template <typename Visit>
  void forEachInStar(Index h, const Visit& visit)
  {
    Index g = first_[mesh_.origin[h]];
    const Index start = g;
    do
    {
      visit(g);
      g = mesh_.rotateCounterclockwise(g);
    } while (g != start && g != kInvalidIndex);
  }

  /// Positive, and wound once: round a neighbour of a cone it can wind twice.
  bool isStarPositive(Index h)
  {
    bool positive = true;
    double angle = 0;
    forEachInStar(h,
      [&](Index g)
      {
        const FixedVec2 a = uv_[Mesh::next(g)] - uv_[g];
        const FixedVec2 b = uv_[Mesh::previous(g)] - uv_[g];
        positive = positive && orientation(a, b) > 0;
        angle += angleBetween(a, b);
      });
    return positive && angle < 3 * kPi;
  }

  Mesh& mesh_;
  std::vector<FixedVec2>& uv_;
  Random& random_;
  std::vector<Transition> chart_; ///< per corner: from the chart of its vertex's first corner
  std::vector<Index> first_;      ///< per vertex
  std::vector<Freedom> freedom_;  ///< per vertex
};

} // namespace quadrille::test

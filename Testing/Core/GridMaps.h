// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Exact integer-grid maps with known quads, and edits that keep them valid: the test cases of the
/// extraction.
#pragma once

#include "TestMeshes.h"

#include "Base/FixedPoint.h"

#include <functional>
#include <random>

namespace quadrille::test
{

using Random = std::mt19937;

inline int pick(Random& random, int count)
{
  return static_cast<int>(random() % static_cast<unsigned>(count));
}

/// A mesh with an integer-grid map and what its quad mesh must be.
struct GridMapCase
{
  std::string name;
  Mesh mesh;
  std::vector<FixedVec2> uv;
  std::size_t quads = 0;
  std::size_t lines = 0; ///< unit edges on features and boundaries
};

/// Gives each pair of triangles (a b c), (a c d), as the shared lattice meshes have them, the
/// square [0, k]^2 in its own chart.
inline GridMapCase squares(std::string name, Mesh mesh, int k)
{
  GridMapCase result{ std::move(name), std::move(mesh), {}, 0, 0 };
  const std::int64_t s = k * kOne;
  for (Index f = 0; f < result.mesh.faceCount(); ++f)
  {
    const FixedVec2 first = f % 2 == 0 ? FixedVec2{ s, 0 } : FixedVec2{ s, s };
    const FixedVec2 second = f % 2 == 0 ? FixedVec2{ s, s } : FixedVec2{ 0, s };
    result.uv.insert(result.uv.end(), { FixedVec2{}, first, second });
  }
  result.quads = std::size_t{ result.mesh.faceCount() } / 2 * static_cast<std::size_t>(k) *
    static_cast<std::size_t>(k);
  for (Index h = 0; h < result.mesh.halfEdgeCount(); ++h)
  {
    const Index g = result.mesh.twin[h];
    result.lines += result.mesh.isConstrained(h) && h < g ? static_cast<std::size_t>(k) : 0;
  }
  return result;
}

/// Edits of a mapped mesh that keep the map an integer-grid map of the same surface.
class MapEditor
{
public:
  explicit MapEditor(GridMapCase& target) : mesh_(target.mesh), uv_(target.uv) {}

  /// Another chart for every face.
  void shuffleCharts(Random& random)
  {
    for (Index f = 0; f < mesh_.faceCount(); ++f)
    {
      const Transition t{ pick(random, 4),
        { kOne * (pick(random, 200) - 100), kOne * (pick(random, 200) - 100) } };
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        uv_[h] = t.apply(uv_[h]);
      }
    }
  }

  /// Splits a face at p (its chart), which must be strictly inside; false and nothing done
  /// otherwise.
  bool splitFace(Index f, FixedVec2 p)
  {
    const Index a = 3 * f, b = a + 1, c = a + 2;
    if (orientation(uv_[a], uv_[b], p) <= 0 || orientation(uv_[b], uv_[c], p) <= 0 ||
      orientation(uv_[c], uv_[a], p) <= 0)
    {
      return false;
    }
    const Index m = addVertex((position(a) + position(b) + position(c)) / 3);
    const Index bc = addFace(mesh_.origin[b], mesh_.origin[c], m, uv_[b], uv_[c], p);
    const Index ca = addFace(mesh_.origin[c], mesh_.origin[a], m, uv_[c], uv_[a], p);
    glue(bc, mesh_.twin[b], mesh_.flags[b]);
    glue(ca, mesh_.twin[c], mesh_.flags[c]);
    mesh_.origin.edit()[c] = m;
    uv_[c] = p;
    glue(b, bc + 2, 0);
    glue(bc + 1, ca + 2, 0);
    glue(ca + 1, c, 0);
    return true;
  }

  /// Splits the edge of h at p (chart of its face), on the edge for a constrained one; false and
  /// nothing done when a triangle would not be positive.
  bool splitEdge(Index h, FixedVec2 p)
  {
    const Index g = mesh_.twin[h];
    const Index c = Mesh::previous(h);
    if (mesh_.isConstrained(h) && orientation(uv_[h], uv_[Mesh::next(h)], p) != 0)
    {
      return false;
    }
    if (orientation(uv_[c], uv_[h], p) <= 0 || orientation(uv_[Mesh::next(h)], uv_[c], p) <= 0)
    {
      return false;
    }
    FixedVec2 q;
    if (g != kInvalidIndex)
    {
      q = transition(h).apply(p);
      const Index d = Mesh::previous(g);
      if (orientation(uv_[d], uv_[g], q) <= 0 || orientation(uv_[Mesh::next(g)], uv_[d], q) <= 0)
      {
        return false;
      }
    }
    const Index m = addVertex((position(h) + position(Mesh::next(h))) / 2);
    const Index upper = cutHalf(h, m, p); // m -> b
    if (g != kInvalidIndex)
    {
      const std::uint8_t flags = mesh_.flags[h];
      const Index lower = cutHalf(g, m, q); // m -> a
      glue(h, lower, flags);
      glue(upper, g, flags);
    }
    return true;
  }

  /// Flips an unconstrained edge where both new triangles are positive.
  bool flip(Index h)
  {
    const Index g = mesh_.twin[h];
    if (mesh_.isConstrained(h) || Mesh::face(h) == Mesh::face(g))
    {
      return false;
    }
    const Index hn = Mesh::next(h), hp = Mesh::previous(h), gn = Mesh::next(g),
                gp = Mesh::previous(g);
    const FixedVec2 d = transition(h).inverse().apply(uv_[gp]);
    const FixedVec2 c = transition(h).apply(uv_[hp]);
    if (areNeighbours(hp, mesh_.origin[gp]) || orientation(uv_[h], d, uv_[hp]) <= 0 ||
      orientation(uv_[g], c, uv_[gp]) <= 0)
    {
      return false;
    }
    // f: (a, b, c) -> (a, d, c); g's face: (b, a, d) -> (b, c, d); see DecimationLog.h.
    const Index hnTwin = mesh_.twin[hn], gnTwin = mesh_.twin[gn];
    const std::uint8_t hnFlags = mesh_.flags[hn], gnFlags = mesh_.flags[gn];
    mesh_.origin.edit()[hn] = mesh_.origin[gp];
    uv_[hn] = d;
    mesh_.origin.edit()[gn] = mesh_.origin[hp];
    uv_[gn] = c;
    glue(h, gnTwin, gnFlags);
    glue(g, hnTwin, hnFlags);
    glue(hn, gn, 0);
    return true;
  }

  /// Moves the vertex of corner h by delta (its chart). Leaves constrained and singular vertices,
  /// and unless `force`, moves that would not keep the star positive and wound once: the ring of a
  /// neighbour of a cone can wind twice.
  bool moveVertex(Index h, FixedVec2 delta, bool force)
  {
    std::vector<std::pair<Index, FixedVec2>> moved;
    Index g = h;
    int rotation = 0;
    do
    {
      if (g == kInvalidIndex || mesh_.isConstrained(g))
      {
        return false;
      }
      moved.emplace_back(g, uv_[g] + rotate(delta, rotation));
      rotation += transition(Mesh::previous(g), true).rotation;
      g = mesh_.rotateCounterclockwise(g);
    } while (g != h);
    if ((rotation & 3) != 0)
    {
      return false;
    }
    double before = 0;
    double after = 0;
    for (const auto& [corner, p] : moved)
    {
      if (!force && orientation(p, uv_[Mesh::next(corner)], uv_[Mesh::previous(corner)]) <= 0)
      {
        return false;
      }
      before += angle(uv_[corner], corner);
      after += angle(p, corner);
    }
    if (!force && (before > 3 * kPi || after > 3 * kPi)) // 2 pi, or 4 pi and more
    {
      return false;
    }
    for (const auto& [corner, p] : moved)
    {
      uv_[corner] = p;
    }
    return true;
  }

  /// A random mix of the above; points are often integer or half integer, so that grid vertices
  /// fall on vertices, edges and faces, and grid lines on edges and through vertices.
  /// Flips look at the map only; without them the mesh in space stays free of folds, too.
  void refine(Random& random, int edits, bool flips = true)
  {
    for (int i = 0; i < edits; ++i)
    {
      const Index h = static_cast<Index>(pick(random, static_cast<int>(mesh_.halfEdgeCount())));
      switch (pick(random, 4))
      {
        case 0:
          splitFace(Mesh::face(h), randomInside(random, h));
          break;
        case 1:
          splitEdge(h, randomOnEdge(random, h));
          break;
        case 2:
          if (flips)
          {
            flip(h);
          }
          break;
        default:
          moveVertex(h, randomDelta(random, 1 << pick(random, 6)), false);
      }
    }
  }

  /// Throws vertices about without looking: inverts some triangles.
  void tangle(Random& random, int edits)
  {
    for (int i = 0; i < edits; ++i)
    {
      const Index h = static_cast<Index>(pick(random, static_cast<int>(mesh_.halfEdgeCount())));
      moveVertex(h, randomDelta(random, 2), true);
    }
  }

private:
  /// At p, in the place of corner h.
  double angle(FixedVec2 p, Index h) const
  {
    const Vector2 a = toDouble(uv_[Mesh::next(h)] - p);
    const Vector2 b = toDouble(uv_[Mesh::previous(h)] - p);
    return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }

  Vector3 position(Index h) const { return mesh_.position[mesh_.origin[h]]; }

  /// Is there an edge from the vertex of corner h to vertex v (or are they the same)?
  bool areNeighbours(Index h, Index v) const
  {
    bool found = mesh_.origin[h] == v;
    Index g = h;
    do
    {
      found = found || mesh_.target(g) == v || mesh_.origin[Mesh::previous(g)] == v;
      g = mesh_.rotateCounterclockwise(g);
    } while (g != h && g != kInvalidIndex);
    for (g = h; g != kInvalidIndex; g = mesh_.rotateClockwise(g))
    {
      found = found || mesh_.target(g) == v || mesh_.origin[Mesh::previous(g)] == v;
      if (mesh_.rotateClockwise(g) == h)
      {
        break;
      }
    }
    return found;
  }

  Index addVertex(const Vector3& p)
  {
    mesh_.position.push_back(p);
    return mesh_.vertexCount() - 1;
  }

  Index addFace(Index a, Index b, Index c, FixedVec2 ua, FixedVec2 ub, FixedVec2 uc)
  {
    const Index h = mesh_.halfEdgeCount();
    mesh_.origin.append({ a, b, c });
    mesh_.twin.append(3, kInvalidIndex);
    mesh_.flags.append(3, 0);
    uv_.insert(uv_.end(), { ua, ub, uc });
    return h;
  }

  void glue(Index h, Index g, std::uint8_t flags)
  {
    mesh_.twin.edit()[h] = g;
    mesh_.flags.edit()[h] = flags;
    if (g != kInvalidIndex)
    {
      mesh_.twin.edit()[g] = h;
      mesh_.flags.edit()[g] = flags;
    }
  }

  /// Face (a, b, c) of h = a -> b becomes (a, m, c), and a new face (m, b, c). Returns m -> b.
  Index cutHalf(Index h, Index m, FixedVec2 p)
  {
    const Index b = Mesh::next(h), c = Mesh::previous(h);
    const Index upper = addFace(m, mesh_.origin[b], mesh_.origin[c], p, uv_[b], uv_[c]);
    mesh_.flags.edit()[upper] = mesh_.flags[h];
    glue(upper + 1, mesh_.twin[b], mesh_.flags[b]);
    mesh_.origin.edit()[b] = m;
    uv_[b] = p;
    glue(b, upper + 2, 0);
    return upper;
  }

  /// folded: the two images may be of length zero, then the rotation is 0.
  Transition transition(Index h, bool folded = false) const
  {
    const Index g = mesh_.twin[h];
    if (g == kInvalidIndex)
    {
      return {};
    }
    const FixedVec2 mine = uv_[Mesh::next(h)] - uv_[h];
    for (int r = 0; r < 4; ++r)
    {
      if (rotate(mine, r) == uv_[g] - uv_[Mesh::next(g)])
      {
        return { r, uv_[Mesh::next(g)] - rotate(uv_[h], r) };
      }
    }
    if (!folded)
    {
      throw std::logic_error("test map is not seamless");
    }
    return {};
  }

  static std::int64_t snap(Random& random, std::int64_t x)
  {
    const int kind = pick(random, 3);
    const std::int64_t unit = kind == 0 ? kOne : kind == 1 ? kOne / 2 : 1;
    return (x + unit / 2) & ~(unit - 1);
  }

  FixedVec2 randomInside(Random& random, Index h) const
  {
    const FixedVec2 a = uv_[h], b = uv_[Mesh::next(h)], c = uv_[Mesh::previous(h)];
    const int wa = 1 + pick(random, 100), wb = 1 + pick(random, 100), wc = 1 + pick(random, 100);
    const int w = wa + wb + wc;
    return { snap(random, (a.u * wa + b.u * wb + c.u * wc) / w),
      snap(random, (a.v * wa + b.v * wb + c.v * wc) / w) };
  }

  FixedVec2 randomOnEdge(Random& random, Index h) const
  {
    const FixedVec2 a = uv_[h], b = uv_[Mesh::next(h)];
    const int t = 1 + pick(random, 99);
    return { snap(random, a.u + (b.u - a.u) / 100 * t), snap(random, a.v + (b.v - a.v) / 100 * t) };
  }

  static FixedVec2 randomDelta(Random& random, std::int64_t parts)
  {
    const auto coordinate = [&]()
    { return (kOne / parts) / 100 * (pick(random, 201) - 100) + pick(random, 3) - 1; };
    return pick(random, 4) == 0 ? FixedVec2{ kOne * (pick(random, 3) - 1), 0 }
                                : FixedVec2{ coordinate(), coordinate() };
  }

  Mesh& mesh_;
  std::vector<FixedVec2>& uv_;
};

/// Two square plates glued along their rims: four vertices of valence 2. chi 2.
inline Mesh pillow(int n)
{
  LatticeBuilder builder;
  for (const int side : { 1, -1 })
  {
    const auto point = [&](int i, int j)
    { return builder.point(i, j, i % n == 0 || j % n == 0 ? 0 : side); };
    for (int i = 0; i < n; ++i)
    {
      for (int j = 0; j < n; ++j)
      {
        const Index a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1),
                    d = point(i, j + 1);
        if ((i == n - 1 && j == 0) || (i == 0 && j == n - 1))
        {
          // No diagonal between points of the rim: both sides would share it.
          side > 0 ? builder.quad(b, c, d, a) : builder.quad(d, c, b, a);
        }
        else
        {
          side > 0 ? builder.quad(a, b, c, d) : builder.quad(a, d, c, b);
        }
      }
    }
  }
  return makeMesh(std::move(builder.points), builder.triangles);
}

/// Three voxels on the axes round one at the origin: a vertex of valence 6, others of 5 and 3.
inline Mesh tripod(int n)
{
  return voxelSurface({ 2, 2, 2 }, n, [](int x, int y, int z) { return x + y + z <= 1; });
}

/// A plane of 2 n x 2 m lattice cells in one chart, one quad for 2 x 2 cells, whose map was thrown
/// about (all determinants stay positive): badly shaped quads on a flat surface.
inline GridMapCase crumpledPlane(int n, int m, unsigned seed, int moves = 4000)
{
  GridMapCase c = squares("plane", gridPlane(2 * n, 2 * m), 1);
  for (Index h = 0; h < c.mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = c.mesh.position[c.mesh.origin[h]];
    c.uv[h] = toFixed(Vector2(p.x() / 2, p.y() / 2));
  }
  c.quads = static_cast<std::size_t>(n * m);
  Random random(seed);
  MapEditor editor(c);
  for (int i = 0; i < moves; ++i)
  {
    const Index h = static_cast<Index>(pick(random, static_cast<int>(c.mesh.halfEdgeCount())));
    const auto part = [&]() { return kOne / 200 * (pick(random, 101) - 50); };
    editor.moveVertex(h, { part(), part() }, false);
  }
  return c;
}

inline std::vector<GridMapCase> allCases(int k)
{
  const double sharp = 0.7;
  std::vector<GridMapCase> cases;
  cases.push_back(squares("plane", gridPlane(5, 3), k));
  cases.push_back(squares("plate with hole", plateWithHole(2), k));
  cases.push_back(squares("plate L", plateL(2), k));
  cases.push_back(squares("torus", torus(5, 4), k));
  cases.push_back(squares("cylinder", openCylinder(5, 3), k));
  cases.push_back(squares("cube", unitCube(2), k));
  cases.push_back(squares("cube with features", markFeatures(unitCube(2), sharp), k));
  cases.push_back(squares("tripod", markFeatures(tripod(1), sharp), k));
  cases.push_back(squares("tripod without features", tripod(2), k));
  cases.push_back(squares("double torus", markFeatures(doubleTorus(1), sharp), k));
  cases.push_back(squares("square torus", squareTorus(1), k));
  cases.push_back(squares("pillow", pillow(2), k));
  cases.push_back(
    squares("two components", disjointUnion(unitCube(1), plateWithHole(1), Vector3(3, 0, 0)), k));
  return cases;
}

} // namespace quadrille::test

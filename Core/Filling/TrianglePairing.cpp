// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/TrianglePairing.h"

#include "Mesh/SurfaceEdit.h"

#include <algorithm>
#include <cassert>
#include <set>
#include <tuple>
#include <utility>

namespace quadrille
{

namespace
{

/// What a flip on a path costs, in units of the scaled Jacobians that a path makes worse.
constexpr double kFlipCost = 0.25;

class TrianglePairing
{
public:
  explicit TrianglePairing(FaceTriangles& triangles)
    : triangles_(triangles), mate_(mesh().faceCount(), kInvalidIndex)
  {
  }

  std::vector<std::array<Index, 4>> run()
  {
    pairGreedily();
    for (Index f = 0; f < mesh().faceCount(); ++f)
    {
      if (isLeftOver(f))
      {
        pairAlong(pathFrom(f));
      }
    }
    return quads();
  }

private:
  using Quad = std::array<Index, 4>;

  /// How a cell, a quad or the triangle at the end, is entered on a path.
  struct Entry
  {
    double cost = 0;
    Index halfEdge = kInvalidIndex; ///< of the cell
    Index apex = kInvalidIndex;     ///< of the triangle that enters, across the half-edge
    Index from = kInvalidIndex;     ///< the cell before; none for the first triangle's neighbours
  };

  const Mesh& mesh() const { return triangles_.surface.mesh; }
  bool isLeftOver(Index f) const
  {
    return mesh().origin[3 * f] != kInvalidIndex && mate_[f] == kInvalidIndex;
  }
  Index cellOf(Index f) const { return std::min(f, mate_[f]); }
  Index opposite(Index h) const { return mesh().origin[Mesh::previous(h)]; }

  /// Of the two triangles at an inner edge.
  Quad quadAt(Index h) const
  {
    return { mesh().origin[h], opposite(mesh().twin[h]), mesh().target(h), opposite(h) };
  }

  double shapeOf(const Quad& quad) const
  {
    std::array<Vector3, 4> corners;
    Vector3 normal = Vector3::Zero();
    for (std::size_t i = 0; i < 4; ++i)
    {
      corners[i] = mesh().position[quad[i]];
      normal += triangles_.normals[quad[i]];
    }
    return quadShape(corners, normal);
  }

  void pair(Index f, Index g)
  {
    mate_[f] = g;
    mate_[g] = f;
  }

  void pairGreedily()
  {
    std::vector<std::pair<double, Index>> candidates;
    for (Index h = 0; h < mesh().halfEdgeCount(); ++h)
    {
      if (mesh().origin[h] != kInvalidIndex && !mesh().isBoundary(h) && h < mesh().twin[h])
      {
        candidates.emplace_back(-shapeOf(quadAt(h)), h);
      }
    }
    std::sort(candidates.begin(), candidates.end());
    for (const auto& [shape, h] : candidates)
    {
      const Index f = Mesh::face(h), g = Mesh::face(mesh().twin[h]);
      if (shape < 0 && isLeftOver(f) && isLeftOver(g))
      {
        pair(f, g);
      }
    }
  }

  /// The half-edges by which the cells of the cheapest path to another left over triangle are entered; the last one is
  /// of that triangle.
  std::vector<Index> pathFrom(Index start) const
  {
    std::vector<Entry> best(mesh().faceCount());
    std::vector<std::uint8_t> done(mesh().faceCount(), 0);
    std::set<std::tuple<double, Index>> queue;
    const auto enter = [&](Index exit, Index apex, double cost, Index from)
    {
      if (mesh().isBoundary(exit))
      {
        return;
      }
      const Index entry = mesh().twin[exit];
      const Index cell = cellOf(Mesh::face(entry));
      if (done[cell] == 0 && (best[cell].halfEdge == kInvalidIndex || cost < best[cell].cost))
      {
        queue.erase({ best[cell].cost, cell });
        best[cell] = { cost, entry, apex, from };
        queue.insert({ cost, cell });
      }
    };
    done[start] = 1;
    for (Index h = 3 * start; h < 3 * start + 3; ++h)
    {
      enter(h, opposite(h), 0, kInvalidIndex);
    }
    Index cell = kInvalidIndex;
    while (!queue.empty())
    {
      cell = std::get<1>(*queue.begin());
      queue.erase(queue.begin());
      done[cell] = 1;
      if (isLeftOver(cell))
      {
        break;
      }
      cross(best[cell], cell, enter);
    }
    assert(cell != kInvalidIndex && isLeftOver(cell));
    std::vector<Index> path;
    for (; cell != kInvalidIndex; cell = best[cell].from)
    {
      path.push_back(best[cell].halfEdge);
    }
    std::reverse(path.begin(), path.end());
    return path;
  }

  /// The pentagon of a triangle and a quad that it enters:
  ///
  ///        k-----d      The triangle is (j, i, a), the quad's half that it enters (i, j, k). The
  ///       / \   /       other half has the point d and is on the edge jk as here, or on ki.
  ///      /   \ /
  ///     i-----j
  ///      \   /
  ///        a
  struct Pentagon
  {
    Index i, j, k, a, d;
    Index inner;           ///< of the half-edges jk and ki the one between the quad's halves
    Index own;             ///< the other one, by which the path may leave the half that it enters
    Quad quadOfA, quadOfD; ///< that are left where that edge's triangle gets the point a, or d
  };

  Pentagon pentagonAt(Index entry, Index a) const
  {
    Pentagon p{};
    p.i = mesh().origin[entry];
    p.j = mesh().target(entry);
    p.k = opposite(entry);
    p.a = a;
    const Index next = Mesh::next(entry), previous = Mesh::previous(entry);
    const bool isAtNext =
      !mesh().isBoundary(next) && Mesh::face(mesh().twin[next]) == mate_[Mesh::face(entry)];
    p.inner = isAtNext ? next : previous;
    p.own = isAtNext ? previous : next;
    p.d = opposite(mesh().twin[p.inner]);
    p.quadOfA = isAtNext ? Quad{ a, p.j, p.d, p.k } : Quad{ a, p.k, p.d, p.i };
    p.quadOfD = isAtNext ? Quad{ p.i, a, p.j, p.d } : Quad{ p.d, p.i, a, p.j };
    return p;
  }

  template <typename Enter>
  void cross(const Entry& entry, Index cell, const Enter& enter) const
  {
    const Pentagon p = pentagonAt(entry.halfEdge, entry.apex);
    const double straight = entry.cost + 1 - shapeOf({ p.i, p.a, p.j, p.k });
    const Index beyond = mesh().twin[p.inner];
    for (const Index exit : { Mesh::next(beyond), Mesh::previous(beyond) })
    {
      enter(exit, opposite(exit), straight, cell);
    }
    const double withA = shapeOf(p.quadOfA), withD = shapeOf(p.quadOfD);
    enter(
      p.own, withA >= withD ? p.a : p.d, entry.cost + kFlipCost + 1 - std::max(withA, withD), cell);
  }

  void pairAlong(const std::vector<Index>& path)
  {
    for (std::size_t step = 0; step + 1 < path.size(); ++step)
    {
      crossQuad(path[step], path[step + 1]);
    }
    pair(Mesh::face(mesh().twin[path.back()]), Mesh::face(path.back()));
  }

  /// The triangle across `entry` enters that quad; what is left over then has the edge of `onwards`.
  void crossQuad(Index entry, Index onwards)
  {
    const Index triangle = Mesh::face(mesh().twin[entry]), half = Mesh::face(entry),
                other = mate_[half];
    if (Mesh::face(mesh().twin[onwards]) == other)
    {
      pair(triangle, half);
      mate_[other] = kInvalidIndex;
      return;
    }
    const Pentagon p = pentagonAt(entry, opposite(mesh().twin[entry]));
    const bool mayA = mayFlip(mesh(), entry), mayD = mayFlip(mesh(), p.inner);
    if (mayA && (!mayD || shapeOf(p.quadOfA) >= shapeOf(p.quadOfD)))
    {
      flipEdge(triangles_.surface.mesh, entry);
      pairRest(triangle, half, other, onwards);
    }
    else if (mayD)
    {
      flipEdge(triangles_.surface.mesh, p.inner);
      pairRest(half, other, triangle, onwards);
    }
    else
    {
      splitAndPair(entry, other, onwards);
    }
  }

  /// Of two triangles, the one without the edge of `onwards` is paired with a third.
  void pairRest(Index first, Index second, Index third, Index onwards)
  {
    const Index left = Mesh::face(mesh().twin[onwards]);
    pair(left == first ? second : first, third);
    mate_[left] = kInvalidIndex;
  }

  /// Where no flip is possible, as the edge that it would make is there already.
  void splitAndPair(Index entry, Index other, Index onwards)
  {
    const Index triangle = Mesh::face(mesh().twin[entry]), half = Mesh::face(entry);
    const Index i = mesh().origin[entry], j = mesh().target(entry);
    splitEdge(triangles_.surface, entry);
    triangles_.normals.push_back((triangles_.normals[i] + triangles_.normals[j]).normalized());
    mate_.resize(mesh().faceCount(), kInvalidIndex);
    const Index otherHalf = mesh().faceCount() - 2, otherTriangle = mesh().faceCount() - 1;
    pair(triangle, otherTriangle);
    pairRest(half, otherHalf, other, onwards);
  }

  std::vector<Quad> quads() const
  {
    std::vector<Quad> result;
    for (Index h = 0; h < mesh().halfEdgeCount(); ++h)
    {
      const Index f = Mesh::face(h);
      if (mesh().origin[h] != kInvalidIndex && !mesh().isBoundary(h) && f < mate_[f] &&
        Mesh::face(mesh().twin[h]) == mate_[f])
      {
        result.push_back(quadAt(h));
      }
    }
    return result;
  }

  FaceTriangles& triangles_;
  std::vector<Index> mate_; ///< per face: the other one of its quad; none for one that is left over
};

} // namespace

std::vector<std::array<Index, 4>> pairTriangles(FaceTriangles& triangles)
{
  return TrianglePairing(triangles).run();
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/QuadLayout.h"

#include "Base/DisjointSets.h"
#include "Base/Error.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Mesh/Requests.h"
#include "Quads/QuadTopology.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace quadrille
{
namespace
{

/// Bits per half-edge; both half-edges of an edge have the same.
enum EdgeMark : std::uint8_t
{
  kFeature = 1,
  kWall = 2, ///< between patches; boundary edges are walls without it
  kSeparatrix = 4
};

/// A fan of quads round a point.
struct Vertex
{
  Index outgoing = kInvalidIndex;    ///< counterclockwise from here are all others that leave it
  Index nextOfPoint = kInvalidIndex; ///< another fan of the same point
  int valence = 0;
  bool onBoundary = false;

  /// The end of separatrices: on the boundary three edges go on straight, and two make a corner.
  bool isIrregular() const { return onBoundary ? valence > 3 : valence != kRegularValence; }
};

class LayoutBuilder
{
public:
  LayoutBuilder(const QuadMesh& mesh, int threads) : mesh_(mesh), marks_(4 * mesh.quads.size(), 0)
  {
    QuadTopology topology = analyzeQuads(mesh.quads, mesh.points.size(), threads);
    if (topology.degenerateQuads > 0)
    {
      throw InvalidInput("the layout needs quads with four different points, these have " +
        topology.text() + ", one of them near " +
        placeText(mesh.points[topology.defectPoints.front()]));
    }
    twin_ = std::move(topology.twin);
  }

  QuadLayout build()
  {
    findVertices();
    markFeatures();
    traceSeparatrices();
    traceFeatures();
    joinPatches();
    measurePatches();
    describeMeshLines();
    return std::move(layout_);
  }

private:
  Index twin(Index h) const { return twin_[h]; }
  bool isBoundary(Index h) const { return twin(h) == kInvalidIndex; }
  bool isWall(Index h) const { return isBoundary(h) || (marks_[h] & kWall) != 0; }
  bool isFeature(Index h) const { return (marks_[h] & kFeature) != 0; }
  const Vertex& vertexAt(Index h) const { return vertices_[vertexOf_[h]]; }
  const Vertex& vertexAhead(Index h) const { return vertexAt(nextInQuad(h)); }
  Index rotateCounterclockwise(Index h) const { return twin(previousInQuad(h)); }

  void mark(Index h, int bits)
  {
    marks_[h] = static_cast<std::uint8_t>(marks_[h] | bits);
    if (!isBoundary(h))
    {
      marks_[twin(h)] = static_cast<std::uint8_t>(marks_[twin(h)] | bits);
    }
  }

  /// One vertex a fan of quads, so that fans which only touch in a point are apart.
  void findVertices()
  {
    vertexOf_.assign(marks_.size(), kInvalidIndex);
    firstVertex_.assign(mesh_.points.size(), kInvalidIndex);
    for (Index h = 0; h < marks_.size(); ++h)
    {
      if (vertexOf_[h] == kInvalidIndex)
      {
        addVertex(h);
      }
    }
  }

  void addVertex(Index h)
  {
    Index first = h;
    while (!isBoundary(first) && nextInQuad(twin(first)) != h)
    {
      first = nextInQuad(twin(first));
    }
    Vertex vertex;
    vertex.onBoundary = isBoundary(first);
    vertex.outgoing = vertex.onBoundary ? first : h;
    vertex.valence = vertex.onBoundary ? 1 : 0;
    vertex.nextOfPoint = firstVertex_[mesh_.origin(h)];
    firstVertex_[mesh_.origin(h)] = static_cast<Index>(vertices_.size());
    forEachOutgoing(vertex,
      [&](Index g)
      {
        vertexOf_[g] = static_cast<Index>(vertices_.size());
        ++vertex.valence;
      });
    vertices_.push_back(vertex);
  }

  /// Counterclockwise. The last edge of a vertex on the boundary has no half-edge that leaves it.
  template <class Visitor>
  void forEachOutgoing(const Vertex& vertex, const Visitor& visit) const
  {
    Index h = vertex.outgoing;
    do
    {
      visit(h);
      h = rotateCounterclockwise(h);
    } while (h != kInvalidIndex && h != vertex.outgoing);
  }

  /// The edge between two points by one of its half-edges; kInvalidIndex where it is none of a quad.
  Index findEdge(Index a, Index b) const
  {
    Index found = kInvalidIndex;
    for (Index v = firstVertex_.at(a); v != kInvalidIndex; v = vertices_[v].nextOfPoint)
    {
      forEachOutgoing(vertices_[v],
        [&](Index h)
        {
          const Index in = previousInQuad(h);
          found = mesh_.target(h) == b ? h : isBoundary(in) && mesh_.origin(in) == b ? in : found;
        });
    }
    return found;
  }

  void markFeatures()
  {
    edgeOfLine_.reserve(mesh_.lines.size());
    for (const QuadLine& line : mesh_.lines)
    {
      const Index h = findEdge(line.a, line.b);
      edgeOfLine_.push_back(h);
      if (h != kInvalidIndex && !isBoundary(h))
      {
        mark(h, kFeature);
      }
    }
  }

  // ------------------------------------------------------------------ straight lines

  /// Does the line go on at the target of an inner half-edge?
  bool goesOn(Index h) const
  {
    const Vertex& vertex = vertexAhead(h);
    return !vertex.onBoundary && vertex.valence == kRegularValence;
  }
  /// The half-edge straight on, where goesOn(h).
  Index straight(Index h) const { return nextInQuad(twin(nextInQuad(h))); }

  void traceSeparatrices()
  {
    for (std::size_t v = 0; v < vertices_.size(); ++v)
    {
      pollNowAndThen(v);
      if (!vertices_[v].isIrregular())
      {
        continue;
      }
      forEachOutgoing(vertices_[v],
        [&](Index h)
        {
          if (!isWall(h))
          {
            trace(h, kWall | kSeparatrix);
          }
        });
    }
  }

  /// What is left of the features: their lines have no irregular end.
  void traceFeatures()
  {
    for (const Index h : edgeOfLine_)
    {
      if (h != kInvalidIndex && !isWall(h))
      {
        Index begin = twin(h); // backwards
        while (goesOn(begin) && straight(begin) != twin(h))
        {
          begin = straight(begin);
        }
        trace(goesOn(begin) ? h : twin(begin), kWall);
      }
    }
  }

  /// Follows the whole line that begins with h, or closes with it, and marks and records it.
  void trace(Index h, int bits)
  {
    path_.clear();
    Index g = h;
    bool closed = false;
    for (;; g = straight(g))
    {
      path_.push_back(g);
      mark(g, bits);
      if (!goesOn(g))
      {
        break;
      }
      if (straight(g) == h)
      {
        closed = true;
        break;
      }
    }
    if (closed)
    {
      rotateToChange();
    }
    record(closed, (bits & kSeparatrix) != 0);
  }

  /// Begins a closed path where it enters or leaves a feature, if it does.
  void rotateToChange()
  {
    const auto differs = [this](Index a, Index b) { return isFeature(a) != isFeature(b); };
    const auto change = std::adjacent_find(path_.begin(), path_.end(), differs);
    if (change != path_.end())
    {
      std::rotate(path_.begin(), change + 1, path_.end());
    }
  }

  static LineEnd endAt(const Vertex& vertex)
  {
    return vertex.isIrregular() ? LineEnd::Irregular
      : vertex.onBoundary       ? LineEnd::Boundary
                                : LineEnd::Feature;
  }

  /// The path in pieces, each on features or on none.
  void record(bool closed, bool separatrix)
  {
    for (std::size_t i = 0; i < path_.size();)
    {
      std::size_t end = i + 1;
      while (end < path_.size() && isFeature(path_[end]) == isFeature(path_[i]))
      {
        ++end;
      }
      LayoutLine line;
      line.first = layout_.linePoints.size();
      line.count = end - i + 1;
      line.feature = isFeature(path_[i]);
      line.separatrix = separatrix;
      layout_.linePoints.push_back(mesh_.origin(path_[i]));
      for (std::size_t k = i; k < end; ++k)
      {
        layout_.linePoints.push_back(mesh_.target(path_[k]));
      }
      const bool loop = closed && line.count == path_.size() + 1;
      line.start = loop ? LineEnd::Closed : endAt(vertexAt(path_[i]));
      line.end = loop ? LineEnd::Closed : endAt(vertexAhead(path_[end - 1]));
      layout_.lines.push_back(line);
      i = end;
    }
  }

  // ------------------------------------------------------------------ patches

  void joinPatches()
  {
    DisjointSets sets(mesh_.quads.size(), 1);
    for (Index h = 0; h < marks_.size(); ++h)
    {
      if (!isWall(h))
      {
        sets.join(h / 4, twin(h) / 4);
      }
    }
    for (Index q = 0; q < mesh_.quads.size(); ++q) // the root is the lowest quad
    {
      const Index root = sets.find(q);
      if (root == q)
      {
        layout_.patches.push_back({ q, {}, {} });
      }
      layout_.patchOf.push_back(
        root == q ? static_cast<Index>(layout_.patches.size() - 1) : layout_.patchOf[root]);
    }
  }

  /// Number of quads that a path across opposite sides meets from side h of its quad on, and whether it comes back to
  /// its beginning before a wall.
  Index countAcross(Index h, bool& closes) const
  {
    Index count = 1;
    Index g = oppositeInQuad(h);
    for (; !isWall(g); g = oppositeInQuad(twin(g)))
    {
      if (twin(g) == h)
      {
        closes = true;
        return count;
      }
      ++count;
    }
    closes = false;
    return count;
  }

  /// Quads from wall to wall through the quad of side h, across h.
  Index countBetweenWalls(Index h, bool& closes) const
  {
    const Index forwards = countAcross(h, closes);
    bool backwards = false;
    return closes ? forwards : forwards + countAcross(oppositeInQuad(h), backwards) - 1;
  }

  void measurePatches()
  {
    std::vector<Index> quads(layout_.patches.size(), 0);
    std::vector<Index> corners(layout_.patches.size(), 0);
    for (Index h = 0; h < marks_.size(); ++h)
    {
      const Index patch = layout_.patchOf[h / 4];
      quads[patch] += h % 4 == 0 ? 1 : 0;
      corners[patch] += isWall(h) && isWall(previousInQuad(h)) ? 1 : 0;
    }
    for (std::size_t i = 0; i < quads.size(); ++i)
    {
      measure(layout_.patches[i], quads[i], corners[i]);
    }
  }

  void measure(LayoutPatch& patch, Index quads, Index corners) const
  {
    const Index h = 4 * patch.firstQuad;
    std::array<bool, 2> closes{};
    // Along side 0, that is across side 1, and across side 0.
    patch.size[0] = countBetweenWalls(h + 1, closes[0]);
    patch.size[1] = countBetweenWalls(h, closes[1]);
    if (closes[0] != closes[1])
    {
      patch.shape = PatchShape::Ring;
      if (closes[1])
      {
        std::swap(patch.size[0], patch.size[1]);
      }
    }
    else if (closes[0])
    {
      patch.shape = PatchShape::Torus;
      patch.size[1] = quads / patch.size[0];
    }
    // Gauss and Bonnet: a patch without irregular vertices inside and without turns other than to the left on its
    // border has four of these or none.
    const Index expected = patch.shape == PatchShape::Rectangle ? 4 : 0;
    if (corners != expected || patch.size[0] * std::size_t{ patch.size[1] } != quads)
    {
      throw std::logic_error("layout: the patch of quad " + std::to_string(patch.firstQuad) +
        " with " + std::to_string(corners) + " corners and " + std::to_string(quads) +
        " quads is no grid");
    }
  }

  void describeMeshLines()
  {
    for (const Index h : edgeOfLine_)
    {
      if (h == kInvalidIndex)
      {
        layout_.patchesOfLine.push_back({ kInvalidIndex, kInvalidIndex });
        layout_.lineOnSeparatrix.push_back(0);
        continue;
      }
      const Index mine = layout_.patchOf[h / 4];
      const Index other = isBoundary(h) ? mine : layout_.patchOf[twin(h) / 4];
      layout_.patchesOfLine.push_back({ std::min(mine, other), std::max(mine, other) });
      layout_.lineOnSeparatrix.push_back((marks_[h] & kSeparatrix) != 0 ? 1 : 0);
    }
  }

  const QuadMesh& mesh_;
  std::vector<Index> twin_;         ///< per half-edge
  std::vector<std::uint8_t> marks_; ///< per half-edge
  std::vector<Index> vertexOf_;     ///< per half-edge, the vertex that it leaves
  std::vector<Vertex> vertices_;
  std::vector<Index> firstVertex_; ///< per point; kInvalidIndex where it has no quad
  std::vector<Index> edgeOfLine_;  ///< per line of the mesh, a half-edge
  std::vector<Index> path_;        ///< half-edges of the line being traced
  QuadLayout layout_;
};

} // namespace

QuadLayout layoutOf(const QuadMesh& mesh, int threads)
{
  return LayoutBuilder(mesh, threads).build();
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/FaceTriangulation.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Mesh/Sizing.h"
#include "Mesh/SurfaceEdit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace quadrille
{

namespace
{

/// Rounds after which triangulations of faces hardly change.
constexpr int kRemeshingRounds = 10;
/// After this round only pins are left of the boundary.
constexpr int kRoundOfPins = 2;
/// Of two triangles that make a quad of edge length 1 on average: equilateral ones have 1.0746.
constexpr double kTriangleEdge = 1.12;
/// Edges between these shares of the wanted length stay [Botsch and Kobbelt 2004].
constexpr double kShort = 4.0 / 5, kLong = 4.0 / 3;
/// A change may make triangles worse than they are down to this shape only (see triangleShape).
constexpr double kSoundTriangle = 0.4;

class FaceRemeshing
{
public:
  FaceRemeshing(const Mesh& face, const FaceGround& ground) : ground_(ground)
  {
    result_.surface.mesh = face;
    result_.surface.sourcePolygon.resize(face.faceCount(), 0);
    result_.surface.sourcePoints.resize(face.faceCount(), std::array<Index, 3>{});
    result_.normals = ground.normals();
    onBoundary_.resize(face.vertexCount(), 0);
    for (Index h = 0; h < face.halfEdgeCount(); ++h)
    {
      onBoundary_[face.origin[h]] |= face.isBoundary(h) ? 1 : 0;
    }
    result_.surface.mesh.sizing = std::vector<float>(ground.sizes().begin(), ground.sizes().end());
  }

  FaceTriangles run()
  {
    for (int round = 0; round < kRemeshingRounds; ++round)
    {
      collapseEdges();
      flipEdges();
      if (round == kRoundOfPins)
      {
        removeOtherBoundaryVertices();
      }
      splitLongEdges();
      flipEdges();
      relax();
    }
    collapseEdges();
    for (int round = 0; round < kRemeshingRounds; ++round)
    {
      flipEdges();
      relax();
    }
    return std::move(result_);
  }

private:
  const Mesh& mesh() const { return result_.surface.mesh; }
  bool isRemoved(Index h) const { return mesh().origin[h] == kInvalidIndex; }
  bool isInner(Index v) const { return onBoundary_[v] == 0; }
  /// Over the wanted length.
  double lengthBetween(Index a, Index b) const
  {
    return (mesh().position[a] - mesh().position[b]).norm() /
      (std::sqrt(sizeAt(mesh(), a) * sizeAt(mesh(), b)) * kTriangleEdge * ground_.edgeLength());
  }
  double lengthOf(Index h) const { return lengthBetween(mesh().origin[h], mesh().target(h)); }

  double shapeOf(Index a, Index b, Index c) const
  {
    return triangleShape({ mesh().position[a], mesh().position[b], mesh().position[c] },
      result_.normals[a] + result_.normals[b] + result_.normals[c]);
  }

  double shapeOfFace(Index f) const
  {
    return shapeOf(mesh().origin[3 * f], mesh().origin[3 * f + 1], mesh().origin[3 * f + 2]);
  }

  double worstShapeAt(Index h) const
  {
    double worst = 1;
    forEachInFan(mesh(), h, [&](Index g) { worst = std::min(worst, shapeOfFace(Mesh::face(g))); });
    return worst;
  }

  static bool isBetter(double after, double before)
  {
    return after >= std::min(kSoundTriangle, before);
  }

  /// May the origin of h go for good, for the sake of where it stands?
  bool isSpare(Index h, const std::vector<std::uint8_t>& isTurnedOver) const
  {
    const Index v = mesh().origin[h];
    return isInner(v) ? lengthOf(h) < kShort || isTurnedOver[v] != 0
                      : !ground_.isPin(v) && mesh().isBoundary(h);
  }

  /// Per vertex: is a face there turned over?
  std::vector<std::uint8_t> findTurnedOver() const
  {
    std::vector<std::uint8_t> result(mesh().vertexCount(), 0);
    for (Index f = 0; f < mesh().faceCount(); ++f)
    {
      if (!isRemoved(3 * f) && shapeOfFace(f) < 0)
      {
        for (Index h = 3 * f; h < 3 * f + 3; ++h)
        {
          result[mesh().origin[h]] = 1;
        }
      }
    }
    return result;
  }

  void collapseEdges()
  {
    bool any = true;
    for (int pass = 0; any && pass < kRemeshingRounds; ++pass)
    {
      const std::vector<std::uint8_t> isTurnedOver = findTurnedOver();
      std::vector<std::pair<double, Index>> spare;
      for (Index h = 0; h < mesh().halfEdgeCount(); ++h)
      {
        if (!isRemoved(h) && isSpare(h, isTurnedOver))
        {
          spare.emplace_back(lengthOf(h), h);
        }
      }
      std::sort(spare.begin(), spare.end());
      any = false;
      for (const auto& [length, h] : spare)
      {
        if (!isRemoved(h) && isSpare(h, isTurnedOver) &&
          isSoundCollapse(h, isTurnedOver[mesh().origin[h]] != 0) && mayCollapse(mesh(), h))
        {
          collapseEdge(result_.surface, h);
          any = true;
        }
      }
    }
  }

  /// Neither long edges nor bad triangles; but at turned over ones, long edges are the lesser evil.
  bool isSoundCollapse(Index h, bool isTurnedOver) const
  {
    const Index v = mesh().origin[h], u = mesh().target(h);
    double longest = 0;
    forEachInFan(
      mesh(), h, [&](Index g) { longest = std::max(longest, lengthBetween(u, mesh().target(g))); });
    if (longest > kLong && isInner(v) && !isTurnedOver)
    {
      return false;
    }
    double before = 1, after = 1;
    forEachInFan(mesh(), h,
      [&](Index g)
      {
        const Index a = mesh().target(g), b = mesh().origin[Mesh::previous(g)];
        before = std::min(before, shapeOf(v, a, b));
        after = a == u || b == u ? after : std::min(after, shapeOf(u, a, b));
      });
    return before < 0 ? after > before : isBetter(after, before);
  }

  /// Whatever becomes of the shapes. What can be in the way of a collapse along the boundary is only a vertex that
  /// both ends have as neighbour without a face between the three, until one of its two edges is split; both are
  /// boundary edges on a loop of three vertices only, and those are pins.
  void removeOtherBoundaryVertices()
  {
    for (bool any = true; any;)
    {
      any = false;
      for (Index h = 0; h < mesh().halfEdgeCount(); ++h)
      {
        if (isRemoved(h) || !mesh().isBoundary(h) || ground_.isPin(mesh().origin[h]))
        {
          continue;
        }
        any = true;
        while (!mayCollapse(mesh(), h))
        {
          splitInTheWay(h);
        }
        collapseEdge(result_.surface, h);
      }
    }
  }

  void splitInTheWay(Index h)
  {
    const Index v = mesh().origin[h], u = mesh().target(h),
                opposite = mesh().origin[Mesh::previous(h)];
    const std::vector<Index> others = neighboursOf(mesh(), Mesh::next(h));
    Index between = kInvalidIndex;
    forEachEdgeInFan(mesh(), h,
      [&](Index g)
      {
        const Index y = mesh().otherEnd(g, v);
        if (y != u && y != opposite && contains(others, y))
        {
          between = mesh().isBoundary(g) ? edgeTo(Mesh::next(h), y) : g;
        }
      });
    assert(between != kInvalidIndex);
    split(between);
  }

  Index edgeTo(Index h, Index y) const
  {
    Index found = kInvalidIndex;
    const Index u = mesh().origin[h];
    forEachEdgeInFan(mesh(), h, [&](Index g) { found = mesh().otherEnd(g, u) == y ? g : found; });
    return found;
  }

  void split(Index h)
  {
    const Index a = mesh().origin[h], b = mesh().target(h);
    splitEdge(result_.surface, h);
    result_.normals.push_back((result_.normals[a] + result_.normals[b]).normalized());
    onBoundary_.push_back(0);
  }

  void splitLongEdges()
  {
    std::vector<std::pair<double, Index>> longest;
    for (Index h = 0; h < mesh().halfEdgeCount(); ++h)
    {
      if (!isRemoved(h) && !mesh().isBoundary(h) && h < mesh().twin[h] && lengthOf(h) > kLong)
      {
        longest.emplace_back(-lengthOf(h), h);
      }
    }
    std::sort(longest.begin(), longest.end());
    for (const auto& [length, h] : longest)
    {
      if (!mesh().isBoundary(h) && lengthOf(h) > kLong) // else it has become another edge
      {
        split(h);
      }
    }
  }

  /// Neighbours that a vertex should have.
  double wantedValence(Index v) const
  {
    return isInner(v) ? 6 : 1 + ground_.angleAt(v) / radians(60);
  }

  void flipEdges()
  {
    std::vector<double> excess(mesh().vertexCount(), 0);
    for (Index h = 0; h < mesh().halfEdgeCount(); ++h)
    {
      if (!isRemoved(h))
      {
        excess[mesh().origin[h]] += 1;
        excess[mesh().target(h)] += mesh().isBoundary(h) ? 1 : 0;
      }
    }
    for (Index v = 0; v < mesh().vertexCount(); ++v)
    {
      excess[v] -= wantedValence(v);
    }
    bool any = true;
    for (int pass = 0; any && pass < kRemeshingRounds; ++pass)
    {
      any = false;
      for (Index h = 0; h < mesh().halfEdgeCount(); ++h)
      {
        if (!isRemoved(h) && !mesh().isBoundary(h) && h < mesh().twin[h] && isGoodFlip(h, excess) &&
          mayFlip(mesh(), h))
        {
          const Index c = mesh().origin[Mesh::previous(h)];
          const Index d = mesh().origin[Mesh::previous(mesh().twin[h])];
          excess[mesh().origin[h]] -= 1;
          excess[mesh().target(h)] -= 1;
          excess[c] += 1;
          excess[d] += 1;
          flipEdge(result_.surface.mesh, h);
          any = true;
        }
      }
    }
  }

  /// Better shapes where they are bad, and elsewhere valences nearer to the wanted ones.
  bool isGoodFlip(Index h, const std::vector<double>& excess) const
  {
    const Index a = mesh().origin[h], b = mesh().target(h);
    const Index c = mesh().origin[Mesh::previous(h)],
                d = mesh().origin[Mesh::previous(mesh().twin[h])];
    const double before = std::min(shapeOf(a, b, c), shapeOf(b, a, d));
    const double after = std::min(shapeOf(a, d, c), shapeOf(b, c, d));
    if (before < kSoundTriangle && after < kSoundTriangle)
    {
      return after > before + 1e-6; // else two flips could take turns
    }
    // Squares of excess - 1 and excess + 1 over those of excess.
    const double gain = 2 * (excess[a] + excess[b] - excess[c] - excess[d]) - 4;
    return after >= kSoundTriangle && (before < kSoundTriangle || gain > 1e-6);
  }

  void relax()
  {
    std::vector<Index> out(mesh().vertexCount(), kInvalidIndex);
    for (Index h = 0; h < mesh().halfEdgeCount(); ++h)
    {
      if (!isRemoved(h) && isInner(mesh().origin[h]))
      {
        out[mesh().origin[h]] = h;
      }
    }
    for (Index v = 0; v < mesh().vertexCount(); ++v)
    {
      if (out[v] != kInvalidIndex)
      {
        relaxVertex(out[v]);
      }
    }
  }

  /// All the way to the mean of its neighbours, or half of it.
  void relaxVertex(Index h)
  {
    const Index v = mesh().origin[h];
    Vector3 sum = Vector3::Zero();
    double count = 0;
    forEachInFan(mesh(), h,
      [&](Index g)
      {
        sum += mesh().position[mesh().target(g)];
        ++count;
      });
    const Vector3 place = mesh().position[v], normal = result_.normals[v];
    if ((sum / count - place).norm() < kLeastMove * ground_.edgeLength() * sizeAt(mesh(), v))
    {
      return;
    }
    const double before = worstShapeAt(h);
    for (const double share : { 1.0, 0.5 })
    {
      const auto spot = ground_.at(place + share * (sum / count - place), normal, place);
      if (!spot)
      {
        continue;
      }
      moveTo(v, spot->point, spot->normal);
      if (isBetter(worstShapeAt(h), before))
      {
        result_.surface.mesh.sizing.edit()[v] = static_cast<float>(spot->size);
        return;
      }
      moveTo(v, place, normal);
    }
  }

  void moveTo(Index v, const Vector3& place, const Vector3& normal)
  {
    result_.surface.mesh.position.edit()[v] = place;
    result_.normals[v] = normal;
  }

  const FaceGround& ground_;
  FaceTriangles result_;
  std::vector<std::uint8_t> onBoundary_; ///< per vertex
};

} // namespace

FaceTriangles triangulateFace(const Mesh& face, const FaceGround& ground)
{
  return FaceRemeshing(face, ground).run();
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Elements/SecondOrder.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Base/TryCount.h"
#include "Elements/QuadraticShape.h"
#include "Elements/SurfaceSection.h"
#include "Mesh/NearestTriangle.h"
#include "Quads/QuadShape.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>

namespace quadrille
{
namespace
{

/// How far a node has moved: 0 not, 1 along the surface, then off it until the straight edge.
using MoveLevel = std::uint8_t;
constexpr MoveLevel kAlong = 1;
constexpr MoveLevel kStraight = 4;
/// What of the way from the surface to the straight edge is left on the levels.
constexpr std::array<double, 5> kLeft{ 1, 1, 0.5, 0.25, 0 };

void checkQuads(const QuadsOnSurface& quads, const SecondOrderOptions& options)
{
  refuseIf(options.nodes != 8 && options.nodes != 9,
    "a quad of second order has 8 or 9 nodes, not ", options.nodes);
  if (quads.places.size() != quads.points.size() ||
    (!quads.featureEdges.empty() && quads.featureEdges.size() != quads.quads.size()))
  {
    refuse("quads of second order: the places or the feature edges do not fit the quads");
  }
  for (std::size_t q = 0; q < quads.quads.size(); ++q)
  {
    for (const Index corner : quads.quads[q])
    {
      refuseIf(corner >= quads.points.size(), "quad ", q, " has the corner ", corner,
        ", but there are ", quads.points.size(), " points");
    }
  }
}

/// The edges of the quads, numbered by their first quad; returns the half-edges of each, 4 quad + side.
Grouped<> findEdges(const QuadsOnSurface& quads, SecondOrderNodes& nodes)
{
  const auto halfEdges = static_cast<Index>(4 * quads.quads.size());
  const auto ends = [&](Index h)
  {
    const std::array<Index, 4>& quad = quads.quads[h / 4];
    return std::array<Index, 2>{ std::min(quad[h % 4], quad[(h + 1) % 4]),
      std::max(quad[h % 4], quad[(h + 1) % 4]) };
  };
  const Grouped<> byLower(quads.points.size(),
    [&](const auto& visit)
    {
      for (Index h = 0; h < halfEdges; ++h)
      {
        visit(ends(h)[0], h);
      }
    });
  nodes.edgesOfQuad.resize(quads.quads.size());
  const auto edgeOf = [&](Index h) -> Index& { return nodes.edgesOfQuad[h / 4][h % 4]; };
  for (Index h = 0; h < halfEdges; ++h)
  {
    const std::array<Index, 2> edge = ends(h);
    const Index first = *std::find_if(
      byLower.begin(edge[0]), byLower.end(edge[0]), [&](Index g) { return ends(g) == edge; });
    if (first == h)
    {
      nodes.edges.push_back(edge);
    }
    edgeOf(h) = first == h ? static_cast<Index>(nodes.edges.size() - 1) : edgeOf(first);
  }
  Grouped<> result(nodes.edges.size(),
    [&](const auto& visit)
    {
      for (Index h = 0; h < halfEdges; ++h)
      {
        visit(edgeOf(h), h);
      }
    });
  for (Index edge = 0; edge < nodes.edges.size(); ++edge)
  {
    nodes.onBoundary.push_back(result.size(edge) == 1);
  }
  return result;
}

//------------------------------------------------------------------------------
/// Nodes by their numbers, edges before centres: where they belong, whatever the surface is there.
class NodeGeometry
{
protected:
  NodeGeometry(const Mesh& surface, const QuadsOnSurface& quads)
    : surface_(surface), quads_(quads), edges_(findEdges(quads, nodes_))
  {
  }

  std::array<Vector3, 4> cornersOfQuad(Index q) const
  {
    return cornersOf(quads_.points, quads_.quads[q]);
  }

  bool isCentre(std::size_t n) const { return n >= nodes_.edges.size(); }
  Index quadOfCentre(std::size_t n) const { return static_cast<Index>(n - nodes_.edges.size()); }

  bool isFeature(Index edge) const
  {
    return !quads_.featureEdges.empty() &&
      std::any_of(edges_.begin(edge), edges_.end(edge),
        [this](Index h) { return (quads_.featureEdges[h / 4] >> h % 4 & 1) != 0; });
  }

  /// Of the straight quads at an edge, or of the quad of a centre.
  Vector3 normalAt(std::size_t n) const
  {
    if (isCentre(n))
    {
      return centreNormal(cornersOfQuad(quadOfCentre(n))).stableNormalized();
    }
    Vector3 sum = Vector3::Zero();
    const auto edge = static_cast<Index>(n);
    for (const Index* h = edges_.begin(edge); h != edges_.end(edge); ++h)
    {
      sum += centreNormal(cornersOfQuad(*h / 4)).stableNormalized();
    }
    return sum;
  }

  /// Where the node is when the element is as straight as its corners and edges let it be.
  Vector3 straightPlace(std::size_t n) const
  {
    if (!isCentre(n))
    {
      const auto [a, b] = nodes_.edges[n];
      return quads_.points[a] + (quads_.points[b] - quads_.points[a]) / 2;
    }
    const Index q = quadOfCentre(n);
    Vector3 place = Vector3::Zero();
    for (std::size_t i = 0; i < 4; ++i)
    {
      place += nodes_.points[nodes_.edgesOfQuad[q][i]] / 2 - quads_.points[quads_.quads[q][i]] / 4;
    }
    return place;
  }

  /// How far from its straight place a node may lie, but on a curve: as on a half circle over the edge, and a little
  /// more for rounding. What is farther, as behind a wall that the straight edge goes through, would be a spike.
  double reachOf(std::size_t n) const
  {
    constexpr double kHalfCircle = 0.51;
    const auto length = [this](Index edge) {
      return (quads_.points[nodes_.edges[edge][1]] - quads_.points[nodes_.edges[edge][0]]).norm();
    };
    if (!isCentre(n))
    {
      return kHalfCircle * length(static_cast<Index>(n));
    }
    double least = kInfinity;
    for (const Index edge : nodes_.edgesOfQuad[quadOfCentre(n)])
    {
      least = std::min(least, length(edge));
    }
    return kHalfCircle * least;
  }

  bool isNear(std::size_t n, const Vector3& p) const
  {
    return (p - straightPlace(n)).norm() <= reachOf(n);
  }

  bool isOnCurve(Index edge) const { return nodes_.onBoundary[edge] != 0 || isFeature(edge); }

  std::optional<CurveChain> chainOf(Index edge) const
  {
    return chainBetween(surface_, quads_.places[nodes_.edges[edge][0]],
      quads_.places[nodes_.edges[edge][1]], nodes_.onBoundary[edge] != 0);
  }

  const Mesh& surface_;
  const QuadsOnSurface& quads_;
  SecondOrderNodes nodes_;
  Grouped<> edges_; ///< half-edges by edge
};

//------------------------------------------------------------------------------
class NodePlacer : NodeGeometry
{
public:
  NodePlacer(const Mesh& surface, const QuadsOnSurface& quads, const SecondOrderOptions& options)
    : NodeGeometry(surface, quads), options_(options)
  {
  }

  SecondOrderNodes run()
  {
    const std::size_t edges = nodes_.edges.size();
    const std::size_t all = edges + (options_.nodes == 9 ? quads_.quads.size() : 0);
    nodes_.points.resize(all);
    nodes_.places.resize(all);
    nodes_.kinds.assign(all, NodePlace::Surface);
    levels_.assign(all, 0);
    fates_.assign(all, Fate::Found);
    report(options_.progress, 0, "nodes between corners");
    place(0, edges);
    report(options_.progress, 0.5, "determinants");
    straighten();
    if (options_.nodes == 9)
    {
      // Between nodes that do not fold the element, as far as they alone can.
      count_ = 9;
      shape_ = QuadraticShape(9);
      report(options_.progress, 0.7, "nodes in centres");
      place(edges, all);
      report(options_.progress, 0.9, "determinants");
      straighten();
    }
    tell();
    return std::move(nodes_);
  }

private:
  enum class Fate : std::uint8_t
  {
    Found,
    WithoutCurve, ///< found, but not on the curve of its edge
    Nowhere,      ///< no way leads there
    WithoutCurveOrWay
  };

  void place(std::size_t first, std::size_t last)
  {
    parallelFor(last - first, kHeavyChunk, options_.threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t n = first + begin; n < first + end; ++n)
        {
          isCentre(n) ? placeCentre(n) : placeMiddle(static_cast<Index>(n));
        }
      });
    placeNearest(first, last);
  }

  void placeMiddle(Index edge)
  {
    const SurfacePoint& from = quads_.places[nodes_.edges[edge][0]];
    const SurfacePoint& to = quads_.places[nodes_.edges[edge][1]];
    if (from.face == kInvalidIndex || to.face == kInvalidIndex)
    {
      fates_[edge] = Fate::Nowhere;
      return;
    }
    const bool isCurve = isOnCurve(edge);
    if (isCurve)
    {
      if (const auto chain = chainOf(edge))
      {
        put(edge, chain->middle(surface_).onSurface());
        return;
      }
      fates_[edge] = Fate::WithoutCurve;
    }
    const auto middle = middleOnSection(surface_, from, to, normalAt(edge));
    if (middle && isNear(edge, positionOf(surface_, *middle)))
    {
      put(edge, *middle);
      return;
    }
    fates_[edge] = isCurve ? Fate::WithoutCurveOrWay : Fate::Nowhere;
  }

  /// Of the two pairs of opposite edges that one is joined which is the shorter way.
  void placeCentre(std::size_t n)
  {
    const std::array<Index, 4>& e = nodes_.edgesOfQuad[quadOfCentre(n)];
    const double first = (nodes_.points[e[2]] - nodes_.points[e[0]]).squaredNorm();
    const double second = (nodes_.points[e[3]] - nodes_.points[e[1]]).squaredNorm();
    const std::size_t k = first <= second ? 0 : 1;
    for (const std::size_t i : { k, 1 - k })
    {
      const SurfacePoint& from = nodes_.places[e[i]];
      const SurfacePoint& to = nodes_.places[e[i + 2]];
      if (from.face == kInvalidIndex || to.face == kInvalidIndex)
      {
        continue;
      }
      countTry(Try::CentreOtherwise, i == k ? 0 : 1);
      const auto middle = middleOnSection(surface_, from, to, normalAt(n));
      if (middle && isNear(n, positionOf(surface_, *middle)))
      {
        countTryLed(Try::CentreOtherwise, i == k ? 0 : 1);
        put(n, *middle);
        return;
      }
    }
    fates_[n] = Fate::Nowhere;
  }

  void put(std::size_t n, const SurfacePoint& place)
  {
    nodes_.places[n] = place;
    nodes_.points[n] = positionOf(surface_, place);
  }

  bool isLost(std::size_t n) const
  {
    return fates_[n] == Fate::Nowhere || fates_[n] == Fate::WithoutCurveOrWay;
  }

  /// The nodes that no way leads to. The tree is made only where there are some.
  void placeNearest(std::size_t first, std::size_t last)
  {
    std::vector<Index> lost = idsWhere(last, [&](Index n) { return n >= first && isLost(n); });
    if (lost.empty())
    {
      return;
    }
    if (!tree_)
    {
      tree_ = std::make_unique<NearestTriangle>(trianglesOf(surface_));
    }
    countTry(Try::CentreOtherwise, lost.size());
    parallelForEach(lost.size(), kHeavyChunk, options_.threads,
      [&](std::size_t i)
      {
        const Vector3 wanted = straightPlace(lost[i]);
        if (const auto near = tree_->at(wanted, normalAt(lost[i]), reachOf(lost[i])))
        {
          countTryLed(Try::CentreOtherwise);
          put(lost[i], { near->triangle, near->weights });
        }
        else
        {
          nodes_.points[lost[i]] = wanted;
          nodes_.kinds[lost[i]] = NodePlace::MovedOff;
          levels_[lost[i]] = kStraight;
        }
      });
  }

  //----------------------------------------------------------------------------
  QuadraticNodes nodesOf(Index q) const
  {
    QuadraticNodes x{};
    for (std::size_t i = 0; i < 4; ++i)
    {
      x[i] = quads_.points[quads_.quads[q][i]];
      x[4 + i] = nodes_.points[nodes_.edgesOfQuad[q][i]];
    }
    x[8] = count_ == 9 ? nodes_.points[nodes_.edges.size() + q] : x[0];
    return x;
  }

  /// What a determinant must be above: so far from zero that rounding, also of others who compute it, does not matter,
  /// but never more than the straight element can have.
  double leastWanted(Index q) const
  {
    const std::array<Vector3, 4> p = cornersOfQuad(q);
    const Vector3 area = centreNormal(p);
    double least = kRoundingOfSingle * area.norm() / 16; // of the straight element at its centre
    const Vector3 normal = area.stableNormalized();
    for (std::size_t i = 0; i < 4; ++i)
    {
      const double corner = normal.dot((p[i] - p[(i + 3) % 4]).cross(p[(i + 1) % 4] - p[i])) / 4;
      least = std::min(least, corner / 2);
    }
    return least;
  }

  bool isFolded(Index q) const { return !(shape_.leastDeterminant(nodesOf(q)) > leastWanted(q)); }

  /// The node at another level. MoveLevel 1 is looked for anew each time, as few nodes need it.
  std::pair<Vector3, SurfacePoint> nodeAt(std::size_t n, MoveLevel level) const
  {
    const Vector3 straight = straightPlace(n);
    if (nodes_.places[n].face == kInvalidIndex)
    {
      return { straight, nodes_.places[n] };
    }
    const SurfacePoint foot = levels_[n] >= kAlong ? nodes_.places[n] : footOf(n, straight);
    const Vector3 onSurface = positionOf(surface_, foot);
    return { kLeft[level] == 1 ? onSurface
                               : Vector3(straight + kLeft[level] * (onSurface - straight)),
      foot };
  }

  SurfacePoint footOf(std::size_t n, const Vector3& straight) const
  {
    if (!isCentre(n) && isOnCurve(static_cast<Index>(n)))
    {
      const auto chain = chainOf(static_cast<Index>(n));
      return chain ? chain->nearest(surface_, straight).onSurface() : nodes_.places[n];
    }
    return approach(surface_, nodes_.places[n], straight);
  }

  struct NodeMove
  {
    std::size_t node = 0;
    MoveLevel level = 0;
  };

  /// The least move of one node that makes element q good, else the one that does most for it. None where all edges are
  /// straight.
  std::optional<NodeMove> wishOf(Index q) const
  {
    const double wanted = leastWanted(q);
    std::optional<NodeMove> best;
    double most = -kInfinity;
    for (MoveLevel level = kAlong; level <= kStraight; ++level)
    {
      for (std::size_t slot = 4; slot < count_; ++slot)
      {
        const std::size_t n = slot < 8 ? nodes_.edgesOfQuad[q][slot - 4] : nodes_.edges.size() + q;
        if (levels_[n] >= level)
        {
          continue;
        }
        QuadraticNodes x = nodesOf(q);
        x[slot] = nodeAt(n, level).first;
        if (slot < 8)
        {
          followWithCentre(q, x);
        }
        const double least = shape_.leastDeterminant(x);
        if (least > most || !best)
        {
          most = least;
          best = NodeMove{ n, level };
        }
      }
      if (most > wanted)
      {
        break;
      }
    }
    return best;
  }

  /// A centre off the surface follows the edges of its quad, also where these are only tried.
  void followWithCentre(Index q, QuadraticNodes& x) const
  {
    const std::size_t n = nodes_.edges.size() + q;
    if (count_ != 9 || levels_[n] <= kAlong)
    {
      return;
    }
    const Vector3 straight = (x[4] + x[5] + x[6] + x[7]) / 2 - (x[0] + x[1] + x[2] + x[3]) / 4;
    x[8] = nodes_.places[n].face == kInvalidIndex
      ? straight
      : Vector3(straight + kLeft[levels_[n]] * (positionOf(surface_, nodes_.places[n]) - straight));
  }

  /// Rounds of moves, each of which only raises levels, so that they end. With all edges straight the element is that
  /// of its corners, whose determinant is positive where it is so at the corners.
  void straighten()
  {
    std::vector<Index> check = idsWhere(quads_.quads.size(), [](Index) { return true; });
    while (!check.empty())
    {
      const std::vector<Index> folded = foldedOf(check);
      check = move(folded);
    }
  }

  std::vector<Index> foldedOf(const std::vector<Index>& check)
  {
    std::vector<std::uint8_t> isBad(check.size(), 0);
    parallelForEach(check.size(), kHeavyChunk, options_.threads,
      [&](std::size_t i) {
        isBad[i] = isInverted(cornersOfQuad(check[i])) ? 2 : isFolded(check[i]) ? 1 : 0;
      });
    std::vector<Index> folded;
    for (std::size_t i = 0; i < check.size(); ++i)
    {
      if (isBad[i] == 1)
      {
        folded.push_back(check[i]);
      }
      else if (isBad[i] == 2)
      {
        nodes_.invertedQuads.push_back(check[i]);
      }
    }
    return folded;
  }

  /// Moves one node of each of the elements. Returns the elements that have to be looked at again, ascending.
  std::vector<Index> move(const std::vector<Index>& folded)
  {
    std::vector<std::optional<NodeMove>> wishes(folded.size());
    parallelForEach(
      folded.size(), 1, options_.threads, [&](std::size_t i) { wishes[i] = wishOf(folded[i]); });
    std::vector<Index> again;
    for (const std::optional<NodeMove>& wish : wishes)
    {
      if (!wish || levels_[wish->node] >= wish->level)
      {
        continue; // another element has moved it as far
      }
      const std::size_t n = wish->node;
      // A node that is moved again has led once.
      countTry(Try::NodeFurther);
      countTryLed(Try::NodeFurther, levels_[n] == 0 ? 1 : 0);
      std::tie(nodes_.points[n], nodes_.places[n]) = nodeAt(n, wish->level);
      levels_[n] = wish->level;
      nodes_.kinds[n] = wish->level == kAlong ? NodePlace::MovedAlong : NodePlace::MovedOff;
      const auto look = [&](Index q)
      {
        again.push_back(q);
        straightenCentre(q);
      };
      if (isCentre(n))
      {
        look(quadOfCentre(n));
        continue;
      }
      for (const Index* h = edges_.begin(static_cast<Index>(n));
           h != edges_.end(static_cast<Index>(n)); ++h)
      {
        look(*h / 4);
      }
    }
    sortUnique(again);
    return again;
  }

  /// A centre off the surface follows the edges of its quad.
  void straightenCentre(Index q)
  {
    const std::size_t n = nodes_.edges.size() + q;
    if (count_ == 9 && levels_[n] > kAlong)
    {
      nodes_.points[n] = nodeAt(n, levels_[n]).first;
    }
  }

  void tell()
  {
    nodes_.withoutCurve = idsWhere(fates_.size(),
      [this](Index n)
      { return fates_[n] == Fate::WithoutCurve || fates_[n] == Fate::WithoutCurveOrWay; });
    nodes_.byNearest = idsWhere(fates_.size(), [this](Index n) { return isLost(n); });
    sortUnique(nodes_.invertedQuads);
  }

  const SecondOrderOptions& options_;
  std::size_t count_ = 8; ///< nodes of an element that are placed
  QuadraticShape shape_{ 8 };
  std::vector<MoveLevel> levels_; ///< per node
  std::vector<Fate> fates_;       ///< per node
  std::unique_ptr<NearestTriangle> tree_;
};

} // namespace

SecondOrderNodes placeSecondOrderNodes(
  const Mesh& surface, const QuadsOnSurface& quads, const SecondOrderOptions& options)
{
  checkQuads(quads, options);
  return NodePlacer(surface, quads, options).run();
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/BoundaryFit.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Mesh/Topology.h"
#include "Quads/QuadTopology.h"
#include "Quads/StripInsertion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>

namespace quadrille
{
namespace
{

/// Edges at a point of the boundary with two quads.
constexpr int kAlongBoundary = 3;
/// By which the ways of the boundary have come to the points inside.
constexpr int kSweepsOfWays = 50;

/// One loop of the boundary of a face, from a pin on.
struct FaceLoop
{
  std::vector<Vector3> places; ///< of its vertices
  std::vector<double> at;      ///< per vertex, then of the first one again: how far along the loop
  std::vector<Index> pins;     ///< vertices of the face
  std::vector<double> pinAt;

  double length() const { return at.back(); }

  /// Of the nearest segments, all of them where the loop comes back to the same place, how far along it p lies.
  double nearest(const Vector3& p, double within, std::vector<double>& along) const
  {
    double best = kInfinity;
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      const Vector3 &a = places[i], way = places[(i + 1) % places.size()] - a;
      const double square = way.squaredNorm();
      const double t = square > 0 ? std::clamp((p - a).dot(way) / square, 0.0, 1.0) : 0;
      const double there = (a + t * way - p).norm();
      if (there > best + within)
      {
        continue;
      }
      if (there < best - within)
      {
        along.clear();
      }
      best = std::min(best, there);
      along.push_back(at[i] + t * (at[i + 1] - at[i]));
    }
    return best;
  }

  /// From one place on to another; nothing is a whole round.
  double onward(double from, double to, double within) const
  {
    const double way = std::fmod(to - from + length(), length());
    return way < within || length() - way < within ? length() : way;
  }
};

std::vector<FaceLoop> loopsOf(const Mesh& face, const FaceGround& ground)
{
  std::vector<FaceLoop> loops;
  std::vector<std::uint8_t> isDone(face.halfEdgeCount(), 0);
  for (Index first = 0; first < face.halfEdgeCount(); ++first)
  {
    if (!face.isBoundary(first) || isDone[first] != 0 || !ground.isPin(face.origin[first]))
    {
      continue;
    }
    FaceLoop& loop = loops.emplace_back();
    loop.at.push_back(0);
    for (Index h = first; isDone[h] == 0; h = nextOnBoundary(face, h))
    {
      isDone[h] = 1;
      loop.places.push_back(face.position[face.origin[h]]);
      loop.at.push_back(loop.at.back() + face.edgeVector(h).norm());
      if (ground.isPin(face.origin[h]))
      {
        loop.pins.push_back(face.origin[h]);
        loop.pinAt.push_back(*std::prev(loop.at.end(), 2));
      }
    }
  }
  return loops;
}

class BoundaryFit
{
public:
  BoundaryFit(QuadMesh own, const Mesh& face, const FaceGround& ground)
    : mesh_(std::move(own)), face_(face), ground_(ground), loops_(loopsOf(face, ground)),
      within_(kRoundingOfSingle * ground.edgeLength()), anchor_(mesh_.points.size(), kInvalidIndex)
  {
    mesh_.lines.clear();
  }

  std::optional<FaceQuads> make(const std::vector<Index>& pins)
  {
    if (!place() || !fit())
    {
      return std::nullopt;
    }
    return withPins(pins);
  }

private:
  struct Sides
  {
    QuadTopology topology;
    std::vector<std::vector<Index>> loops; ///< half-edges; each from an anchor on where it has some
    /// How many edges lack between two anchors, or all round a loop without any; below zero: so many are too many.
    std::vector<std::ptrdiff_t> sides;
    std::vector<Index> of; ///< per half-edge of the boundary; of other ones kInvalidIndex
  };

  /// Which loop of the face each of the quads' is, and which of their points are pins.
  bool place()
  {
    const QuadTopology topology = analyzeQuads(mesh_.quads, mesh_.points.size());
    const std::vector<std::vector<Index>> loops = boundaryLoops(topology);
    if (!topology.manifold() || loops.size() != loops_.size())
    {
      return false;
    }
    loopOf_.assign(mesh_.points.size(), kInvalidIndex);
    std::vector<std::uint8_t> isTaken(loops_.size(), 0);
    for (const std::vector<Index>& loop : loops)
    {
      double least = kInfinity;
      Index nearest = 0;
      std::vector<std::vector<double>> along;
      for (Index i = 0; i < loops_.size(); ++i)
      {
        double sum = 0;
        std::vector<std::vector<double>> there(loop.size());
        for (std::size_t k = 0; k < loop.size(); ++k)
        {
          sum += loops_[i].nearest(mesh_.points[mesh_.origin(loop[k])], within_, there[k]);
        }
        if (sum < least)
        {
          least = sum;
          nearest = i;
          along = std::move(there);
        }
      }
      if (std::exchange(isTaken[nearest], 1) != 0 ||
        !anchor(loop, topology, loops_[nearest], along))
      {
        return false;
      }
      for (const Index h : loop)
      {
        loopOf_[mesh_.origin(h)] = nearest;
      }
    }
    return true;
  }

  /// Which points of a loop are pins: those in corners, where other than two quads meet. False where they do not go
  /// once round the loop of the face. along: where each may lie, several places where both sides of a slit do.
  bool anchor(const std::vector<Index>& loop, const QuadTopology& topology, const FaceLoop& ofFace,
    const std::vector<std::vector<double>>& along)
  {
    const auto sure = std::find_if(along.begin(), along.end(),
      [](const std::vector<double>& places) { return places.size() == 1; });
    const auto first = static_cast<std::size_t>(sure == along.end() ? 0 : sure - along.begin());
    double at = along[first].front(), round = 0;
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const Index p = mesh_.origin(loop[(first + i) % loop.size()]);
      const bool isCorner = topology.valence[p] != kAlongBoundary;
      for (Index pin = 0; isCorner && pin < ofFace.pins.size(); ++pin)
      {
        if (ofFace.onward(ofFace.pinAt[pin], at, within_) >= ofFace.length())
        {
          anchor_[p] = pin;
        }
      }
      double way = kInfinity;
      for (const double next : along[(first + i + 1) % loop.size()])
      {
        way = std::min(way, ofFace.onward(at, next, within_));
      }
      at = std::fmod(at + way, ofFace.length());
      round += way;
    }
    return std::abs(round - ofFace.length()) < within_ * static_cast<double>(loop.size());
  }

  /// None where the quads are no manifold any more.
  std::optional<Sides> sides() const
  {
    Sides found;
    found.topology = analyzeQuads(mesh_.quads, mesh_.points.size());
    if (found.topology.nonManifoldEdges + found.topology.nonManifoldVertices +
        found.topology.degenerateQuads >
      0)
    {
      return std::nullopt;
    }
    found.loops = boundaryLoops(found.topology);
    found.of.assign(found.topology.twin.size(), kInvalidIndex);
    for (std::vector<Index>& loop : found.loops)
    {
      const auto isAnchored = [&](Index h) { return anchor_[mesh_.origin(h)] != kInvalidIndex; };
      std::rotate(loop.begin(), std::find_if(loop.begin(), loop.end(), isAnchored), loop.end());
      const auto pins =
        static_cast<std::ptrdiff_t>(loops_[loopOf_[mesh_.origin(loop.front())]].pins.size());
      for (std::size_t k = 0; k < loop.size();)
      {
        std::size_t end = k + 1;
        while (end < loop.size() && !isAnchored(loop[end]))
        {
          ++end;
        }
        const Index from = anchor_[mesh_.origin(loop[k])];
        const Index to = anchor_[mesh_.target(loop[end - 1])];
        const std::ptrdiff_t between = from == to
          ? pins
          : (static_cast<std::ptrdiff_t>(to) - static_cast<std::ptrdiff_t>(from) + pins) % pins;
        for (std::size_t i = k; i < end; ++i)
        {
          found.of[loop[i]] = static_cast<Index>(found.sides.size());
        }
        found.sides.push_back(between - static_cast<std::ptrdiff_t>(end - k));
        k = end;
      }
    }
    return found;
  }

  bool fit()
  {
    // Each strip leaves one or two edges less to be put in or taken out, but for those that take one from a side that
    // has the right number, of which there are no more than there are edges.
    for (std::size_t left = 2 * face_.vertexCount(); left > 0; --left)
    {
      poll();
      const std::optional<Sides> now = sides();
      if (!now)
      {
        return false;
      }
      const auto [least, most] = std::minmax_element(now->sides.begin(), now->sides.end());
      if (*least == 0 && *most == 0)
      {
        return true;
      }
      if (*least < 0 ? !takeOut(*now) : !putIn(*now))
      {
        return false;
      }
    }
    return false;
  }

  /// Mean length of the edges at both ends of a chord.
  double widthOf(const QuadPath& chord) const
  {
    const Index last = oppositeInQuad(chord.back());
    const auto length = [&](Index h)
    { return (mesh_.points[mesh_.target(h)] - mesh_.points[mesh_.origin(h)]).norm(); };
    return (length(chord.front()) + length(last)) / 2;
  }

  /// The narrowest strip that begins at a side with too many edges, and ends at one if there is any.
  bool takeOut(const Sides& now)
  {
    const Grouped<> quadsAt = quadsAtPoints(mesh_.quads, mesh_.points.size());
    std::optional<QuadPath> best;
    std::pair<bool, double> leastCost;
    for (Index h = 0; h < now.of.size(); ++h)
    {
      if (now.of[h] == kInvalidIndex || now.sides[now.of[h]] >= 0)
      {
        continue;
      }
      const std::optional<QuadPath> chord = chordFrom(now.topology.twin, h);
      if (!chord)
      {
        continue;
      }
      const Index other = now.of[oppositeInQuad(chord->back())];
      const std::ptrdiff_t lacks =
        now.sides[other] + (other == now.of[h] ? 1 : 0); // without the first edge
      const std::pair<bool, double> cost(lacks >= 0, widthOf(*chord));
      const bool isLess = !best || cost < leastCost;
      if ((other != now.of[h] || lacks < 0) && isLess && mayGo(*chord, now.topology, quadsAt))
      {
        best = chord;
        leastCost = cost;
      }
    }
    if (best)
    {
      const auto rank = [&](Index p) {
        return anchor_[p] != kInvalidIndex ? 2 : now.topology.onBoundary[p] != 0 ? 1 : 0;
      };
      removeChord(mesh_, *best, rank);
    }
    return best.has_value();
  }

  /// Whether the two sides of a strip may become one: no two anchors, no two points of the boundary over the inside,
  /// none that have a neighbour in common; three quads are left round each point inside, and some quads at all.
  bool mayGo(const QuadPath& chord, const QuadTopology& topology, const Grouped<>& quadsAt) const
  {
    if (chord.size() == mesh_.quads.size())
    {
      return false;
    }
    std::vector<Index> seen;
    for (std::size_t i = 0; i <= chord.size(); ++i)
    {
      const Index rung = i < chord.size() ? chord[i] : oppositeInQuad(chord.back());
      const Index a = mesh_.origin(rung), b = mesh_.target(rung);
      const bool isEnd = i == 0 || i == chord.size();
      const bool isA = topology.onBoundary[a] != 0, isB = topology.onBoundary[b] != 0;
      if ((anchor_[a] != kInvalidIndex && anchor_[b] != kInvalidIndex) || (!isEnd && isA && isB) ||
        (!isA && !isB && topology.valence[a] + topology.valence[b] < 7))
      {
        return false;
      }
      const std::vector<Index> atA = neighbours(a, quadsAt), atB = neighbours(b, quadsAt);
      if (std::any_of(atA.begin(), atA.end(), [&](Index p) { return contains(atB, p); }))
      {
        return false;
      }
      seen.insert(seen.end(), { a, b });
    }
    const std::size_t count = seen.size();
    sortUnique(seen);
    return seen.size() == count;
  }

  std::vector<Index> neighbours(Index p, const Grouped<>& quadsAt) const
  {
    std::vector<Index> others;
    for (const Index* q = quadsAt.begin(p); q != quadsAt.end(p); ++q)
    {
      const std::array<Index, 4>& quad = mesh_.quads[*q];
      const auto i =
        static_cast<std::size_t>(std::find(quad.begin(), quad.end(), p) - quad.begin());
      others.insert(others.end(), { quad[(i + 1) % 4], quad[(i + 3) % 4] });
    }
    sortUnique(others);
    return others;
  }

  /// The widest strip between two sides that lack edges is split; where there is none, one is put in along a path.
  bool putIn(const Sides& now)
  {
    std::optional<QuadPath> best;
    for (Index h = 0; h < now.of.size(); ++h)
    {
      if (now.of[h] == kInvalidIndex || now.sides[now.of[h]] <= 0)
      {
        continue;
      }
      const std::optional<QuadPath> chord = chordFrom(now.topology.twin, h);
      const Index end = chord ? now.of[oppositeInQuad(chord->back())] : kInvalidIndex;
      if (chord && now.sides[end] > (end == now.of[h] ? 1 : 0) &&
        (!best || widthOf(*chord) > widthOf(*best)))
      {
        best = chord;
      }
    }
    if (best)
    {
      split(*best);
    }
    return best || open(now);
  }

  void split(const QuadPath& chord)
  {
    std::vector<Vector3> middles;
    for (std::size_t i = 0; i <= chord.size(); ++i)
    {
      const Index rung = i < chord.size() ? chord[i] : oppositeInQuad(chord.back());
      middles.push_back((mesh_.points[mesh_.origin(rung)] + mesh_.points[mesh_.target(rung)]) / 2);
    }
    const InsertedStrip strip = splitChord(mesh_, chord);
    for (std::size_t i = 0; i < middles.size(); ++i)
    {
      mesh_.points[strip.points[i].second] = middles[i];
    }
    growWith(strip);
  }

  /// From a side that lacks edges to another one, or to itself.
  std::optional<QuadPath> pathFor(const Sides& now) const
  {
    std::vector<Index> sideOf(mesh_.points.size(), kInvalidIndex);
    for (Index h = 0; h < now.of.size(); ++h)
    {
      const Index p = mesh_.origin(h);
      if (now.of[h] != kInvalidIndex && anchor_[p] == kInvalidIndex)
      {
        sideOf[p] = now.of[h];
      }
    }
    std::optional<QuadPath> path;
    for (const bool toItself : { false, true })
    {
      for (Index from = 0; from < now.sides.size() && !path; ++from)
      {
        if (now.sides[from] <= (toItself ? 1 : 0))
        {
          continue;
        }
        std::vector<std::pair<Index, double>> starts;
        for (const Index p : idsWhere(sideOf.size(), [&](Index p) { return sideOf[p] == from; }))
        {
          starts.emplace_back(p, 0);
        }
        path = findStripPath(mesh_, starts,
          [&](Index, Index end) -> std::optional<double>
          {
            const Index to = sideOf[end];
            const bool isLacking = to != kInvalidIndex && now.sides[to] > 0;
            return isLacking && (to == from) == toItself ? std::optional<double>(0) : std::nullopt;
          });
      }
    }
    return path;
  }

  bool open(const Sides& now)
  {
    const std::optional<QuadPath> path = pathFor(now);
    if (!path)
    {
      return false;
    }
    const InsertedStrip strip = insertStrip(mesh_, *path);
    mesh_.lines.clear();
    growWith(strip);
    for (const auto& [p, way] : waysApart(strip, mesh_))
    {
      mesh_.points[p] += way;
    }
    return true;
  }

  void growWith(const InsertedStrip& strip)
  {
    anchor_.resize(mesh_.points.size(), kInvalidIndex);
    loopOf_.resize(mesh_.points.size(), kInvalidIndex);
    for (const auto& [p, copy] : { strip.points.front(), strip.points.back() })
    {
      loopOf_[copy] = loopOf_[p];
    }
  }

  /// The points of the boundary become pins; where a loop has no anchor, those that are nearest all in all.
  FaceQuads withPins(const std::vector<Index>& pins)
  {
    std::vector<Index> ids(face_.vertexCount(), kInvalidIndex);
    FaceQuads result;
    result.pinCount = static_cast<Index>(pins.size());
    for (const Index v : pins)
    {
      ids[v] = static_cast<Index>(result.points.size());
      result.points.push_back(face_.position[v]);
      result.normals.push_back(ground_.normals()[v]);
      result.fitting.push_back(ground_.angleAt(v) / kRightAngle);
    }
    std::vector<Index> own(mesh_.points.size(), kInvalidIndex);
    const std::optional<Sides> now = sides(); // as fit() has left them
    for (const std::vector<Index>& loop : now->loops)
    {
      const Index first = mesh_.origin(loop.front());
      const std::vector<Index>& ofLoop = loops_[loopOf_[first]].pins;
      const std::size_t shift =
        anchor_[first] != kInvalidIndex ? anchor_[first] : nearestShift(loop, ofLoop);
      for (std::size_t k = 0; k < loop.size(); ++k)
      {
        own[mesh_.origin(loop[k])] = ids[ofLoop[(k + shift) % ofLoop.size()]];
      }
    }
    moveInside(own, result.points);
    for (const std::array<Index, 4>& quad : mesh_.quads)
    {
      std::array<Index, 4>& made = result.quads.emplace_back();
      for (std::size_t i = 0; i < 4; ++i)
      {
        Index& id = own[quad[i]];
        if (id == kInvalidIndex)
        {
          const FaceGround::Spot spot =
            *ground_.at(mesh_.points[quad[i]], Vector3::Zero(), mesh_.points[quad[i]]);
          id = static_cast<Index>(result.points.size());
          result.points.push_back(spot.point);
          result.normals.push_back(spot.normal);
          result.fitting.push_back(4);
        }
        made[i] = id;
      }
    }
    return result;
  }

  /// Those inside go along with the boundary, each by the mean of its neighbours' ways. pinOf: per point; pins: their
  /// places.
  void moveInside(const std::vector<Index>& pinOf, const std::vector<Vector3>& pins)
  {
    const Grouped<> quadsAt = quadsAtPoints(mesh_.quads, mesh_.points.size());
    std::vector<std::vector<Index>> beside(mesh_.points.size());
    std::vector<Vector3> way(mesh_.points.size(), Vector3::Zero());
    for (Index p = 0; p < mesh_.points.size(); ++p)
    {
      if (pinOf[p] != kInvalidIndex)
      {
        way[p] = pins[pinOf[p]] - mesh_.points[p];
      }
      else
      {
        beside[p] = neighbours(p, quadsAt);
      }
    }
    for (int sweep = 0; sweep < kSweepsOfWays; ++sweep)
    {
      for (Index p = 0; p < mesh_.points.size(); ++p)
      {
        if (!beside[p].empty())
        {
          way[p] = std::accumulate(beside[p].begin(), beside[p].end(), Vector3(Vector3::Zero()),
                     [&](const Vector3& sum, Index other) { return Vector3(sum + way[other]); }) /
            static_cast<double>(beside[p].size());
        }
      }
    }
    for (Index p = 0; p < mesh_.points.size(); ++p)
    {
      mesh_.points[p] += way[p];
    }
  }

  std::size_t nearestShift(const std::vector<Index>& loop, const std::vector<Index>& pins) const
  {
    std::size_t best = 0;
    double least = kInfinity;
    for (std::size_t shift = 0; shift < pins.size(); ++shift)
    {
      double sum = 0;
      for (std::size_t k = 0; k < loop.size(); ++k)
      {
        const Vector3& pin = face_.position[pins[(k + shift) % pins.size()]];
        sum += (mesh_.points[mesh_.origin(loop[k])] - pin).squaredNorm();
      }
      best = sum < least ? shift : best;
      least = std::min(least, sum);
    }
    return best;
  }

  QuadMesh mesh_;
  const Mesh& face_;
  const FaceGround& ground_;
  std::vector<FaceLoop> loops_;
  double within_;
  std::vector<Index> anchor_; ///< per point: which pin of its loop it is
  std::vector<Index> loopOf_; ///< per point of the boundary
};

} // namespace

std::optional<FaceQuads> fitBoundary(
  QuadMesh own, const Mesh& face, const FaceGround& ground, const std::vector<Index>& pins)
{
  return own.quads.empty() ? std::nullopt : BoundaryFit(std::move(own), face, ground).make(pins);
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Assembly/SheetJoints.h"

#include "Assembly/StripInsertion.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Mesh/Topology.h"
#include "Quads/QuadHalfEdges.h"
#include "Quads/QuadMoves.h"
#include "Quads/QuadShape.h"
#include "Quads/QuadSmoothing.h"
#include "Quads/QuadTopology.h"
#include "Quads/QuadUntangling.h"
#include "Quads/SurfaceWalk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace quadrille
{

namespace
{

constexpr Index kNoJoint = kInvalidIndex;

/// A joint between two nodes, by points of the joint surface.
struct JointSegment
{
  std::vector<Index> points;
  std::vector<double> arc;   ///< from the begin, one a point
  std::size_t edges = 0;     ///< of the quads
  std::vector<double> stops; ///< arc of each point of the quads, edges + 1
};

/// What a sheet's quads have along a segment, or along its own boundary between two nodes.
struct SheetChain
{
  Index segment = kNoJoint;
  bool isForward = true;
  std::vector<Index> points; ///< of the quads, at least one
  std::size_t edges() const { return points.size() - 1; }
};

/// A boundary loop of a sheet, in the order of its boundary; each chain ends where the next one begins.
struct SheetLoop
{
  Index sheet = 0;
  std::vector<SheetChain> chains;
};

/// A boundary loop of the surface: half-edges in order, with what of the input lies there.
struct FineLoop
{
  Index sheet = 0;
  std::vector<Index> halfEdges;
  std::vector<double> arc;       ///< of the origin of each; the length of the loop at the end
  std::vector<Index> jointPoint; ///< at the origin of each, or kNoJoint
};

std::pair<Index, Index> sortedPair(Index a, Index b)
{
  return { std::min(a, b), std::max(a, b) };
}

class SheetMeeting
{
public:
  SheetMeeting(RemeshResult& result, const JointSheets& sheets,
    const std::vector<Vector3>& jointPoints, int smoothingSteps, int threads)
    : result_(result), mesh_(result.surface.mesh), quads_(result.quads), sheets_(sheets),
      jointPoints_(jointPoints), smoothingSteps_(smoothingSteps), threads_(threads)
  {
  }

  MetSheets meet()
  {
    findFineLoops();
    findNodes();
    findSegments();
    findChains();
    if (met_.status.ok())
    {
      chooseNumbers();
    }
    fillSheets();
    if (met_.status.ok())
    {
      placePoints();
      smooth();
    }
    moveBack();
    return std::move(met_);
  }

private:
  Index sheetOfFace(Index f) const { return sheets_.sheetOf[result_.surface.sourcePolygon[f]]; }

  /// The point of the input at a corner of the surface; none where refinement made it.
  Index inputAt(Index corner) const
  {
    const PreparedSurface& surface = result_.surface;
    const Index f = corner / 3;
    if (surface.refinedEntry.empty() || surface.refinedEntry[f] == kInvalidIndex)
    {
      return surface.sourcePoints[f][corner % 3];
    }
    const auto& weights = surface.cornerWeights[surface.refinedEntry[f]][corner % 3];
    for (std::size_t i = 0; i < 3; ++i)
    {
      if (weights[i] == 1)
      {
        return surface.sourcePoints[f][i];
      }
    }
    return kNoJoint;
  }

  void findFineLoops()
  {
    std::vector<std::uint8_t> seen(mesh_.halfEdgeCount(), 0);
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      if (!mesh_.isBoundary(h) || seen[h] != 0)
      {
        continue;
      }
      FineLoop& loop = fineLoops_.emplace_back();
      loop.sheet = sheetOfFace(Mesh::face(h));
      loop.arc.push_back(0);
      for (Index g = h; seen[g] == 0; g = nextOnBoundary(mesh_, g))
      {
        seen[g] = 1;
        loop.halfEdges.push_back(g);
        loop.arc.push_back(loop.arc.back() + mesh_.edgeVector(g).norm());
        const Index input = inputAt(g);
        loop.jointPoint.push_back(input == kNoJoint ? kNoJoint : sheets_.jointPoint[input]);
      }
    }
  }

  /// Ends and branches of joints, where sheets change, and what the quads of a sheet have there.
  void findNodes()
  {
    std::map<Index, std::vector<Index>> neighbours;
    for (const auto& [a, b] : sheets_.edges)
    {
      neighbours[a].push_back(b);
      neighbours[b].push_back(a);
    }
    std::map<std::pair<Index, Index>, std::set<Index>> sheetsAt; // of edges
    std::set<Index> onFeatures;
    for (const SectorRequest& request : result_.onFeatures)
    {
      onFeatures.insert(request.vertex);
    }
    for (const FineLoop& loop : fineLoops_)
    {
      Index before = kNoJoint, first = kNoJoint;
      for (std::size_t i = 0; i < loop.halfEdges.size(); ++i)
      {
        const Index point = loop.jointPoint[i];
        const Index v = mesh_.origin[loop.halfEdges[i]];
        if (point == kNoJoint)
        {
          continue;
        }
        if (neighbours.count(point) != 0 && (onFeatures.count(v) != 0 || result_.turns[v] != 2))
        {
          nodes_.insert(point);
        }
        if (before != kNoJoint)
        {
          sheetsAt[sortedPair(before, point)].insert(loop.sheet);
        }
        first = first == kNoJoint ? point : first;
        before = point;
      }
      if (first != kNoJoint)
      {
        sheetsAt[sortedPair(before, first)].insert(loop.sheet);
      }
    }
    for (const auto& [point, others] : neighbours)
    {
      if (others.size() != 2 ||
        sheetsAt[sortedPair(point, others[0])] != sheetsAt[sortedPair(point, others[1])])
      {
        nodes_.insert(point);
      }
    }
    neighbours_ = std::move(neighbours);
  }

  void findSegments()
  {
    std::set<std::pair<Index, Index>> taken;
    const auto follow = [&](Index from, Index next)
    {
      if (!taken.insert(sortedPair(from, next)).second)
      {
        return;
      }
      JointSegment segment;
      segment.points = { from, next };
      while (nodes_.count(segment.points.back()) == 0)
      {
        const Index at = segment.points.back(), before = segment.points[segment.points.size() - 2];
        const std::vector<Index>& others = neighbours_[at];
        const Index following = others[0] == before ? others[1] : others[0];
        taken.insert(sortedPair(at, following));
        segment.points.push_back(following);
      }
      segment.arc.push_back(0);
      for (std::size_t i = 1; i < segment.points.size(); ++i)
      {
        segment.arc.push_back(segment.arc.back() +
          (jointPoints_[segment.points[i]] - jointPoints_[segment.points[i - 1]]).norm());
      }
      const auto id = static_cast<Index>(segments_.size());
      for (std::size_t i = 1; i < segment.points.size(); ++i)
      {
        segmentOf_[{ segment.points[i - 1], segment.points[i] }] = { id, true };
        segmentOf_[{ segment.points[i], segment.points[i - 1] }] = { id, false };
      }
      segments_.push_back(std::move(segment));
    };
    const auto followAll = [&](Index node)
    {
      for (const Index next : neighbours_[node])
      {
        follow(node, next);
      }
    };
    const std::set<Index> found = nodes_;
    for (const Index node : found)
    {
      followAll(node);
    }
    for (const auto& [point, others] : neighbours_)
    {
      // What is left are closed joints without a node: the lowest point becomes one.
      if (taken.count(sortedPair(point, others.front())) == 0)
      {
        nodes_.insert(point);
        followAll(point);
      }
    }
    met_.segments = segments_.size();
  }

  /// A place on the boundary of the surface.
  struct OnLoop
  {
    std::size_t loop = 0;
    CurvePoint at;
    double arc = 0;
    double distance = std::numeric_limits<double>::infinity();
  };

  OnLoop nearestOnLoops(Index sheet, const Vector3& p) const
  {
    OnLoop best;
    for (std::size_t l = 0; l < fineLoops_.size(); ++l)
    {
      const FineLoop& loop = fineLoops_[l];
      for (std::size_t i = 0; loop.sheet == sheet && i < loop.halfEdges.size(); ++i)
      {
        const Index h = loop.halfEdges[i];
        const CurvePoint at = nearestOnEdge(h, p);
        const double length = mesh_.edgeVector(h).norm();
        const double distance =
          (mesh_.position[mesh_.origin[h]] + at.t * mesh_.edgeVector(h) - p).norm();
        if (distance < best.distance)
        {
          best = { l, at, loop.arc[i] + at.t * length, distance };
        }
      }
    }
    return best;
  }

  /// The chains of all sheets, cut at the points of the quads nearest to nodes.
  void findChains()
  {
    const QuadTopology topology = analyzeQuads(quads_.quads, quads_.points.size(), threads_);
    std::vector<std::uint8_t> hasQuads(fineLoops_.size(), 0);
    for (const std::vector<Index>& halfEdges : boundaryLoops(topology))
    {
      poll();
      const Index sheet = sheetOfFace(quads_.quadSourceFace[halfEdges.front() / 4]);
      std::vector<std::pair<double, Index>> points; // by arc
      std::size_t fine = fineLoops_.size();
      for (const Index h : halfEdges)
      {
        const Index p = quads_.quads[h / 4][h % 4];
        const OnLoop place = nearestOnLoops(sheet, quads_.points[p]);
        fine = fine == fineLoops_.size() ? place.loop : fine;
        points.emplace_back(place.arc, p);
      }
      if (fine == fineLoops_.size())
      {
        continue;
      }
      hasQuads[fine] = 1;
      // In the order of the loop, from the one with the least arc on.
      std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
      addLoop(fineLoops_[fine], points);
    }
    for (std::size_t l = 0; l < fineLoops_.size(); ++l)
    {
      const FineLoop& loop = fineLoops_[l];
      const auto isOnJoint = [&](Index point)
      { return point != kNoJoint && neighbours_.count(point) != 0; };
      const auto at = std::find_if(loop.jointPoint.begin(), loop.jointPoint.end(), isOnJoint);
      if (hasQuads[l] == 0 && at != loop.jointPoint.end())
      {
        fail("a sheet has no quads along a curve of more than two sheets", *at);
      }
    }
  }

  void fail(const std::string& what, Index jointPoint)
  {
    met_.status = { StatusCode::NotConverged,
      what + " near " + placeText(jointPoints_[jointPoint]) + ": ask for more quads" };
  }

  void addLoop(const FineLoop& fine, const std::vector<std::pair<double, Index>>& points)
  {
    const double length = fine.arc.back();
    struct Stop
    {
      double arc;
      Index node;
      Index next; ///< the next point of the input
      std::size_t point;
    };
    std::vector<Stop> stops;
    for (std::size_t i = 0; i < fine.halfEdges.size(); ++i)
    {
      if (fine.jointPoint[i] == kNoJoint || nodes_.count(fine.jointPoint[i]) == 0)
      {
        continue;
      }
      Index next = kNoJoint;
      for (std::size_t k = 1; k <= fine.halfEdges.size() && next == kNoJoint; ++k)
      {
        next = fine.jointPoint[(i + k) % fine.halfEdges.size()];
      }
      stops.push_back({ fine.arc[i], fine.jointPoint[i], next, 0 });
    }
    if (stops.empty())
    {
      return;
    }
    for (Stop& stop : stops)
    {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        const double gap = std::abs(points[i].first - stop.arc);
        const double around = std::min(gap, length - gap);
        if (around < least)
        {
          least = around;
          stop.point = i;
        }
      }
    }
    SheetLoop& loop = loops_.emplace_back();
    loop.sheet = fine.sheet;
    // Where all stops are at one point, the longest chain goes all the way round.
    const auto lengthOf = [&](std::size_t s)
    {
      const double gap = stops[(s + 1) % stops.size()].arc - stops[s].arc;
      return gap > 0 ? gap : gap + length;
    };
    std::size_t whole = stops.size();
    if (std::all_of(stops.begin(), stops.end(),
          [&](const Stop& stop) { return stop.point == stops.front().point; }))
    {
      whole = 0;
      for (std::size_t s = 1; s < stops.size(); ++s)
      {
        whole = lengthOf(s) > lengthOf(whole) ? s : whole;
      }
    }
    for (std::size_t s = 0; s < stops.size(); ++s)
    {
      const Stop& stop = stops[s];
      const Stop& following = stops[(s + 1) % stops.size()];
      SheetChain chain;
      const auto segment = segmentOf_.find({ stop.node, stop.next });
      if (segment != segmentOf_.end())
      {
        chain.segment = segment->second.first;
        chain.isForward = segment->second.second;
      }
      chain.points.push_back(points[stop.point].second);
      for (std::size_t i = stop.point;
           i != following.point || (s == whole && chain.points.size() == 1);)
      {
        i = (i + 1) % points.size();
        chain.points.push_back(points[i].second);
      }
      loop.chains.push_back(std::move(chain));
    }
  }

  //----------------------------------------------------------------------------
  // Numbers of edges

  void chooseNumbers()
  {
    for (const bool allEven : { false, true })
    {
      countTry(Try::EvenNumbers, allEven ? 1 : 0);
      for (JointSegment& segment : segments_)
      {
        segment.edges = 1;
      }
      for (const SheetLoop& loop : loops_)
      {
        for (const SheetChain& chain : loop.chains)
        {
          if (chain.segment != kNoJoint)
          {
            std::size_t& edges = segments_[chain.segment].edges;
            edges = std::max(edges, chain.edges());
          }
        }
      }
      for (JointSegment& segment : segments_)
      {
        segment.edges += allEven ? segment.edges % 2 : 0;
      }
      bool isPossible = true;
      for (Index sheet = 0; sheet < sheets_.offset.size(); ++sheet)
      {
        isPossible = isPossible && (hasFree(sheet) || lackOf(sheet) % 2 == 0);
      }
      if (isPossible)
      {
        countTryLed(Try::EvenNumbers, allEven ? 1 : 0);
        return;
      }
    }
  }

  bool hasFree(Index sheet) const
  {
    return std::any_of(loops_.begin(), loops_.end(),
      [&](const SheetLoop& loop)
      {
        return loop.sheet == sheet &&
          std::any_of(loop.chains.begin(), loop.chains.end(),
            [](const SheetChain& chain) { return chain.segment == kNoJoint; });
      });
  }

  std::size_t lackOf(const SheetChain& chain) const
  {
    return chain.segment == kNoJoint ? 0 : segments_[chain.segment].edges - chain.edges();
  }

  std::size_t lackOf(Index sheet) const
  {
    std::size_t lack = 0;
    for (const SheetLoop& loop : loops_)
    {
      for (const SheetChain& chain : loop.chains)
      {
        lack += loop.sheet == sheet ? lackOf(chain) : 0;
      }
    }
    return lack;
  }

  //----------------------------------------------------------------------------
  // Strips

  struct ChainPlace
  {
    std::size_t loop = 0, chain = 0;
  };

  /// A strip may end where nothing is lacking, if it must: then all sheets there lack an edge more.
  void fillSheets()
  {
    std::size_t most = 0;
    for (Index sheet = 0; sheet < sheets_.offset.size(); ++sheet)
    {
      most += lackOf(sheet);
    }
    most = 4 * (most + segments_.size());
    for (std::optional<ChainPlace> from = mostLacking(); from && met_.status.ok();
         from = mostLacking())
    {
      poll();
      const bool isDone = met_.strips < most && (insertFrom(*from, false) || fillOtherwise(*from));
      if (!isDone)
      {
        fail("the quads of a sheet cannot get the edges that others have along their common curve",
          segments_[loops_[from->loop].chains[from->chain].segment].points.front());
      }
    }
  }

  /// Where no path leads to a chain that lacks edges too.
  bool fillOtherwise(const ChainPlace& from)
  {
    countTry(Try::StripOtherwise);
    bool isDone = splitFrom(from, false);
    if (!isDone)
    {
      countTry(Try::StripOtherwise);
      isDone = insertFrom(from, true);
    }
    if (!isDone)
    {
      countTry(Try::StripOtherwise);
      isDone = splitFrom(from, true);
    }
    countTryLed(Try::StripOtherwise, isDone ? 1 : 0);
    return isDone;
  }

  std::optional<ChainPlace> mostLacking() const
  {
    std::optional<ChainPlace> place;
    std::size_t most = 0;
    for (std::size_t l = 0; l < loops_.size(); ++l)
    {
      for (std::size_t c = 0; c < loops_[l].chains.size(); ++c)
      {
        if (lackOf(loops_[l].chains[c]) > most)
        {
          most = lackOf(loops_[l].chains[c]);
          place = { l, c };
        }
      }
    }
    return place;
  }

  /// Whether a strip from a chain may end at another one, or at the same: it lacks an edge, or has no others to fit.
  bool takesEnd(const ChainPlace& from, const ChainPlace& to) const
  {
    const SheetChain& chain = loops_[to.loop].chains[to.chain];
    const bool isSame = to.loop == from.loop && to.chain == from.chain;
    return chain.segment == kNoJoint || lackOf(chain) >= (isSame ? 2U : 1U);
  }

  /// Before a strip goes there.
  void raise(const ChainPlace& from, const ChainPlace& to)
  {
    if (!takesEnd(from, to))
    {
      ++segments_[loops_[to.loop].chains[to.chain].segment].edges;
    }
  }

  bool insertFrom(const ChainPlace& from, bool mayRaise)
  {
    constexpr double freeCost = 10, raiseCost = 60;
    const Index sheet = loops_[from.loop].sheet;
    // By point: the chain that would get the other end.
    std::map<Index, std::pair<double, ChainPlace>> ends;
    for (std::size_t l = 0; l < loops_.size(); ++l)
    {
      for (std::size_t c = 0; c < loops_[l].chains.size() && loops_[l].sheet == sheet; ++c)
      {
        const SheetChain& chain = loops_[l].chains[c];
        const bool takes = takesEnd(from, { l, c });
        if (!takes && !mayRaise)
        {
          continue;
        }
        const double cost = !takes ? raiseCost : chain.segment == kNoJoint ? freeCost : 0;
        for (const Index p : chain.points)
        {
          const double atPoint = cost + crowdedCost(p);
          const auto [known, isNew] = ends.emplace(p, std::make_pair(atPoint, ChainPlace{ l, c }));
          if (!isNew && atPoint < known->second.first)
          {
            known->second = { atPoint, { l, c } };
          }
        }
      }
    }
    std::vector<std::pair<Index, double>> starts;
    for (const Index p : loops_[from.loop].chains[from.chain].points)
    {
      starts.emplace_back(p, crowdedCost(p));
    }
    const std::optional<QuadPath> path = findStripPath(quads_, starts,
      [&](Index, Index end) -> std::optional<double>
      {
        const auto found = ends.find(end);
        return found == ends.end() ? std::nullopt : std::optional<double>(found->second.first);
      });
    if (!path)
    {
      return false;
    }
    const Index last = path->back();
    const ChainPlace to = ends.at(quads_.quads[last / 4][(last + 1) % 4]).second;
    raise(from, to);
    const InsertedStrip strip = insertStrip(quads_, *path);
    splitBehind(from, strip.points.front().first, strip.points.front().second);
    splitBefore(to, strip.points.back().first, strip.points.back().second);
    crowd(from, strip.points.front().first);
    crowd(to, strip.points.back().first);
    spread(strip);
    spreadOnBoundary(to, strip.points.back().first);
    spreadOnBoundary(to, strip.points.back().second);
    ++met_.strips;
    withStrips_.insert(loops_[from.loop].sheet);
    return true;
  }

  /// The same by a chord of quads that is split: where no path can begin, as at a single quad between two corners.
  bool splitFrom(const ChainPlace& from, bool mayRaise)
  {
    const QuadTopology topology = analyzeQuads(quads_.quads, quads_.points.size(), threads_);
    std::map<std::pair<Index, Index>, Index> boundary; // half-edges by their ends
    for (Index h = 0; h < topology.twin.size(); ++h)
    {
      if (topology.twin[h] == kInvalidIndex)
      {
        boundary[{ quads_.quads[h / 4][h % 4], quads_.quads[h / 4][(h + 1) % 4] }] = h;
      }
    }
    struct Choice
    {
      QuadPath chord;
      ChainPlace to;
    };
    std::optional<Choice> best;
    const std::vector<Index> points = loops_[from.loop].chains[from.chain].points;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
    {
      const std::optional<QuadPath> chord =
        chordFrom(quads_, boundary.at({ points[i], points[i + 1] }));
      if (!chord)
      {
        continue;
      }
      const auto [x, y] = endOf(*chord);
      const std::optional<ChainPlace> to = chainOf(loops_[from.loop].sheet, x, y);
      if (to && (mayRaise || takesEnd(from, *to)) && (!best || chord->size() < best->chord.size()))
      {
        best = { *chord, *to };
      }
    }
    if (!best)
    {
      return false;
    }
    const Index a = quads_.quads[best->chord.front() / 4][best->chord.front() % 4];
    const auto [x, y] = endOf(best->chord);
    raise(from, best->to);
    const InsertedStrip strip = splitChord(quads_, best->chord);
    insertBehind(from, a, strip.points.front().second);
    insertBehind(best->to, x, strip.points.back().second);
    for (std::size_t i = 0; i < strip.points.size(); ++i)
    {
      // Half of the way along the edge that was split.
      const Index middle = strip.points[i].second;
      const Index q = static_cast<Index>(
        quads_.quads.size() - best->chord.size() + std::min(i, best->chord.size() - 1));
      const Index other = i < best->chord.size() ? quads_.quads[q][1] : quads_.quads[q][2];
      goTowards(middle, 0.5 * (quads_.points[other] - quads_.points[middle]));
    }
    spreadOnBoundary(best->to, strip.points.back().second);
    ++met_.strips;
    withStrips_.insert(loops_[from.loop].sheet);
    return true;
  }

  /// The edge of the boundary at the end of a chord, in the direction of the boundary.
  std::pair<Index, Index> endOf(const QuadPath& chord) const
  {
    const Index h = oppositeInQuad(chord.back());
    return { quads_.quads[h / 4][h % 4], quads_.quads[h / 4][(h + 1) % 4] };
  }

  std::optional<ChainPlace> chainOf(Index sheet, Index x, Index y) const
  {
    for (std::size_t l = 0; l < loops_.size(); ++l)
    {
      for (std::size_t c = 0; c < loops_[l].chains.size() && loops_[l].sheet == sheet; ++c)
      {
        const std::vector<Index>& points = loops_[l].chains[c].points;
        for (std::size_t i = 0; i + 1 < points.size(); ++i)
        {
          if (points[i] == x && points[i + 1] == y)
          {
            return ChainPlace{ l, c };
          }
        }
      }
    }
    return std::nullopt;
  }

  void insertBehind(const ChainPlace& place, Index point, Index added)
  {
    std::vector<Index>& points = loops_[place.loop].chains[place.chain].points;
    points.insert(std::find(points.begin(), points.end(), point) + 1, added);
  }

  /// A point of a chain that is on no joint goes away from its copy, or between its neighbours.
  void spreadOnBoundary(const ChainPlace& place, Index point)
  {
    constexpr double share = 1.0 / 3;
    const SheetChain& chain = loops_[place.loop].chains[place.chain];
    const auto at = std::find(chain.points.begin(), chain.points.end(), point);
    if (chain.segment != kNoJoint || at == chain.points.begin() || at + 1 >= chain.points.end())
    {
      return;
    }
    const Vector3& p = quads_.points[point];
    const Vector3 before = quads_.points[*(at - 1)] - p, behind = quads_.points[*(at + 1)] - p;
    move(point, loops_[place.loop].sheet, p + share * (before + behind));
  }

  /// Over the surface, or along the feature that the point is on.
  void goTowards(Index p, const Vector3& displacement)
  {
    constexpr int mostFaces = 1000;
    const bool isOnFeature = std::any_of(quads_.lines.begin(), quads_.lines.end(),
      [p](const QuadLine& line) { return !line.boundary && (line.a == p || line.b == p); });
    std::optional<SurfacePoint> there;
    if (isOnFeature)
    {
      there = nearestOnFeatures(sheetOfFace(quads_.sourceFace[p]), quads_.points[p] + displacement);
    }
    else
    {
      there = walkSurface(
        mesh_, { quads_.sourceFace[p], quads_.sourceWeights[p] }, displacement, mostFaces);
    }
    if (there)
    {
      quads_.sourceFace[p] = there->face;
      quads_.sourceWeights[p] = there->weights;
      quads_.points[p] = positionOf(mesh_, *there);
    }
  }

  std::optional<SurfacePoint> nearestOnFeatures(Index sheet, const Vector3& p) const
  {
    std::optional<CurvePoint> best;
    double least = std::numeric_limits<double>::infinity();
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      if (mesh_.isBoundary(h) || !mesh_.isFeature(h) || h > mesh_.twin[h] ||
        sheetOfFace(Mesh::face(h)) != sheet)
      {
        continue;
      }
      const CurvePoint at = nearestOnEdge(h, p);
      const double distance = (positionOf(mesh_, at.onSurface()) - p).norm();
      if (distance < least)
      {
        least = distance;
        best = at;
      }
    }
    return best ? std::optional<SurfacePoint>(best->onSurface()) : std::nullopt;
  }

  CurvePoint nearestOnEdge(Index h, const Vector3& p) const
  {
    const Vector3 along = mesh_.edgeVector(h);
    const double squared = along.squaredNorm();
    const double t = squared > 0
      ? std::clamp((p - mesh_.position[mesh_.origin[h]]).dot(along) / squared, 0.0, 1.0)
      : 0.0;
    return { h, t };
  }

  double crowdedCost(Index p) const
  {
    const auto found = crowded_.find(p);
    return found == crowded_.end() ? 0 : found->second;
  }

  /// The next strips keep away from this one, such that the points of the chain need not move far.
  void crowd(const ChainPlace& place, Index point)
  {
    constexpr double cost = 20;
    const std::vector<Index>& points = loops_[place.loop].chains[place.chain].points;
    const auto at = std::find(points.begin(), points.end(), point) - points.begin();
    const auto count = static_cast<std::ptrdiff_t>(points.size());
    const std::ptrdiff_t reach = std::max<std::ptrdiff_t>(2, count / 8);
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, at - reach);
         i < std::min(count, at + reach + 1); ++i)
    {
      double& there = crowded_[points[static_cast<std::size_t>(i)]];
      there = std::max(
        there, cost * (1 - static_cast<double>(std::abs(i - at)) / static_cast<double>(reach + 1)));
    }
  }

  /// The copy comes behind the point in its chain.
  void splitBehind(const ChainPlace& place, Index point, Index copy)
  {
    std::vector<SheetChain>& chains = loops_[place.loop].chains;
    std::vector<Index>& points = chains[place.chain].points;
    const auto at = std::find(points.begin(), points.end(), point);
    const bool isLast = at + 1 == points.end();
    points.insert(at + 1, copy);
    // Chains that begin at the point begin at the copy.
    for (std::size_t i = 1; isLast && i < chains.size(); ++i)
    {
      std::vector<Index>& next = chains[(place.chain + i) % chains.size()].points;
      const bool isOnlyPoint = next.size() == 1;
      if (next.front() == point)
      {
        next.front() = copy;
      }
      if (!isOnlyPoint)
      {
        break;
      }
    }
  }

  /// The copy comes before the point in its chain.
  void splitBefore(const ChainPlace& place, Index point, Index copy)
  {
    std::vector<SheetChain>& chains = loops_[place.loop].chains;
    std::vector<Index>& points = chains[place.chain].points;
    const auto at = std::find(points.begin(), points.end(), point);
    const bool isFirst = at == points.begin();
    points.insert(at, copy);
    for (std::size_t i = 1; isFirst && i <= chains.size();
         ++i) // of a loop of one chain its own end
    {
      std::vector<Index>& before = chains[(place.chain + chains.size() - i) % chains.size()].points;
      const bool isOnlyPoint = before.size() == 1;
      if (before.back() == point)
      {
        before.back() = copy;
      }
      if (!isOnlyPoint)
      {
        break;
      }
    }
  }

  /// Points inside a strip go apart, by a third of the way to their neighbours across.
  void spread(const InsertedStrip& strip)
  {
    constexpr double share = 1.0 / 3;
    std::map<Index, std::vector<Index>> neighbours;
    std::set<Index> onPath;
    for (const auto& [left, right] : strip.points)
    {
      onPath.insert(left);
      onPath.insert(right);
    }
    for (const std::array<Index, 4>& quad : quads_.quads)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        for (const std::size_t k : { (i + 1) % 4, (i + 3) % 4 })
        {
          if (onPath.count(quad[i]) != 0 && onPath.count(quad[k]) == 0)
          {
            neighbours[quad[i]].push_back(quad[k]);
          }
        }
      }
    }
    for (std::size_t i = 1; i + 1 < strip.points.size(); ++i)
    {
      for (const Index p : { strip.points[i].first, strip.points[i].second })
      {
        Vector3 sum = Vector3::Zero();
        for (const Index q : neighbours[p])
        {
          sum += quads_.points[q] - quads_.points[p];
        }
        const double count = std::max(1.0, static_cast<double>(neighbours[p].size()));
        goTowards(p, share / count * sum);
      }
    }
  }

  //----------------------------------------------------------------------------
  // Places

  Vector3 placeAt(const JointSegment& segment, double arc) const
  {
    const auto next = std::upper_bound(segment.arc.begin() + 1, segment.arc.end() - 1, arc);
    const auto i = static_cast<std::size_t>(next - segment.arc.begin());
    const double length = segment.arc[i] - segment.arc[i - 1];
    const double t = length > 0 ? std::clamp((arc - segment.arc[i - 1]) / length, 0.0, 1.0) : 0.0;
    const Vector3& from = jointPoints_[segment.points[i - 1]];
    const Vector3& to = jointPoints_[segment.points[i]];
    return t == 1 ? to : Vector3(from + t * (to - from));
  }

  void placePoints()
  {
    met_.same.resize(quads_.points.size());
    for (Index p = 0; p < met_.same.size(); ++p)
    {
      met_.same[p] = p;
    }
    for (JointSegment& segment : segments_)
    {
      for (std::size_t i = 0; i <= segment.edges; ++i)
      {
        segment.stops.push_back(
          segment.arc.back() * static_cast<double>(i) / static_cast<double>(segment.edges));
      }
    }
    std::map<Index, std::vector<Index>> atNode; // points of the quads
    std::map<std::pair<Index, std::size_t>, std::vector<Index>> atStop;
    target_.assign(quads_.points.size(), kNoJoint);
    for (const SheetLoop& loop : loops_)
    {
      for (const SheetChain& chain : loop.chains)
      {
        if (chain.segment == kNoJoint)
        {
          continue;
        }
        const JointSegment& segment = segments_[chain.segment];
        for (std::size_t i = 0; i < chain.points.size(); ++i)
        {
          const std::size_t stop = chain.isForward ? i : segment.edges - i;
          const bool isNode = stop == 0 || stop == segment.edges;
          const Index p = chain.points[i];
          const Index node = stop == 0 ? segment.points.front() : segment.points.back();
          (isNode ? atNode[node] : atStop[{ chain.segment, stop }]).push_back(p);
          target_[p] = static_cast<Index>(places_.size());
          places_.push_back(isNode ? jointPoints_[node] : placeAt(segment, segment.stops[stop]));
          move(p, loop.sheet, places_.back() + sheets_.offset[loop.sheet]);
        }
      }
    }
    const auto makeSame = [this](const std::vector<Index>& points)
    {
      const Index lowest = *std::min_element(points.begin(), points.end());
      for (const Index p : points)
      {
        met_.same[p] = lowest;
      }
    };
    for (const auto& [node, points] : atNode)
    {
      makeSame(points);
    }
    for (const auto& [stop, points] : atStop)
    {
      makeSame(points);
    }
  }

  void move(Index p, Index sheet, const Vector3& to)
  {
    const OnLoop place = nearestOnLoops(sheet, to);
    const SurfacePoint at = place.at.onSurface();
    quads_.points[p] = to;
    quads_.sourceFace[p] = at.face;
    quads_.sourceWeights[p] = at.weights;
  }

  /// Points of joints stay: the boundary there has no lines meanwhile, as a trimmed one.
  void smooth()
  {
    constexpr int leastSteps = 40;
    std::vector<QuadLine> joints, others;
    for (QuadLine& line : quads_.lines)
    {
      const bool isOnJoint =
        line.boundary && target_[line.a] != kNoJoint && target_[line.b] != kNoJoint;
      if (line.halfEdge == kInvalidIndex)
      {
        line.halfEdge = nearestOnLoops(sheetOfFace(quads_.sourceFace[line.a]),
          0.5 * (quads_.points[line.a] + quads_.points[line.b]))
                          .at.h;
      }
      (isOnJoint ? joints : others).push_back(line);
    }
    quads_.lines = others;
    SmoothingOptions options;
    options.threads = threads_;
    for (const ValenceRequest& request : result_.surface.valenceRequests)
    {
      options.fixedVertices.push_back(request.vertex);
    }
    if (met_.strips > 0)
    {
      evenOut(options.fixedVertices);
    }
    if (met_.strips > 0 || smoothingSteps_ > 0)
    {
      options.steps = met_.strips > 0 ? std::max(leastSteps, smoothingSteps_) : smoothingSteps_;
      options.goodShape = met_.strips > 0 ? 1 : options.goodShape;
      smoothQuads(mesh_, quads_, options);
    }
    UntanglingOptions untangling;
    untangling.fixedVertices = options.fixedVertices;
    untangling.threads = threads_;
    met_.inverted = untangleQuads(mesh_, quads_, untangling).invertedAfter;
    quads_.lines.insert(quads_.lines.end(), joints.begin(), joints.end());
  }

  /// Points of sheets with strips go to the middle of their neighbours, those of features and of boundaries without
  /// joint along their curve, whatever this does to single quads: strips have made some narrow and others wide.
  void evenOut(const std::vector<Index>& fixedVertices)
  {
    constexpr int sweeps = 50;
    QuadMoves moves(mesh_, quads_, fixedVertices);
    std::vector<std::vector<Index>> neighbours(quads_.points.size());
    for (const std::array<Index, 4>& quad : quads_.quads)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Index p = quad[i];
        if (moves.freedom(p) == QuadMoves::Freedom::Surface &&
          withStrips_.count(sheetOfPoint(p)) != 0)
        {
          neighbours[p].push_back(quad[(i + 1) % 4]);
          neighbours[p].push_back(quad[(i + 3) % 4]);
        }
      }
    }
    for (const QuadLine& line : quads_.lines)
    {
      for (const auto& [p, other] :
        { std::make_pair(line.a, line.b), std::make_pair(line.b, line.a) })
      {
        if (moves.freedom(p) == QuadMoves::Freedom::Curve &&
          withStrips_.count(sheetOfPoint(p)) != 0)
        {
          neighbours[p].push_back(other);
        }
      }
    }
    for (int sweep = 0; sweep < sweeps; ++sweep)
    {
      poll();
      for (Index p = 0; p < neighbours.size(); ++p)
      {
        Vector3 sum = Vector3::Zero();
        for (const Index other : neighbours[p])
        {
          sum += quads_.points[other] - quads_.points[p];
        }
        const auto there = neighbours[p].empty()
          ? std::nullopt
          : moves.target(p, sum / static_cast<double>(neighbours[p].size()));
        if (there)
        {
          moves.move(p, *there, positionOf(mesh_, *there));
        }
      }
    }
  }

  Index sheetOfPoint(Index p) const { return sheetOfFace(quads_.sourceFace[p]); }

  //----------------------------------------------------------------------------
  // Back to where the sheets were

  void moveBack()
  {
    std::vector<Index> sheetOf(mesh_.vertexCount(), 0);
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      sheetOf[mesh_.origin[h]] = sheetOfFace(Mesh::face(h));
    }
    for (Index p = 0; p < quads_.points.size(); ++p)
    {
      const bool isPlaced = p < target_.size() && target_[p] != kNoJoint;
      quads_.points[p] = isPlaced
        ? places_[target_[p]]
        : Vector3(quads_.points[p] - sheets_.offset[sheetOfFace(quads_.sourceFace[p])]);
    }
    for (Index v = 0; v < mesh_.vertexCount(); ++v)
    {
      mesh_.position.edit()[v] -= sheets_.offset[sheetOf[v]];
    }
    for (SmallDetail& detail : result_.details)
    {
      detail.place = sheets_.movedBack(detail.place);
    }
    for (GivenUpCurve& curve : result_.givenUpFeatures)
    {
      curve.place = sheets_.movedBack(curve.place);
    }
    result_.framePositions.clear();
  }

  RemeshResult& result_;
  Mesh& mesh_;
  QuadMesh& quads_;
  const JointSheets& sheets_;
  const std::vector<Vector3>& jointPoints_;
  int smoothingSteps_;
  int threads_;
  MetSheets met_;
  std::vector<FineLoop> fineLoops_;
  std::map<Index, std::vector<Index>> neighbours_; ///< along joints, by points of the joint surface
  std::set<Index> nodes_;
  std::vector<JointSegment> segments_;
  /// Of an edge from the first point to the second: its segment, and whether it runs along it.
  std::map<std::pair<Index, Index>, std::pair<Index, bool>> segmentOf_;
  std::vector<SheetLoop> loops_;
  std::map<Index, double> crowded_; ///< by point of the quads, what it costs to begin a strip there
  std::set<Index> withStrips_;      ///< sheets
  std::vector<Index> target_;       ///< per point of the quads: its place on a joint, or kNoJoint
  std::vector<Vector3> places_;
};

} // namespace

MetSheets meetAtJoints(RemeshResult& result, const JointSheets& sheets,
  const std::vector<Vector3>& jointPoints, int smoothingSteps, int threads)
{
  const TryScope tries;
  MetSheets met = SheetMeeting(result, sheets, jointPoints, smoothingSteps, threads).meet();
  result.tries.add(tries.counts());
  return met;
}

} // namespace quadrille

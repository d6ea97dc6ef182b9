// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/FeatureNetwork.h"

#include "Base/Error.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Features/ArcNetwork.h"
#include "Features/FeatureFilter.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

/// What two nodes that stay close to each other count as, in edge lengths.
constexpr double kLossOfPair = 3;
/// A gap shorter than this between two nodes gives a map no more room than the arc did.
constexpr double kShortestGap = 0.25;
/// So far, in edge lengths, phase 1 may move a curve.
constexpr double kMovable = 0.1;
constexpr double kUnreached = std::numeric_limits<double>::infinity();

/// What to take out for one short arc.
struct Resolution
{
  std::vector<Index> arcs;
  double loss = kUnreached; ///< in edge lengths
};

Resolution lesser(Resolution a, Resolution b)
{
  return b.loss < a.loss ? std::move(b) : std::move(a);
}

/// All arcs at `node` go but `arc` and one other, the one whose loss would be largest.
Resolution endOfCurve(const ArcNetwork& network, Index node, Index arc)
{
  const std::vector<NetworkArc>& arcs = network.arcs();
  std::vector<Index> others;
  for (const Index a : network.arcsAt(node))
  {
    if (a != arc)
    {
      others.push_back(a);
    }
  }
  std::sort(others.begin(), others.end());
  Resolution best;
  for (const Index kept : others)
  {
    Resolution made{ {}, 0 };
    for (const Index a : others)
    {
      const bool again = !made.arcs.empty() && made.arcs.back() == a;
      if (a != kept && !again)
      {
        made.arcs.push_back(a);
        made.loss += arcs[a].removable ? arcs[a].length : kUnreached;
      }
    }
    // A corner so near to the other end is as good as a node, unless a curve may be moved so far.
    if (arcs[arc].length > kMovable && !network.goStraightOn(node, arc, kept))
    {
      made.loss += kLossOfPair;
    }
    // A loop that begins and ends here is no way on.
    const bool loop = arcs[kept].ends[0] == arcs[kept].ends[1];
    if (!loop)
    {
      best = lesser(std::move(best), std::move(made));
    }
  }
  return best;
}

/// Whether without `arc` no node is left, and the curve that goes on there is no corner.
bool isFreeWithout(const ArcNetwork& network, Index node, Index arc)
{
  std::vector<Index> rest;
  for (const Index a : network.arcsAt(node))
  {
    if (a != arc)
    {
      rest.push_back(a);
    }
  }
  return rest.empty() || (rest.size() == 2 && network.goStraightOn(node, rest[0], rest[1]));
}

Resolution resolve(const ArcNetwork& network, Index id)
{
  const NetworkArc& arc = network.arcs()[id];
  const bool pair =
    !isFreeWithout(network, arc.ends[0], id) && !isFreeWithout(network, arc.ends[1], id);
  Resolution best{ {}, kLossOfPair }; // it stays, and so do its ends
  if (arc.removable && (!pair || arc.length >= kShortestGap))
  {
    best = { { id }, arc.length + (pair ? kLossOfPair : 0) };
  }
  if (arc.ends[0] != arc.ends[1])
  {
    best = lesser(std::move(best), endOfCurve(network, arc.ends[0], id));
    best = lesser(std::move(best), endOfCurve(network, arc.ends[1], id));
  }
  return best;
}

/// Shortest first.
std::vector<Index> shortArcs(const std::vector<NetworkArc>& arcs)
{
  std::vector<Index> found;
  for (Index i = 0; i < arcs.size(); ++i)
  {
    if (arcs[i].length < kShortestArc)
    {
      found.push_back(i);
    }
  }
  std::stable_sort(
    found.begin(), found.end(), [&](Index a, Index b) { return arcs[a].length < arcs[b].length; });
  return found;
}

void takeOut(Mesh& mesh, const NetworkArc& arc, NetworkReport& report)
{
  unmarkFeatures(mesh, arc.halfEdges);
  ++report.removedCurves;
  report.removedEdges += arc.halfEdges.size();
  report.removedLength += arc.length;
  if (arc.length > report.longest)
  {
    report.longest = arc.length;
    const Index h = arc.halfEdges[arc.halfEdges.size() / 2];
    report.place = 0.5 * (mesh.position[mesh.origin[h]] + mesh.position[mesh.target(h)]);
  }
}

/// Arcs that share no node; returns whether there were any that something could be done about.
bool simplifyOnce(Mesh& mesh, double edgeLength, NetworkReport& report)
{
  const ArcNetwork network(mesh, edgeLength);
  const std::vector<NetworkArc>& arcs = network.arcs();
  std::vector<std::uint8_t> touched(mesh.vertexCount(), 0);
  const auto touch = [&](const NetworkArc& arc)
  { touched[arc.ends[0]] = touched[arc.ends[1]] = 1; };
  bool any = false;
  for (const Index id : shortArcs(arcs))
  {
    poll();
    if (touched[arcs[id].ends[0]] != 0 || touched[arcs[id].ends[1]] != 0)
    {
      continue;
    }
    const Resolution resolution = resolve(network, id);
    if (resolution.arcs.empty())
    {
      continue; // all that could go is asked for, boundary, or worth more
    }
    ++report.shortArcs;
    any = true;
    touch(arcs[id]);
    for (const Index a : resolution.arcs)
    {
      touch(arcs[a]);
      takeOut(mesh, arcs[a], report);
    }
  }
  return any;
}

/// Leads branches of junctions to others, see mergeNearJunctions.
class JunctionMerge
{
public:
  JunctionMerge(Mesh& mesh, double edgeLength)
    : mesh_(mesh), edgeLength_(edgeLength), network_(mesh, edgeLength),
      touched_(mesh.vertexCount(), 0), isConstrained_(constrainedVertices(mesh)),
      outgoing_(outgoingHalfEdges(mesh))
  {
  }

  MovedFeatures merge()
  {
    for (const Index id : shortArcs(network_.arcs()))
    {
      poll();
      const NetworkArc& arc = network_.arcs()[id];
      const auto [a, b] = arc.ends;
      if (a != b && touched_[a] == 0 && touched_[b] == 0)
      {
        // A branch that leaves a curve which goes straight on is the one that moves, if there is one.
        static_cast<void>(moveFrom(b, a, id, true) || moveFrom(a, b, id, true) ||
          moveFrom(b, a, id, false) || moveFrom(a, b, id, false));
      }
    }
    return std::move(moved_);
  }

private:
  bool moveFrom(Index node, Index to, Index arc, bool straightOn)
  {
    const std::vector<Index> at = network_.arcsAt(node);
    if (at.size() != 3)
    {
      return false;
    }
    std::vector<Index> others;
    std::copy_if(
      at.begin(), at.end(), std::back_inserter(others), [arc](Index a) { return a != arc; });
    if (others.size() != 2 || others[0] == others[1])
    {
      return false;
    }
    std::sort(others.begin(), others.end());
    for (const std::size_t i : { std::size_t{ 0 }, std::size_t{ 1 } })
    {
      const Index branch = others[i], kept = others[1 - i];
      const std::array<Index, 2>& ends = network_.arcs()[branch].ends;
      const bool isOnItsOwn = ends[0] != to && ends[1] != to && ends[0] != ends[1];
      if (network_.arcs()[branch].yields && isOnItsOwn &&
        (!straightOn || network_.goStraightOn(node, arc, kept)) && leadTo(node, to, branch))
      {
        return true;
      }
    }
    return false;
  }

  /// Half-edges of an arc from a node on, each leaving the vertex before.
  std::vector<Index> edgesFrom(Index node, const NetworkArc& arc) const
  {
    std::vector<Index> edges = arc.halfEdges;
    if (arc.ends[0] != node)
    {
      std::reverse(edges.begin(), edges.end());
    }
    Index v = node;
    for (Index& h : edges)
    {
      h = mesh_.origin[h] == v ? h : mesh_.twin[h];
      v = mesh_.target(h);
    }
    return edges;
  }

  bool leadTo(Index node, Index to, Index branch)
  {
    const std::vector<Index> edges = edgesFrom(node, network_.arcs()[branch]);
    std::map<Index, std::size_t> goals; // inner vertices of the branch, with their place in it
    std::vector<double> along{ 0 };
    for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    {
      along.push_back(along.back() + sizedLength(mesh_, edges[i]) / edgeLength_);
      if (along.back() > kReach && !goals.empty())
      {
        break;
      }
      goals[mesh_.target(edges[i])] = i + 1;
    }
    const std::optional<std::vector<Index>> way = wayTo(to, goals, along);
    if (!way)
    {
      return false;
    }
    const std::size_t upTo = goals.at(mesh_.target(way->back()));
    for (std::size_t i = 0; i < upTo; ++i)
    {
      moved_.off.push_back(standingFor(edges[i]));
    }
    unmarkFeatures(mesh_, { edges.begin(), edges.begin() + static_cast<std::ptrdiff_t>(upTo) });
    touched_[node] = touched_[to] = 1;
    for (const Index h : *way)
    {
      moved_.on.push_back(standingFor(h));
      isConstrained_[mesh_.target(h)] = 1;
    }
    markYielding(mesh_, *way);
    if (moved_.junctions++ == 0)
    {
      moved_.place = mesh_.position[node];
    }
    return true;
  }

  Index standingFor(Index h) const { return std::min(h, mesh_.twin[h]); }

  /// The cheapest way over free edges to one of the goals, where what is left of the branch within reach counts, too.
  std::optional<std::vector<Index>> wayTo(
    Index from, const std::map<Index, std::size_t>& goals, const std::vector<double>& along) const
  {
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    std::map<Index, std::pair<double, Index>> known; // by vertex: its distance, the half-edge to it
    open.push({ 0, from });
    known[from] = { 0, kInvalidIndex };
    std::optional<Index> best;
    double least = kUnreached;
    while (!open.empty() && open.top().first < std::min(least, kFarthestEnd))
    {
      const auto [distance, v] = open.top();
      open.pop();
      const auto goal = goals.find(v);
      if (goal != goals.end() && distance + along.back() - along[goal->second] < least)
      {
        least = distance + along.back() - along[goal->second];
        best = v;
      }
      if (distance > known[v].first || (v != from && isConstrained_[v] != 0))
      {
        continue;
      }
      forEachInFan(mesh_, outgoing_[v],
        [&, d = distance](Index h)
        {
          const Index w = mesh_.target(h);
          const bool mayPass = !mesh_.isConstrained(h) && w != from && touched_[w] == 0 &&
            (isConstrained_[w] == 0 || goals.count(w) != 0);
          const double there = d + sizedLength(mesh_, h) / edgeLength_;
          const auto old = known.find(w);
          if (mayPass && (old == known.end() || there < old->second.first))
          {
            known[w] = { there, h };
            open.push({ there, w });
          }
        });
    }
    if (!best)
    {
      return std::nullopt;
    }
    std::vector<Index> way;
    for (Index v = *best; v != from; v = mesh_.origin[way.back()])
    {
      way.push_back(known[v].second);
    }
    std::reverse(way.begin(), way.end());
    return way;
  }

  /// Of an edge that has a face beyond; a boundary edge is constrained, so the one beside it is no way.
  static constexpr double kReach = 1.5;
  static constexpr double kFarthestEnd = 3;

  Mesh& mesh_;
  double edgeLength_;
  ArcNetwork network_;
  std::vector<std::uint8_t> touched_, isConstrained_;
  std::vector<Index>
    outgoing_; ///< a half-edge that leaves the vertex, on the boundary the first one
  MovedFeatures moved_;
};

} // namespace

NetworkReport simplifyFeatureNetwork(
  Mesh& mesh, double edgeLength, bool isDesigned, FeatureFilterReport& filtered)
{
  if (!(edgeLength > 0))
  {
    throw InvalidInput("the edge length for simplifying features must be positive");
  }
  NetworkReport report;
  while (hasDetectedFeature(mesh) && simplifyOnce(mesh, edgeLength, report))
  {
    const FeatureFilterReport more = removeUnresolvedFeatures(mesh, edgeLength, isDesigned);
    filtered.removedEdges += more.removedEdges;
    filtered.keptEdges = more.keptEdges;
  }
  if (report.removedCurves > 0)
  {
    report.keptLength = lengthOfFeatures(mesh, edgeLength);
  }
  return report;
}

MovedFeatures mergeNearJunctions(Mesh& mesh, double edgeLength)
{
  if (!(edgeLength > 0))
  {
    throw InvalidInput("the edge length for merging junctions must be positive");
  }
  return JunctionMerge(mesh, edgeLength).merge();
}

double lengthOfFeatures(const Mesh& mesh, double edgeLength)
{
  double length = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    const bool isFirst = !mesh.isBoundary(h) && h < mesh.twin[h];
    length += mesh.isFeature(h) && isFirst ? sizedLength(mesh, h) / edgeLength : 0;
  }
  return length;
}

std::string NetworkReport::text() const
{
  if (removedCurves == 0)
  {
    return {};
  }
  return std::to_string(removedCurves) + (removedCurves == 1 ? " curve" : " curves") +
    " of sharp edges with " + inEdgeLengths(removedLength) + " edge lengths" +
    (removedCurves == 1 ? "" : " altogether, the longest of " + inEdgeLengths(longest)) + " near " +
    placeText(place) + (removedCurves == 1 ? " was" : " were") +
    " not used as features: junctions of features were nearer to each other than half a quad at " +
    std::to_string(shortArcs) + (shortArcs == 1 ? " place" : " places") + ". Features of " +
    inEdgeLengths(keptLength) +
    " edge lengths stayed; ask for smaller quads, or mark the edges that are to stay";
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/FeatureNetwork.h"

#include "Base/Error.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Features/ArcNetwork.h"
#include "Features/FeatureFilter.h"
#include "Mesh/Sizing.h"

#include <algorithm>
#include <limits>
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

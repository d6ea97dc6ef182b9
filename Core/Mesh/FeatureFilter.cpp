// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/FeatureFilter.h"

#include "Base/Error.h"
#include "Base/Progress.h"
#include "Mesh/Distance.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace quadrille
{
namespace
{

constexpr double kShortestDangling = 4;
constexpr double kShortestLoop = 2;
constexpr double kShortestMeanChain = 1;
/// Length over length in steps of s. A circle of radius s has 1.04, one of 0.7 s 1.09; mesh edges that
/// zigzag through noise have 1.2 and more.
constexpr double kMostJagged = 1.1;

/// A maximal run of constrained edges between nodes; `ends` is invalid for a closed loop.
struct Chain
{
  std::vector<Index> halfEdges; ///< one of each edge
  double length = 0;
  double jaggedness = 1; ///< length over its length in steps of s
  Index first = kInvalidIndex;
  Index last = kInvalidIndex;
  bool removable = true; ///< all of it was detected, none asked for, none on the boundary
};

class FeatureGraph
{
public:
  FeatureGraph(const Mesh& mesh, double edgeLength) : mesh_(mesh), edgeLength_(edgeLength)
  {
    countDegrees();
    listIncidentEdges();
    traceChains();
  }

  const std::vector<Chain>& chains() const { return chains_; }
  /// A single feature that ends in the surface or on the boundary continues nowhere.
  bool endsThere(Index v) const
  {
    Index features = 0;
    for (Index i = offset_[v]; i < offset_[v + 1]; ++i)
    {
      features += !mesh_.isBoundary(incident_[i]);
    }
    return features == 1;
  }

private:
  Index degree(Index v) const { return offset_[v + 1] - offset_[v]; }

  bool isEdge(Index h) const
  {
    return mesh_.isConstrained(h) && (mesh_.isBoundary(h) || h < mesh_.twin[h]);
  }

  void countDegrees()
  {
    offset_.assign(mesh_.vertexCount() + 1, 0);
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (isEdge(h))
      {
        ++offset_[mesh_.origin[h] + 1];
        ++offset_[mesh_.target(h) + 1];
      }
    }
    std::partial_sum(offset_.begin(), offset_.end(), offset_.begin());
  }

  void listIncidentEdges()
  {
    incident_.resize(offset_.back());
    std::vector<Index> fill(offset_.begin(), offset_.end() - 1);
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (isEdge(h))
      {
        incident_[fill[mesh_.origin[h]]++] = h;
        incident_[fill[mesh_.target(h)]++] = h;
      }
    }
  }

  void traceChains()
  {
    std::vector<std::uint8_t> done(mesh_.halfEdgeCount(), 0);
    for (const bool loops : { false, true })
    {
      for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
      {
        pollNowAndThen(h);
        if (!isEdge(h) || done[h])
        {
          continue;
        }
        const bool startsHere = degree(mesh_.origin[h]) != 2;
        const bool endsHere = degree(mesh_.target(h)) != 2;
        if (startsHere || endsHere || loops)
        {
          trace(h, startsHere ? mesh_.origin[h] : mesh_.target(h), done);
        }
      }
    }
  }

  Index otherEnd(Index h, Index v) const
  {
    return mesh_.origin[h] == v ? mesh_.target(h) : mesh_.origin[h];
  }

  void trace(Index h, Index start, std::vector<std::uint8_t>& done)
  {
    Chain chain;
    Index v = start;
    std::vector<Index> path{ start };
    while (true)
    {
      done[h] = 1;
      chain.halfEdges.push_back(h);
      chain.length += mesh_.edgeVector(h).norm();
      chain.removable =
        chain.removable && !mesh_.isBoundary(h) && (mesh_.flags[h] & kRequestedFeature) == 0;
      v = otherEnd(h, v);
      path.push_back(v);
      if (degree(v) != 2)
      {
        break;
      }
      const Index a = incident_[offset_[v]];
      const Index next = a == h ? incident_[offset_[v] + 1] : a;
      if (done[next])
      {
        break; // a closed loop without a node
      }
      h = next;
    }
    if (degree(start) != 2)
    {
      chain.first = start;
      chain.last = v;
    }
    chain.jaggedness = chain.length / std::max(steppedLength(path), 1e-12 * chain.length);
    chains_.push_back(std::move(chain));
  }

  /// Length of the polyline through points of the path that are s apart along it.
  double steppedLength(const std::vector<Index>& path) const
  {
    double sum = 0;
    double walked = 0;
    Vector3 last = mesh_.position[path.front()];
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
    {
      const Vector3& a = mesh_.position[path[i]];
      const Vector3& b = mesh_.position[path[i + 1]];
      const double length = (b - a).norm();
      double used = 0;
      while (walked + length - used >= edgeLength_)
      {
        used += edgeLength_ - walked;
        walked = 0;
        const Vector3 point = a + (b - a) * (used / length);
        sum += (point - last).norm();
        last = point;
      }
      walked += length - used;
    }
    return sum + (mesh_.position[path.back()] - last).norm();
  }

  const Mesh& mesh_;
  double edgeLength_;
  std::vector<Index> offset_;
  std::vector<Index> incident_;
  std::vector<Chain> chains_;
};

/// Components of chains that share nodes.
std::vector<Index> chainComponents(const Mesh& mesh, const std::vector<Chain>& chains)
{
  std::vector<Index> parent(mesh.vertexCount());
  std::iota(parent.begin(), parent.end(), Index{ 0 });
  const auto root = [&](Index v)
  {
    while (parent[v] != v)
    {
      v = parent[v] = parent[parent[v]];
    }
    return v;
  };
  for (const Chain& chain : chains)
  {
    if (chain.first != kInvalidIndex)
    {
      parent[root(chain.first)] = root(chain.last);
    }
  }
  std::vector<Index> component(chains.size());
  for (std::size_t i = 0; i < chains.size(); ++i)
  {
    const Chain& chain = chains[i];
    component[i] =
      root(chain.first == kInvalidIndex ? mesh.origin[chain.halfEdges.front()] : chain.first);
  }
  return component;
}

/// One pass; returns whether anything went.
bool removeOnce(Mesh& mesh, double edgeLength, FeatureFilterReport& report)
{
  const FeatureGraph graph(mesh, edgeLength);
  const std::vector<Chain>& chains = graph.chains();
  const std::vector<Index> component = chainComponents(mesh, chains);
  std::vector<double> total(mesh.vertexCount(), 0);
  std::vector<Index> count(mesh.vertexCount(), 0);
  for (std::size_t i = 0; i < chains.size(); ++i)
  {
    if (chains[i].removable)
    {
      total[component[i]] += chains[i].length;
      ++count[component[i]];
    }
  }
  bool removed = false;
  for (std::size_t i = 0; i < chains.size(); ++i)
  {
    const Chain& chain = chains[i];
    if (!chain.removable)
    {
      continue;
    }
    const bool loop = chain.first == kInvalidIndex;
    const bool dangling = !loop && (graph.endsThere(chain.first) || graph.endsThere(chain.last));
    const bool tangle = total[component[i]] < kShortestMeanChain * edgeLength * count[component[i]];
    if ((loop && chain.length < kShortestLoop * edgeLength) ||
      (dangling &&
        (chain.length < kShortestDangling * edgeLength || chain.jaggedness > kMostJagged)) ||
      tangle)
    {
      unmarkFeatures(mesh, chain.halfEdges);
      report.removedEdges += chain.halfEdges.size();
      removed = true;
    }
  }
  return removed;
}

} // namespace

FeatureFilterReport removeUnresolvedFeatures(Mesh& mesh, double edgeLength)
{
  if (!(edgeLength > 0))
  {
    throw InvalidInput("the edge length for filtering features must be positive");
  }
  FeatureFilterReport report;
  while (removeOnce(mesh, edgeLength, report))
  {
  }
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    report.keptEdges += mesh.isFeature(h) && h < mesh.twin[h];
  }
  return report;
}

std::vector<Index> detectedFeaturesNear(
  const Mesh& mesh, const std::vector<Vector3>& points, double radius)
{
  if (!(radius > 0))
  {
    throw InvalidInput("the radius for removing features must be positive");
  }
  std::vector<Index> found;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (!mesh.isFeature(h) || mesh.isBoundary(h) || mesh.twin[h] < h ||
      (mesh.flags[h] & kRequestedFeature) != 0)
    {
      continue;
    }
    const Vector3& a = mesh.position[mesh.origin[h]];
    const Vector3& b = mesh.position[mesh.target(h)];
    if (std::any_of(points.begin(), points.end(),
          [&](const Vector3& p) { return distanceToSegment(p, a, b) < radius; }))
    {
      found.push_back(h);
    }
  }
  return found;
}

void unmarkFeatures(Mesh& mesh, const std::vector<Index>& halfEdges)
{
  constexpr auto keep = static_cast<std::uint8_t>(~kFeatureEdge);
  for (const Index h : halfEdges)
  {
    mesh.flags[h] &= keep;
    mesh.flags[mesh.twin[h]] &= keep;
  }
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/FeatureFilter.h"

#include "Base/DisjointSets.h"
#include "Base/Error.h"
#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Mesh/Distance.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <unordered_map>
#include <vector>

namespace quadrille
{
namespace
{

/// Over the smallest detail, as the next one.
constexpr double kShortestDangling = 4;
/// Mean width of a patch; there a quad is at least so much narrower than it is long.
constexpr double kThinnestPatch = 0.01;
/// Chains shorter than this part of a patch's longest one are its ends and not its sides.
constexpr double kShortestSide = 0.5;

/// A maximal run of constrained edges between nodes; `ends` is invalid for a closed loop.
struct Chain
{
  std::vector<Index> halfEdges; ///< one of each edge
  double length = 0;
  double sizedLength = 0; ///< length over the size of quads there
  Index first = kInvalidIndex;
  Index last = kInvalidIndex;
  bool removable = true; ///< all of it was detected, none asked for, none on the boundary
};

class FeatureGraph
{
public:
  /// edges: constrainedEdges of the mesh.
  FeatureGraph(const Mesh& mesh, const std::vector<Index>& edges)
    : mesh_(mesh), edges_(edges), at_(edgesAtVertices(mesh, edges))
  {
    traceChains();
  }

  const std::vector<Chain>& chains() const { return chains_; }
  /// A single feature that ends in the surface or on the boundary continues nowhere.
  bool endsThere(Index v) const
  {
    Index features = 0;
    for (const Index* edge = at_.begin(v); edge != at_.end(v); ++edge)
    {
      features += !mesh_.isBoundary(*edge);
    }
    return features == 1;
  }

private:
  void traceChains()
  {
    std::vector<std::uint8_t> done(edges_.size(), 0);
    for (const bool loops : { false, true })
    {
      for (std::size_t i = 0; i < edges_.size(); ++i)
      {
        pollNowAndThen(i);
        const Index h = edges_[i];
        if (done[i] != 0)
        {
          continue;
        }
        const bool startsHere = at_.size(mesh_.origin[h]) != 2;
        const bool endsHere = at_.size(mesh_.target(h)) != 2;
        if (startsHere || endsHere || loops)
        {
          trace(h, startsHere ? mesh_.origin[h] : mesh_.target(h), done);
        }
      }
    }
  }

  void trace(Index h, Index start, std::vector<std::uint8_t>& done)
  {
    Chain chain;
    Index v = start;
    while (true)
    {
      done[indexIn(edges_, h)] = 1;
      chain.halfEdges.push_back(h);
      chain.length += mesh_.edgeVector(h).norm();
      chain.sizedLength += sizedLength(mesh_, h);
      chain.removable =
        chain.removable && !mesh_.isBoundary(h) && (mesh_.flags[h] & kRequestedFeature) == 0;
      v = mesh_.otherEnd(h, v);
      if (at_.size(v) != 2)
      {
        break;
      }
      const Index next = at_.otherThan(v, h);
      if (done[indexIn(edges_, next)] != 0)
      {
        break; // a closed loop without a node
      }
      h = next;
    }
    if (at_.size(start) != 2)
    {
      chain.first = start;
      chain.last = v;
    }
    chains_.push_back(std::move(chain));
  }

  const Mesh& mesh_;
  const std::vector<Index>& edges_;
  Grouped<> at_; ///< edges by vertex
  std::vector<Chain> chains_;
};

/// Chains that hang together at their ends.
struct ChainGroup
{
  Eigen::AlignedBox3d box;
  double length = 0, sizedLength = 0;
  bool removable = true;

  void add(const Mesh& mesh, const Chain& chain)
  {
    for (const Index h : chain.halfEdges)
    {
      box.extend(mesh.position[mesh.origin[h]]);
      box.extend(mesh.position[mesh.target(h)]);
    }
    length += chain.length;
    sizedLength += chain.sizedLength;
    removable = removable && chain.removable;
  }

  /// Over s, times the size there.
  double extent() const { return box.diagonal().norm() * sizedLength / length; }
};

/// For each chain the number of its group.
std::vector<Index> groupsOf(const Mesh& mesh, const std::vector<Chain>& chains)
{
  DisjointSets nodes(mesh.vertexCount(), 1);
  for (const Chain& chain : chains)
  {
    if (chain.first != kInvalidIndex)
    {
      nodes.join(chain.first, chain.last);
    }
  }
  std::vector<Index> group(chains.size());
  std::unordered_map<Index, Index> number;
  for (std::size_t i = 0; i < chains.size(); ++i)
  {
    const Chain& chain = chains[i];
    const bool isLoop = chain.first == kInvalidIndex;
    const Index node = nodes.find(isLoop ? mesh.origin[chain.halfEdges.front()] : chain.first);
    group[i] = number.try_emplace(node, static_cast<Index>(number.size())).first->second;
  }
  return group;
}

/// Chain by chain; returns whether anything went.
bool dropChains(Mesh& mesh, double smallest, const FeatureGraph& graph, FeatureFilterReport& report)
{
  const std::vector<Chain>& chains = graph.chains();
  const std::vector<Index> groupOf = groupsOf(mesh, chains);
  std::vector<ChainGroup> groups(chains.size());
  for (std::size_t i = 0; i < chains.size(); ++i)
  {
    groups[groupOf[i]].add(mesh, chains[i]);
  }
  bool removed = false;
  for (std::size_t i = 0; i < chains.size(); ++i)
  {
    const Chain& chain = chains[i];
    const ChainGroup& group = groups[groupOf[i]];
    const bool isDangling =
      chain.first != kInvalidIndex && (graph.endsThere(chain.first) || graph.endsThere(chain.last));
    const bool isShort = isDangling && chain.sizedLength < kShortestDangling * smallest;
    const bool isSmall = group.removable && group.extent() < smallest;
    if (chain.removable && (isShort || isSmall))
    {
      unmarkFeatures(mesh, chain.halfEdges);
      report.removedEdges += chain.halfEdges.size();
      removed = true;
    }
  }
  return removed;
}

/// Patches, the connected faces between constrained edges, that are thinner than quads can be.
class ThinPatches
{
public:
  /// thinnest: mean width of the others.
  ThinPatches(const Mesh& mesh, double thinnest, const std::vector<Chain>& chains)
    : mesh_(mesh), chains_(chains), patch_(mesh.faceCount(), kInvalidIndex),
      chainOf_(mesh.halfEdgeCount(), kInvalidIndex)
  {
    double longest = 0;
    for (Index c = 0; c < chains.size(); ++c)
    {
      longest += 2 * chains[c].length;
      for (const Index h : chains[c].halfEdges)
      {
        chainOf_[h] = c;
        if (!mesh.isBoundary(h))
        {
          chainOf_[mesh.twin[h]] = c;
        }
      }
    }
    const double largest = 0.5 * thinnest * longest; // a thin one has no more area than this
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (mesh.isConstrained(h) && patch_[Mesh::face(h)] == kInvalidIndex)
      {
        grow(Mesh::face(h), largest, thinnest);
      }
    }
  }

  /// For each of these patches the bluntest of its sides that has another patch beyond it; never two sides of the same
  /// one, which the first may have made wide enough.
  std::vector<Index> chainsToDrop() const
  {
    std::vector<Index> result;
    std::vector<std::uint8_t> touched(isThin_.size(), 0);
    for (const Thin& thin : thin_)
    {
      if (touched[thin.patch] == 0)
      {
        dropOne(thin, touched, result);
      }
    }
    return result;
  }

private:
  struct Thin
  {
    Index patch;
    std::vector<Index> border; ///< constrained half-edges of its faces
  };

  void grow(Index seed, double largest, double thinnest)
  {
    const Index id = static_cast<Index>(isThin_.size());
    std::vector<Index> faces{ seed };
    Thin thin{ id, {} };
    double area = 0, perimeter = 0;
    patch_[seed] = id;
    bool large = false;
    for (std::size_t i = 0; i < faces.size() && !large; ++i)
    {
      pollNowAndThen(i);
      const Index f = faces[i];
      area += sizedArea(mesh_, f);
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        if (mesh_.isConstrained(h))
        {
          thin.border.push_back(h);
          perimeter += sizedLength(mesh_, h);
          continue;
        }
        const Index next = Mesh::face(mesh_.twin[h]);
        // What reaches a patch that was left off as too large is a part of it.
        large = large || (patch_[next] != kInvalidIndex && patch_[next] != id);
        if (patch_[next] == kInvalidIndex)
        {
          patch_[next] = id;
          faces.push_back(next);
        }
      }
      large = large || area > largest;
    }
    isThin_.push_back(!large && 2 * area < thinnest * perimeter ? 1 : 0);
    if (isThin_.back() != 0)
    {
      thin_.push_back(std::move(thin));
    }
  }

  void dropOne(
    const Thin& thin, std::vector<std::uint8_t>& touched, std::vector<Index>& result) const
  {
    std::vector<Index> sides;
    double longest = 0;
    for (const Index h : thin.border)
    {
      longest = std::max(longest, chains_[chainOf_[h]].length);
      if (chains_[chainOf_[h]].removable && neighbour(h) != thin.patch)
      {
        sides.push_back(chainOf_[h]);
      }
    }
    sortUnique(sides);
    Index best = kInvalidIndex;
    double bluntest = kInfinity;
    for (const Index c : sides)
    {
      const bool isEnd = chains_[c].length < kShortestSide * longest;
      const double sharpness = isEnd ? bluntest : sharpnessOf(chains_[c]);
      if (sharpness < bluntest)
      {
        best = c;
        bluntest = sharpness;
      }
    }
    if (best == kInvalidIndex)
    {
      return;
    }
    // What is wide is not made wide by this.
    std::vector<Index> joined;
    for (const Index h : chains_[best].halfEdges)
    {
      for (const Index p : { patch_[Mesh::face(h)], neighbour(h) })
      {
        if (isThin_[p] != 0)
        {
          joined.push_back(p);
        }
      }
    }
    if (std::none_of(joined.begin(), joined.end(), [&](Index p) { return touched[p] != 0; }))
    {
      result.push_back(best);
      for (const Index p : joined)
      {
        touched[p] = 1;
      }
    }
  }

  Index neighbour(Index h) const { return patch_[Mesh::face(mesh_.twin[h])]; }

  Vector3 normal(Index f) const { return mesh_.doubleAreaNormal(f).normalized(); }

  /// Mean angle between the normals on both sides.
  double sharpnessOf(const Chain& chain) const
  {
    double sum = 0;
    for (const Index h : chain.halfEdges)
    {
      const double cosine = normal(Mesh::face(h)).dot(normal(Mesh::face(mesh_.twin[h])));
      sum += std::acos(std::clamp(cosine, -1.0, 1.0)) * mesh_.edgeVector(h).norm();
    }
    return sum / chain.length;
  }

  const Mesh& mesh_;
  const std::vector<Chain>& chains_;
  std::vector<Index> patch_;         ///< #F; kInvalidIndex where no patch was grown
  std::vector<Index> chainOf_;       ///< #H
  std::vector<std::uint8_t> isThin_; ///< #patches
  std::vector<Thin> thin_;
};

bool dropAlongThinPatches(
  Mesh& mesh, double smallest, const std::vector<Chain>& chains, FeatureFilterReport& report)
{
  const ThinPatches patches(mesh, kThinnestPatch * smallest, chains);
  const std::vector<Index> drop = patches.chainsToDrop();
  for (const Index c : drop)
  {
    unmarkFeatures(mesh, chains[c].halfEdges);
    report.removedEdges += chains[c].halfEdges.size();
  }
  return !drop.empty();
}

/// One pass; returns whether anything went. Most scans have nothing to drop, and patches take memory for each
/// half-edge. edges: constrainedEdges of the mesh.
bool removeOnce(
  Mesh& mesh, double smallest, const std::vector<Index>& edges, FeatureFilterReport& report)
{
  if (std::none_of(edges.begin(), edges.end(), [&](Index h) { return isDetectedFeature(mesh, h); }))
  {
    return false;
  }
  const FeatureGraph graph(mesh, edges);
  const std::vector<Chain>& chains = graph.chains();
  const bool any =
    std::any_of(chains.begin(), chains.end(), [](const Chain& chain) { return chain.removable; });
  return any &&
    (dropChains(mesh, smallest, graph, report) ||
      dropAlongThinPatches(mesh, smallest, chains, report));
}

/// Whether a curve of features passes a place within a distance, and is nowhere farther from another one.
bool runsAlong(
  const Mesh& mesh, const Chain& chain, const Chain& other, const Vector3& place, double within)
{
  const auto isNear = [&](const Chain& curve, const Vector3& p)
  {
    return std::any_of(curve.halfEdges.begin(), curve.halfEdges.end(),
      [&](Index h)
      {
        return distanceToSegment(p, mesh.position[mesh.origin[h]], mesh.position[mesh.target(h)]) <=
          within;
      });
  };
  return isNear(chain, place) &&
    std::all_of(chain.halfEdges.begin(), chain.halfEdges.end(),
      [&](Index h)
      {
        return !mesh.isBoundary(h) && isNear(other, mesh.position[mesh.origin[h]]) &&
          isNear(other, mesh.position[mesh.target(h)]);
      });
}

} // namespace

FeatureFilterReport removeUnresolvedFeatures(Mesh& mesh, double smallest, int threads)
{
  if (!(smallest >= 0))
  {
    throw InvalidInput("the smallest detail of features must not be negative");
  }
  FeatureFilterReport report;
  std::vector<Index> edges = constrainedEdges(mesh, threads);
  while (removeOnce(mesh, smallest, edges, report))
  {
    eraseIf(edges, [&](Index h) { return !mesh.isConstrained(h); });
  }
  report.keptEdges = static_cast<std::size_t>(
    std::count_if(edges.begin(), edges.end(), [&](Index h) { return mesh.isFeature(h); }));
  return report;
}

bool hasDetectedFeature(const Mesh& mesh)
{
  constexpr std::uint8_t kFeatureBits = kFeatureEdge | kRequestedFeature;
  return std::any_of(mesh.flags.begin(), mesh.flags.end(),
    [](std::uint8_t flags) { return (flags & kFeatureBits) == kFeatureEdge; });
}

bool isDetectedFeature(const Mesh& mesh, Index h)
{
  return mesh.isFeature(h) && !mesh.isBoundary(h) && h < mesh.twin[h] &&
    (mesh.flags[h] & kRequestedFeature) == 0;
}

std::vector<Index> featuresNear(const Mesh& mesh, const std::vector<Vector3>& points, double radius)
{
  if (!(radius > 0))
  {
    throw InvalidInput("the radius for removing features must be positive");
  }
  std::vector<Index> found;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (!isDetectedFeature(mesh, h))
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

std::vector<ClearedFeature> clearFeatures(
  Mesh& mesh, const std::vector<Vector3>& places, double within, double beside)
{
  std::vector<ClearedFeature> cleared;
  const std::vector<Index> edges = constrainedEdges(mesh);
  const FeatureGraph graph(mesh, edges);
  const std::vector<Chain>& chains = graph.chains();
  std::vector<const Chain*> gone; // which are no boundary: that meets features at nodes only
  for (const Vector3& place : places)
  {
    ClearedFeature& found = cleared.emplace_back();
    found.distance = kInfinity;
    const Chain* nearest = nullptr;
    for (const Chain& chain : chains)
    {
      for (const Index h : chain.halfEdges)
      {
        const Vector3& a = mesh.position[mesh.origin[h]];
        const Vector3& b = mesh.position[mesh.target(h)];
        const double distance =
          mesh.isBoundary(h) ? found.distance : distanceToSegment(place, a, b);
        if (distance < found.distance)
        {
          found.distance = distance;
          found.nearest = nearestOnSegment(place, a, b);
          nearest = &chain;
        }
      }
    }
    if (nearest != nullptr && found.distance <= within)
    {
      found.length = nearest->length;
      gone.push_back(nearest);
      for (const Chain& chain : chains)
      {
        if (&chain != nearest && runsAlong(mesh, chain, *nearest, place, beside))
        {
          ++found.beside;
          gone.push_back(&chain);
        }
      }
    }
  }
  for (const Chain* chain : gone)
  {
    unmarkFeatures(mesh, chain->halfEdges, kFeatureEdge | kRequestedFeature);
  }
  return cleared;
}

std::string inEdgeLengths(double length)
{
  std::ostringstream text;
  text.precision(length < 10 ? 2 : length < 1000 ? 3 : 6);
  text << (length < 1000 ? length : std::round(length));
  return text.str();
}

void unmarkFeatures(Mesh& mesh, const std::vector<Index>& halfEdges, std::uint8_t flags)
{
  const auto keep = static_cast<std::uint8_t>(~flags);
  for (const Index h : halfEdges)
  {
    mesh.flags.edit()[h] &= keep;
    mesh.flags.edit()[mesh.twin[h]] &= keep;
  }
}

} // namespace quadrille

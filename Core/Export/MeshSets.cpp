// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/MeshSets.h"

#include "Base/Angles.h"
#include "Base/LargeArray.h"
#include "Base/Lists.h"
#include "Export/ElementMesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace quadrille
{

namespace
{

class ElementEdges
{
public:
  /// Linear for bounded valence. Looks out for a stop. The mesh must outlive it and be valid.
  explicit ElementEdges(const ElementMesh& mesh);

  Index halfEdgeCount() const { return static_cast<Index>(twin_.size()); }
  Index start(Index h) const { return mesh_.corner(h / 4, h % 4); }
  Index end(Index h) const { return mesh_.corner(h / 4, h % 4 + 1); }
  Index otherEnd(Index h, Index node) const { return start(h) == node ? end(h) : start(h); }
  /// The same edge in the other element; kInvalidIndex where there is none, or more than one.
  Index twin(Index h) const { return twin_[h]; }
  bool isBoundary(Index h) const { return (kinds_[h] & kBoundary) != 0; }
  /// On a feature and not on the boundary. An edge of more than two elements counts as one.
  bool isFeature(Index h) const { return (kinds_[h] & kFeature) != 0; }
  /// Whether it is the lowest half-edge of its edge, so that each edge is visited once.
  bool isLowest(Index h) const { return (kinds_[h] & kLowestHalfEdge) != 0; }
  /// The other side of the same element at one end of h.
  Index otherSide(Index h, Index node) const;

private:
  enum EdgeFlag : std::uint8_t
  {
    kBoundary = 1,
    kFeature = 2,
    kLowestHalfEdge = 4
  };

  void joinRun(const Index* begin, const Index* end);

  const ElementMesh& mesh_;
  std::vector<Index> twin_;
  std::vector<std::uint8_t> kinds_;
};

ElementEdges::ElementEdges(const ElementMesh& mesh) : mesh_(mesh)
{
  const std::size_t count = 4 * mesh.elementCount();
  growLarge(twin_, count, kInvalidIndex);
  growLarge(kinds_, count, std::uint8_t{ 0 });
  const Grouped<> byLowerNode(mesh.nodes.size(),
    [this](const auto& visit)
    {
      for (Index h = 0; h < halfEdgeCount(); ++h)
      {
        pollNowAndThen(h);
        visit(std::min(start(h), end(h)), h);
      }
    });
  const auto key = [this](Index h) { return std::max(start(h), end(h)); };
  std::vector<Index> bucket;
  for (std::size_t v = 0; v < mesh.nodes.size(); ++v)
  {
    pollNowAndThen(v);
    bucket.assign(byLowerNode.begin(v), byLowerNode.end(v));
    std::sort(bucket.begin(), bucket.end(),
      [&](Index a, Index b) { return std::make_pair(key(a), a) < std::make_pair(key(b), b); });
    const Index* const bucketEnd = bucket.data() + bucket.size();
    for (const Index* run = bucket.data(); run != bucketEnd;)
    {
      const Index* runEnd =
        std::find_if(run, bucketEnd, [&](Index h) { return key(h) != key(*run); });
      joinRun(run, runEnd);
      run = runEnd;
    }
  }
}

/// Half-edges of one edge, the lowest first.
void ElementEdges::joinRun(const Index* begin, const Index* end)
{
  const auto count = end - begin;
  bool feature = count > 2;
  for (const Index* h = begin; h != end; ++h)
  {
    feature = feature ||
      (!mesh_.featureEdges.empty() && ((mesh_.featureEdges[*h / 4] >> (*h % 4)) & 1) != 0);
  }
  if (count == 2)
  {
    twin_[begin[0]] = begin[1];
    twin_[begin[1]] = begin[0];
  }
  for (const Index* h = begin; h != end; ++h)
  {
    kinds_[*h] = static_cast<std::uint8_t>((count == 1   ? kBoundary
                                               : feature ? kFeature
                                                         : 0) |
      (h == begin ? kLowestHalfEdge : 0));
  }
}

Index ElementEdges::otherSide(Index h, Index node) const
{
  const Index side = h % 4;
  return h - side + (start(h) == node ? (side + 3) % 4 : (side + 1) % 4);
}

std::string defaultPatchName(std::int64_t number)
{
  // Without the sign of the text, as -number does not exist for the lowest one.
  return number < 0 ? "PATCH_MINUS_" + std::to_string(number).substr(1)
                    : "PATCH_" + std::to_string(number);
}

std::vector<ElementSet> patchSets(const ElementMesh& mesh)
{
  std::vector<Index> order(mesh.patches.size());
  std::iota(order.begin(), order.end(), Index{ 0 });
  std::stable_sort(order.begin(), order.end(),
    [&](Index a, Index b) { return mesh.patches[a].number < mesh.patches[b].number; });
  std::map<std::string, Index> setOfName;
  std::vector<ElementSet> sets;
  std::vector<Index> setOf(mesh.patches.size());
  for (const Index p : order)
  {
    const MeshPatch& patch = mesh.patches[p];
    const std::string name = patch.name.empty() ? defaultPatchName(patch.number) : patch.name;
    const auto [found, isNew] = setOfName.emplace(name, static_cast<Index>(sets.size()));
    if (isNew)
    {
      sets.push_back({ name, patch.number, {}, false });
    }
    setOf[p] = found->second;
    sets[found->second].isNamed = sets[found->second].isNamed || !patch.name.empty();
  }
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    pollNowAndThen(e);
    sets[setOf[mesh.patch(e)]].elements.push_back(static_cast<Index>(e));
  }
  eraseIf(sets, [](const ElementSet& set) { return set.elements.empty(); });
  return sets;
}

//------------------------------------------------------------------------------
/// The boundary and the features as a graph, its corners, and its chains.
class SetNetwork
{
public:
  SetNetwork(const ElementMesh& mesh, MeshSets& sets)
    : mesh_(mesh), setOfElement_(patchSetOfElements(mesh, sets)), edges_(mesh), sets_(sets)
  {
    collect();
    findCorners();
    growLarge(done_, edges_.halfEdgeCount(), std::uint8_t{ 0 });
    trace(
      "BOUNDARY_", sets.boundaries, [this](Index h) { return edges_.isBoundary(h); },
      [this](Index h, Index node) { return nextOnBoundary(h, node); });
    trace(
      "CURVE_", sets.curves, [this](Index h) { return edges_.isFeature(h) && edges_.isLowest(h); },
      [this](Index h, Index node) { return nextOnFeature(h, node); });
    gatherNamed();
  }

private:
  /// Network edges at a node; `count` may be more than are kept.
  struct AtNode
  {
    Index count = 0;
    Index first = kInvalidIndex,
          second = kInvalidIndex; ///< half-edges, each the lowest of its edge
  };

  bool isInNetwork(Index h) const { return edges_.isBoundary(h) || edges_.isFeature(h); }

  /// Which of the mesh's curveNames the edge is of.
  Index nameOf(Index h) const
  {
    if (mesh_.curveOf.empty())
    {
      return kInvalidIndex;
    }
    const Index twin = edges_.twin(h);
    return mesh_.curveOf[h] != kInvalidIndex || twin == kInvalidIndex ? mesh_.curveOf[h]
                                                                      : mesh_.curveOf[twin];
  }

  void collect()
  {
    growLarge(elementsAt_, mesh_.nodes.size(), Index{ 0 });
    for (Index h = 0; h < edges_.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      ++elementsAt_[edges_.start(h)];
      if (!edges_.isLowest(h) || !isInNetwork(h))
      {
        continue;
      }
      for (const Index node : { edges_.start(h), edges_.end(h) })
      {
        AtNode& at = at_[node];
        (at.count == 0 ? at.first : at.second) = h;
        ++at.count;
      }
    }
  }

  double bend(Index node, const AtNode& at) const
  {
    const Vector3& p = mesh_.nodes[node];
    const Vector3 in = p - mesh_.nodes[edges_.otherEnd(at.first, node)];
    const Vector3 out = mesh_.nodes[edges_.otherEnd(at.second, node)] - p;
    return std::atan2(in.cross(out).norm(), in.dot(out));
  }

  /// From an edge at the node through elements to the next one that `ends` holds for, or that goes no further: that one
  /// and how many elements are between; none where an element comes again.
  template <class Ends>
  std::optional<std::pair<Index, Index>> across(Index h, Index node, const Ends& ends) const
  {
    Index side = edges_.otherSide(h, node);
    for (Index count = 1; count <= elementsAt_[node]; ++count)
    {
      if (ends(side) || edges_.twin(side) == kInvalidIndex)
      {
        return std::make_pair(side, count);
      }
      side = edges_.otherSide(edges_.twin(side), node);
    }
    return std::nullopt;
  }

  bool goesStraightOn(Index node, const AtNode& at) const
  {
    if (edges_.isBoundary(at.first))
    {
      return elementsAt_[node] == 2;
    }
    const auto found = across(at.first, node, [this](Index h) { return isInNetwork(h); });
    return found && found->second == 2 && elementsAt_[node] == 4;
  }

  void findCorners()
  {
    std::map<Index, std::string> names; // by ids of nodes
    for (const auto& [node, at] : at_)
    {
      const bool isEnd = at.count != 2 ||
        edges_.isBoundary(at.first) != edges_.isBoundary(at.second) ||
        nameOf(at.first) != nameOf(at.second);
      if (isEnd || (bend(node, at) > kCornerAngle && !goesStraightOn(node, at)))
      {
        names[node];
      }
    }
    for (const NamedNode& named : mesh_.namedNodes)
    {
      names[named.node] = named.name;
    }
    for (const auto& [node, name] : names)
    {
      cornerOf_[node] = static_cast<Index>(sets_.corners.size());
      const std::string number = std::to_string(sets_.corners.size() + 1);
      sets_.corners.push_back({ name.empty() ? "CORNER_" + number : name, node });
    }
  }

  Index corner(Index node) const
  {
    const auto found = cornerOf_.find(node);
    return found == cornerOf_.end() ? kInvalidIndex : found->second;
  }

  /// The half-edge of the edge that is kept for `done_` and in sides.
  Index lowest(Index h) const
  {
    return edges_.twin(h) == kInvalidIndex ? h : std::min(h, edges_.twin(h));
  }

  /// The boundary edge after h at the node, round the elements between them; none at a place that is no manifold.
  std::optional<Index> nextOnBoundary(Index h, Index node) const
  {
    const auto found = across(h, node, [this](Index side) { return edges_.isBoundary(side); });
    return found && edges_.isBoundary(found->first) ? std::optional(found->first) : std::nullopt;
  }

  /// The other feature edge at a node that is no corner.
  std::optional<Index> nextOnFeature(Index h, Index node) const
  {
    if (corner(node) != kInvalidIndex)
    {
      return std::nullopt;
    }
    const AtNode& at = at_.at(node);
    return lowest(at.first) == lowest(h) ? at.second : at.first;
  }

  /// Edges one after the other and the nodes before each of them and behind the last.
  struct Walk
  {
    std::vector<Index> halfEdges;
    std::vector<Index> nodes;
    bool closed = false;
  };

  template <class Next>
  Walk follow(Index first, Index from, const Next& next)
  {
    Walk walk{ {}, { from }, false };
    for (std::optional<Index> h = first; h;)
    {
      pollNowAndThen(walk.nodes.size());
      done_[lowest(*h)] = 1;
      walk.halfEdges.push_back(*h);
      walk.nodes.push_back(edges_.otherEnd(*h, walk.nodes.back()));
      h = next(*h, walk.nodes.back());
      if (h && lowest(*h) == lowest(first))
      {
        walk.closed = true;
        walk.nodes.pop_back();
        break;
      }
    }
    return walk;
  }

  /// Also what lies before the first edge, where it does not close.
  template <class Next>
  Walk followBothWays(Index first, const Next& next)
  {
    Walk walk = follow(first, edges_.start(first), next);
    if (walk.closed)
    {
      return walk;
    }
    const Walk back = follow(first, edges_.end(first), next);
    Walk whole;
    whole.nodes.assign(back.nodes.rbegin(), back.nodes.rend() - 1);
    whole.halfEdges.assign(back.halfEdges.rbegin(), back.halfEdges.rend() - 1);
    whole.nodes.insert(whole.nodes.end(), walk.nodes.begin() + 1, walk.nodes.end());
    append(whole.halfEdges, walk.halfEdges);
    return whole;
  }

  /// Begins a closed walk at its first corner, if it has one.
  void rotateToCorner(Walk& walk) const
  {
    const auto found = std::find_if(walk.nodes.begin(), walk.nodes.end(),
      [this](Index node) { return corner(node) != kInvalidIndex; });
    if (found != walk.nodes.end())
    {
      const auto by = found - walk.nodes.begin();
      std::rotate(walk.nodes.begin(), found, walk.nodes.end());
      std::rotate(walk.halfEdges.begin(), walk.halfEdges.begin() + by, walk.halfEdges.end());
    }
  }

  void addEdge(EdgeChain& chain, Index h) const
  {
    const Index kept = lowest(h);
    chain.sides.push_back({ kept / 4, kept % 4 });
    if (mesh_.nodesPerElement > 4)
    {
      chain.middles.push_back(mesh_.middle(kept / 4, kept % 4));
    }
    const Index here = setOfElement_[kept / 4];
    const Index twin = edges_.twin(kept);
    if (twin == kInvalidIndex || setOfElement_[twin / 4] != here)
    {
      chain.patches.push_back(here);
      chain.patches.push_back(twin == kInvalidIndex ? here : setOfElement_[twin / 4]);
    }
  }

  /// Chains of a walk, cut at corners.
  void addChains(Walk walk, CurveSet& curve)
  {
    if (walk.closed)
    {
      rotateToCorner(walk);
    }
    const bool isRing = walk.closed && corner(walk.nodes.front()) == kInvalidIndex;
    if (walk.closed && !isRing)
    {
      walk.nodes.push_back(walk.nodes.front());
    }
    EdgeChain chain;
    chain.closed = isRing;
    const auto finish = [&]
    {
      sortUnique(chain.patches);
      if (!isRing)
      {
        chain.startCorner = corner(chain.nodes.front());
        chain.endCorner = corner(chain.nodes.back());
      }
      curve.chains.push_back(static_cast<Index>(sets_.chains.size()));
      sets_.chains.push_back(std::move(chain));
    };
    chain.nodes.push_back(walk.nodes.front());
    for (std::size_t i = 0; i < walk.halfEdges.size(); ++i)
    {
      addEdge(chain, walk.halfEdges[i]);
      if (isRing && i + 1 == walk.halfEdges.size())
      {
        break;
      }
      chain.nodes.push_back(walk.nodes[i + 1]);
      if (corner(walk.nodes[i + 1]) != kInvalidIndex && i + 1 < walk.halfEdges.size())
      {
        finish();
        chain = EdgeChain();
        chain.nodes.push_back(walk.nodes[i + 1]);
      }
    }
    finish();
  }

  /// One curve for each edge that `begins` holds for and no curve before has.
  template <class Begins, class Next>
  void trace(
    const char* name, std::vector<CurveSet>& curves, const Begins& begins, const Next& next)
  {
    for (Index h = 0; h < edges_.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (begins(h) && !done_[h])
      {
        CurveSet curve{ name + std::to_string(curves.size() + 1), {} };
        addChains(followBothWays(h, next), curve);
        curves.push_back(std::move(curve));
      }
    }
  }

  /// Chains with names become sets of their own, in the order of the names; the other curves are numbered anew.
  void gatherNamed()
  {
    if (mesh_.curveOf.empty())
    {
      return;
    }
    std::vector<CurveSet> named(mesh_.curveNames.size());
    for (std::size_t c = 0; c < sets_.chains.size(); ++c)
    {
      const ElementSide& side = sets_.chains[c].sides.front(); // the chain ends where the name does
      const Index name = nameOf(4 * side.element + side.side);
      if (name != kInvalidIndex)
      {
        named[name].chains.push_back(static_cast<Index>(c));
      }
    }
    std::vector<std::uint8_t> isNamed(sets_.chains.size(), 0);
    for (std::size_t n = 0; n < named.size(); ++n)
    {
      named[n].name = mesh_.curveNames[n];
      named[n].isNamed = true;
      for (const Index c : named[n].chains)
      {
        isNamed[c] = 1;
      }
    }
    eraseIf(
      sets_.curves, [&](const CurveSet& curve) { return isNamed[curve.chains.front()] != 0; });
    for (std::size_t i = 0; i < sets_.curves.size(); ++i)
    {
      sets_.curves[i].name = "CURVE_" + std::to_string(i + 1);
    }
    eraseIf(named, [](const CurveSet& curve) { return curve.chains.empty(); });
    append(sets_.curves, named);
  }

  const ElementMesh& mesh_;
  const std::vector<Index> setOfElement_;
  const ElementEdges edges_;
  MeshSets& sets_;
  std::vector<Index> elementsAt_; ///< #nodes
  std::map<Index, AtNode> at_;    ///< nodes of the network
  std::map<Index, Index> cornerOf_;
  std::vector<std::uint8_t> done_; ///< by lowest half-edge
};

} // namespace

MeshSets setsOf(const ElementMesh& mesh)
{
  requireValid(mesh);
  MeshSets sets;
  sets.patches = patchSets(mesh);
  SetNetwork network(mesh, sets);
  return sets;
}

std::size_t MeshSets::edgeCount() const
{
  return std::accumulate(chains.begin(), chains.end(), std::size_t{ 0 },
    [](std::size_t count, const EdgeChain& chain) { return count + chain.sides.size(); });
}

std::vector<Index> patchSetOfElements(const ElementMesh& mesh, const MeshSets& sets)
{
  std::vector<Index> setOf;
  growLarge(setOf, mesh.elementCount(), Index{ 0 });
  for (std::size_t i = 0; i < sets.patches.size(); ++i)
  {
    for (const Index e : sets.patches[i].elements)
    {
      setOf[e] = static_cast<Index>(i);
    }
  }
  return setOf;
}

std::vector<Index> nodesOf(const MeshSets& sets, const CurveSet& curve)
{
  std::vector<Index> nodes;
  std::set<Index> corners; // a loop may come through one more than once
  for (const Index c : curve.chains)
  {
    const EdgeChain& chain = sets.chains[c];
    for (std::size_t i = 0; i < chain.nodes.size(); ++i)
    {
      const bool isEnd = !chain.closed && (i == 0 || i + 1 == chain.nodes.size());
      if (!isEnd || corners.insert(chain.nodes[i]).second)
      {
        nodes.push_back(chain.nodes[i]);
      }
      if (i < chain.middles.size())
      {
        nodes.push_back(chain.middles[i]);
      }
    }
  }
  return nodes;
}

std::vector<Index> nodesOf(const ElementMesh& mesh, const ElementSet& patch)
{
  std::vector<Index> nodes;
  nodes.reserve(patch.elements.size() * static_cast<std::size_t>(mesh.nodesPerElement));
  for (std::size_t i = 0; i < patch.elements.size(); ++i)
  {
    pollNowAndThen(i);
    const Index* const element = mesh.element(patch.elements[i]);
    nodes.insert(nodes.end(), element, element + mesh.nodesPerElement);
  }
  sortUnique(nodes);
  return nodes;
}

std::vector<ElementSide> sidesOf(const MeshSets& sets, const CurveSet& curve)
{
  std::vector<ElementSide> sides;
  for (const Index c : curve.chains)
  {
    append(sides, sets.chains[c].sides);
  }
  return sides;
}

} // namespace quadrille

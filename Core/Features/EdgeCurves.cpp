// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/EdgeCurves.h"

#include "Base/Progress.h"

#include <unordered_map>

namespace quadrille
{
namespace
{

/// Edges and the network of constrained ones, at the vertices of the former.
class EdgeNetwork
{
public:
  EdgeNetwork(const Mesh& mesh, const std::vector<Index>& halfEdges)
  {
    for (const Index h : halfEdges)
    {
      at_[mesh.origin[h]].edges.push_back(h);
      at_[mesh.target(h)].edges.push_back(h);
    }
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (mesh.isConstrained(h))
      {
        markEnd(mesh.origin[h]);
        markEnd(mesh.target(h));
      }
    }
  }

  /// The edge beyond v of the same curve; kInvalidIndex where it ends.
  Index onwards(Index h, Index v) const
  {
    const Meeting& meeting = at_.at(v);
    if (meeting.onNetwork || meeting.edges.size() != 2)
    {
      return kInvalidIndex;
    }
    return meeting.edges[0] == h ? meeting.edges[1] : meeting.edges[0];
  }

private:
  struct Meeting
  {
    std::vector<Index> edges;
    bool onNetwork = false; ///< a feature or boundary passes here
  };

  void markEnd(Index v)
  {
    const auto found = at_.find(v);
    if (found != at_.end())
    {
      found->second.onNetwork = true;
    }
  }

  std::unordered_map<Index, Meeting> at_; // only looked up, so its order does not matter
};

/// The edges of the curve through `seed`, in their order.
std::vector<Index> curveThrough(
  const Mesh& mesh, const EdgeNetwork& network, Index seed, std::unordered_map<Index, bool>& done)
{
  std::vector<Index> ways[2];
  for (int side = 0; side < 2; ++side)
  {
    Index h = seed;
    Index v = side == 0 ? mesh.origin[seed] : mesh.target(seed);
    while (true)
    {
      const Index next = network.onwards(h, v);
      if (next == kInvalidIndex || done[next])
      {
        break;
      }
      done[next] = true;
      ways[side].push_back(next);
      v = mesh.otherEnd(next, v);
      h = next;
    }
  }
  std::vector<Index> curve(ways[0].rbegin(), ways[0].rend());
  curve.push_back(seed);
  curve.insert(curve.end(), ways[1].begin(), ways[1].end());
  return curve;
}

} // namespace

std::vector<std::vector<Index>> curvesOfEdges(const Mesh& mesh, const std::vector<Index>& halfEdges)
{
  std::vector<std::vector<Index>> curves;
  if (halfEdges.empty())
  {
    return curves;
  }
  const EdgeNetwork network(mesh, halfEdges);
  std::unordered_map<Index, bool> done;
  for (const Index seed : halfEdges)
  {
    if (!done[seed])
    {
      done[seed] = true;
      curves.push_back(curveThrough(mesh, network, seed, done));
    }
  }
  return curves;
}

} // namespace quadrille

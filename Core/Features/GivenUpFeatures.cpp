// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/GivenUpFeatures.h"

#include "Base/Error.h"
#include "Base/Progress.h"
#include "Mesh/Sizing.h"

#include <unordered_map>

namespace quadrille
{
namespace
{

/// Lost features and what is left of the network, at the vertices of the lost ones.
class LostNetwork
{
public:
  LostNetwork(const Mesh& mesh, const std::vector<Index>& halfEdges)
  {
    for (const Index h : halfEdges)
    {
      at_[mesh.origin[h]].lost.push_back(h);
      at_[mesh.target(h)].lost.push_back(h);
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

  /// The lost edge beyond v of the same curve; kInvalidIndex where it ends.
  Index onwards(Index h, Index v) const
  {
    const Meeting& meeting = at_.at(v);
    if (meeting.onNetwork || meeting.lost.size() != 2)
    {
      return kInvalidIndex;
    }
    return meeting.lost[0] == h ? meeting.lost[1] : meeting.lost[0];
  }

private:
  struct Meeting
  {
    std::vector<Index> lost;
    bool onNetwork = false; ///< a feature or boundary that stayed passes here
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
std::vector<Index> lostCurve(
  const Mesh& mesh, const LostNetwork& network, Index seed, std::unordered_map<Index, bool>& done)
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

const char* nameOf(FeatureLoss reason)
{
  switch (reason)
  {
    case FeatureLoss::NoCrease:
      return "no crease";
    case FeatureLoss::FailedMap:
      return "failed map";
    case FeatureLoss::MidLine:
      return "mid-line";
    default:
      return "unresolved";
  }
}

std::vector<Index> lostFeatures(const Mesh& mesh, const std::vector<std::uint8_t>& flagsBefore)
{
  if (flagsBefore.size() != mesh.flags.size())
  {
    throw InvalidInput("lost features: flags of another mesh");
  }
  std::vector<Index> lost;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    const bool was = (flagsBefore[h] & kFeatureEdge) != 0;
    if (was && !mesh.isFeature(h) && !mesh.isBoundary(h) && h < mesh.twin[h])
    {
      lost.push_back(h);
    }
  }
  return lost;
}

std::vector<GivenUpCurve> givenUpCurves(
  const Mesh& mesh, const std::vector<Index>& halfEdges, double edgeLength, FeatureLoss reason)
{
  if (!(edgeLength > 0))
  {
    throw InvalidInput("the edge length for telling of features must be positive");
  }
  std::vector<GivenUpCurve> curves;
  if (halfEdges.empty())
  {
    return curves;
  }
  const LostNetwork network(mesh, halfEdges);
  std::unordered_map<Index, bool> done;
  for (const Index seed : halfEdges)
  {
    if (done[seed])
    {
      continue;
    }
    done[seed] = true;
    const std::vector<Index> edges = lostCurve(mesh, network, seed, done);
    GivenUpCurve curve;
    curve.reason = reason;
    curve.edges = edges.size();
    const Index middle = edges[edges.size() / 2];
    curve.place = 0.5 * (mesh.position[mesh.origin[middle]] + mesh.position[mesh.target(middle)]);
    for (const Index h : edges)
    {
      curve.length += mesh.edgeVector(h).norm();
      curve.lengthInQuads += sizedLength(mesh, h) / edgeLength;
    }
    curves.push_back(curve);
  }
  return curves;
}

const char* whyNotFollowed(FeatureLoss reason)
{
  switch (reason)
  {
    case FeatureLoss::NoCrease:
      return "not followed: its curve is no crease as a whole";
    case FeatureLoss::FailedMap:
      return "not followed: with it there was no map, or no quads";
    case FeatureLoss::MidLine:
      return "not followed: it lies in the mirror plane, which quads straddle";
    default:
      return "not followed: below the smallest detail, as an end, a group or a side of a band";
  }
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/AngleStructure.h"

#include "Base/Lists.h"
#include "Base/Progress.h"

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace quadrille
{
namespace
{

// Angles are integers, in degrees, so that the answer is exact; none is below one.
constexpr std::int64_t kQuarterTurn = 90;

// Nodes are triangles, then fans. A triangle above half a turn passes angle on: it lowers its corner at a fan, which
// raises the corner of another triangle there, until a triangle below half a turn takes it.
class AngleTransport
{
public:
  AngleTransport(const Mesh& mesh, const FieldTopology& topology, const std::vector<int>& turns)
    : topology_(topology), faces_(mesh.faceCount()),
      nodes_(faces_ + static_cast<Index>(topology.fans.size())), angle_(mesh.halfEdgeCount()),
      surplus_(faces_, -2 * kQuarterTurn), corners_(topology.fans.size(),
                                             [&](const auto& visit)
                                             {
                                               for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
                                               {
                                                 visit(topology.fanOfCorner[h], h);
                                               }
                                             })
  {
    for (Index i = 0; i < turns.size(); ++i)
    {
      spreadTurns(i, turns[i]);
    }
    for (Index h = 0; h < angle_.size(); ++h)
    {
      surplus_[Mesh::face(h)] += angle_[h];
    }
  }

  // False when a fan is too small even for the smallest angles.
  bool fansFit() const { return fit_; }

  void solve()
  {
    while (buildLevels(true))
    {
      next_.assign(nodes_, 0);
      for (Index f = 0; f < faces_; ++f)
      {
        while (surplus_[f] > 0 && pushFrom(f))
        {
        }
      }
    }
  }

  bool balanced() const
  {
    return std::all_of(surplus_.begin(), surplus_.end(), [](std::int64_t s) { return s == 0; });
  }

  // Flags of the fans that surplus reaches (forward), or from which a deficit is reached.
  std::vector<std::uint8_t> reached(bool forward)
  {
    buildLevels(forward);
    std::vector<std::uint8_t> flags;
    std::transform(level_.begin() + faces_, level_.end(), std::back_inserter(flags),
      [](Index level) { return level != kInvalidIndex ? 1 : 0; });
    return flags;
  }

private:
  Index degree(Index node) const { return node < faces_ ? 3 : corners_.size(node - faces_); }
  Index cornerOf(Index node, Index k) const
  {
    return node < faces_ ? 3 * node + k : corners_.begin(node - faces_)[k];
  }
  Index otherEnd(Index node, Index corner) const
  {
    return node < faces_ ? faces_ + topology_.fanOfCorner[corner] : Mesh::face(corner);
  }

  // Starts from the surface's own angles, scaled to the turns: most triangles are then nearly right.
  void spreadTurns(Index i, int turns)
  {
    const Fan& fan = topology_.fans[i];
    std::int64_t left = kQuarterTurn * turns - fan.corners;
    fit_ = fit_ && left >= 0;
    left = std::max<std::int64_t>(left, 0);
    double angleLeft = fan.angle;
    for (const Index* h = corners_.begin(i); h != corners_.end(i); ++h)
    {
      const double own = topology_.cornerAngle[*h];
      const double share = angleLeft > 0 ? std::min(1.0, own / angleLeft) : 1.0;
      const std::int64_t part = h + 1 == corners_.end(i)
        ? left
        : static_cast<std::int64_t>(share * static_cast<double>(left));
      angle_[*h] = 1 + part;
      left -= part;
      angleLeft -= own;
    }
  }

  // Distances from triangles with surplus (backward: to those with a deficit); whether one with a deficit (a surplus)
  // is reached. Angle leaves a triangle only where its corner can shrink; it may enter anywhere.
  bool buildLevels(bool forward)
  {
    level_.assign(nodes_, kInvalidIndex);
    std::vector<Index> queue =
      idsWhere(faces_, [&](Index f) { return forward ? surplus_[f] > 0 : surplus_[f] < 0; });
    for (const Index f : queue)
    {
      level_[f] = 0;
    }
    bool found = false;
    for (std::size_t i = 0; i < queue.size(); ++i)
    {
      pollNowAndThen(++steps_);
      const Index node = queue[i];
      found = found || (node < faces_ && (forward ? surplus_[node] < 0 : surplus_[node] > 0));
      for (Index k = 0; k < degree(node); ++k)
      {
        const Index corner = cornerOf(node, k);
        const Index other = otherEnd(node, corner);
        const bool isLeaving = (node < faces_) == forward;
        if (level_[other] == kInvalidIndex && (!isLeaving || angle_[corner] > 1))
        {
          level_[other] = level_[node] + 1;
          queue.push_back(other);
        }
      }
    }
    return found;
  }

  // One augmenting path in the level graph from triangle f; false when there is none left.
  bool pushFrom(Index f)
  {
    path_.clear();
    Index node = f;
    while (!(node < faces_ && surplus_[node] < 0))
    {
      pollNowAndThen(++steps_);
      if (next_[node] < degree(node))
      {
        const Index corner = cornerOf(node, next_[node]);
        const Index other = otherEnd(node, corner);
        if (level_[other] == level_[node] + 1 && (node >= faces_ || angle_[corner] > 1))
        {
          path_.push_back(corner);
          node = other;
          continue;
        }
        ++next_[node];
        continue;
      }
      if (path_.empty())
      {
        return false;
      }
      // Dead end: back up, and past the arc that led here.
      node = otherEnd(node, path_.back());
      path_.pop_back();
      ++next_[node];
    }
    std::int64_t amount = std::min(surplus_[f], -surplus_[node]);
    for (std::size_t i = 0; i < path_.size(); i += 2)
    {
      amount = std::min(amount, angle_[path_[i]] - 1);
    }
    for (std::size_t i = 0; i < path_.size(); ++i)
    {
      angle_[path_[i]] += i % 2 == 0 ? -amount : amount;
    }
    surplus_[f] -= amount;
    surplus_[node] += amount;
    return true;
  }

  const FieldTopology& topology_;
  Index faces_;
  Index nodes_;
  std::vector<std::int64_t> angle_;   // #H
  std::vector<std::int64_t> surplus_; // #F, over half a turn
  Grouped<> corners_;                 // by fan
  std::vector<Index> level_;          // #nodes
  std::vector<Index> next_;           // #nodes, next arc to try
  std::vector<Index> path_;           // corners; even ones shrink, odd ones grow
  std::size_t steps_ = 0;             // between looks out for a stop
  bool fit_ = true;
};

} // namespace

AngleStructure findAngleStructure(
  const Mesh& mesh, const FieldTopology& topology, const std::vector<int>& turns)
{
  AngleTransport transport(mesh, topology, turns);
  transport.solve();
  AngleStructure result;
  if (transport.fansFit() && transport.balanced())
  {
    return result;
  }
  result.feasible = false;
  result.tooMany = transport.reached(true);
  result.tooFew = transport.reached(false);
  return result;
}

} // namespace quadrille

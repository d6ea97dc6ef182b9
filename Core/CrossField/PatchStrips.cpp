// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/PatchStrips.h"

#include "Base/StrongComponents.h"
#include "CrossField/TurnRepair.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace quadrille
{
namespace
{

/// A corner's turns may differ by so many quarters from its angle, unless what turns is shorter than an edge of quads:
/// a right angle stays one, and a straight side stays straight.
constexpr double kMostUnnatural = 0.75;

/// One loop of the boundary of a patch.
struct PatchLoop
{
  Index patch = 0;
  std::vector<Index> halfEdges; ///< each ends where the next one begins
  std::vector<Index> corners;   ///< which of these begin at a corner
  std::vector<double> before;   ///< the length of those before each
  double length = 0;
};

/// A quarter turn goes from one corner of a loop to another: all sides between them turn by a quarter.
struct TurnMove
{
  double cost = 0;
  Index loop = 0;
  Index from = 0, to = 0; ///< of its half-edges
  int by = 1;             ///< -1: the other way, and the sides between them turn the other way
};

/// Nodes that the arcs of a node lead to.
struct NextNodes
{
  const Index* first = nullptr;
  Index count = 0;

  Index size() const { return count; }
  Index operator[](Index i) const { return first[i]; }
};

class PatchStrips
{
public:
  explicit PatchStrips(const PatchStripsInput& input)
    : input_(input), mesh_(input.mesh), turns_(input.turns), patch_(regionsOf(input.mesh)),
      isCorner_(mesh_.vertexCount(), 0), turnsAt_(mesh_.vertexCount(), 0),
      isBoundary_(mesh_.vertexCount(), 0), direction_(mesh_.halfEdgeCount(), 0)
  {
    numberPatches();
    findCorners();
    findLoops();
    findFreePatches();
    findDirections();
  }

  /// The number of sides without a strip.
  std::size_t findStrips()
  {
    const Index nodes = 1 + 4 * static_cast<Index>(isFree_.size());
    first_.assign(nodes + 1, 0);
    forArcs([&](Index from, Index /*to*/) { ++first_[from + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    next_.resize(first_.back());
    std::vector<Index> end(first_.begin(), first_.end() - 1);
    forArcs([&](Index from, Index to) { next_[end[from]++] = to; });
    components_ = StrongComponents<NextNodes>(nodes);
    for (Index node = 0; node < nodes; ++node)
    {
      components_.walkFrom(node, [this](Index n) { return nextOf(n); });
    }
    return static_cast<std::size_t>(
      std::count_if(sides_.begin(), sides_.end(), [this](Index h) { return !hasStrip(h); }));
  }

  /// Moves turns until `without`, the number of findStrips(), is 0 or no single move lessens it; whether it was.
  bool lessen(std::size_t& without)
  {
    std::vector<TurnMove> moves = possibleMoves();
    std::sort(moves.begin(), moves.end(),
      [](const TurnMove& a, const TurnMove& b)
      {
        return std::tie(a.cost, a.loop, a.from, a.to, a.by) <
          std::tie(b.cost, b.loop, b.from, b.to, b.by);
      });
    const std::size_t before = without;
    for (TurnMove& move : moves)
    {
      if (without == 0)
      {
        break;
      }
      if (!costOf(move)) // after others
      {
        continue;
      }
      apply(move);
      const std::size_t left = findStrips();
      if (left < without)
      {
        without = left;
        isChanged_[loops_[move.loop].patch] = 1;
        continue;
      }
      move.by = -move.by;
      apply(move);
    }
    findStrips();
    return without < before;
  }

  std::vector<int> sectorTurns() const
  {
    std::vector<int> sectors = input_.sectorTurns;
    sectors.resize(mesh_.halfEdgeCount(), 0);
    for (const PatchLoop& loop : loops_)
    {
      for (const Index i : loop.corners)
      {
        if (isChanged_[loop.patch] != 0)
        {
          sectors[loop.halfEdges[i]] = turnsOf(loop.halfEdges[i]);
        }
      }
    }
    return sectors;
  }

private:
  int turnsOf(Index h) const { return turns_[input_.topology.fanOfCorner[h]]; }

  void numberPatches()
  {
    Index count = 0;
    std::vector<Index> number(patch_.size(), kInvalidIndex); // by the lowest face
    for (Index& patch : patch_)
    {
      Index& known = number[patch];
      known = known == kInvalidIndex ? count++ : known;
      patch = known;
    }
    isFree_.assign(count, 0);
    isChanged_.assign(count, 0);
  }

  void findCorners()
  {
    std::vector<int> sectors(mesh_.vertexCount(), 0);
    const std::vector<Fan>& fans = input_.topology.fans;
    for (std::size_t i = 0; i < fans.size(); ++i)
    {
      const Index v = fans[i].vertex;
      turnsAt_[v] += turns_[i];
      sectors[v] += fans[i].sector ? 1 : 0;
      isCorner_[v] |= fans[i].sector && turns_[i] != 2 ? 1 : 0;
      isBoundary_[v] |= fans[i].sector && mesh_.isBoundary(fans[i].first) ? 1 : 0;
    }
    for (Index v = 0; v < mesh_.vertexCount(); ++v)
    {
      isCorner_[v] |= sectors[v] != (isBoundary_[v] != 0 ? 1 : 2) ? 1 : 0;
    }
  }

  /// The sector at its end begins with it.
  Index nextOnLoop(Index h) const
  {
    return input_.topology.fans[input_.topology.fanOfCorner[Mesh::next(h)]].first;
  }

  void findLoops()
  {
    std::vector<std::uint8_t> seen(mesh_.halfEdgeCount(), 0);
    for (Index first = 0; first < mesh_.halfEdgeCount(); ++first)
    {
      if (!mesh_.isConstrained(first) || seen[first] != 0)
      {
        continue;
      }
      PatchLoop loop;
      loop.patch = patch_[Mesh::face(first)];
      for (Index h = first; seen[h] == 0; h = nextOnLoop(h))
      {
        seen[h] = 1;
        if (isCorner_[mesh_.origin[h]] != 0)
        {
          loop.corners.push_back(static_cast<Index>(loop.halfEdges.size()));
          sides_.push_back(h);
        }
        loop.halfEdges.push_back(h);
        loop.before.push_back(loop.length);
        loop.length += input_.topology.edgeLength[h];
      }
      if (loop.corners.empty())
      {
        sides_.push_back(first);
      }
      loops_.push_back(std::move(loop));
    }
  }

  /// Without irregular vertices the turns of a patch's loops sum up to its Euler characteristic, whose loops are those
  /// of a sphere with as many holes if it has no handle.
  void findFreePatches()
  {
    std::vector<int> sum(isFree_.size(), 0);
    loopsOf_.assign(isFree_.size(), 0);
    const std::vector<Fan>& fans = input_.topology.fans;
    for (std::size_t i = 0; i < fans.size(); ++i)
    {
      isFree_[patch_[Mesh::face(fans[i].first)]] |= !fans[i].sector && turns_[i] != 4 ? 1 : 0;
    }
    for (const PatchLoop& loop : loops_)
    {
      const int turning = std::accumulate(loop.halfEdges.begin(), loop.halfEdges.end(), 0,
        [&](int before, Index h) { return before + 2 - turnsOf(h); });
      isFree_[loop.patch] |= turning % 4 != 0 ? 1 : 0;
      sum[loop.patch] += turning;
      ++loopsOf_[loop.patch];
    }
    for (Index p = 0; p < isFree_.size(); ++p)
    {
      isFree_[p] |= sum[p] != 4 * (2 - loopsOf_[p]) ? 1 : 0;
    }
  }

  /// Of sides in one chart of each patch.
  void findDirections()
  {
    std::vector<std::int8_t> rotation(mesh_.faceCount(), -1);
    std::vector<Index> open;
    for (Index root = 0; root < mesh_.faceCount(); ++root)
    {
      if (rotation[root] >= 0)
      {
        continue;
      }
      rotation[root] = 0;
      open.push_back(root);
      while (!open.empty())
      {
        const Index f = open.back();
        open.pop_back();
        for (Index h = 3 * f; h < 3 * f + 3; ++h)
        {
          if (mesh_.isConstrained(h))
          {
            direction_[h] = static_cast<std::uint8_t>((rotation[f] + input_.alignment[h]) & 3);
          }
          else if (const Index g = Mesh::face(mesh_.twin[h]); rotation[g] < 0)
          {
            rotation[g] = static_cast<std::int8_t>((rotation[f] - input_.matching[h]) & 3);
            open.push_back(g);
          }
        }
      }
    }
  }

  /// In the patch of h, after a side that runs like h turned by so many quarters. 0: anywhere, and outside.
  Index nodeOf(Index h, int turned) const
  {
    const Index p = patch_[Mesh::face(h)];
    return isFree_[p] != 0 ? 0 : 1 + 4 * p + ((direction_[h] + turned) & 3);
  }
  Index nodeBeyond(Index h) const { return mesh_.isBoundary(h) ? 0 : nodeOf(mesh_.twin[h], 0); }

  template <typename Visit>
  void forArcs(const Visit& visit) const
  {
    for (const Index h : sides_)
    {
      visit(nodeOf(h, 2), nodeBeyond(h));
      if (mesh_.isBoundary(h))
      {
        visit(0, nodeOf(h, 0));
      }
    }
  }
  NextNodes nextOf(Index node) const
  {
    return { next_.data() + first_[node], first_[node + 1] - first_[node] };
  }
  bool hasStrip(Index h) const
  {
    return components_.componentOf(nodeOf(h, 2)) == components_.componentOf(nodeBeyond(h));
  }

  /// #patches: where strips come to that begin at a side without any, forwards or backwards.
  std::vector<std::uint8_t> reached() const
  {
    std::vector<std::uint8_t> seen(first_.size() - 1, 0), found(isFree_.size(), 0);
    std::vector<Index> open;
    const auto add = [&](Index node)
    {
      if (node != 0 && seen[node] == 0)
      {
        seen[node] = 1;
        open.push_back(node);
      }
    };
    for (const Index h : sides_)
    {
      if (!hasStrip(h))
      {
        add(nodeBeyond(h));
        add(nodeOf(h, 0)); // backwards all directions are turned round
      }
    }
    while (!open.empty())
    {
      const NextNodes next = nextOf(open.back());
      found[(open.back() - 1) / 4] = 1;
      open.pop_back();
      for (Index i = 0; i < next.size(); ++i)
      {
        add(next[i]);
      }
    }
    return found;
  }

  std::vector<TurnMove> possibleMoves() const
  {
    const std::vector<std::uint8_t> isReached = reached();
    std::vector<TurnMove> moves;
    for (Index l = 0; l < loops_.size(); ++l)
    {
      const PatchLoop& loop = loops_[l];
      for (const Index from : loop.corners)
      {
        for (const Index to : loop.corners)
        {
          // On a disc it is the same whether what lies before or what lies behind turns.
          for (const int by : { 1, -1 })
          {
            TurnMove move{ 0, l, from, to, by };
            if (from == to || isReached[loop.patch] == 0 || (by < 0 && loopsOf_[loop.patch] == 1))
            {
              continue;
            }
            if (const std::optional<double> cost = costOf(move))
            {
              move.cost = *cost;
              moves.push_back(move);
            }
          }
        }
      }
    }
    return moves;
  }

  /// None where it may not be.
  std::optional<double> costOf(const TurnMove& move) const
  {
    const PatchLoop& loop = loops_[move.loop];
    const double between = std::abs(loop.before[move.to] - loop.before[move.from]);
    const bool isShort = std::min(between, loop.length - between) <= input_.length;
    const auto from = costOf(loop.halfEdges[move.from], -move.by, isShort);
    const auto to = costOf(loop.halfEdges[move.to], move.by, isShort);
    return from && to ? std::optional<double>(*from + *to) : std::nullopt;
  }

  /// The change of the squared difference of a corner's turns to its angle.
  std::optional<double> costOf(Index h, int change, bool isShort) const
  {
    const Index fan = input_.topology.fanOfCorner[h];
    const Index v = mesh_.origin[h];
    const int turns = turns_[fan] + change;
    const int atVertex = turnsAt_[v] + change;
    const bool isPossible = turns >= 1 && turns <= turnLimit(input_.topology.fans[fan]) &&
      (change > 0 ? atVertex <= kMostTurns : isBoundary_[v] != 0 || atVertex >= kLeastTurns);
    const bool isHeld = !input_.sectorTurns.empty() && input_.sectorTurns[h] != 0;
    const double before = std::abs(turns_[fan] - input_.natural[fan]);
    const double after = std::abs(turns - input_.natural[fan]);
    if (!isPossible || isHeld || (!isShort && after > std::max(kMostUnnatural, before)))
    {
      return std::nullopt;
    }
    return after * after - before * before;
  }

  void apply(const TurnMove& move)
  {
    const std::vector<Index>& halfEdges = loops_[move.loop].halfEdges;
    const auto change = [&](Index h, int by)
    {
      turns_[input_.topology.fanOfCorner[h]] += by;
      turnsAt_[mesh_.origin[h]] += by;
    };
    change(halfEdges[move.from], -move.by);
    change(halfEdges[move.to], move.by);
    for (Index i = move.from; i != move.to; i = i + 1 < halfEdges.size() ? i + 1 : 0)
    {
      std::uint8_t& direction = direction_[halfEdges[i]];
      direction = static_cast<std::uint8_t>((direction + move.by) & 3);
    }
  }

  /// Of all sectors of a vertex, as valences: a field makes no others unless it has to.
  static constexpr int kLeastTurns = 3;
  static constexpr int kMostTurns = 6;

  const PatchStripsInput& input_;
  const Mesh& mesh_;
  std::vector<int> turns_;               ///< per fan
  std::vector<Index> patch_;             ///< #F
  std::vector<std::uint8_t> isFree_;     ///< per patch: a strip may leave it over any side
  std::vector<std::uint8_t> isChanged_;  ///< per patch
  std::vector<int> loopsOf_;             ///< per patch
  std::vector<std::uint8_t> isCorner_;   ///< #V
  std::vector<int> turnsAt_;             ///< #V
  std::vector<std::uint8_t> isBoundary_; ///< #V
  std::vector<std::uint8_t>
    direction_; ///< #H, quarters, of constrained ones in the chart of their patch
  std::vector<PatchLoop> loops_;
  std::vector<Index> sides_;        ///< the first half-edge of each, on both sides of features
  std::vector<Index> first_, next_; ///< arcs by node
  StrongComponents<NextNodes> components_;
};

} // namespace

StripTurns stripTurns(const PatchStripsInput& input)
{
  PatchStrips strips(input);
  StripTurns result;
  result.without = strips.findStrips();
  std::size_t without = result.without;
  while (without > 0 && strips.lessen(without))
  {
  }
  if (result.without > 0 && without == 0)
  {
    result.sectorTurns = strips.sectorTurns();
  }
  return result;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/PatchSides.h"

#include "Base/DisjointSets.h"
#include "CrossField/TurnRepair.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace quadrille
{
namespace
{

/// A corner's turns may differ by so many quarters from its angle, unless what turns is shorter than an edge of quads:
/// a right angle stays one, and a straight side stays straight.
constexpr double kMostUnnatural = 0.75;

/// Of all sectors of a vertex, as valences: a field makes no others unless it has to.
constexpr int kLeastTurns = 3;
constexpr int kMostTurns = 6;

} // namespace

PatchSides::PatchSides(const PatchSidesInput& input)
  : input_(input), mesh_(input.mesh), turns_(input.turns), patch_(regionsOf(input.mesh)),
    isCorner_(mesh_.vertexCount(), 0), turnsAt_(mesh_.vertexCount(), 0),
    isBoundary_(mesh_.vertexCount(), 0), direction_(mesh_.halfEdgeCount(), 0)
{
  numberPatches();
  findCorners();
  findLoops();
  findSides();
  findFreePatches();
  findDirections();
}

void PatchSides::numberPatches()
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
  sidesOfPatch_.resize(count);
}

void PatchSides::findCorners()
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
Index PatchSides::nextOnLoop(Index h) const
{
  return input_.topology.fans[input_.topology.fanOfCorner[Mesh::next(h)]].first;
}

void PatchSides::findLoops()
{
  std::vector<std::uint8_t> seen(mesh_.halfEdgeCount(), 0);
  for (Index first = 0; first < mesh_.halfEdgeCount(); ++first)
  {
    if (!mesh_.isConstrained(first) || seen[first] != 0)
    {
      continue;
    }
    PatchLoop loop;
    loop.patch = patchOf(first);
    for (Index h = first; seen[h] == 0; h = nextOnLoop(h))
    {
      seen[h] = 1;
      if (isCorner_[mesh_.origin[h]] != 0)
      {
        loop.corners.push_back(static_cast<Index>(loop.halfEdges.size()));
      }
      loop.halfEdges.push_back(h);
      loop.before.push_back(loop.length);
      loop.length += input_.topology.edgeLength[h];
    }
    loops_.push_back(std::move(loop));
  }
}

/// Both sides of a curve of features have its number.
void PatchSides::findSides()
{
  std::vector<Index> curveOf(mesh_.halfEdgeCount(), kInvalidIndex);
  Index curves = 0;
  for (PatchLoop& loop : loops_)
  {
    loop.firstSide = static_cast<Index>(sides_.size());
    const Index count = static_cast<Index>(loop.halfEdges.size());
    const Index start = loop.corners.empty() ? 0 : loop.corners.front();
    for (Index i = 0; i < count; ++i)
    {
      const Index h = loop.halfEdges[(start + i) % count];
      if (i == 0 || isCorner_[mesh_.origin[h]] != 0)
      {
        sidesOfPatch_[loop.patch].push_back(static_cast<Index>(sides_.size()));
        sides_.push_back({ h, curveOf[h] == kInvalidIndex ? curves++ : curveOf[h] });
      }
      curveOf[h] = sides_.back().curve;
      if (!mesh_.isBoundary(h))
      {
        curveOf[mesh_.twin[h]] = curveOf[h];
      }
    }
  }
}

/// Without irregular vertices the turns of a patch's loops sum up to its Euler characteristic, whose loops are those of
/// a sphere with as many holes if it has no handle.
void PatchSides::findFreePatches()
{
  std::vector<int> sum(isFree_.size(), 0);
  loopsOfPatch_.assign(isFree_.size(), 0);
  const std::vector<Fan>& fans = input_.topology.fans;
  for (std::size_t i = 0; i < fans.size(); ++i)
  {
    isFree_[patchOf(fans[i].first)] |= !fans[i].sector && turns_[i] != 4 ? 1 : 0;
  }
  for (const PatchLoop& loop : loops_)
  {
    const int turning = std::accumulate(loop.halfEdges.begin(), loop.halfEdges.end(), 0,
      [&](int before, Index h) { return before + 2 - turnsOf(h); });
    isFree_[loop.patch] |= turning % 4 != 0 ? 1 : 0;
    sum[loop.patch] += turning;
    ++loopsOfPatch_[loop.patch];
  }
  for (Index p = 0; p < patchCount(); ++p)
  {
    isFree_[p] |= sum[p] != 4 * (2 - loopsOfPatch_[p]) ? 1 : 0;
  }
}

/// In one chart of each patch.
void PatchSides::findDirections()
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

std::vector<TurnMove> PatchSides::movesOf(Index loop) const
{
  std::vector<TurnMove> moves;
  const Index corners = static_cast<Index>(loops_[loop].corners.size());
  // On a disc it is the same whether what lies before or what lies behind turns.
  const bool isDisc = loopsOfPatch_[loops_[loop].patch] == 1;
  for (Index from = 0; from < corners; ++from)
  {
    for (Index to = 0; to < corners; ++to)
    {
      for (int by = 1; by >= (isDisc ? 1 : -1) && from != to; by -= 2)
      {
        TurnMove move{ 0, loop, from, to, by };
        if (const std::optional<double> cost = costOf(move))
        {
          move.cost = *cost;
          moves.push_back(move);
        }
      }
    }
  }
  return moves;
}

std::optional<double> PatchSides::costOf(const TurnMove& move) const
{
  const PatchLoop& loop = loops_[move.loop];
  const Index first = loop.corners[move.from], last = loop.corners[move.to];
  const double between = std::abs(loop.before[last] - loop.before[first]);
  const bool isShort = std::min(between, loop.length - between) <= input_.length;
  const auto from = costOf(loop.halfEdges[first], -move.by, isShort);
  const auto to = costOf(loop.halfEdges[last], move.by, isShort);
  return from && to ? std::optional<double>(*from + *to) : std::nullopt;
}

/// The change of the squared difference of a corner's turns to its angle.
std::optional<double> PatchSides::costOf(Index h, int change, bool isShort) const
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

void PatchSides::apply(const TurnMove& move)
{
  const PatchLoop& loop = loops_[move.loop];
  const auto change = [&](Index h, int by)
  {
    turns_[input_.topology.fanOfCorner[h]] += by;
    turnsAt_[mesh_.origin[h]] += by;
  };
  change(loop.halfEdges[loop.corners[move.from]], -move.by);
  change(loop.halfEdges[loop.corners[move.to]], move.by);
  const Index count = static_cast<Index>(loop.halfEdges.size());
  for (Index i = loop.corners[move.from]; i != loop.corners[move.to]; i = i + 1 < count ? i + 1 : 0)
  {
    std::uint8_t& direction = direction_[loop.halfEdges[i]];
    direction = static_cast<std::uint8_t>((direction + move.by) & 3);
  }
}

bool PatchSides::isAnyChanged() const
{
  return std::any_of(isChanged_.begin(), isChanged_.end(), [](std::uint8_t x) { return x != 0; });
}

void PatchSides::leaveOut(const std::vector<Index>& patches)
{
  DisjointSets components(patchCount(), 1);
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    if (mesh_.isFeature(h) && !mesh_.isBoundary(h))
    {
      components.join(patchOf(h), patchOf(mesh_.twin[h]));
    }
  }
  std::vector<std::uint8_t> isOut(isFree_.size(), 0);
  for (const Index p : patches)
  {
    isOut[components.find(p)] = 1;
  }
  for (Index p = 0; p < patchCount(); ++p)
  {
    if (isOut[components.find(p)] != 0)
    {
      isFree_[p] = 1;
      isChanged_[p] = 0;
    }
  }
}

std::vector<int> PatchSides::sectorTurns() const
{
  std::vector<int> sectors = input_.sectorTurns;
  sectors.resize(mesh_.halfEdgeCount(), 0);
  for (const PatchLoop& loop : loops_)
  {
    for (const Index h : loop.halfEdges)
    {
      sectors[h] = isChanged_[loop.patch] != 0 ? turnsOf(h) : sectors[h];
    }
  }
  return sectors;
}

std::vector<int> PatchSides::targetValences() const
{
  std::vector<int> targets = input_.targetValences;
  targets.resize(mesh_.vertexCount(), 0);
  for (const Fan& fan : input_.topology.fans)
  {
    int& target = targets[fan.vertex];
    target = !fan.sector && isChanged_[patchOf(fan.first)] != 0 ? 4 : target;
  }
  return targets;
}

} // namespace quadrille

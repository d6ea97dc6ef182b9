// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/PatchStrips.h"

#include <algorithm>
#include <tuple>

namespace quadrille
{

std::size_t PatchStrips::find()
{
  const Index nodes = 1 + 4 * sides_.patchCount();
  next_ = { nodes, [this](const auto& visit) { forArcs(visit); } };
  components_ = StrongComponents<NextNodes>(nodes);
  for (Index node = 0; node < nodes; ++node)
  {
    components_.walkFrom(node, [this](Index n) { return nextOf(n); });
  }
  const std::vector<PatchSide>& sides = sides_.sides();
  return static_cast<std::size_t>(std::count_if(
    sides.begin(), sides.end(), [this](const PatchSide& side) { return !hasStrip(side.first); }));
}

std::size_t PatchStrips::lessen(std::size_t without)
{
  for (std::size_t before = without + 1; without > 0 && without < before;)
  {
    before = without;
    without = lessenOnce(without);
  }
  return without;
}

std::size_t PatchStrips::lessenOnce(std::size_t without)
{
  std::vector<TurnMove> moves;
  const std::vector<std::uint8_t> isReached = reached();
  for (Index l = 0; l < sides_.loops().size(); ++l)
  {
    if (isReached[sides_.loops()[l].patch] != 0)
    {
      const std::vector<TurnMove> ofLoop = sides_.movesOf(l);
      moves.insert(moves.end(), ofLoop.begin(), ofLoop.end());
    }
  }
  std::sort(moves.begin(), moves.end(),
    [](const TurnMove& a, const TurnMove& b)
    {
      return std::tie(a.cost, a.loop, a.from, a.to, a.by) <
        std::tie(b.cost, b.loop, b.from, b.to, b.by);
    });
  for (const TurnMove& move : moves)
  {
    if (without == 0)
    {
      break;
    }
    if (!sides_.costOf(move)) // after others
    {
      continue;
    }
    sides_.apply(move);
    const std::size_t left = find();
    if (left < without)
    {
      without = left;
      sides_.markChanged(sides_.loops()[move.loop].patch);
      continue;
    }
    sides_.apply(move.back());
  }
  return find();
}

std::vector<Index> PatchStrips::patchesWithout() const
{
  std::vector<Index> patches;
  for (const PatchSide& side : sides_.sides())
  {
    if (!hasStrip(side.first))
    {
      patches.push_back(sides_.patchOf(side.first));
    }
  }
  return patches;
}

/// In the patch of h, after a side that runs like h turned by so many quarters. 0: anywhere, and outside.
Index PatchStrips::nodeOf(Index h, int turned) const
{
  const Index p = sides_.patchOf(h);
  return sides_.isFree(p) ? 0 : 1 + 4 * p + ((sides_.direction(h) + turned) & 3);
}

Index PatchStrips::nodeBeyond(Index h) const
{
  return mesh_.isBoundary(h) ? 0 : nodeOf(mesh_.twin[h], 0);
}

template <typename Visit>
void PatchStrips::forArcs(const Visit& visit) const
{
  for (const PatchSide& side : sides_.sides())
  {
    const Index h = side.first;
    visit(nodeOf(h, 2), nodeBeyond(h));
    if (mesh_.isBoundary(h))
    {
      visit(0, nodeOf(h, 0));
    }
  }
}

bool PatchStrips::hasStrip(Index h) const
{
  return components_.componentOf(nodeOf(h, 2)) == components_.componentOf(nodeBeyond(h));
}

/// #patches: where strips come to that begin at a side without any, forwards or backwards.
std::vector<std::uint8_t> PatchStrips::reached() const
{
  std::vector<std::uint8_t> seen(1 + 4 * sides_.patchCount(), 0), found(sides_.patchCount(), 0);
  std::vector<Index> open;
  const auto add = [&](Index node)
  {
    if (node != 0 && seen[node] == 0)
    {
      seen[node] = 1;
      open.push_back(node);
    }
  };
  for (const PatchSide& side : sides_.sides())
  {
    if (!hasStrip(side.first))
    {
      add(nodeBeyond(side.first));
      add(nodeOf(side.first, 0)); // backwards all directions are turned round
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

} // namespace quadrille

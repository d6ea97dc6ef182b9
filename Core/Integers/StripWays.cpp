// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/StripWays.h"

#include "Integers/StripSearch.h"

namespace quadrille
{

void StripWays::find(std::int64_t length, double mostCost)
{
  length_ = length;
  mostCost_ = mostCost;
  findEntries();
  components_ = StrongComponents<Next>(outside() + 1);
  const auto next = [this](Index state) { return nextOf(state); };
  components_.walkFrom(outside(), next);
  for (const Index f : map_.faces())
  {
    for (Index state = 12 * f; state < 12 * f + 12; ++state)
    {
      if (map_.mayShift(state / 4, vectorOfState(state, length_)))
      {
        components_.walkFrom(state, next);
      }
    }
  }
}

bool StripWays::mayHave(Index h, FixedVec2 e, double cost) const
{
  if (components_.empty() || IntegerMap::lengthOf(e) != length_ || cost > mostCost_)
  {
    return true;
  }
  const Index component = components_.componentOf(stateOf(h, e));
  return component != kInvalidIndex && components_.sizeOf(component) > 1;
}

void StripWays::findEntries()
{
  entries_.clear();
  for (const Index f : map_.faces())
  {
    for (Index state = 12 * f; state < 12 * f + 12; ++state)
    {
      const Index h = state / 4;
      const FixedVec2 e = vectorOfState(state, length_);
      if (map_.mesh().twin[h] == kInvalidIndex && map_.mayShift(h, e) &&
        map_.energyChange(h, e) < mostCost_)
      {
        entries_.push_back(state);
      }
    }
  }
}

StripWays::Next StripWays::nextOf(Index state) const
{
  Next next;
  if (state == outside())
  {
    next.entries = &entries_;
    next.count = static_cast<Index>(entries_.size());
    return next;
  }
  const Index in = state / 4;
  const FixedVec2 e = vectorOfState(state, length_);
  for (const Index out : { Mesh::next(in), Mesh::previous(in) })
  {
    if (map_.mayShift(out, -e) && map_.energyChange(out, -e) < mostCost_ &&
      IntegerMap::brokenness(map_.crossedDeterminant(in, e, out)) == 0)
    {
      const Index beyond = map_.mesh().twin[out];
      next.states[next.count++] =
        beyond == kInvalidIndex ? outside() : stateOf(beyond, rotate(e, map_.mesh().rotation[out]));
    }
  }
  return next;
}

} // namespace quadrille

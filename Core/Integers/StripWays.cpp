// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/StripWays.h"

#include "Integers/StripSearch.h"

#include <algorithm>

namespace quadrille
{

void StripWays::find(std::int64_t length, double mostCost)
{
  length_ = length;
  mostCost_ = mostCost;
  findEntries();
  component_.assign(outside() + 1, kInvalidIndex);
  size_.clear();
  order_.assign(outside() + 1, kInvalidIndex);
  lowest_.assign(outside() + 1, kInvalidIndex);
  clock_ = 0;
  walkFrom(outside());
  for (const Index f : map_.faces())
  {
    for (Index state = 12 * f; state < 12 * f + 12; ++state)
    {
      if (map_.mayShift(state / 4, vectorOfState(state, length_)))
      {
        walkFrom(state);
      }
    }
  }
}

bool StripWays::mayHave(Index h, FixedVec2 e, double cost) const
{
  if (component_.empty() || IntegerMap::lengthOf(e) != length_ || cost > mostCost_)
  {
    return true;
  }
  const Index component = component_[stateOf(h, e)];
  return component != kInvalidIndex && size_[component] > 1;
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

StripWays::Entered StripWays::entered(Index state) const
{
  Entered result;
  result.state = state;
  if (state == outside())
  {
    result.count = static_cast<Index>(entries_.size());
    return result;
  }
  const Index in = state / 4;
  const FixedVec2 e = vectorOfState(state, length_);
  for (const Index out : { Mesh::next(in), Mesh::previous(in) })
  {
    if (map_.mayShift(out, -e) && map_.energyChange(out, -e) < mostCost_ &&
      IntegerMap::brokenness(map_.crossedDeterminant(in, e, out)) == 0)
    {
      const Index next = map_.mesh().twin[out];
      result.next[result.count++] =
        next == kInvalidIndex ? outside() : stateOf(next, rotate(e, map_.mesh().rotation[out]));
    }
  }
  return result;
}

void StripWays::enter(Index state)
{
  order_[state] = lowest_[state] = clock_++;
  open_.push_back(state);
  way_.push_back(entered(state));
}

/// Tarjan's algorithm, without a recursion.
void StripWays::walkFrom(Index root)
{
  if (order_[root] != kInvalidIndex)
  {
    return;
  }
  enter(root);
  while (!way_.empty())
  {
    Entered& last = way_.back();
    if (last.done == last.count)
    {
      leave();
      continue;
    }
    const Index next = nextOf(last, last.done++);
    if (order_[next] == kInvalidIndex)
    {
      enter(next);
    }
    else if (component_[next] == kInvalidIndex)
    {
      lowest_[last.state] = std::min(lowest_[last.state], order_[next]);
    }
  }
}

/// Back from the last state of the way. Where nothing from there on leads to one before it, these are a component.
void StripWays::leave()
{
  const Index state = way_.back().state;
  way_.pop_back();
  if (!way_.empty())
  {
    Index& before = lowest_[way_.back().state];
    before = std::min(before, lowest_[state]);
  }
  if (lowest_[state] < order_[state])
  {
    return;
  }
  const auto begin = std::find(open_.rbegin(), open_.rend(), state).base() - 1;
  for (auto i = begin; i != open_.end(); ++i)
  {
    component_[*i] = static_cast<Index>(size_.size());
  }
  size_.push_back(static_cast<Index>(open_.end() - begin));
  open_.erase(begin, open_.end());
}

} // namespace quadrille

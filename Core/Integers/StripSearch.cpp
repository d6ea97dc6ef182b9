// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/StripSearch.h"

#include "Base/WorkCount.h"

#include <algorithm>

namespace quadrille
{

namespace
{

/// Makes the shorter of two equally cheap strips win.
constexpr double kStepCost = 1e-6;
/// Steps that an improving search may settle.
constexpr std::size_t kMostSettled = 4000;
/// Steps that count as work at a time, and the units that they are, see WorkCount.h.
constexpr std::size_t kCountedSteps = 1000;
constexpr std::size_t kWorkOfCountedSteps = 160;
constexpr std::size_t kHeapChildren = 4;

} // namespace

StripSearch::StripSearch(
  const IntegerMap& map, StripCost cost, const std::vector<double>* faceWeight)
  : map_(map), mesh_(map.mesh()), cost_(cost), faceWeight_(faceWeight),
    reached_(4 * map.mesh().origin.size()), visitStamp_(map.mesh().alive.size(), 0)
{
}

void StripSearch::restart()
{
  ++round_;
  heap_.clear();
}

void StripSearch::visit(Index f)
{
  if (visitStamp_[f] != searches_)
  {
    visitStamp_[f] = searches_;
    visited_.push_back(f);
  }
}

void StripSearch::push(Entry entry)
{
  std::size_t i = heap_.size();
  heap_.push_back(entry);
  while (i > 0)
  {
    const std::size_t above = (i - 1) / kHeapChildren;
    if (!entry.isBefore(heap_[above]))
    {
      break;
    }
    heap_[i] = heap_[above];
    i = above;
  }
  heap_[i] = entry;
}

StripSearch::Entry StripSearch::popFirst()
{
  const Entry first = heap_.front();
  const Entry last = heap_.back();
  heap_.pop_back();
  const std::size_t count = heap_.size();
  std::size_t i = 0;
  for (std::size_t child = 1; child < count; child = kHeapChildren * i + 1)
  {
    std::size_t least = child;
    for (std::size_t other = child + 1; other < std::min(child + kHeapChildren, count); ++other)
    {
      least = heap_[other].isBefore(heap_[least]) ? other : least;
    }
    if (!heap_[least].isBefore(last))
    {
      break;
    }
    heap_[i] = heap_[least];
    i = least;
  }
  if (count > 0)
  {
    heap_[i] = last;
  }
  return first;
}

void StripSearch::relax(Index state, double cost, Index parent)
{
  Reached& reached = reached_[state];
  if (reached.stamp / 2 == round_ && reached.distance <= cost)
  {
    return;
  }
  reached = { cost, parent, 2 * round_ };
  push({ cost, state });
}

bool StripSearch::pop(Index& state, double& cost)
{
  while (!heap_.empty())
  {
    const Entry first = popFirst();
    cost = first.cost;
    state = first.state;
    std::uint32_t& stamp = reached_[state].stamp;
    if (stamp % 2 == 0)
    {
      if (++work_ % kCountedSteps == 0)
      {
        countWork(kWorkOfCountedSteps);
      }
      ++stamp;
      return true;
    }
  }
  return false;
}

/// Price of the triangle for e coming in through `in` and leaving through `out`.
double StripSearch::crossingCost(Index in, FixedVec2 e, Index out, bool isFirst) const
{
  const std::int64_t after = map_.crossedDeterminant(in, e, out);
  if (cost_ == StripCost::KeepSound)
  {
    return IntegerMap::brokenness(after) == 0 ? 0 : kInfinity;
  }
  const std::int64_t change =
    IntegerMap::brokenness(after) - IntegerMap::brokenness(map_.determinant(Mesh::face(in)));
  // Only the first triangle may pay with what it gains, or Dijkstra's algorithm would not apply.
  const double weight = faceWeight_ == nullptr ? 1.0 : (*faceWeight_)[Mesh::face(in)];
  return kBroken * weight *
    static_cast<double>(isFirst ? change : std::max<std::int64_t>(0, change));
}

double StripSearch::edgeCost(Index out, FixedVec2 e) const
{
  return kStepCost + std::max(0.0, map_.energyChange(out, -e));
}

void StripSearch::explore(Index h, FixedVec2 e, double bound, End& closed, End& border)
{
  restart();
  const Index last = mesh_.twin[h];
  const FixedVec2 closing = last == kInvalidIndex ? e : rotate(e, mesh_.rotation[h]);
  const Index start = stateOf(h, e);
  relax(start, 0, kInvalidIndex);
  Index state = 0;
  double cost = 0;
  // A repair has to reach far; what improves does so nearby, or costs more time than it is worth.
  const std::size_t end = work_ + kMostSettled;
  while (pop(state, cost) && (cost_ == StripCost::Repair || work_ < end))
  {
    // The first triangle may repay, so the bound may be negative.
    if (state != start && !(cost < std::min(bound, closed.cost)))
    {
      break;
    }
    const Index in = state / 4;
    const FixedVec2 carried = vectorOf(state);
    visit(Mesh::face(in));
    for (const Index out : { Mesh::next(in), Mesh::previous(in) })
    {
      if (!map_.mayShift(out, -carried))
      {
        continue;
      }
      const double crossed = cost + crossingCost(in, carried, out, state == start);
      if (!(crossed < bound))
      {
        continue;
      }
      if (out == last)
      {
        if (carried == closing && crossed < std::min(closed.cost, bound))
        {
          closed = { crossed, state, kInvalidIndex, {} };
        }
        continue;
      }
      const double total = crossed + edgeCost(out, carried);
      if (!(total < bound))
      {
        continue;
      }
      const Index next = mesh_.twin[out];
      if (next != kInvalidIndex)
      {
        relax(stateOf(next, rotate(carried, mesh_.rotation[out])), total, state);
      }
      // Out where it came in, a strip would take back what it is for.
      else if (total < border.cost && (out != h || carried != e))
      {
        border = { total, state, out, -carried };
      }
    }
  }
}

void StripSearch::appendPath(const End& end, std::vector<StripStep>& steps) const
{
  if (end.exit != kInvalidIndex)
  {
    steps.push_back({ end.exit, end.exitVector });
  }
  for (Index state = end.state; state != kInvalidIndex; state = reached_[state].parent)
  {
    steps.push_back({ state / 4, vectorOf(state) });
  }
}

Strip StripSearch::through(Index h, FixedVec2 e, double bound)
{
  length_ = IntegerMap::lengthOf(e);
  ++searches_;
  visited_.clear();
  Strip strip;
  End closed, border;
  explore(h, e, bound, closed, border);
  if (closed.cost < bound)
  {
    appendPath(closed, strip.steps);
    strip.cost = closed.cost;
  }
  if (!(border.cost < std::min(bound, closed.cost)))
  {
    return strip;
  }
  std::vector<StripStep> steps;
  appendPath(border, steps);
  double cost = border.cost;
  const Index g = mesh_.twin[h];
  if (g != kInvalidIndex)
  {
    End otherClosed, otherBorder;
    explore(g, -rotate(e, mesh_.rotation[h]), std::min(bound, closed.cost) - border.cost,
      otherClosed, otherBorder);
    cost += otherBorder.cost;
    if (otherBorder.cost < kInfinity)
    {
      appendPath(otherBorder, steps);
      steps.pop_back(); // the shift of h itself, which the first half has
    }
  }
  if (cost < std::min(bound, closed.cost))
  {
    strip.steps = std::move(steps);
    strip.cost = cost;
  }
  return strip;
}

Strip StripSearch::discharge(Index f, FixedVec2 e, const std::vector<FixedVec2>& residuals)
{
  length_ = IntegerMap::lengthOf(e);
  ++searches_;
  restart();
  End best;
  const auto leave = [&](Index out, FixedVec2 carried, double cost, Index from)
  {
    if (!map_.mayShift(out, -carried))
    {
      return;
    }
    const double total = cost + edgeCost(out, carried);
    const Index next = mesh_.twin[out];
    if (next != kInvalidIndex)
    {
      relax(stateOf(next, rotate(carried, mesh_.rotation[out])), total, from);
    }
    else if (total < best.cost)
    {
      best = { total, from, out, -carried };
    }
  };
  for (Index out = 3 * f; out < 3 * f + 3; ++out)
  {
    leave(out, e, 0, kInvalidIndex);
  }
  Index state = 0;
  double cost = 0;
  while (pop(state, cost) && cost < best.cost)
  {
    const Index in = state / 4;
    const FixedVec2 carried = vectorOf(state);
    const FixedVec2 there = Mesh::face(in) == f ? residuals[f] - e : residuals[Mesh::face(in)];
    if (there.u * carried.u + there.v * carried.v < 0)
    {
      best = { cost, state, kInvalidIndex, {} };
      break;
    }
    for (const Index out : { Mesh::next(in), Mesh::previous(in) })
    {
      leave(out, carried, cost + crossingCost(in, carried, out, false), state);
    }
  }
  Strip strip;
  appendPath(best, strip.steps);
  strip.cost = best.cost;
  return strip;
}

} // namespace quadrille

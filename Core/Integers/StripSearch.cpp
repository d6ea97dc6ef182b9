// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/StripSearch.h"

#include "Base/WorkCount.h"

#include <algorithm>
#include <optional>

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
    visitStamp_(map.mesh().alive.size(), 0)
{
  onward_.reached.resize(4 * map.mesh().origin.size());
  back_.reached.resize(onward_.reached.size());
}

void StripSearch::visit(Index f)
{
  if (visitStamp_[f] != searches_)
  {
    visitStamp_[f] = searches_;
    visited_.push_back(f);
  }
}

void StripSearch::Front::push(Entry entry)
{
  std::size_t i = heap.size();
  heap.push_back(entry);
  while (i > 0)
  {
    const std::size_t above = (i - 1) / kHeapChildren;
    if (!entry.isBefore(heap[above]))
    {
      break;
    }
    heap[i] = heap[above];
    i = above;
  }
  heap[i] = entry;
}

StripSearch::Entry StripSearch::Front::popFirst()
{
  const Entry first = heap.front();
  const Entry last = heap.back();
  heap.pop_back();
  const std::size_t count = heap.size();
  std::size_t i = 0;
  for (std::size_t child = 1; child < count; child = kHeapChildren * i + 1)
  {
    std::size_t least = child;
    for (std::size_t other = child + 1; other < std::min(child + kHeapChildren, count); ++other)
    {
      least = heap[other].isBefore(heap[least]) ? other : least;
    }
    if (!heap[least].isBefore(last))
    {
      break;
    }
    heap[i] = heap[least];
    i = least;
  }
  if (count > 0)
  {
    heap[i] = last;
  }
  return first;
}

void StripSearch::Front::relax(Index state, double cost, Index parent)
{
  Reached& there = reached[state];
  if (there.stamp / 2 == round && there.distance <= cost)
  {
    return;
  }
  there = { cost, parent, 2 * round };
  push({ cost, state });
}

bool StripSearch::pop(Front& front, Index& state, double& cost)
{
  while (!front.heap.empty())
  {
    const Entry first = front.popFirst();
    cost = first.cost;
    state = first.state;
    std::uint32_t& stamp = front.reached[state].stamp;
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

StripSearch::Exploration StripSearch::begin(Front& front, Index h, FixedVec2 e, double bound) const
{
  front.restart();
  Exploration way{ front, h, e, bound };
  way.last = mesh_.twin[h];
  way.closing = way.last == kInvalidIndex ? e : rotate(e, mesh_.rotation[h]);
  way.start = stateOf(h, e);
  front.relax(way.start, 0, kInvalidIndex);
  return way;
}

void StripSearch::step(Exploration& way)
{
  Index state = 0;
  double cost = 0;
  // The first triangle may repay, so the bound may be negative.
  way.isOver = !pop(way.front, state, cost) ||
    (state != way.start && !(cost < std::min(way.bound, way.closed.cost)));
  if (way.isOver)
  {
    return;
  }
  // A repair has to reach far; what improves does so nearby, or costs more time than it is worth.
  ++way.settled;
  way.isCut = cost_ == StripCost::KeepSound && way.settled == kMostSettled;
  if (way.isCut)
  {
    way.isOver = true;
    return;
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
    const double crossed = cost + crossingCost(in, carried, out, state == way.start);
    if (!(crossed < way.bound))
    {
      continue;
    }
    if (out == way.last)
    {
      if (carried == way.closing && crossed < std::min(way.closed.cost, way.bound))
      {
        way.closed = { crossed, state, kInvalidIndex, {} };
      }
      continue;
    }
    const double total = crossed + edgeCost(out, carried);
    if (!(total < way.bound))
    {
      continue;
    }
    const Index next = mesh_.twin[out];
    if (next != kInvalidIndex)
    {
      way.front.relax(stateOf(next, rotate(carried, mesh_.rotation[out])), total, state);
    }
    // Out where it came in, a strip would take back what it is for.
    else if (total < way.border.cost && (out != way.h || carried != way.e))
    {
      way.border = { total, state, out, -carried };
    }
  }
}

bool StripSearch::explore(Exploration& way, Exploration* other)
{
  while (!way.isOver)
  {
    step(way);
    if (other != nullptr && !way.isOver)
    {
      step(*other);
      if (other->isOver && !other->isCut && !other->hasFound())
      {
        return false;
      }
      other = other->isOver ? nullptr : other;
    }
  }
  return way.hasFound();
}

void StripSearch::appendPath(
  const Front& front, const End& end, std::vector<StripStep>& steps) const
{
  if (end.exit != kInvalidIndex)
  {
    steps.push_back({ end.exit, end.exitVector });
  }
  for (Index state = end.state; state != kInvalidIndex; state = front.reached[state].parent)
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
  const Index g = mesh_.twin[h];
  const auto backwards = [&](double below)
  { return begin(back_, g, -rotate(e, mesh_.rotation[h]), below); };
  Exploration way = begin(onward_, h, e, bound);
  std::optional<Exploration> other;
  if (cost_ == StripCost::KeepSound && g != kInvalidIndex)
  {
    other.emplace(backwards(bound));
  }
  if (!explore(way, other ? &*other : nullptr))
  {
    return strip;
  }
  const End &closed = way.closed, &border = way.border;
  if (closed.cost < bound)
  {
    appendPath(onward_, closed, strip.steps);
    strip.cost = closed.cost;
  }
  if (!(border.cost < std::min(bound, closed.cost)))
  {
    return strip;
  }
  std::vector<StripStep> steps;
  appendPath(onward_, border, steps);
  double cost = border.cost;
  if (g != kInvalidIndex)
  {
    Exploration back = backwards(std::min(bound, closed.cost) - border.cost);
    explore(back, nullptr);
    cost += back.border.cost;
    if (back.border.cost < kInfinity)
    {
      appendPath(back_, back.border, steps);
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
  onward_.restart();
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
      onward_.relax(stateOf(next, rotate(carried, mesh_.rotation[out])), total, from);
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
  while (pop(onward_, state, cost) && cost < best.cost)
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
  appendPath(onward_, best, strip.steps);
  strip.cost = best.cost;
  return strip;
}

} // namespace quadrille

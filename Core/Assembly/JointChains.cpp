// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Assembly/JointChains.h"

#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Quads/QuadTopology.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>

namespace quadrille
{

namespace
{

std::pair<Index, Index> sortedPair(Index a, Index b)
{
  return { std::min(a, b), std::max(a, b) };
}

/// Gauss-Jordan elimination modulo 2. rows: of equations that have a solution, the right side at `unknowns`. The
/// unknowns that are 1 in the solution in which all that the equations leave free are 0.
std::vector<std::size_t> onesOfSolution(std::vector<std::vector<bool>> rows, std::size_t unknowns)
{
  std::vector<std::size_t> pivots; // of the first rows
  for (std::size_t c = 0; c < unknowns && pivots.size() < rows.size(); ++c)
  {
    const auto begin = rows.begin() + static_cast<std::ptrdiff_t>(pivots.size());
    const auto pivot =
      std::find_if(begin, rows.end(), [&](const std::vector<bool>& row) { return row[c]; });
    if (pivot == rows.end())
    {
      continue;
    }
    std::iter_swap(begin, pivot);
    for (auto row = rows.begin(); row != rows.end(); ++row)
    {
      if (row != begin && (*row)[c])
      {
        std::transform(
          row->begin(), row->end(), begin->begin(), row->begin(), std::not_equal_to<>());
      }
    }
    pivots.push_back(c);
  }
  std::vector<std::size_t> ones;
  for (std::size_t i = 0; i < pivots.size(); ++i)
  {
    if (rows[i][unknowns])
    {
      ones.push_back(pivots[i]);
    }
  }
  return ones;
}

} // namespace

void JointChains::findNodes()
{
  std::map<Index, std::vector<Index>> neighbours;
  for (const auto& [a, b] : sheets_.edges)
  {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  std::map<std::pair<Index, Index>, std::set<Index>> sheetsAt; // of edges
  std::set<Index> onFeatures;
  for (const SectorRequest& request : result_.onFeatures)
  {
    onFeatures.insert(request.vertex);
  }
  for (const FineLoop& loop : fineLoops_)
  {
    Index before = kInvalidIndex, first = kInvalidIndex;
    for (std::size_t i = 0; i < loop.halfEdges.size(); ++i)
    {
      const Index point = loop.jointPoint[i];
      const Index v = mesh_.origin[loop.halfEdges[i]];
      if (point == kInvalidIndex)
      {
        continue;
      }
      if (neighbours.count(point) != 0 && (onFeatures.count(v) != 0 || result_.turns[v] != 2))
      {
        nodes_.insert(point);
      }
      if (before != kInvalidIndex)
      {
        sheetsAt[sortedPair(before, point)].insert(loop.sheet);
      }
      first = first == kInvalidIndex ? point : first;
      before = point;
    }
    if (first != kInvalidIndex)
    {
      sheetsAt[sortedPair(before, first)].insert(loop.sheet);
    }
  }
  for (const auto& [point, others] : neighbours)
  {
    if (others.size() != 2 ||
      sheetsAt[sortedPair(point, others[0])] != sheetsAt[sortedPair(point, others[1])])
    {
      nodes_.insert(point);
    }
  }
  neighbours_ = std::move(neighbours);
}

void JointChains::findSegments()
{
  std::set<std::pair<Index, Index>> taken;
  const auto follow = [&](Index from, Index next)
  {
    if (!taken.insert(sortedPair(from, next)).second)
    {
      return;
    }
    JointSegment segment;
    segment.points = { from, next };
    while (nodes_.count(segment.points.back()) == 0)
    {
      const Index at = segment.points.back(), before = segment.points[segment.points.size() - 2];
      const std::vector<Index>& others = neighbours_[at];
      const Index following = others[0] == before ? others[1] : others[0];
      taken.insert(sortedPair(at, following));
      segment.points.push_back(following);
    }
    segment.arc.push_back(0);
    for (std::size_t i = 1; i < segment.points.size(); ++i)
    {
      segment.arc.push_back(segment.arc.back() +
        (jointPoints_[segment.points[i]] - jointPoints_[segment.points[i - 1]]).norm());
    }
    const auto id = static_cast<Index>(segments_.size());
    for (std::size_t i = 1; i < segment.points.size(); ++i)
    {
      segmentOf_[{ segment.points[i - 1], segment.points[i] }] = { id, true };
      segmentOf_[{ segment.points[i], segment.points[i - 1] }] = { id, false };
    }
    segments_.push_back(std::move(segment));
  };
  const auto followAll = [&](Index node)
  {
    for (const Index next : neighbours_[node])
    {
      follow(node, next);
    }
  };
  const std::set<Index> found = nodes_;
  for (const Index node : found)
  {
    followAll(node);
  }
  for (const auto& [point, others] : neighbours_)
  {
    // What is left are closed joints without a node: the lowest point becomes one.
    if (taken.count(sortedPair(point, others.front())) == 0)
    {
      nodes_.insert(point);
      followAll(point);
    }
  }
  met_.segments = segments_.size();
}

void JointChains::findChains()
{
  const QuadTopology topology = analyzeQuads(quads_.quads, quads_.points.size(), threads_);
  std::vector<std::uint8_t> hasQuads(fineLoops_.size(), 0);
  for (const std::vector<Index>& halfEdges : boundaryLoops(topology))
  {
    poll();
    const Index sheet = borders_.sheetOfFace(quads_.quadSourceFace[halfEdges.front() / 4]);
    std::vector<std::pair<double, Index>> points; // by arc
    std::size_t fine = fineLoops_.size();
    for (const Index h : halfEdges)
    {
      const Index p = quads_.origin(h);
      const SheetBorders::OnLoop place = borders_.nearestOnLoops(sheet, quads_.points[p]);
      fine = fine == fineLoops_.size() ? place.loop : fine;
      points.emplace_back(place.arc, p);
    }
    if (fine == fineLoops_.size())
    {
      continue;
    }
    hasQuads[fine] = 1;
    // In the order of the loop, from the one with the least arc on.
    std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
    addLoop(fineLoops_[fine], points);
  }
  for (std::size_t l = 0; l < fineLoops_.size(); ++l)
  {
    const FineLoop& loop = fineLoops_[l];
    const auto isOnJoint = [&](Index point)
    { return point != kInvalidIndex && neighbours_.count(point) != 0; };
    const auto at = std::find_if(loop.jointPoint.begin(), loop.jointPoint.end(), isOnJoint);
    if (hasQuads[l] == 0 && at != loop.jointPoint.end())
    {
      fail("a sheet has no quads along a curve of more than two sheets", *at);
    }
  }
}

void JointChains::fail(const std::string& what, Index jointPoint)
{
  met_.status = { StatusCode::NotConverged,
    what + " near " + placeText(jointPoints_[jointPoint]) + ": ask for more quads" };
}

void JointChains::addLoop(const FineLoop& fine, const std::vector<std::pair<double, Index>>& points)
{
  const double length = fine.arc.back();
  struct Stop
  {
    double arc;
    Index node;
    Index next; ///< the next point of the input
    std::size_t point;
  };
  std::vector<Stop> stops;
  for (std::size_t i = 0; i < fine.halfEdges.size(); ++i)
  {
    if (fine.jointPoint[i] == kInvalidIndex || nodes_.count(fine.jointPoint[i]) == 0)
    {
      continue;
    }
    Index next = kInvalidIndex;
    for (std::size_t k = 1; k <= fine.halfEdges.size() && next == kInvalidIndex; ++k)
    {
      next = fine.jointPoint[(i + k) % fine.halfEdges.size()];
    }
    stops.push_back({ fine.arc[i], fine.jointPoint[i], next, 0 });
  }
  if (stops.empty())
  {
    return;
  }
  for (Stop& stop : stops)
  {
    double least = kInfinity;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const double gap = std::abs(points[i].first - stop.arc);
      const double around = std::min(gap, length - gap);
      if (around < least)
      {
        least = around;
        stop.point = i;
      }
    }
  }
  SheetLoop& loop = loops_.emplace_back();
  loop.sheet = fine.sheet;
  // Where all stops are at one point, the longest chain goes all the way round.
  const auto lengthOf = [&](std::size_t s)
  {
    const double gap = stops[(s + 1) % stops.size()].arc - stops[s].arc;
    return gap > 0 ? gap : gap + length;
  };
  std::size_t whole = stops.size();
  if (std::all_of(stops.begin(), stops.end(),
        [&](const Stop& stop) { return stop.point == stops.front().point; }))
  {
    whole = 0;
    for (std::size_t s = 1; s < stops.size(); ++s)
    {
      whole = lengthOf(s) > lengthOf(whole) ? s : whole;
    }
  }
  for (std::size_t s = 0; s < stops.size(); ++s)
  {
    const Stop& stop = stops[s];
    const Stop& following = stops[(s + 1) % stops.size()];
    SheetChain chain;
    const auto segment = segmentOf_.find({ stop.node, stop.next });
    if (segment != segmentOf_.end())
    {
      chain.segment = segment->second.first;
      chain.isForward = segment->second.second;
    }
    chain.points.push_back(points[stop.point].second);
    for (std::size_t i = stop.point;
         i != following.point || (s == whole && chain.points.size() == 1);)
    {
      i = (i + 1) % points.size();
      chain.points.push_back(points[i].second);
    }
    loop.chains.push_back(std::move(chain));
  }
}

//----------------------------------------------------------------------------
// Numbers of edges

void JointChains::chooseNumbers()
{
  for (JointSegment& segment : segments_)
  {
    segment.edges = 1;
  }
  for (const SheetLoop& loop : loops_)
  {
    for (const SheetChain& chain : loop.chains)
    {
      if (chain.segment != kInvalidIndex)
      {
        std::size_t& edges = segments_[chain.segment].edges;
        edges = std::max(edges, chain.edges());
      }
    }
  }
  makeSheetsEven();
}

void JointChains::makeSheetsEven()
{
  // One equation a sheet without a boundary of its own, over the segments that it has an odd number of times: the sum
  // of what they get is odd where the sheet lacks an odd number. All even numbers are a solution, so there is one. Long
  // segments are the first to be solved for, and all others stay as they are.
  const std::size_t segments = segments_.size();
  std::vector<std::size_t> order(segments);
  std::iota(order.begin(), order.end(), std::size_t{ 0 });
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b)
    { return segments_[a].arc.back() > segments_[b].arc.back(); });
  std::vector<std::size_t> column(segments);
  for (std::size_t i = 0; i < segments; ++i)
  {
    column[order[i]] = i;
  }
  std::vector<std::vector<bool>> rows;
  for (Index sheet = 0; sheet < sheets_.offset.size(); ++sheet)
  {
    if (hasFree(sheet))
    {
      continue;
    }
    std::vector<bool>& row = rows.emplace_back(segments + 1, false);
    for (const SheetLoop& loop : loops_)
    {
      for (const SheetChain& chain : loop.chains)
      {
        if (loop.sheet == sheet)
        {
          row[column[chain.segment]].flip();
        }
      }
    }
    row[segments] = lackOf(sheet) % 2 != 0;
  }
  for (const std::size_t c : onesOfSolution(std::move(rows), segments))
  {
    ++segments_[order[c]].edges;
  }
}

bool JointChains::hasFree(Index sheet) const
{
  return std::any_of(loops_.begin(), loops_.end(),
    [&](const SheetLoop& loop)
    {
      return loop.sheet == sheet &&
        std::any_of(loop.chains.begin(), loop.chains.end(),
          [](const SheetChain& chain) { return chain.segment == kInvalidIndex; });
    });
}

std::size_t JointChains::lackOf(const SheetChain& chain) const
{
  return chain.segment == kInvalidIndex ? 0 : segments_[chain.segment].edges - chain.edges();
}

std::size_t JointChains::lackOf(Index sheet) const
{
  std::size_t lack = 0;
  for (const SheetLoop& loop : loops_)
  {
    for (const SheetChain& chain : loop.chains)
    {
      lack += loop.sheet == sheet ? lackOf(chain) : 0;
    }
  }
  return lack;
}

} // namespace quadrille

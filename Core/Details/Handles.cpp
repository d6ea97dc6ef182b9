// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/Handles.h"

#include "Base/Error.h"
#include "Base/Progress.h"
#include "Details/HandleBasis.h"
#include "Details/LoopSearch.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>

namespace quadrille
{

namespace
{

/// Vertices that all searches together may visit, 0.5 microseconds each.
constexpr std::size_t kMaximumVisits = 3000000;
/// Classes of short loops that are told apart.
constexpr std::size_t kMaximumClasses = 20000;
/// Generators where a search for the shortest loop begins, and vertices of a loop where it goes on.
constexpr std::size_t kStarts = 16;

/// Short loops of all classes that are met, shortest first.
std::vector<LoopSearch::Loop> shortLoops(LoopSearch& search, double limit, bool& complete)
{
  LoopSearch::LoopsByLabel found;
  for (const Index root : search.roots())
  {
    if (search.work() > kMaximumVisits || found.size() > kMaximumClasses)
    {
      complete = false;
      break;
    }
    search.search(root, limit, found);
  }
  std::vector<std::pair<std::uint64_t, LoopSearch::Loop*>> order;
  for (auto& [label, loop] : found)
  {
    order.push_back({ label, &loop });
  }
  std::sort(order.begin(), order.end(),
    [](const auto& a, const auto& b)
    {
      return a.second->length != b.second->length ? a.second->length < b.second->length
                                                  : a.first < b.first;
    });
  std::vector<LoopSearch::Loop> loops;
  loops.reserve(order.size());
  for (const auto& [label, loop] : order)
  {
    loops.push_back(std::move(*loop));
  }
  return loops;
}

std::vector<Index> spaced(const std::vector<Index>& all, std::size_t most)
{
  std::vector<Index> some;
  const std::size_t count = std::min(all.size(), most);
  for (std::size_t i = 0; i < count; ++i)
  {
    some.push_back(all[i * all.size() / count]);
  }
  return some;
}

/// From the generators, then again from vertices of the loop that was found, until it gets no shorter.
std::optional<LoopSearch::Loop> tightenedLoop(LoopSearch& search)
{
  std::optional<LoopSearch::Loop> best;
  std::vector<Index> starts = spaced(search.generatorRoots(), kStarts);
  while (!starts.empty())
  {
    bool shorter = false;
    for (const Index start : starts)
    {
      const double bound = best ? best->length : kInfinity;
      std::optional<LoopSearch::Loop> loop = search.shortest(start, bound);
      if (loop)
      {
        best = std::move(loop);
        shorter = true;
      }
      if (best && search.work() > 2 * kMaximumVisits)
      {
        return best;
      }
    }
    starts = shorter ? spaced(best->vertices, kStarts) : std::vector<Index>();
  }
  return best;
}

HandleLoop boundaryLoop(const Mesh& mesh, Index start, double length)
{
  HandleLoop loop;
  loop.length = length;
  Index h = start;
  do
  {
    loop.vertices.push_back(mesh.origin[h]);
    h = nextOnBoundary(mesh, h);
  } while (h != start);
  return loop;
}

void requireLimit(double limit)
{
  if (!(limit > 0))
  {
    throw InvalidInput("the length below which handles are looked for must be positive");
  }
}

/// One short loop for each handle that has any. The rest of the report is left alone.
void collectShortLoops(LoopSearch& search, double limit, HandleReport& report)
{
  report.handles = search.handles();
  HandleBasis basis(2 * report.handles);
  for (LoopSearch::Loop& loop : shortLoops(search, limit, report.complete))
  {
    if (basis.size() == report.handles)
    {
      break;
    }
    pollNowAndThen(basis.size());
    const LoopSearch::Class sum = search.classOf(loop);
    if (basis.insert(sum, search.crossings(sum)))
    {
      report.loops.push_back({ std::move(loop.vertices), loop.length });
    }
  }
}

} // namespace

std::vector<HandleLoop> findShortHandles(const Mesh& mesh, double limit)
{
  requireLimit(limit);
  HandleReport report;
  LoopSearch search(mesh, LoopSearch::kStraightened);
  collectShortLoops(search, limit, report);
  return std::move(report.loops);
}

HandleReport findHandles(const Mesh& mesh, double limit)
{
  requireLimit(limit);
  HandleReport report;
  LoopSearch search(mesh, LoopSearch::kStraightened);
  collectShortLoops(search, limit, report);
  if (!report.loops.empty())
  {
    report.shortest = report.loops.front();
  }
  else if (std::optional<LoopSearch::Loop> loop = tightenedLoop(search))
  {
    report.shortest = HandleLoop{ std::move(loop->vertices), loop->length };
  }
  return report;
}

BoundaryReport measureBoundary(const Mesh& mesh, double limit)
{
  BoundaryReport report;
  std::vector<bool> visited(mesh.halfEdgeCount(), false);
  for (Index start = 0; start < mesh.halfEdgeCount(); ++start)
  {
    pollNowAndThen(start);
    if (!mesh.isBoundary(start) || visited[start])
    {
      continue;
    }
    double length = 0;
    for (Index h = start; !visited[h]; h = nextOnBoundary(mesh, h))
    {
      visited[h] = true;
      length += sizedLength(mesh, h);
    }
    if (length < limit)
    {
      report.tooShort.push_back(boundaryLoop(mesh, start, length));
    }
    report.shortLoops += length < limit ? 1 : 0;
    if (report.loops++ == 0 || length < report.shortest)
    {
      report.shortest = length;
      report.place = mesh.position[mesh.origin[start]];
    }
  }
  return report;
}

} // namespace quadrille

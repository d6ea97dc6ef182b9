// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/QuadChains.h"

#include "Extraction/QuadHalfEdges.h"
#include "Mesh/Distance.h"
#include "Mesh/Guides.h"

#include <algorithm>
#include <limits>
#include <set>

namespace quadrille
{
namespace
{

double distanceToLine(const Vector3& p, const std::vector<Vector3>& line)
{
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
  {
    least = std::min(least, distanceToSegment(p, line[i], line[i + 1]));
  }
  return least;
}

double largestDistance(const std::vector<Vector3>& points, const std::vector<Vector3>& line)
{
  double largest = 0;
  for (const Vector3& p : points)
  {
    largest = std::max(largest, distanceToLine(p, line));
  }
  return largest;
}

Index cornerOf(const QuadMesh& quads, Index h)
{
  return quads.quads[h / 4][h % 4];
}

} // namespace

QuadChains::QuadChains(const QuadMesh& quads)
  : quads_(quads), topology_(analyzeQuads(quads.quads, quads.points.size())),
    onCurve_(topology_.onBoundary), leaving_(quads.points.size())
{
  for (const QuadLine& line : quads.lines)
  {
    onCurve_[line.a] = onCurve_[line.b] = 1;
  }
  for (Index h = 0; h < 4 * quads.quads.size(); ++h)
  {
    leaving_[cornerOf(quads, h)].push_back(h);
  }
}

bool QuadChains::isIrregular(Index p) const
{
  return topology_.onBoundary[p] == 0 && topology_.valence[p] != kRegularValence;
}

template <class StopAt>
QuadChains::Stop QuadChains::walk(Index h, std::vector<Index>& chain, const StopAt& stop) const
{
  chain = { cornerOf(quads_, h) };
  for (Index at = h; true;)
  {
    const Index target = cornerOf(quads_, nextInQuad(at));
    chain.push_back(target);
    if (stop(target) || topology_.onBoundary[target] != 0 || isIrregular(target))
    {
      return Stop::Ended;
    }
    // Across the edge to the left, and on: the one opposite to where it came in.
    const Index twin = topology_.twin[nextInQuad(at)];
    if (twin == kInvalidIndex)
    {
      return Stop::Ended;
    }
    at = nextInQuad(twin);
    if (at == h)
    {
      return Stop::Closed;
    }
    if (chain.size() > leaving_.size() + 1)
    {
      return Stop::Ended; // crosses itself before it would close
    }
  }
}

template <class Among>
Index QuadChains::nearest(const Vector3& p, const Among& among) const
{
  Index best = kInvalidIndex;
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < quads_.points.size(); ++i)
  {
    const double squared = (quads_.points[i] - p).squaredNorm();
    if (squared < least && !leaving_[i].empty() && among(i))
    {
      best = i;
      least = squared;
    }
  }
  return best;
}

std::optional<double> QuadChains::connection(const std::vector<Vector3>& line) const
{
  Index first = nearest(line.front(), [this](Index p) { return isEnd(p); });
  Index last = nearest(line.back(), [this](Index p) { return isEnd(p); });
  if (first == kInvalidIndex || last == kInvalidIndex)
  {
    return std::nullopt;
  }
  if (!isIrregular(first))
  {
    std::swap(first, last);
  }
  std::vector<Index> starts{ first };
  if (!isIrregular(first)) // both ends are on curves, along which they may lie anywhere
  {
    for (Index p = 0; p < onCurve_.size(); ++p)
    {
      if (onCurve_[p] != 0 && p != first)
      {
        starts.push_back(p);
      }
    }
  }
  std::optional<double> best;
  const bool toCurve = !isIrregular(last);
  for (const Index start : starts)
  {
    for (const Index h : leaving_[start])
    {
      std::vector<Index> chain;
      walk(h, chain, [&](Index p) { return p == last || (toCurve && onCurve_[p] != 0); });
      if (chain.back() != last && !(toCurve && onCurve_[chain.back()] != 0))
      {
        continue;
      }
      std::vector<Vector3> points;
      std::transform(chain.begin(), chain.end(), std::back_inserter(points),
        [this](Index p) { return quads_.points[p]; });
      const double distance = largestDistance(points, line);
      best = best ? std::min(*best, distance) : distance;
    }
  }
  return best;
}

std::optional<double> QuadChains::cycle(const std::vector<Vector3>& line) const
{
  double length = 0;
  for (std::size_t i = 0; i < line.size(); ++i)
  {
    length += (line[(i + 1) % line.size()] - line[i]).norm();
  }
  std::set<Index> starts{ nearest(line.front(), [](Index) { return true; }) };
  starts.erase(kInvalidIndex);
  constexpr int kRings = 4;
  for (int ring = 0; ring < kRings; ++ring)
  {
    std::set<Index> wider = starts;
    for (const Index p : starts)
    {
      for (const Index h : leaving_[p])
      {
        wider.insert(quads_.quads[h / 4].begin(), quads_.quads[h / 4].end());
      }
    }
    starts = std::move(wider);
  }
  std::optional<double> best;
  for (const Index start : starts)
  {
    if (isIrregular(start) || topology_.onBoundary[start] != 0)
    {
      continue;
    }
    for (const Index h : leaving_[start])
    {
      std::vector<Index> chain;
      if (walk(h, chain, [](Index) { return false; }) == Stop::Ended)
      {
        continue;
      }
      std::vector<Vector3> loop;
      std::transform(chain.begin(), chain.end(), std::back_inserter(loop),
        [this](Index p) { return quads_.points[p]; });
      const double distance = largestDistance(line, loop);
      best = best ? std::min(*best, distance) : distance;
    }
  }
  constexpr double kElsewhere = 0.1;
  return best && *best <= kElsewhere * length ? best : std::nullopt;
}

} // namespace quadrille

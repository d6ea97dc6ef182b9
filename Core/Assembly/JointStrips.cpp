// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Assembly/JointStrips.h"

#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Quads/QuadMesh.h"
#include "Quads/QuadTopology.h"
#include "Quads/SurfaceWalk.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace quadrille
{

void JointStrips::fillSheets()
{
  std::size_t most = 0;
  for (Index sheet = 0; sheet < sheets_.offset.size(); ++sheet)
  {
    most += chains_.lackOf(sheet);
  }
  most = 4 * (most + segments_.size());
  for (std::optional<ChainPlace> from = mostLacking(); from && met_.status.ok();
       from = mostLacking())
  {
    poll();
    const bool isDone = met_.strips < most && (insertFrom(*from, false) || fillOtherwise(*from));
    if (!isDone)
    {
      chains_.fail(
        "the quads of a sheet cannot get the edges that others have along their common curve",
        segments_[loops_[from->loop].chains[from->chain].segment].points.front());
    }
  }
}

bool JointStrips::fillOtherwise(const ChainPlace& from)
{
  countTry(Try::StripOtherwise);
  bool isDone = splitFrom(from, false);
  if (!isDone)
  {
    countTry(Try::StripOtherwise);
    isDone = insertFrom(from, true);
  }
  if (!isDone)
  {
    countTry(Try::StripOtherwise);
    isDone = splitFrom(from, true);
  }
  countTryLed(Try::StripOtherwise, isDone ? 1 : 0);
  return isDone;
}

std::optional<JointStrips::ChainPlace> JointStrips::mostLacking() const
{
  std::optional<ChainPlace> place;
  std::size_t most = 0;
  for (std::size_t l = 0; l < loops_.size(); ++l)
  {
    for (std::size_t c = 0; c < loops_[l].chains.size(); ++c)
    {
      if (chains_.lackOf(loops_[l].chains[c]) > most)
      {
        most = chains_.lackOf(loops_[l].chains[c]);
        place = { l, c };
      }
    }
  }
  return place;
}

bool JointStrips::takesEnd(const ChainPlace& from, const ChainPlace& to) const
{
  const SheetChain& chain = loops_[to.loop].chains[to.chain];
  const bool isSame = to.loop == from.loop && to.chain == from.chain;
  return chain.segment == kInvalidIndex || chains_.lackOf(chain) >= (isSame ? 2U : 1U);
}

void JointStrips::raise(const ChainPlace& from, const ChainPlace& to)
{
  if (!takesEnd(from, to))
  {
    ++segments_[loops_[to.loop].chains[to.chain].segment].edges;
  }
}

bool JointStrips::insertFrom(const ChainPlace& from, bool mayRaise)
{
  constexpr double freeCost = 10, raiseCost = 60;
  const Index sheet = loops_[from.loop].sheet;
  // By point: the chain that would get the other end.
  std::map<Index, std::pair<double, ChainPlace>> ends;
  for (std::size_t l = 0; l < loops_.size(); ++l)
  {
    for (std::size_t c = 0; c < loops_[l].chains.size() && loops_[l].sheet == sheet; ++c)
    {
      const SheetChain& chain = loops_[l].chains[c];
      const bool takes = takesEnd(from, { l, c });
      if (!takes && !mayRaise)
      {
        continue;
      }
      const double cost = !takes ? raiseCost : chain.segment == kInvalidIndex ? freeCost : 0;
      for (const Index p : chain.points)
      {
        const double atPoint = cost + crowdedCost(p);
        const auto [known, isNew] = ends.emplace(p, std::make_pair(atPoint, ChainPlace{ l, c }));
        if (!isNew && atPoint < known->second.first)
        {
          known->second = { atPoint, { l, c } };
        }
      }
    }
  }
  std::vector<std::pair<Index, double>> starts;
  for (const Index p : loops_[from.loop].chains[from.chain].points)
  {
    starts.emplace_back(p, crowdedCost(p));
  }
  const std::optional<QuadPath> path = findStripPath(quads_, starts,
    [&](Index, Index end) -> std::optional<double>
    {
      const auto found = ends.find(end);
      return found == ends.end() ? std::nullopt : std::optional<double>(found->second.first);
    });
  if (!path)
  {
    return false;
  }
  const Index last = path->back();
  const ChainPlace to = ends.at(quads_.quads[last / 4][(last + 1) % 4]).second;
  raise(from, to);
  const InsertedStrip strip = insertStrip(quads_, *path);
  splitAt(from, strip.points.front().first, strip.points.front().second, true);
  splitAt(to, strip.points.back().first, strip.points.back().second, false);
  crowd(from, strip.points.front().first);
  crowd(to, strip.points.back().first);
  spread(strip);
  spreadOnBoundary(to, strip.points.back().first);
  spreadOnBoundary(to, strip.points.back().second);
  ++met_.strips;
  withStrips_.insert(loops_[from.loop].sheet);
  return true;
}

bool JointStrips::splitFrom(const ChainPlace& from, bool mayRaise)
{
  const QuadTopology topology = analyzeQuads(quads_.quads, quads_.points.size(), threads_);
  std::map<std::pair<Index, Index>, Index> boundary; // half-edges by their ends
  for (Index h = 0; h < topology.twin.size(); ++h)
  {
    if (topology.twin[h] == kInvalidIndex)
    {
      boundary[{ quads_.origin(h), quads_.target(h) }] = h;
    }
  }
  struct Choice
  {
    QuadPath chord;
    ChainPlace to;
  };
  std::optional<Choice> best;
  const std::vector<Index> points = loops_[from.loop].chains[from.chain].points;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
  {
    const std::optional<QuadPath> chord =
      chordFrom(topology.twin, boundary.at({ points[i], points[i + 1] }));
    if (!chord)
    {
      continue;
    }
    const auto [x, y] = endOf(*chord);
    const std::optional<ChainPlace> to = chainOf(loops_[from.loop].sheet, x, y);
    if (to && (mayRaise || takesEnd(from, *to)) && (!best || chord->size() < best->chord.size()))
    {
      best = { *chord, *to };
    }
  }
  if (!best)
  {
    return false;
  }
  const Index a = quads_.quads[best->chord.front() / 4][best->chord.front() % 4];
  const auto [x, y] = endOf(best->chord);
  raise(from, best->to);
  const InsertedStrip strip = splitChord(quads_, best->chord);
  insertBehind(from, a, strip.points.front().second);
  insertBehind(best->to, x, strip.points.back().second);
  for (std::size_t i = 0; i < strip.points.size(); ++i)
  {
    // Half of the way along the edge that was split.
    const Index middle = strip.points[i].second;
    const Index q = static_cast<Index>(
      quads_.quads.size() - best->chord.size() + std::min(i, best->chord.size() - 1));
    const Index other = i < best->chord.size() ? quads_.quads[q][1] : quads_.quads[q][2];
    goTowards(middle, 0.5 * (quads_.points[other] - quads_.points[middle]));
  }
  spreadOnBoundary(best->to, strip.points.back().second);
  ++met_.strips;
  withStrips_.insert(loops_[from.loop].sheet);
  return true;
}

std::pair<Index, Index> JointStrips::endOf(const QuadPath& chord) const
{
  const Index h = oppositeInQuad(chord.back());
  return { quads_.origin(h), quads_.target(h) };
}

std::optional<JointStrips::ChainPlace> JointStrips::chainOf(Index sheet, Index x, Index y) const
{
  for (std::size_t l = 0; l < loops_.size(); ++l)
  {
    for (std::size_t c = 0; c < loops_[l].chains.size() && loops_[l].sheet == sheet; ++c)
    {
      const std::vector<Index>& points = loops_[l].chains[c].points;
      for (std::size_t i = 0; i + 1 < points.size(); ++i)
      {
        if (points[i] == x && points[i + 1] == y)
        {
          return ChainPlace{ l, c };
        }
      }
    }
  }
  return std::nullopt;
}

void JointStrips::insertBehind(const ChainPlace& place, Index point, Index added)
{
  std::vector<Index>& points = loops_[place.loop].chains[place.chain].points;
  points.insert(std::find(points.begin(), points.end(), point) + 1, added);
}

void JointStrips::spreadOnBoundary(const ChainPlace& place, Index point)
{
  constexpr double share = 1.0 / 3;
  const SheetChain& chain = loops_[place.loop].chains[place.chain];
  const auto at = std::find(chain.points.begin(), chain.points.end(), point);
  if (chain.segment != kInvalidIndex || at == chain.points.begin() || at + 1 >= chain.points.end())
  {
    return;
  }
  const Vector3& p = quads_.points[point];
  const Vector3 before = quads_.points[*(at - 1)] - p, behind = quads_.points[*(at + 1)] - p;
  borders_.move(point, loops_[place.loop].sheet, p + share * (before + behind));
}

void JointStrips::goTowards(Index p, const Vector3& displacement)
{
  const bool isOnFeature = std::any_of(quads_.lines.begin(), quads_.lines.end(),
    [p](const QuadLine& line) { return !line.boundary && (line.a == p || line.b == p); });
  std::optional<SurfacePoint> there;
  if (isOnFeature)
  {
    there = borders_.nearestOnFeatures(
      borders_.sheetOfFace(quads_.sourceFace[p]), quads_.points[p] + displacement);
  }
  else
  {
    there = walkSurface(mesh_, { quads_.sourceFace[p], quads_.sourceWeights[p] }, displacement);
  }
  if (there)
  {
    quads_.sourceFace[p] = there->face;
    quads_.sourceWeights[p] = there->weights;
    quads_.points[p] = positionOf(mesh_, *there);
  }
}

double JointStrips::crowdedCost(Index p) const
{
  const auto found = crowded_.find(p);
  return found == crowded_.end() ? 0 : found->second;
}

void JointStrips::crowd(const ChainPlace& place, Index point)
{
  constexpr double cost = 20;
  const std::vector<Index>& points = loops_[place.loop].chains[place.chain].points;
  const auto at = std::find(points.begin(), points.end(), point) - points.begin();
  const auto count = static_cast<std::ptrdiff_t>(points.size());
  const std::ptrdiff_t reach = std::max<std::ptrdiff_t>(2, count / 8);
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, at - reach);
       i < std::min(count, at + reach + 1); ++i)
  {
    double& there = crowded_[points[static_cast<std::size_t>(i)]];
    there = std::max(
      there, cost * (1 - static_cast<double>(std::abs(i - at)) / static_cast<double>(reach + 1)));
  }
}

void JointStrips::splitAt(const ChainPlace& place, Index point, Index copy, bool behind)
{
  std::vector<SheetChain>& chains = loops_[place.loop].chains;
  std::vector<Index>& points = chains[place.chain].points;
  const auto at = std::find(points.begin(), points.end(), point);
  const bool isAtEnd = behind ? at + 1 == points.end() : at == points.begin();
  points.insert(behind ? at + 1 : at, copy);
  // Chains that begin at the point begin at the copy, or end at it; before it also a loop of one chain its own end.
  const std::size_t count = chains.size();
  for (std::size_t i = 1; isAtEnd && i < count + (behind ? 0 : 1); ++i)
  {
    std::vector<Index>& next = chains[(place.chain + (behind ? i : count - i)) % count].points;
    const bool isOnlyPoint = next.size() == 1;
    Index& end = behind ? next.front() : next.back();
    end = end == point ? copy : end;
    if (!isOnlyPoint)
    {
      break;
    }
  }
}

void JointStrips::spread(const InsertedStrip& strip)
{
  std::map<Index, Vector3> ways = waysApart(strip, quads_);
  for (const auto& [p, q] : { strip.points.front(), strip.points.back() })
  {
    ways.erase(p);
    ways.erase(q);
  }
  for (const auto& [p, way] : ways)
  {
    goTowards(p, way);
  }
}

} // namespace quadrille

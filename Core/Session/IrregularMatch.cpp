// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/IrregularMatch.h"

#include "Quads/QuadSmoothing.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

namespace quadrille
{
namespace
{

struct IrregularPair
{
  double squared = 0;
  std::size_t expected = 0, actual = 0;

  bool operator<(const IrregularPair& other) const
  {
    return std::tie(squared, expected, actual) <
      std::tie(other.squared, other.expected, other.actual);
  }
};

/// All pairs within reach, by a sweep along x.
std::vector<IrregularPair> pairsWithin(const std::vector<IrregularVertex>& expected,
  const std::vector<IrregularVertex>& actual, const std::vector<double>& reach,
  const std::function<bool(std::size_t, std::size_t)>& mayPair)
{
  std::vector<std::size_t> order(actual.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return actual[a].place.x() < actual[b].place.x(); });
  std::vector<IrregularPair> pairs;
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    const Vector3& p = expected[i].place;
    auto at = std::lower_bound(order.begin(), order.end(), p.x() - reach[i],
      [&](std::size_t k, double x) { return actual[k].place.x() < x; });
    for (; at != order.end() && actual[*at].place.x() <= p.x() + reach[i]; ++at)
    {
      const double squared = (actual[*at].place - p).squaredNorm();
      if (squared <= reach[i] * reach[i] && actual[*at].valence == expected[i].valence &&
        (!mayPair || mayPair(i, *at)))
      {
        pairs.push_back({ squared, i, *at });
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// As many pairs as can be, each vertex in one at most.
class Partners
{
public:
  Partners(const std::vector<IrregularPair>& pairs, std::size_t expected, std::size_t actual)
    : candidates_(expected), actualOf_(expected), expectedOf_(actual)
  {
    for (const IrregularPair& pair : pairs)
    {
      candidates_[pair.expected].push_back(pair.actual);
      if (!actualOf_[pair.expected] && !expectedOf_[pair.actual])
      {
        join(pair.expected, pair.actual);
      }
    }
    for (std::size_t i = 0; i < expected; ++i)
    {
      if (!actualOf_[i])
      {
        isSeen_.assign(actual, 0);
        findFor(i);
      }
    }
  }

  std::vector<std::optional<std::size_t>> take() { return std::move(actualOf_); }

private:
  void join(std::size_t expected, std::size_t actual)
  {
    actualOf_[expected] = actual;
    expectedOf_[actual] = expected;
  }
  /// A partner that is free, or whose own one finds another: an augmenting path.
  bool findFor(std::size_t expected)
  {
    for (const std::size_t actual : candidates_[expected])
    {
      if (isSeen_[actual] != 0)
      {
        continue;
      }
      isSeen_[actual] = 1;
      if (!expectedOf_[actual] || findFor(*expectedOf_[actual]))
      {
        join(expected, actual);
        return true;
      }
    }
    return false;
  }

  std::vector<std::vector<std::size_t>> candidates_; ///< of expected ones, the nearest first
  std::vector<std::optional<std::size_t>> actualOf_, expectedOf_;
  std::vector<std::uint8_t> isSeen_; ///< actual ones
};

} // namespace

IrregularMatch matchIrregular(const std::vector<IrregularVertex>& expected,
  const std::vector<IrregularVertex>& actual, const std::vector<double>& reach,
  const std::function<bool(std::size_t, std::size_t)>& mayPair)
{
  IrregularMatch match;
  match.actual =
    Partners(pairsWithin(expected, actual, reach, mayPair), expected.size(), actual.size()).take();
  std::vector<std::uint8_t> isTaken(actual.size(), 0);
  for (const std::optional<std::size_t>& partner : match.actual)
  {
    if (partner)
    {
      isTaken[*partner] = 1;
    }
  }
  for (std::size_t k = 0; k < actual.size(); ++k)
  {
    if (isTaken[k] == 0)
    {
      match.unexpected.push_back(k);
    }
  }
  return match;
}

std::vector<IrregularVertex> irregularPoints(const QuadMesh& quads)
{
  std::vector<IrregularVertex> irregular;
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    const int valence = quads.valence[p] + (quads.onBoundary[p] != 0 ? 1 : 0);
    if (valence != kRegularValence)
    {
      irregular.push_back({ quads.points[p], valence });
    }
  }
  std::sort(irregular.begin(), irregular.end(),
    [](const IrregularVertex& a, const IrregularVertex& b)
    { return PlaceOrder()(a.place, b.place); });
  return irregular;
}

std::vector<ValencePlace> expectedIrregular(
  const std::vector<IrregularVertex>& shown, const std::optional<Isometry>& symmetry)
{
  std::vector<ValencePlace> expected;
  expected.reserve(shown.size() * (symmetry ? symmetry->order : 1));
  for (const IrregularVertex& vertex : shown)
  {
    for (int power = 0; power < (symmetry ? symmetry->order : 1); ++power)
    {
      expected.push_back(
        { power == 0 ? vertex.place : symmetry->image(vertex.place, power), vertex.valence });
    }
  }
  return expected;
}

ShownPlaces shownPlaces(
  const std::vector<IrregularVertex>& irregular, const QuadMesh& quads, const NearestQuads& nearest)
{
  const std::vector<std::uint8_t> isOnLine = pointsOnCurves(quads);
  std::vector<double> length(quads.points.size(), 0), edges(quads.points.size(), 0);
  for (const std::array<Index, 4>& quad : quads.quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      const Index a = quad[i], b = quad[(i + 1) % 4];
      const double edge = (quads.points[a] - quads.points[b]).norm();
      length[a] += edge;
      length[b] += edge;
      ++edges[a];
      ++edges[b];
    }
  }
  std::vector<IrregularVertex> points;
  std::vector<ShownPlace> places;
  std::vector<double> reach;
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    if (isOnLine[p] == 0 && quads.valence[p] != kRegularValence && edges[p] > 0)
    {
      points.push_back({ quads.points[p], quads.valence[p] });
      places.push_back({ quads.points[p], length[p] / edges[p], nearest.pointNormal(p) });
      reach.push_back(kReachOfSmoothing * places.back().edgeLength);
    }
  }
  std::vector<Vector3> normals;
  normals.reserve(irregular.size());
  for (const IrregularVertex& vertex : irregular)
  {
    normals.push_back(nearest.normalAt(vertex.place));
  }
  const IrregularMatch match = matchIrregular(points, irregular, reach,
    [&](std::size_t i, std::size_t k) { return areOnOneSide(places[i].normal, normals[k]); });
  ShownPlaces shown;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (match.actual[i])
    {
      shown[irregular[*match.actual[i]].place] = places[i];
    }
  }
  return shown;
}

void change(std::vector<IrregularVertex>& shown, const IrregularEdit::Change& made)
{
  auto nearest = shown.end();
  for (auto at = shown.begin(); made.before != kRegularValence && at != shown.end(); ++at)
  {
    const bool isNearer = nearest == shown.end() ||
      (at->place - made.place).squaredNorm() < (nearest->place - made.place).squaredNorm();
    nearest = at->valence == made.before && isNearer ? at : nearest;
  }
  if (nearest != shown.end())
  {
    shown.erase(nearest);
  }
  if (made.after != kRegularValence)
  {
    shown.push_back({ made.place, made.after });
  }
}

} // namespace quadrille

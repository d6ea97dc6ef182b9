// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/IrregularMatch.h"

#include <algorithm>
#include <numeric>
#include <tuple>

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
  const std::vector<IrregularVertex>& actual, double reach)
{
  std::vector<std::size_t> order(actual.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return actual[a].place.x() < actual[b].place.x(); });
  std::vector<IrregularPair> pairs;
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    const Vector3& p = expected[i].place;
    auto at = std::lower_bound(order.begin(), order.end(), p.x() - reach,
      [&](std::size_t k, double x) { return actual[k].place.x() < x; });
    for (; at != order.end() && actual[*at].place.x() <= p.x() + reach; ++at)
    {
      const double squared = (actual[*at].place - p).squaredNorm();
      if (squared <= reach * reach && actual[*at].valence == expected[i].valence)
      {
        pairs.push_back({ squared, i, *at });
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// As vertices whose valence is the sum of turns; those of ends and junctions differ by the number of sectors, too.
std::vector<IrregularVertex> asVertices(const std::vector<HeldVertex>& held)
{
  constexpr int kMostSectorTurns = 1000;
  std::vector<IrregularVertex> vertices;
  for (const HeldVertex& vertex : held)
  {
    int turns = kMostSectorTurns * static_cast<int>(vertex.sectors.size());
    for (const HeldSector& sector : vertex.sectors)
    {
      turns += sector.turns;
    }
    vertices.push_back({ vertex.place, turns });
  }
  return vertices;
}

} // namespace

IrregularMatch matchIrregular(const std::vector<IrregularVertex>& expected,
  const std::vector<IrregularVertex>& actual, double reach)
{
  IrregularMatch match;
  match.actual.resize(expected.size());
  std::vector<std::uint8_t> isTaken(actual.size(), 0);
  for (const IrregularPair& pair : pairsWithin(expected, actual, reach))
  {
    if (!match.actual[pair.expected] && isTaken[pair.actual] == 0)
    {
      match.actual[pair.expected] = pair.actual;
      isTaken[pair.actual] = 1;
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

std::vector<Vector3> differencesOnFeatures(
  const std::vector<HeldVertex>& expected, const std::vector<HeldVertex>& actual, double reach)
{
  const IrregularMatch match = matchIrregular(asVertices(expected), asVertices(actual), reach);
  std::vector<Vector3> places;
  for (std::size_t i = 0; i < expected.size(); ++i)
  {
    if (!match.actual[i])
    {
      places.push_back(expected[i].place);
    }
  }
  for (const std::size_t k : match.unexpected)
  {
    places.push_back(actual[k].place);
  }
  return places;
}

} // namespace quadrille

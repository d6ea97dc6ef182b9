// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/DefectSearch.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "GridMap/MapCheck.h"

#include <algorithm>
#include <cstddef>

namespace quadrille
{
std::vector<Index> DefectSearch::find(int threads) const
{
  const std::vector<int> turns = countTurns(threads);
  return parallelSelect(mesh_.faceCount(), kMediumChunk, threads,
    [&](Index f)
    {
      bool defect = !isPositive(f);
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        defect = defect || turns[mesh_.origin[h]] != expectedTurns_[mesh_.origin[h]];
      }
      return defect;
    });
}

std::array<std::int8_t, 3> DefectSearch::enteredBy(Index f) const
{
  return quadrantsEnteredByAll(&uv_[3 * f], isPositive(f) ? 1 : -1);
}

std::vector<int> DefectSearch::countTurns(int threads) const
{
  std::vector<std::int8_t> entered(mesh_.halfEdgeCount());
  parallelForEach(mesh_.faceCount(), kMediumChunk, threads,
    [&](std::size_t f)
    {
      const std::array<std::int8_t, 3> corners = enteredBy(static_cast<Index>(f));
      std::copy(corners.begin(), corners.end(), &entered[3 * f]);
    });
  return sumTurns(mesh_, [&](Index h) { return entered[h]; });
}

int DefectSearch::turnsRound(Index corner) const
{
  int turns = 0;
  forEachInFan(mesh_, corner, [&](Index h) { turns += enteredBy(Mesh::face(h))[h % 3]; });
  return turns;
}

bool DefectSearch::isDefect(Index f) const
{
  bool defect = !isPositive(f);
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    defect = defect || turnsRound(h) != expectedTurns_[mesh_.origin[h]];
  }
  return defect;
}

std::vector<Index> DefectSearch::findAmong(
  std::vector<Index> faces, const std::vector<Index>& changed) const
{
  for (const Index f : changed)
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      forEachInFan(mesh_, h, [&](Index c) { faces.push_back(Mesh::face(c)); });
    }
  }
  sortUnique(faces);
  eraseIf(faces, [&](Index f) { return !isDefect(f); });
  return faces;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/LevelTerms.h"

#include <algorithm>
#include <array>

namespace quadrille
{

std::optional<Index> positionIn(const Level& level, Index v)
{
  const auto found = std::lower_bound(level.fineVertex.begin(), level.fineVertex.end(), v);
  return found != level.fineVertex.end() && *found == v
    ? std::optional<Index>(static_cast<Index>(found - level.fineVertex.begin()))
    : std::nullopt;
}

Level inFineTerms(Level level, const Level& above)
{
  for (Index& v : level.fineVertex)
  {
    v = above.fineVertex[v];
  }
  for (Index& f : level.fineFace)
  {
    f = above.fineFace[f];
  }
  return level;
}

BlockRecords inFineTerms(BlockRecords records, const Level& above)
{
  renameRecords(
    records, [&](Index slot) { return 3 * above.fineFace[slot / 3] + slot % 3; },
    [&](Index v) { return above.fineVertex[v]; });
  return records;
}

FeatureCurves curvesOf(const Level& level, const FeatureCurves& fine)
{
  FeatureCurves curves;
  for (const Index v : level.fineVertex)
  {
    curves.kind.push_back(fine.kind[v]);
    curves.curve.push_back(fine.curve[v]);
  }
  const auto toLevel = [&](const std::array<Index, 2>& ends)
  {
    return ends[0] == kInvalidIndex
      ? ends
      : std::array<Index, 2>{ *positionIn(level, ends[0]), *positionIn(level, ends[1]) };
  };
  for (const std::array<Index, 2>& ends : fine.ends)
  {
    curves.ends.push_back(toLevel(ends));
  }
  for (const std::array<Index, 2>& ends : fine.endPairs)
  {
    curves.endPairs.push_back(toLevel(ends)); // the order of the vertices is kept
  }
  return curves;
}

} // namespace quadrille

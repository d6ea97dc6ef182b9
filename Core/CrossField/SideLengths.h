// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which lengths of curves turns allow. In a patch without irregular vertices the sides along u are as long in the map
/// as those against u, and so with v. Where every side has a strip (see PatchStrips), lengths above zero exist that
/// meet this, and those nearest to the curves' own by relative entropy come from iterative proportional fitting
/// [Sinkhorn 1967]: scale the sides of one patch and axis to equal sums, again and again. How far they are from their
/// own is what any map with these turns has to stretch.
#pragma once

#include "CrossField/PatchSides.h"
#include "CrossField/PatchStrips.h"

#include <optional>
#include <vector>

namespace quadrille
{

class SideLengths
{
public:
  /// Both have to outlive it; all sides need a strip.
  SideLengths(PatchSides& sides, PatchStrips& strips);

  /// Of a map with turns as they are: the squared logarithms of what each curve is stretched by, times its length over
  /// s, summed up.
  double strain() const;
  /// Moves turns in patches whose sides along u and against it differ, as long as this lessens the strain by more than
  /// it makes the turns of corners unnatural and leaves all sides their strips. Their patches are marked as changed.
  void evenOut();

private:
  std::vector<double> fitted() const;
  SidesByDirection sumsOf(Index patch, const std::vector<double>& length) const;
  double unevenness(const SidesByDirection& sums) const;
  std::vector<SidesByDirection> sumsBeforeCorners(const PatchLoop& loop) const;
  std::optional<TurnMove> bestMove(Index patch) const;

  PatchSides& sides_;
  PatchStrips& strips_;
  std::vector<double> length_; ///< per curve
  std::vector<std::vector<Index>> loopsOfPatch_;
};

} // namespace quadrille

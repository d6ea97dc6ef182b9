// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CrossField/SideLengths.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// Fitting ends when no patch is scaled by more than this, or after so many rounds.
constexpr double kFittedWithin = 0.01;
constexpr int kMostFits = 100;

} // namespace

SideLengths::SideLengths(PatchSides& sides, PatchStrips& strips)
  : sides_(sides), strips_(strips), loopsOfPatch_(sides.patchCount())
{
  const std::vector<PatchLoop>& loops = sides_.loops();
  for (Index l = 0; l < loops.size(); ++l)
  {
    const PatchLoop& loop = loops[l];
    loopsOfPatch_[loop.patch].push_back(l);
    const double first = loop.corners.empty() ? 0 : loop.before[loop.corners.front()];
    for (std::size_t i = 0; i < std::max<std::size_t>(1, loop.corners.size()); ++i)
    {
      const double begin = i == 0 ? first : loop.before[loop.corners[i]];
      const double end =
        i + 1 < loop.corners.size() ? loop.before[loop.corners[i + 1]] : loop.length + first;
      const Index curve = sides_.sides()[loop.firstSide + i].curve;
      length_.resize(std::max<std::size_t>(length_.size(), curve + 1));
      length_[curve] = end - begin;
    }
  }
}

double SideLengths::strain() const
{
  const std::vector<double> length = fitted();
  double sum = 0;
  for (std::size_t i = 0; i < length.size(); ++i)
  {
    const double stretch = length_[i] > 0 ? std::log(length[i] / length_[i]) : 0;
    sum += length_[i] * stretch * stretch;
  }
  return sum / sides_.input().length;
}

std::vector<double> SideLengths::fitted() const
{
  std::vector<double> length = length_;
  double most = 2 * kFittedWithin;
  for (int fit = 0; fit < kMostFits && most > kFittedWithin; ++fit)
  {
    most = 0;
    for (Index p = 0; p < sides_.patchCount(); ++p)
    {
      for (int axis = 0; axis < 2 && !sides_.isFree(p); ++axis)
      {
        const SidesByDirection sums = sumsOf(p, length);
        if (sums[axis] <= 0 || sums[axis + 2] <= 0)
        {
          continue;
        }
        const double by = std::sqrt(sums[axis + 2] / sums[axis]);
        most = std::max(most, std::abs(std::log(by)));
        for (const Index i : sides_.sidesOf(p))
        {
          const PatchSide& side = sides_.sides()[i];
          const int direction = sides_.direction(side.first);
          length[side.curve] *= direction == axis ? by : direction == axis + 2 ? 1 / by : 1;
        }
      }
    }
  }
  return length;
}

void SideLengths::evenOut()
{
  double least = strain();
  for (Index p = 0; p < sides_.patchCount(); ++p)
  {
    for (std::optional<TurnMove> move = bestMove(p); move; move = bestMove(p))
    {
      sides_.apply(*move);
      const bool hasStrips = strips_.find() == 0;
      const double now = hasStrips ? strain() : least;
      if (!hasStrips || now + move->cost >= least)
      {
        sides_.apply(move->back());
        break;
      }
      least = now;
      sides_.markChanged(p);
    }
  }
}

SidesByDirection SideLengths::sumsOf(Index patch, const std::vector<double>& length) const
{
  SidesByDirection sums{};
  for (const Index i : sides_.sidesOf(patch))
  {
    const PatchSide& side = sides_.sides()[i];
    sums[sides_.direction(side.first)] += length[side.curve];
  }
  return sums;
}

/// The strain of making sums equal within the patch, up to the second order.
double SideLengths::unevenness(const SidesByDirection& sums) const
{
  double sum = 0;
  for (int axis = 0; axis < 2; ++axis)
  {
    const double both = sums[axis] + sums[axis + 2];
    const double difference = sums[axis] - sums[axis + 2];
    sum += both > 0 ? difference * difference / both : 0;
  }
  return sum / sides_.input().length;
}

/// From the first corner on; the last ones are of the whole loop.
std::vector<SidesByDirection> SideLengths::sumsBeforeCorners(const PatchLoop& loop) const
{
  std::vector<SidesByDirection> before(1);
  for (Index i = 0; i < loop.corners.size(); ++i)
  {
    const PatchSide& side = sides_.sides()[loop.firstSide + i];
    before.push_back(before.back());
    before.back()[sides_.direction(side.first)] += length_[side.curve];
  }
  return before;
}

/// By the patch alone; none where no move lessens its unevenness by more than it costs.
std::optional<TurnMove> SideLengths::bestMove(Index patch) const
{
  if (sides_.isFree(patch))
  {
    return std::nullopt;
  }
  std::optional<TurnMove> best;
  const SidesByDirection all = sumsOf(patch, length_);
  double least = unevenness(all);
  for (const Index l : loopsOfPatch_[patch])
  {
    const std::vector<SidesByDirection> before = sumsBeforeCorners(sides_.loops()[l]);
    for (const TurnMove& move : sides_.movesOf(l))
    {
      SidesByDirection sums = all;
      for (int d = 0; d < 4; ++d)
      {
        const double between =
          before[move.to][d] - before[move.from][d] + (move.to < move.from ? before.back()[d] : 0);
        sums[d] -= between;
        sums[(d + move.by) & 3] += between;
      }
      if (const double now = unevenness(sums) + move.cost; now < least)
      {
        least = now;
        best = move;
      }
    }
  }
  return best;
}

} // namespace quadrille

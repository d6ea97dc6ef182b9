// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/HandleBasis.h"

#include "Base/Lists.h"

namespace quadrille
{

namespace
{

using Class = LoopSearch::Class;

constexpr std::size_t kNoBit = static_cast<std::size_t>(-1);

std::size_t lowestBit(const Class& sum)
{
  for (std::size_t i = 0; i < 64 * sum.size(); ++i)
  {
    if (sum[i / 64] == 0)
    {
      i += 63;
    }
    else if ((sum[i / 64] >> i % 64 & 1) != 0)
    {
      return i;
    }
  }
  return kNoBit;
}

void add(Class& sum, const Class& other)
{
  for (std::size_t i = 0; i < sum.size(); ++i)
  {
    sum[i] ^= other[i];
  }
}

bool oddOverlap(const Class& a, const Class& b)
{
  std::uint64_t overlap = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    overlap ^= a[i] & b[i];
  }
  for (int shift = 32; shift > 0; shift /= 2)
  {
    overlap ^= overlap >> shift;
  }
  return (overlap & 1) != 0;
}

} // namespace

HandleBasis::HandleBasis(std::size_t bits) : withLowestBit_(bits, kNoBit) {}

bool HandleBasis::insert(Class loop, const Class& crossings)
{
  for (const auto& [first, second] : pairs_)
  {
    // Both questions are about the class as it came in: pairs cross no other pair.
    const bool crossesFirst = oddOverlap(crossings, first);
    if (oddOverlap(crossings, second))
    {
      add(loop, first);
    }
    if (crossesFirst)
    {
      add(loop, second);
    }
  }
  const std::vector<Index> crossed =
    idsWhere(open_.size(), [&](Index i) { return oddOverlap(crossings, open_[i]); });
  if (!crossed.empty())
  {
    makePair(crossed, std::move(loop));
    return false;
  }
  return insertOpen(std::move(loop));
}

/// The class is the other way round the handle of one that it crosses; the others that it crosses are moved off it.
void HandleBasis::makePair(const std::vector<Index>& crossed, Class&& loop)
{
  // With the one of the highest lowest bit, adding it leaves all other lowest bits as they are.
  std::size_t partner = crossed.front();
  for (const Index i : crossed)
  {
    partner = lowestBit(open_[i]) > lowestBit(open_[partner]) ? i : partner;
  }
  for (const Index i : crossed)
  {
    if (i != partner)
    {
      add(open_[i], open_[partner]);
    }
  }
  withLowestBit_[lowestBit(open_[partner])] = kNoBit;
  pairs_.emplace_back(std::move(open_[partner]), std::move(loop));
  if (partner + 1 != open_.size())
  {
    open_[partner] = std::move(open_.back());
    withLowestBit_[lowestBit(open_[partner])] = partner;
  }
  open_.pop_back();
}

bool HandleBasis::insertOpen(Class&& loop)
{
  std::size_t bit = lowestBit(loop);
  while (bit != kNoBit && withLowestBit_[bit] != kNoBit)
  {
    add(loop, open_[withLowestBit_[bit]]);
    bit = lowestBit(loop);
  }
  if (bit == kNoBit)
  {
    return false;
  }
  withLowestBit_[bit] = open_.size();
  open_.push_back(std::move(loop));
  return true;
}

} // namespace quadrille

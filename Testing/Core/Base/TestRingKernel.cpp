// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/RingKernel.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

using namespace quadrille;

namespace
{

std::optional<FixedVec2> kernel(const std::vector<FixedVec2>& ring)
{
  return kernelPoint(ring.data(), static_cast<int>(ring.size()), true);
}

} // namespace

TEST(RingKernel, OfASquareIsItsCentre)
{
  const std::vector<FixedVec2> square{ { 0, 0 }, { 100, 0 }, { 100, 100 }, { 0, 100 } };
  EXPECT_EQ(kernel(square), (FixedVec2{ 50, 50 }));
}

TEST(RingKernel, IsFoundWhereAMeanOfTheCornersFails)
{
  // An L with long arms: the kernel is the square where they meet.
  const std::vector<FixedVec2> ring{ { 0, 0 }, { 1000, 0 }, { 1000, 10 }, { 10, 10 }, { 10, 1000 },
    { 0, 1000 } };
  EXPECT_EQ(kernel(ring), (FixedVec2{ 5, 5 }));
}

TEST(RingKernel, IsExactForSmallestKernels)
{
  // The only grid point with positive determinants of a triangle of three units is (1, 1).
  const std::vector<FixedVec2> ring{ { 0, 0 }, { 3, 0 }, { 0, 3 } };
  EXPECT_EQ(kernel(ring), (FixedVec2{ 1, 1 }));
  const std::vector<FixedVec2> tooSmall{ { 0, 0 }, { 1, 0 }, { 0, 1 } };
  EXPECT_EQ(kernel(tooSmall), std::nullopt);
}

TEST(RingKernel, AZigZagHasNone)
{
  const std::vector<FixedVec2> ring{ { 0, 0 }, { 100, 0 }, { 100, 100 }, { 90, 10 }, { 10, 90 },
    { 0, 0 }, { 0, 50 } };
  EXPECT_EQ(kernel(ring), std::nullopt);
  const std::vector<FixedVec2> clockwise{ { 0, 0 }, { 0, 100 }, { 100, 0 } };
  EXPECT_EQ(kernel(clockwise), std::nullopt);
}

TEST(RingKernel, OnASegmentStaysOnItsIsoline)
{
  // Vertices of a feature v = 7 between (0, 7) and (1000, 7); the ring admits only u in (600, 700).
  const std::vector<FixedVec2> ring{ { 0, 7 }, { 600, -500 }, { 1000, 7 }, { 700, 500 } };
  const auto whole = kernelPointOnSegment(ring.data(), 4, true, ring[0], ring[2]);
  ASSERT_TRUE(whole.has_value());
  EXPECT_EQ(whole->v, 7);
  // A slot below the line, from u = 600 to 700, must be seen into.
  const std::vector<FixedVec2> narrow{ { 0, 7 }, { 600, 6 }, { 600, -500 }, { 700, -500 },
    { 700, 6 }, { 1000, 7 }, { 700, 500 } };
  const auto inside = kernelPointOnSegment(narrow.data(), 7, true, narrow[0], narrow[5]);
  ASSERT_TRUE(inside.has_value());
  EXPECT_EQ(inside->v, 7);
  EXPECT_GT(inside->u, 600);
  EXPECT_LT(inside->u, 700);
}

TEST(RingKernel, OpenRingNeedsNoTriangleAtItsOpening)
{
  const std::vector<FixedVec2> half{ { 100, 0 }, { 0, 100 }, { -100, 0 } };
  EXPECT_TRUE(starIsPositive(half.data(), 3, false, { 0, 0 }));
  EXPECT_FALSE(starIsPositive(half.data(), 3, true, { 0, 0 }));
  EXPECT_EQ(kernelPointOnSegment(half.data(), 3, false, half[2], half[0]), (FixedVec2{ 0, 0 }));
}

TEST(RingKernel, RingThatWindsTwiceIsNoStar)
{
  // Every triangle with the origin is counterclockwise, but the ring goes round it twice, as it can next to a
  // cone of valence 5.
  const std::vector<FixedVec2> once{ { 100, 0 }, { 0, 100 }, { -100, 0 }, { 0, -100 } };
  std::vector<FixedVec2> twice = once;
  for (const FixedVec2 p : once)
  {
    twice.push_back({ 2 * p.u, 2 * p.v });
  }
  EXPECT_TRUE(starIsPositive(once.data(), 4, true, { 0, 0 }));
  EXPECT_FALSE(starIsPositive(twice.data(), 8, true, { 0, 0 }));
  EXPECT_EQ(kernelPoint(twice.data(), 8, true), std::nullopt);
}

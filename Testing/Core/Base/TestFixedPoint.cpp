// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/ChartRotation.h"
#include "Base/FixedPoint.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace quadrille
{

namespace
{

constexpr std::int64_t kLargest = std::int64_t{ 1 } << 44;

std::vector<FixedVec2> somePoints()
{
  std::vector<FixedVec2> points{ { 0, 0 }, { kOne, 0 }, { -1, 1 }, { kLargest, -kLargest },
    { -kLargest, -kLargest } };
  std::mt19937_64 random(11);
  std::uniform_int_distribution<std::int64_t> coordinate(-kLargest, kLargest);
  for (int i = 0; i < 50; ++i)
  {
    points.push_back({ coordinate(random), coordinate(random) });
  }
  return points;
}

std::vector<Transition> someTransitions()
{
  std::vector<Transition> transitions;
  const std::vector<FixedVec2> points = somePoints();
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    transitions.push_back({ static_cast<int>(i % 4), points[i] });
  }
  return transitions;
}

} // namespace

TEST(FixedPoint, FourQuarterTurnsAreNone)
{
  for (const FixedVec2 p : somePoints())
  {
    EXPECT_EQ(rotate(p, 0), p);
    EXPECT_EQ(rotate(p, 2), -p);
    EXPECT_EQ(rotate(rotate(rotate(rotate(p, 1), 1), 1), 1), p);
    for (int r = -8; r <= 8; ++r)
    {
      EXPECT_EQ(rotate(rotate(p, r), -r), p);
      EXPECT_EQ(rotate(p, r), rotate(p, r + 4));
    }
  }
  EXPECT_EQ(rotate({ kOne, 0 }, 1), (FixedVec2{ 0, kOne })); // counterclockwise
}

TEST(FixedPoint, TheRotationBetweenTwoImagesIsExact)
{
  for (const FixedVec2 p : somePoints())
  {
    for (int r = 0; r < 4 && p != FixedVec2{}; ++r)
    {
      EXPECT_EQ(rotationBetween(p, rotate(p, r)), r);
      EXPECT_FALSE(rotationBetween(p, rotate(p, r) + FixedVec2{ 1, 0 }))
        << "one step away is no image";
    }
    EXPECT_FALSE(rotationBetween(p, {})) << "all of them, or none";
    EXPECT_FALSE(rotationBetween({}, p));
  }
}

TEST(FixedPoint, TransitionsInvertExactly)
{
  for (const Transition& t : someTransitions())
  {
    EXPECT_TRUE(t.after(t.inverse()).isIdentity());
    EXPECT_TRUE(t.inverse().after(t).isIdentity());
    EXPECT_EQ(t.inverse().inverse(), t);
    for (const FixedVec2 p : somePoints())
    {
      EXPECT_EQ(t.inverse().apply(t.apply(p)), p);
    }
  }
}

TEST(FixedPoint, TransitionsComposeAsTheyApply)
{
  const std::vector<Transition> transitions = someTransitions();
  for (std::size_t i = 0; i + 2 < transitions.size(); ++i)
  {
    const Transition &a = transitions[i], &b = transitions[i + 1], &c = transitions[i + 2];
    EXPECT_EQ(a.after(b).after(c), a.after(b.after(c)));
    EXPECT_EQ(a.after(b).inverse(), b.inverse().after(a.inverse()));
    for (const FixedVec2 p : somePoints())
    {
      EXPECT_EQ(a.after(b).apply(p), a.apply(b.apply(p)));
    }
  }
}

TEST(FixedPoint, TransitionsKeepOrientation)
{
  const std::vector<FixedVec2> p = somePoints();
  for (const Transition& t : someTransitions())
  {
    for (std::size_t i = 0; i + 2 < p.size(); ++i)
    {
      EXPECT_TRUE(determinant(t.apply(p[i]), t.apply(p[i + 1]), t.apply(p[i + 2])) ==
        determinant(p[i], p[i + 1], p[i + 2]));
    }
  }
}

TEST(FixedPoint, OrientationIsExactAtTheLimits)
{
  // The longest possible edges, and a point off their line by the least possible amount: a double would
  // see 90 bits of product and lose the one that counts.
  const FixedVec2 a{ -kLargest, -kLargest }, b{ kLargest, kLargest };
  EXPECT_EQ(orientation(a, b, { 0, 0 }), 0);
  EXPECT_EQ(orientation(a, b, { 0, 1 }), 1);
  EXPECT_EQ(orientation(a, b, { 1, 0 }), -1);
  EXPECT_EQ(orientation(a, b, { kLargest - 1, kLargest }), 1);
  EXPECT_EQ(orientation(b, a, { kLargest - 1, kLargest }), -1);
  EXPECT_EQ(orientation({ 0, 0 }, { kOne, 0 }, { 0, kOne }), 1);
}

TEST(FixedPoint, ConversionRoundsToTheNearestGridValue)
{
  EXPECT_EQ(toFixed(1.0), kOne);
  EXPECT_EQ(toFixed(-2.5), -5 * kOne / 2);
  EXPECT_EQ(toFixed(0.4 / static_cast<double>(kOne)), 0);
  EXPECT_EQ(toFixed(0.6 / static_cast<double>(kOne)), 1);
  EXPECT_EQ(toFixed(-0.6 / static_cast<double>(kOne)), -1);
  for (const FixedVec2 p : somePoints())
  {
    EXPECT_EQ(toFixed(toDouble(p)), p); // 45 bits fit in a double
  }
}

TEST(FixedPoint, IntegersAreWholeUnits)
{
  EXPECT_TRUE(isInteger(std::int64_t{ 0 }));
  EXPECT_TRUE(isInteger(-3 * kOne));
  EXPECT_FALSE(isInteger(kOne / 2));
  EXPECT_FALSE(isInteger(-3 * kOne + 1));
  EXPECT_TRUE(isInteger(FixedVec2{ kOne, -kOne }));
  EXPECT_FALSE(isInteger(FixedVec2{ kOne, 1 }));
}

} // namespace quadrille

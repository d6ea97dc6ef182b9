// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "DrawnLine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace quadrille;

namespace
{

std::vector<Pixel> circle(double radius, int count, double share)
{
  std::vector<Pixel> path;
  for (int i = 0; i < count; ++i)
  {
    const double angle = 2 * M_PI * share * i / (count - 1);
    path.push_back({ radius * std::cos(angle), radius * std::sin(angle) });
  }
  return path;
}

} // namespace

TEST(DrawnLine, AnEvenPathKeepsEndsAndLength)
{
  const std::vector<Pixel> path{ { 0, 0 }, { 30, 0 }, { 30, 1 }, { 30, 40 } };
  const std::vector<Pixel> even = evenPath(path, 5);
  ASSERT_EQ(even.size(), 15u); // 70 pixels
  EXPECT_EQ(even.front(), path.front());
  EXPECT_EQ(even.back(), path.back());
  for (std::size_t i = 1; i < even.size(); ++i)
  {
    EXPECT_NEAR(std::hypot(even[i][0] - even[i - 1][0], even[i][1] - even[i - 1][1]), 5, 1e-12);
  }
}

TEST(DrawnLine, APathWithoutLengthIsOnePixel)
{
  EXPECT_TRUE(evenPath({}, 5).empty());
  EXPECT_EQ(evenPath({ { 3, 4 }, { 3, 4 } }, 5), (std::vector<Pixel>{ { 3, 4 } }));
}

TEST(DrawnLine, SmoothingTakesTheTremblingOutAndLeavesTheEnds)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> tremble(-2, 2);
  std::vector<Pixel> path;
  for (int i = 0; i <= 60; ++i)
  {
    path.push_back({ 5.0 * i, i == 0 || i == 60 ? 0 : tremble(random) });
  }
  const std::vector<Pixel> smooth = smoothPath(path, 3, false);
  EXPECT_EQ(smooth.front(), path.front());
  EXPECT_EQ(smooth.back(), path.back());
  double before = 0;
  double after = 0;
  for (std::size_t i = 3; i + 3 < path.size(); ++i)
  {
    before += path[i][1] * path[i][1];
    after += smooth[i][1] * smooth[i][1];
  }
  EXPECT_LT(after, before / 4); // the mean of seven has a seventh of the variance
}

TEST(DrawnLine, SmoothingAStraightLineChangesNothing)
{
  std::vector<Pixel> path;
  for (int i = 0; i < 20; ++i)
  {
    path.push_back({ 5.0 * i, 2.0 * i });
  }
  const std::vector<Pixel> smooth = smoothPath(path, 3, false);
  for (std::size_t i = 0; i < path.size(); ++i)
  {
    EXPECT_NEAR(smooth[i][0], path[i][0], 1e-12);
    EXPECT_NEAR(smooth[i][1], path[i][1], 1e-12);
  }
}

TEST(DrawnLine, ACircleClosesAndThreeQuartersOfItDoNot)
{
  EXPECT_TRUE(isClosedPath(circle(50, 80, 1), 10));
  EXPECT_TRUE(isClosedPath(circle(50, 80, 0.9), 10)); // a hand does not meet its begin
  EXPECT_FALSE(isClosedPath(circle(50, 80, 0.75), 10));
  EXPECT_FALSE(isClosedPath({ { 0, 0 }, { 100, 0 } }, 10));
}

TEST(DrawnLine, TheLongestRowOnOneSheetIsTaken)
{
  // Three places in front, five behind, two in front again.
  std::vector<std::optional<Place>> places;
  for (int i = 0; i < 10; ++i)
  {
    places.push_back(Place{ 0.1 * i, 0, i >= 3 && i < 8 ? -5.0 : 0.0 });
  }
  const auto seen = [&places](std::size_t begin, std::size_t end)
  {
    std::vector<Place> row;
    for (std::size_t i = begin; i < end; ++i)
    {
      row.push_back(*places[i]);
    }
    return row;
  };
  EXPECT_EQ(longestOnOneSheet(places, 0.5, 2), seen(3, 8));
  EXPECT_EQ(longestOnOneSheet(places, 6, 2), seen(0, 10));
  EXPECT_EQ(longestOnOneSheet({ places.front() }, 0.5, 2), seen(0, 1));
  EXPECT_TRUE(longestOnOneSheet({ std::nullopt, std::nullopt }, 0.5, 2).empty());
  EXPECT_TRUE(longestOnOneSheet({}, 0.5, 2).empty());
}

TEST(DrawnLine, ARowGoesOnBesideARayThatSlippedThrough)
{
  std::vector<std::optional<Place>> places;
  for (int i = 0; i < 12; ++i)
  {
    places.push_back(Place{ 0.1 * i, 0, 0 });
  }
  places[4] = places[5] = std::nullopt;
  EXPECT_EQ(longestOnOneSheet(places, 0.5, 2).size(), 10u);
  places[6] = std::nullopt;
  const std::vector<Place> after = longestOnOneSheet(places, 0.5, 2);
  ASSERT_EQ(after.size(), 5u); // of two rows, four and five long
  EXPECT_EQ(after.front(), *places[7]);
}

TEST(DrawnLine, KeptPlacesAreWithinTheToleranceOfAll)
{
  std::vector<Place> places;
  for (int i = 0; i <= 100; ++i)
  {
    places.push_back({ std::cos(0.02 * i), std::sin(0.02 * i), 0 });
  }
  const double tolerance = 0.01;
  const std::vector<std::size_t> kept = keptPlaces(places, tolerance);
  ASSERT_GE(kept.size(), 2u);
  EXPECT_EQ(kept.front(), 0u);
  EXPECT_EQ(kept.back(), 100u);
  // A chord of the angle a lies 1 - cos(a / 2) off the unit circle: at most 16 chords of 2 radians have to be kept.
  EXPECT_LT(kept.size(), 17u);
  for (std::size_t k = 1; k < kept.size(); ++k)
  {
    const double half = 0.01 * static_cast<double>(kept[k] - kept[k - 1]);
    EXPECT_LE(1 - std::cos(half), tolerance);
  }
}

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Lists.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace quadrille
{

TEST(Lists, ItemsAreGroupedInTheOrderInWhichTheyCome)
{
  const std::vector<std::pair<std::size_t, Index>> items{ { 2, 7 }, { 0, 5 }, { 2, 3 }, { 2, 9 } };
  const Grouped<> grouped(4,
    [&](const auto& visit)
    {
      for (const auto& [key, item] : items)
      {
        visit(key, item);
      }
    });
  const auto of = [&](std::size_t key)
  { return std::vector<Index>(grouped.begin(key), grouped.end(key)); };
  EXPECT_EQ(of(0), (std::vector<Index>{ 5 }));
  EXPECT_TRUE(of(1).empty());
  EXPECT_EQ(of(2), (std::vector<Index>{ 7, 3, 9 }));
  EXPECT_EQ(grouped.size(2), 3U);
  EXPECT_EQ(grouped.size(3), 0U);
}

TEST(Lists, TextsSayWhereThereIsMore)
{
  const auto textOf = [](int number) { return std::to_string(number); };
  EXPECT_EQ(joined(std::vector<int>{ 1, 2, 3 }, 3, textOf), "1, 2, 3");
  EXPECT_EQ(joined(std::vector<int>{ 1, 2, 3 }, 2, textOf), "1, 2, ...");
  EXPECT_EQ(joined(std::vector<int>{}, 2, textOf), "");
}

TEST(Lists, ValuesStayOnceAndInOrder)
{
  std::vector<int> list{ 3, 1, 3, 2, 1 };
  sortUnique(list);
  EXPECT_EQ(list, (std::vector<int>{ 1, 2, 3 }));
  append(list, std::vector<int>{ 6, 5 });
  eraseIf(list, [](int value) { return value % 2 == 0; });
  EXPECT_EQ(list, (std::vector<int>{ 1, 3, 5 }));
  EXPECT_TRUE(contains(list, 3));
  EXPECT_FALSE(contains(list, 2));
  EXPECT_EQ(idsWhere(5, [](Index i) { return i % 2 != 0; }), (std::vector<Index>{ 1, 3 }));
}

} // namespace quadrille

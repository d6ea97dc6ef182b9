// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/SharedArray.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace quadrille
{
namespace
{

TEST(SharedArray, CopiesHaveTheSameElementsAtTheSamePlace)
{
  const SharedArray<int> first{ 1, 2, 3 };
  const SharedArray<int> second = first;
  EXPECT_EQ(second.data(), first.data());
  EXPECT_TRUE(first.isShared());
  EXPECT_EQ(second, first);
}

TEST(SharedArray, AChangeOfOneLeavesTheOther)
{
  const SharedArray<int> first{ 1, 2, 3 };
  SharedArray<int> edited = first, longer = first, shorter = first, all = first;
  edited.edit()[1] = 7;
  longer.push_back(4);
  shorter.pop_back();
  for (int& value : all.editAll())
  {
    value = 0;
  }
  EXPECT_EQ(first.vector(), (std::vector<int>{ 1, 2, 3 }));
  EXPECT_EQ(edited.vector(), (std::vector<int>{ 1, 7, 3 }));
  EXPECT_EQ(longer.vector(), (std::vector<int>{ 1, 2, 3, 4 }));
  EXPECT_EQ(shorter.vector(), (std::vector<int>{ 1, 2 }));
  EXPECT_EQ(all.vector(), (std::vector<int>{ 0, 0, 0 }));
  EXPECT_FALSE(first.isShared());
}

TEST(SharedArray, WhatNobodySharesIsNotCopied)
{
  SharedArray<int> array{ 1, 2, 3 };
  const int* const place = array.data();
  array.edit()[0] = 5;
  EXPECT_EQ(array.data(), place);
  SharedArray<int> moved = std::move(array);
  EXPECT_EQ(moved.data(), place);
  EXPECT_EQ(moved.take().data(), place);
  EXPECT_TRUE(moved.empty());
}

TEST(SharedArray, TakingASharedOneLeavesTheOther)
{
  const SharedArray<int> first{ 1, 2 };
  SharedArray<int> second = first;
  EXPECT_EQ(second.take(), (std::vector<int>{ 1, 2 }));
  EXPECT_TRUE(second.empty());
  EXPECT_EQ(first.vector(), (std::vector<int>{ 1, 2 }));
}

TEST(SharedArray, AnEmptyOneIsAnEmptyVector)
{
  SharedArray<int> array;
  EXPECT_TRUE(array.empty());
  EXPECT_EQ(array.begin(), array.end());
  EXPECT_TRUE(array.vector().empty());
  EXPECT_EQ(array.edit(), nullptr);
  array.append({ 1, 2 });
  array.change([](std::vector<int>& values) { values.push_back(3); });
  EXPECT_EQ(array.vector(), (std::vector<int>{ 1, 2, 3 }));
  array.clear();
  EXPECT_EQ(array, SharedArray<int>());
}

} // namespace
} // namespace quadrille

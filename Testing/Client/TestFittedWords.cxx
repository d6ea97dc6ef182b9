// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "FittedWords.h"

#include <gtest/gtest.h>

#include <string>

using namespace quadrille;

namespace
{

/// Lines of ten letters; an ellipsis is one, which has three bytes.
bool isInTen(const std::string& text)
{
  const std::size_t bytesOfEllipsis = 3;
  const bool hasEllipsis = text.find("\xe2\x80\xa6") != std::string::npos;
  return text.size() - (hasEllipsis ? bytesOfEllipsis - 1 : 0) <= 10;
}

} // namespace

TEST(FittedWords, WhatHasRoomStaysAsItIs)
{
  EXPECT_EQ(fittedWords("", 2, isInTen), "");
  EXPECT_EQ(fittedWords("one two", 1, isInTen), "one two");
  EXPECT_EQ(fittedWords("one two three four", 2, isInTen), "one two\nthree four");
}

TEST(FittedWords, AnEllipsisEndsTheLastLineWhereThereIsMore)
{
  EXPECT_EQ(fittedWords("one two three four five", 2, isInTen), "one two\nthree\xe2\x80\xa6");
  EXPECT_EQ(fittedWords("one two three four five", 1, isInTen), "one two\xe2\x80\xa6");
  EXPECT_EQ(fittedWords("one two three six five", 2, isInTen), "one two\nthree six\xe2\x80\xa6");
}

TEST(FittedWords, AWordThatIsTooLongHasALineOfItsOwn)
{
  EXPECT_EQ(fittedWords("incomprehensible", 1, isInTen), "incomprehensible");
  EXPECT_EQ(fittedWords("an incomprehensible word", 3, isInTen), "an\nincomprehensible\nword");
}

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "FittedWords.h"

#include <algorithm>
#include <sstream>
#include <vector>

namespace quadrille
{
namespace
{

constexpr const char* kEllipsis = "\xe2\x80\xa6"; // in UTF-8

std::vector<std::string> wordsOf(const std::string& text)
{
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;)
  {
    words.push_back(word);
  }
  return words;
}

} // namespace

std::string fittedWords(
  const std::string& text, std::size_t lines, const std::function<bool(const std::string&)>& fits)
{
  const std::vector<std::string> words = wordsOf(text);
  std::string fitted;
  std::size_t at = 0;
  for (std::size_t line = 0; line < lines && at < words.size(); ++line)
  {
    std::size_t end = at;
    std::string row;
    const auto grow = [&row, &words](std::size_t i)
    { return row.empty() ? words[i] : row + ' ' + words[i]; };
    const bool isLast = line + 1 == lines;
    std::string whole; // the longest that has room for an ellipsis
    while (end < words.size() && (end == at || fits(grow(end))))
    {
      row = grow(end++);
      whole = end == at + 1 || fits(row + kEllipsis) ? row : whole;
    }
    const bool hasMore = isLast && end < words.size();
    fitted += (fitted.empty() ? "" : "\n") + (hasMore ? whole + kEllipsis : row);
    at = end;
  }
  return fitted;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/SetNames.h"

#include "Base/Lists.h"

#include <algorithm>

namespace quadrille
{

namespace
{

bool isContinuation(char c)
{
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; // of a character of UTF-8
}

char inUpperCase(char c)
{
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

bool isLetter(char c)
{
  return inUpperCase(c) >= 'A' && inUpperCase(c) <= 'Z';
}

bool isDigit(char c)
{
  return c >= '0' && c <= '9';
}

/// At most so many bytes, and no part of a character.
std::string cut(const std::string& text, std::size_t longest)
{
  std::size_t end = std::min(text.size(), longest);
  while (end > 0 && end < text.size() && isContinuation(text[end]))
  {
    --end;
  }
  return text.substr(0, end);
}

std::string trimmed(const std::string& text)
{
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string::npos
    ? std::string()
    : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

} // namespace

std::string SetNames::cleaned(const std::string& name, std::size_t longest) const
{
  std::string clean;
  for (const char c : trimmed(name))
  {
    if (rules_.identifiers)
    {
      if (!isContinuation(c))
      {
        clean += isLetter(c) || isDigit(c) ? c : '_'; // one for a character of several bytes
      }
      continue;
    }
    const bool isControl = static_cast<unsigned char>(c) < 0x20U || c == 0x7F;
    const bool isBlank = c == ' ' || isControl;
    clean += c == '"' ? '\'' : isBlank ? (rules_.blanks ? ' ' : '_') : c;
  }
  if (rules_.identifiers && (clean.empty() || !isLetter(clean[0])))
  {
    clean = "S_" + clean;
  }
  return clean.empty() ? "S" : cut(keyOf(clean), longest);
}

std::string SetNames::keyOf(const std::string& name) const
{
  std::string key = name;
  if (rules_.upperCase)
  {
    std::transform(key.begin(), key.end(), key.begin(), inUpperCase);
  }
  return key;
}

std::string SetNames::numbered(const std::string& name, std::size_t longest) const
{
  for (std::size_t number = 2;; ++number)
  {
    const std::string tail = "_" + std::to_string(number);
    std::string candidate = cut(name, longest - tail.size()) + tail;
    if (taken_.count(keyOf(candidate)) == 0)
    {
      return candidate;
    }
  }
}

std::vector<std::string> SetNames::unique(const std::vector<std::string>& names, std::size_t room)
{
  const std::size_t longest = rules_.longest - room;
  std::vector<std::string> result(names.size());
  for (const bool keeps : { true, false }) // those that can keep their name go first
  {
    for (std::size_t i = 0; i < names.size(); ++i)
    {
      const std::string clean = cleaned(names[i], longest);
      if ((clean == names[i]) != keeps)
      {
        continue;
      }
      const bool isTaken = taken_.count(keyOf(clean)) > 0;
      result[i] = isTaken ? numbered(clean, longest) : clean;
      taken_.insert(keyOf(result[i]));
      // A change of case alone means nothing where case does not count.
      if (result[i] != names[i] && !(rules_.upperCase && result[i] == keyOf(names[i])))
      {
        changed_.emplace_back(names[i], result[i]);
      }
    }
  }
  return result;
}

std::vector<std::string> SetNames::notices() const
{
  if (changed_.empty())
  {
    return {};
  }
  std::string text = std::to_string(changed_.size()) +
    (changed_.size() == 1 ? " name of a set is" : " names of sets are") +
    " another in this format, as it cannot have the character, the length, or the same name "
    "twice: ";
  return { text +
    joined(changed_, kMostTold,
      [](const auto& change) { return "'" + change.first + "' is " + change.second; }) };
}

} // namespace quadrille

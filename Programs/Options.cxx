// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

namespace quadrille
{

namespace
{

template <class Number>
Number parse(const std::string& name, const std::string& text, Number least, Number most)
{
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() ||
    !(value >= least && value <= most))
  {
    std::ostringstream message;
    message << "--" << name << " needs a number from " << least << " to " << most << ", not '"
            << text << "'";
    throw UsageError(message.str());
  }
  return value;
}

/// Insertions, deletions and exchanges of letters that lead from one word to the other.
std::size_t editDistance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{ 0 });
  for (std::size_t i = 1; i <= a.size(); ++i)
  {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j)
    {
      const std::size_t kept = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({ row[j] + 1, row[j - 1] + 1, kept });
    }
  }
  return row.back();
}

[[noreturn]] void refuseOption(
  const std::string& word, const std::string& name, const std::vector<std::string>& names)
{
  const auto nearest = std::min_element(names.begin(), names.end(),
    [&](const std::string& a, const std::string& b)
    { return editDistance(name, a) < editDistance(name, b); });
  const bool similar =
    nearest != names.end() && 2 * editDistance(name, *nearest) <= nearest->size();
  throw UsageError("unknown option " + word +
    (similar ? "; did you mean --" + *nearest + "?" : "; --help lists all options"));
}

bool contains(const std::vector<std::string>& names, const std::string& name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace

CommandLine::CommandLine(int argc, char* argv[], const std::vector<std::string>& known,
  const std::vector<std::string>& flags)
{
  for (int i = 1; i < argc; ++i)
  {
    const std::string word = argv[i];
    if (word == "--help" || word == "-h")
    {
      help_ = true;
      continue;
    }
    if (word.size() < 2 || word[0] != '-')
    {
      positional_.push_back(word);
      continue;
    }
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(2, equals == std::string::npos ? equals : equals - 2);
    const bool isFlag = contains(flags, name);
    if (word[1] != '-' || !(isFlag || contains(known, name)))
    {
      std::vector<std::string> names = known;
      names.insert(names.end(), flags.begin(), flags.end());
      refuseOption(word, name, names);
    }
    if (isFlag && equals != std::string::npos)
    {
      throw UsageError("--" + name + " takes no value");
    }
    if (isFlag)
    {
      values_.emplace(name, "");
      continue;
    }
    if (equals == std::string::npos && i + 1 >= argc)
    {
      throw UsageError(word + " needs a value");
    }
    const std::string value = equals == std::string::npos ? argv[++i] : word.substr(equals + 1);
    if (!values_.emplace(name, value).second)
    {
      throw UsageError("--" + name + " is given twice");
    }
  }
}

std::optional<std::string> CommandLine::text(const std::string& name) const
{
  const auto found = values_.find(name);
  return found == values_.end() ? std::nullopt : std::optional<std::string>(found->second);
}

std::optional<double> CommandLine::number(const std::string& name, double least, double most) const
{
  const std::optional<std::string> value = this->text(name);
  return value ? std::optional<double>(parse(name, *value, least, most)) : std::nullopt;
}

std::optional<long long> CommandLine::count(
  const std::string& name, long long least, long long most) const
{
  const std::optional<std::string> value = this->text(name);
  return value ? std::optional<long long>(parse(name, *value, least, most)) : std::nullopt;
}

int methodOf(const CommandLine& line)
{
  constexpr std::array<const char*, 4> kNames{ "scale-aware", "mixed-integer", "quadcover",
    "seamless" };
  const std::string name = line.text("method").value_or(kNames[0]);
  const auto* const found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end())
  {
    throw UsageError(
      "--method needs scale-aware, mixed-integer, quadcover or seamless, not '" + name + "'");
  }
  return static_cast<int>(found - kNames.begin());
}

int integersOf(const CommandLine& line)
{
  const std::string name = line.text("integers").value_or("keep-sizes");
  if (name != "keep-sizes" && name != "coarsest")
  {
    throw UsageError("--integers needs keep-sizes or coarsest, not '" + name + "'");
  }
  return name == "coarsest" ? 1 : 0;
}

} // namespace quadrille

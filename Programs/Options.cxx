// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

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

} // namespace

CommandLine::CommandLine(int argc, char* argv[], const std::vector<std::string>& known)
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
    if (word[1] != '-' || std::find(known.begin(), known.end(), name) == known.end())
    {
      throw UsageError("unknown option " + word);
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

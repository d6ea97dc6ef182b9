// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Command lines of the programs, by CLI11: each option is declared once, with its text in the help, what it may be and
/// who gets it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace quadrille
{

/// A command line that cannot be understood; the message says which argument, and what it may be.
class UsageError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// What a number may be.
template <class Number>
struct Range
{
  Number least;
  Number most;
};

/// Words without a leading "--" are files, "--name value" and "--name=value" are options, "--name" alone is a flag.
class CommandOptions
{
public:
  /// The help is the introduction, the options in their order, and the closing words.
  CommandOptions(const std::string& introduction, const std::string& closing);
  ~CommandOptions();
  CommandOptions(const CommandOptions&) = delete;
  CommandOptions& operator=(const CommandOptions&) = delete;

  /// Options from here on stand under this text in the help. To be called before the first one is added.
  void beginGroup(const std::string& text);

  /// What is given to the setters has been checked; they are called while parse() runs.
  void addNumber(const std::string& name, const std::string& unit, Range<double> range,
    std::function<void(double)> set, const std::string& help);
  void addCount(const std::string& name, const std::string& unit, Range<long long> range,
    std::function<void(long long)> set, const std::string& help);
  /// A count, or this word, for which the setter gets nothing.
  void addCountOrWord(const std::string& name, const std::string& unit, Range<long long> range,
    const std::string& word, std::function<void(std::optional<long long>)> set,
    const std::string& help);
  /// One of some words; the setter gets its place among them.
  void addChoice(const std::string& name, const std::string& unit,
    const std::vector<std::string>& words, std::function<void(int)> set, const std::string& help);
  void addText(const std::string& name, const std::string& unit,
    std::function<void(const std::string&)> set, const std::string& help);
  /// A text that may be given several times; the setter gets one after the other.
  void addTexts(const std::string& name, const std::string& unit,
    std::function<void(const std::string&)> set, const std::string& help);
  void addFlag(const std::string& name, std::function<void()> set, const std::string& help);

  /// What to print in place of a run, where --help or --version is given. Throws UsageError for an option that is none
  /// (and names the nearest one that is), lacks its value, has one though it is a flag, is given twice, or is not what
  /// it may be.
  std::optional<std::string> parse(int argc, char* argv[]);

  const std::vector<std::string>& files() const;
  bool given(const std::string& name) const;
  std::string help() const;

private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

/// Adds the option --method; the setter gets a number of vtkQuadRemesh::Methods, which are those of MapMethod.
void addMethod(CommandOptions& options, std::function<void(int)> set, const std::string& help);

} // namespace quadrille

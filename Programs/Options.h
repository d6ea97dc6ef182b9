// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Command lines of the programs.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace quadrille
{

/// A command line that cannot be understood; the message says which argument.
class UsageError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Words without a leading "--" are positional, "--name value" and "--name=value" are options, "--name" alone is a flag.
class CommandLine
{
public:
  /// Throws UsageError for an option that is neither in `known` nor in `flags` (and names the nearest one that is), lacks its value, has one
  /// though it is a flag, or is given twice.
  CommandLine(int argc, char* argv[], const std::vector<std::string>& known,
    const std::vector<std::string>& flags = {});

  const std::vector<std::string>& positional() const { return positional_; }
  bool help() const { return help_; }
  bool flag(const std::string& name) const { return values_.count(name) > 0; }
  std::optional<std::string> text(const std::string& name) const;
  /// Throw UsageError unless the value is a number in [least, most].
  std::optional<double> number(const std::string& name, double least, double most) const;
  std::optional<long long> count(const std::string& name, long long least, long long most) const;

private:
  std::vector<std::string> positional_;
  std::map<std::string, std::string> values_;
  bool help_ = false;
};

/// The option --method: a number of vtkQuadRemesh::Methods, which are those of MapMethod; 0 when it is not given. Throws
/// UsageError for a name that is none.
int methodOf(const CommandLine& line);

/// The option --integers: a number of vtkQuadRemesh::IntegersTypes; 0 when it is not given. Throws UsageError for a name that
/// is none.
int integersOf(const CommandLine& line);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Names of sets as a format can have them.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{

/// What a format takes for a name.
struct NameRules
{
  std::size_t longest = 0;  ///< bytes; at least 16
  bool identifiers = false; ///< letters, digits and _ only, a letter first
  bool upperCase = false;   ///< and names that differ in case only are one
  bool blanks = true;       ///< else _ stands in their place
};

/// Blanks and commas can be no part of a name, 80 characters, case does not count.
constexpr NameRules kInpNames{ 80, true, true, false };
/// In quotation marks, up to 127 characters.
constexpr NameRules kGmshNames{ 127, false, false, true };
/// 32 characters, which is what readers expect that do not ask for more.
constexpr NameRules kExodusNames{ 32, false, false, true };
/// One word; a blank would begin another group.
constexpr NameRules kObjNames{ 1000, false, false, false };
/// Text of comments.
constexpr NameRules kCommentNames{ 1000, false, false, true };

/// Gives each set a name of its own that follows the rules. Names that follow them already stay, and go first where
/// others would become them; these get _2, _3, ...
class SetNames
{
public:
  explicit SetNames(const NameRules& rules) : rules_(rules) {}

  /// The names in their order; `room` bytes less than the longest, for what is put behind them.
  std::vector<std::string> unique(const std::vector<std::string>& names, std::size_t room = 0);
  /// The same of sets that have a name.
  template <class Set>
  std::vector<std::string> uniqueOf(const std::vector<Set>& sets, std::size_t room = 0)
  {
    std::vector<std::string> names;
    names.reserve(sets.size());
    for (const Set& set : sets)
    {
      names.push_back(set.name);
    }
    return unique(names, room);
  }
  /// One sentence of all names that were changed; none where none was.
  std::vector<std::string> notices() const;

private:
  std::string cleaned(const std::string& name, std::size_t longest) const;
  std::string keyOf(const std::string& name) const;
  std::string numbered(const std::string& name, std::size_t longest) const;

  NameRules rules_;
  std::set<std::string> taken_;
  std::vector<std::pair<std::string, std::string>> changed_;
};

} // namespace quadrille

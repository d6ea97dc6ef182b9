// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the command shows while it works, and how it writes sentences.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace quadrille
{

/// On a terminal one line with a bar that is written over; elsewhere a line now and then, for who reads a log.
class ProgressDisplay
{
public:
  /// quiet: shows nothing.
  explicit ProgressDisplay(bool quiet);

  /// fraction in [0, 1]; text: "stage: what it does".
  void show(double fraction, const std::string& text);
  /// Takes the bar away.
  void finish();

private:
  using Clock = std::chrono::steady_clock;

  bool quiet_;
  bool terminal_;
  bool open_ = false;
  std::string drawn_; ///< the line as it stands
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

/// A bar of `width` characters in all, as "[####....]  45 %  Decimating  3 s"; the text gives way where there is no
/// room.
std::string barText(double fraction, const std::string& text, double seconds, std::size_t width);

/// The text in lines of at most `width` characters, broken at spaces; those after the first begin with `indent` spaces.
std::string wrapText(const std::string& text, std::size_t width, std::size_t indent);

/// Columns of the terminal behind standard error; none where it is no terminal.
std::size_t terminalWidth();

/// Writes sentences to standard error, one paragraph each with a dash before it: wrapped on a terminal, a line each
/// elsewhere.
void printSentences(const std::vector<std::string>& sentences);

} // namespace quadrille

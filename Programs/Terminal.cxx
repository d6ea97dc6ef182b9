// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace quadrille
{

namespace
{

constexpr std::size_t kBar = 24;
constexpr double kRedrawSeconds = 0.1;
/// Between two lines where there is no terminal, and before the first: short runs show none.
constexpr double kLineSeconds = 5;

double secondsOf(std::chrono::steady_clock::duration duration)
{
  return std::chrono::duration<double>(duration).count();
}

int percentOf(double fraction)
{
  return static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
}

} // namespace

std::string barText(double fraction, const std::string& text, double spent, std::size_t width)
{
  const auto full = static_cast<std::size_t>(std::lround(kBar * std::clamp(fraction, 0.0, 1.0)));
  char numbers[32];
  std::snprintf(numbers, sizeof(numbers), "] %3d %% %5.0f s  ", percentOf(fraction), spent);
  const std::string line =
    "[" + std::string(full, '#') + std::string(kBar - full, '.') + numbers + text;
  return line.substr(0, width);
}

std::string wrapText(const std::string& text, std::size_t width, std::size_t indent)
{
  std::istringstream words(text);
  std::string result;
  std::size_t column = 0;
  for (std::string word; words >> word;)
  {
    if (column > 0 && column + 1 + word.size() > width)
    {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    }
    else if (column > 0)
    {
      result += " ";
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

std::size_t terminalWidth()
{
  winsize size{};
  if (::isatty(STDERR_FILENO) == 0)
  {
    return 0;
  }
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

void printSentences(const std::vector<std::string>& sentences)
{
  const std::size_t width = terminalWidth();
  for (const std::string& sentence : sentences)
  {
    const std::string line = "- " + sentence;
    std::fprintf(stderr, "%s\n", width > 0 ? wrapText(line, width - 1, 2).c_str() : line.c_str());
  }
}

ProgressDisplay::ProgressDisplay(bool quiet) : quiet_(quiet), terminal_(terminalWidth() > 0) {}

void ProgressDisplay::show(double fraction, const std::string& text)
{
  const Clock::time_point time = Clock::now();
  if (quiet_ || secondsOf(time - last_) < (terminal_ ? kRedrawSeconds : kLineSeconds))
  {
    return;
  }
  last_ = time;
  if (!terminal_)
  {
    std::fprintf(stderr, "%3d %% after %.0f s: %s\n", percentOf(fraction), secondsOf(time - start_),
      text.c_str());
    return;
  }
  // The last column stays free: some terminals begin a new line there.
  const std::string line = barText(fraction, text, secondsOf(time - start_), terminalWidth() - 1);
  if (line != drawn_)
  {
    std::fprintf(stderr, "\r\033[K%s", line.c_str());
    std::fflush(stderr);
    drawn_ = line;
    open_ = true;
  }
}

void ProgressDisplay::finish()
{
  if (open_)
  {
    std::fprintf(stderr, "\r\033[K");
    std::fflush(stderr);
    open_ = false;
    drawn_.clear();
  }
}

} // namespace quadrille

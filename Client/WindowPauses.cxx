// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "WindowPauses.h"

#include <QObject>
#include <QTimer>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <memory>

namespace quadrille
{
namespace
{

using Clock = std::chrono::system_clock;

constexpr int kTick = 10;                         // milliseconds
constexpr std::chrono::milliseconds kPause{ 50 }; // shorter ones are not written

double seconds(Clock::duration time)
{
  return std::chrono::duration<double>(time).count();
}

/// Of the thread of the window.
double processorSeconds()
{
#ifdef CLOCK_THREAD_CPUTIME_ID
  std::timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
#else
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
#endif
}

} // namespace

void writePauses(QObject* parent)
{
  const char* path = std::getenv("QUADRILLE_WINDOW_PAUSES");
  if (!path)
  {
    return;
  }
  auto file = std::make_shared<std::ofstream>(path);
  *file << std::fixed << std::setprecision(3);
  auto* timer = new QTimer(parent);
  timer->setInterval(kTick);
  QObject::connect(timer, &QTimer::timeout, timer,
    [file, last = Clock::now(), worked = processorSeconds()]() mutable
    {
      const Clock::time_point now = Clock::now();
      if (now - last >= kPause)
      {
        *file << seconds(now.time_since_epoch()) << ' ' << seconds(now - last) << ' '
              << processorSeconds() - worked << std::endl;
      }
      last = now;
      worked = processorSeconds();
    });
  timer->start();
}

} // namespace quadrille

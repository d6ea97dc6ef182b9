// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Estimate.h"

#include "Base/Parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>

namespace quadrille
{

namespace
{

// Medians of quadrille-bench on scans, see Documentation/Performance.md: what does not depend on the surface (the
// coarse level), a triangle's share that threads cannot help, the share that they can, and a quad's share.
constexpr double kSecondsFixed = 0.3;
constexpr double kSecondsSerial = 0.9e-6;
constexpr double kSecondsParallel = 1.0e-6;
constexpr double kSecondsQuad = 8e-6;
constexpr double kBytesFixed = 30e6;
constexpr double kBytesTriangle = 200;
constexpr double kBytesQuad = 900;
/// Bytes that the store takes for a triangle of the input.
constexpr double kBytesRemembered = 150;

} // namespace

RunEstimate estimateRun(std::size_t triangles, double quads, int threads)
{
  const double faces = static_cast<double>(triangles);
  // Blocks of the decimation that share a border wait for each other; more than eight threads bring little.
  const double workers = std::min(8.0, static_cast<double>(resolveThreads(threads)));
  return { kSecondsFixed + (kSecondsSerial + kSecondsParallel / workers) * faces +
      kSecondsQuad * quads,
    kBytesFixed + kBytesTriangle * faces + kBytesQuad * quads };
}

double bytesToRemember(const RunEstimate& run, std::size_t triangles, std::size_t held)
{
  // What is held already is not free any more.
  return run.bytes +
    std::max(0.0, kBytesRemembered * static_cast<double>(triangles) - static_cast<double>(held));
}

double freeMemory()
{
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);)
  {
    double kibibytes = 0;
    if (std::sscanf(line.c_str(), "MemAvailable: %lf kB", &kibibytes) == 1)
    {
      return 1024 * kibibytes;
    }
  }
  return std::numeric_limits<double>::infinity();
}

std::string bytesText(double bytes)
{
  std::array<char, 64> text{};
  if (bytes < 1e9)
  {
    std::snprintf(text.data(), text.size(), "%.0f MB", std::ceil(bytes * 1e-6));
  }
  else
  {
    std::snprintf(text.data(), text.size(), "%.1f GB", bytes * 1e-9);
  }
  return text.data();
}

std::string estimateText(const RunEstimate& estimate)
{
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "about %.0f s and ", std::max(1.0, estimate.seconds));
  return text.data() + bytesText(estimate.bytes);
}

} // namespace quadrille

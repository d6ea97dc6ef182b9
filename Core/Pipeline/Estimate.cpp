// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Estimate.h"

#include "Base/Parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

namespace quadrille
{

namespace
{

// Medians of quadrille-bench on scans, see Documentation/Performance.md: what does not depend on the surface (the
// coarse level), a triangle's share, once of what threads cannot help and once of what they can, and a quad's share.
constexpr double kSecondsFixed = 0.3;
constexpr double kSecondsTriangle = 1.0e-6;
constexpr double kSecondsQuad = 8e-6;
constexpr double kBytesFixed = 30e6;
constexpr double kBytesTriangle = 200;
constexpr double kBytesQuad = 900;
// The same of pieces: all that a triangle takes is shared by the threads. Bytes that stay of each, and those of a piece
// under work; thinned triangles of a quad.
constexpr double kBytesStaying = 48;
constexpr double kBytesInPiece = 165;
constexpr double kThinnedOfQuad = 22;
/// Bytes that the store takes for a triangle of the input.
constexpr double kBytesRemembered = 150;

} // namespace

RunEstimate estimateRun(std::size_t triangles, double quads, int threads)
{
  const double faces = static_cast<double>(triangles);
  // Blocks of the decimation that share a border wait for each other; more than eight threads bring little.
  const double workers = std::min(8.0, static_cast<double>(resolveThreads(threads)));
  return { kSecondsFixed + kSecondsTriangle * (1 + 1 / workers) * faces + kSecondsQuad * quads,
    kBytesFixed + kBytesTriangle * faces + kBytesQuad * quads };
}

RunEstimate estimateInPieces(
  std::size_t triangles, std::size_t trianglesOfPiece, double quads, int threads)
{
  const double faces = static_cast<double>(triangles);
  const double pieces = std::max(1.0, std::round(faces / static_cast<double>(trianglesOfPiece)));
  const double workers = std::min(pieces, static_cast<double>(resolveThreads(threads)));
  const double thinned = std::min(faces, kThinnedOfQuad * quads);
  const RunEstimate joined = estimateRun(static_cast<std::size_t>(thinned), quads, threads);
  return { joined.seconds + kSecondsTriangle * faces / workers,
    kBytesStaying * faces + std::max(joined.bytes, kBytesInPiece * workers * faces / pieces) };
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
  return kInfinity;
}

Status memoryStatus(
  const RunEstimate& estimate, std::size_t triangles, const RemeshOptions& options)
{
  const double limit = options.memoryLimit.value_or(freeMemory());
  if (estimate.bytes <= limit)
  {
    return {};
  }
  return { StatusCode::TooLarge,
    "free memory, raise the memory limit, or decimate the surface first: about " +
      bytesText(estimate.bytes) + " of memory would be needed for " + std::to_string(triangles) +
      " triangles, but " + bytesText(limit) +
      (options.memoryLimit ? " are allowed" : " are free") };
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

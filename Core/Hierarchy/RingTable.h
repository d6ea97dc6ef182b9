// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where FreeStar finds the triangles of a ring, made by the compiler.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace quadrille
{

/// The triangles of a polygon with N corners, up to rotation, and the order in which the triangulation of
/// least cost asks for them.
template <int N>
struct RingTable
{
  static constexpr std::size_t kPaddedLanes = (N + 3) / 4 * 4;
  static constexpr std::size_t kTriples = std::size_t{ N } * (N - 1) * (N - 2) / 6;
  static constexpr std::size_t kOrbits = (kTriples + N - 1) / N;

  struct Orbit
  {
    std::uint8_t first = 0,
                 second = 0; ///< steps from the first to the second and to the third corner
  };
  std::array<Orbit, kOrbits> orbit{};
  /// Positions in the array of costs, for gaps 2 to N - 1, starts and middles in ascending order.
  std::array<std::uint8_t, kTriples> cost{};

  static constexpr bool isLess(int a1, int a2, int b1, int b2)
  {
    return a1 != b1 ? a1 < b1 : a2 < b2;
  }

  constexpr RingTable()
  {
    std::size_t count = 0;
    for (int d1 = 1; d1 <= N - 2; ++d1)
    {
      for (int d2 = 1; d1 + d2 <= N - 1; ++d2)
      {
        const int d3 = N - d1 - d2;
        if (!isLess(d2, d3, d1, d2) && !isLess(d3, d1, d1, d2))
        {
          orbit[count].first = static_cast<std::uint8_t>(d1);
          orbit[count].second = static_cast<std::uint8_t>(d1 + d2);
          ++count;
        }
      }
    }
    std::size_t step = 0;
    for (int gap = 2; gap < N; ++gap)
    {
      for (int a = 0; a + gap < N; ++a)
      {
        for (int b = a + 1; b < a + gap; ++b)
        {
          cost[step++] = position(a, b, a + gap);
        }
      }
    }
  }

  /// Where the cost of a triangle stands: by its orbit and the corner at which that begins.
  constexpr std::uint8_t position(int a, int b, int c) const
  {
    int start = a;
    int d1 = b - a;
    int d2 = c - b;
    int d3 = N - d1 - d2;
    for (int step = 0; step < 2 && (isLess(d2, d3, d1, d2) || isLess(d3, d1, d1, d2)); ++step)
    {
      start = (start + d1) % N;
      const int rotated = d1;
      d1 = d2;
      d2 = d3;
      d3 = rotated;
    }
    std::size_t k = 0;
    while (orbit[k].first != d1 || orbit[k].second != d1 + d2)
    {
      ++k;
    }
    return static_cast<std::uint8_t>(k * kPaddedLanes + static_cast<std::size_t>(start));
  }
};

template <int N>
constexpr RingTable<N> kRingTable{};

} // namespace quadrille

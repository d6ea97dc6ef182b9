// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The flips that lead from the fan which a collapse leaves to the planned triangulation of its ring.
#pragma once

#include "Hierarchy/DecimationMesh.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace quadrille
{

/// For rings of at most kRing vertices. Ring positions are counted from the target of the collapse: face j of the
/// fan, 1 <= j, is (target, j, j + 1).
template <std::size_t kRing>
class FanFlips
{
  static_assert(kRing <= 64, "neighbours of the target are bits of a word");

public:
  /// slots: the corners of the target in the faces of the fan, in order.
  void begin(const Index* slots, int count)
  {
    std::copy(slots, slots + count, fan_.begin() + 1);
    neighbours_ = 0;
  }

  /// A triangle of the planned triangulation.
  void add(std::size_t a, std::size_t b, std::size_t c)
  {
    opposite_[a][b] = static_cast<std::uint8_t>(c);
    opposite_[b][c] = static_cast<std::uint8_t>(a);
    opposite_[c][a] = static_cast<std::uint8_t>(b);
    if (a == 0 || b == 0 || c == 0)
    {
      neighbours_ |= std::uint64_t{ 1 } << a | std::uint64_t{ 1 } << b | std::uint64_t{ 1 } << c;
    }
  }

  void carryOut(DecimationMesh& mesh, int ringSize, RecordWriter& log)
  {
    int last = 1; // next to the target on the ring
    for (int i = 2; i < ringSize; ++i)
    {
      if ((neighbours_ >> i & 1U) != 0)
      {
        cutEars(mesh, last, i, log);
        last = i;
      }
    }
  }

private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  void cutEars(DecimationMesh& mesh, int x, int y, RecordWriter& log)
  {
    if (y - x < 2)
    {
      return;
    }
    const int z = opposite_[index(y)][index(x)];
    cutEars(mesh, x, z, log);
    cutEars(mesh, z, y, log);
    const Index h = fan_[index(z)];
    log.flip(h, mesh.twin[h]);
    mesh.flip(h);
    fan_[index(x)] = h;
  }

  std::array<Index, kRing> fan_{};
  std::array<std::array<std::uint8_t, kRing>, kRing> opposite_{};
  std::uint64_t neighbours_ = 0; ///< of the target: bits of ring positions
};

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which lines of a wedge's quads lie in its cuts.
#pragma once

#include "Extraction/Extraction.h"
#include "Symmetry/RotationCopies.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille
{

/// Which lines of a wedge run along a cut: no line across the wedge has both ends on the same side of it.
class CutLines
{
public:
  CutLines(std::size_t points, const std::vector<SeamPoints>& pairs)
    : isFirst_(points, 0), isSecond_(points, 0)
  {
    for (const SeamPoints& pair : pairs)
    {
      isFirst_[pair.first] = isSecond_[pair.second] = 1;
    }
  }

  bool inFirst(const QuadLine& line) const
  {
    return line.boundary && isFirst_[line.a] != 0 && isFirst_[line.b] != 0;
  }
  bool has(const QuadLine& line) const
  {
    return inFirst(line) || (line.boundary && isSecond_[line.a] != 0 && isSecond_[line.b] != 0);
  }

private:
  std::vector<std::uint8_t> isFirst_, isSecond_;
};

} // namespace quadrille

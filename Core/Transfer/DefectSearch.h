// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where a map has to be mended: triangles that are inverted or degenerate, and vertices about which it winds otherwise
/// than it should.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille
{

/// Of the map as it is whenever one is asked for.
class DefectSearch
{
public:
  /// expectedTurns: #V quarter turns round each vertex.
  DefectSearch(
    const Mesh& mesh, const std::vector<FixedVec2>& uv, const std::vector<int>& expectedTurns)
    : mesh_(mesh), uv_(uv), expectedTurns_(expectedTurns)
  {
  }

  bool isPositive(Index f) const
  {
    return determinant(uv_[3 * f], uv_[3 * f + 1], uv_[3 * f + 2]) > 0;
  }

  /// Faces to mend around: those that are not positive and those at a vertex of wrong turns.
  std::vector<Index> find(int threads) const;
  /// What find() would find now, from the faces before and from those that have changed since.
  std::vector<Index> findAmong(std::vector<Index> faces, const std::vector<Index>& changed) const;

private:
  /// Quarter turns round the vertex of a corner, by walking its fan.
  int turnsRound(Index corner) const;
  /// Quadrants entered in the corners of a face; a degenerate one counts like an inverted one.
  std::array<std::int8_t, 3> enteredBy(Index f) const;
  std::vector<int> countTurns(int threads) const;
  bool isDefect(Index f) const;

  const Mesh& mesh_;
  const std::vector<FixedVec2>& uv_;
  const std::vector<int>& expectedTurns_;
};

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Distances along a surface between its vertices: shortest paths in a graph whose arcs are straight lines through
/// strips of triangles.
#pragma once

#include "Mesh/Mesh.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace quadrille
{

/// A shortest path on a polyhedron is straight when the triangles that it crosses are laid out in a plane, and bends
/// at vertices only [Mitchell, Mount, Papadimitriou 1987]. Arcs join a vertex to all that see it through a strip of at
/// most kMostCrossings + 1 triangles; a longer straight line is followed by several of them, which bend at vertices
/// near it. So distances are never too short, and too long by 1 / cos of half the angle between neighbouring directions
/// at most: 1 % on the triangles of an even sampling (some ninety arcs a vertex), 1.4 % on a grid of right-angled ones
/// (fifty), and 2.5 % over a few edges of an uneven one. Exact windows would give that last per cent for hundred times
/// the work.
class GeodesicGraph
{
public:
  static constexpr int kMostCrossings = 6;

  /// The mesh is read here only. Time and memory are linear in it, some 800 bytes a vertex.
  explicit GeodesicGraph(const Mesh& mesh);

  /// The distance from `source` to each target; infinite for one of another component. The search ends when it has all
  /// of them. Throws InvalidInput for a vertex out of range.
  std::vector<double> distances(Index source, const std::vector<Index>& targets) const;

private:
  std::vector<std::size_t> firstArc_;         ///< #V + 1
  std::vector<std::pair<Index, float>> arcs_; ///< head and length
};

} // namespace quadrille

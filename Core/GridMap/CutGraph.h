// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Combing and cutting: one chart per component, opened along a cut graph that carries the rotations.
#pragma once

#include "CrossField/CrossField.h"
#include "Mesh/Mesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// A combed chart per component. The chart of face f, rotated by comb[f] quarter turns, is the chart of its
/// component; inside it a point has one image per wedge (the corners of a vertex between cut edges).
/// A segment is a chain of cut edges that all have the same transition.
struct CutGraph
{
  std::vector<std::uint8_t> comb; ///< #F, quarter turns 0..3
  std::vector<Index> component;   ///< #F
  Index components = 0;
  std::vector<Index> wedge; ///< #H: wedge of the corner
  Index wedges = 0;
  std::vector<Index>
    segment; ///< #H: of a half-edge that runs along its segment, else kInvalidIndex
  std::vector<std::uint8_t>
    rotation;              ///< #S: quarter turns from the chart left of it to the one right of it
  std::vector<Index> path; ///< the half-edges with a segment, segment by segment in order
};

/// Throws InvalidInput when matchings, alignments and turns of the field contradict each other.
CutGraph cutAlongField(const Mesh& mesh, const CrossField& field);

} // namespace quadrille

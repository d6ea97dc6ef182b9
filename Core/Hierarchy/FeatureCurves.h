// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The constrained curves (features and boundaries) of a mesh: which vertices must stay, which may go along
/// their curve, and which pairs must not be joined by a chord [Ebke et al. 2016, Section 5.2].
#pragma once

#include "Base/Angles.h"
#include "Mesh/Mesh.h"

#include <array>
#include <vector>

namespace quadrille
{

enum class VertexKind : std::uint8_t
{
  Free = 0,     ///< on no constrained edge
  Curve = 1,    ///< inner vertex of a curve: exactly two constrained edges and no corner
  Protected = 2 ///< end, junction or corner of curves, stays
};

struct FeatureCurves
{
  std::vector<VertexKind> kind; ///< #V
  std::vector<Index> curve;     ///< #V; curve of an inner curve vertex, else kInvalidIndex
  /// Protected end vertices of each curve; kInvalidIndex twice for a closed one without corners.
  std::vector<std::array<Index, 2>> ends;
  std::vector<std::array<Index, 2>>
    endPairs; ///< sorted copy of the ends that exist, lower id first

  /// Whether both vertices lie on one curve, ends included.
  bool onSameCurve(Index a, Index b) const;
};

/// Traces the curves. A vertex is a corner when the curve bends by more than kCornerAngle both between its two
/// edges and between the chords to the points `scale` (times the size there) away on both sides, and bends most among
/// its neighbours within scale / 2: so a corner survives and the staircase of a scan's boundary does not count as one.
FeatureCurves traceFeatureCurves(const Mesh& mesh, double scale);

} // namespace quadrille

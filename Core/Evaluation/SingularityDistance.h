// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How far the singularities of two cross fields on one surface are apart [Ebke et al. 2016, Section 8].
#pragma once

#include "Mesh/Mesh.h"

#include <map>
#include <vector>

namespace quadrille
{

/// Number of interior vertices per number of quarter turns (see CrossField::turns), regular ones left out.
std::map<int, std::size_t> singularityHistogram(const Mesh& mesh, const std::vector<int>& turns);

/// A part of the optimal transport: so many quarter turns go from one vertex to another one.
struct SingularityMove
{
  Index from = kInvalidIndex, to = kInvalidIndex;
  int turns = 0;     ///< >= 1
  double length = 0; ///< of the way along the surface
};

struct SingularityDistance
{
  /// The first Wasserstein (earth mover's) distance between the two distributions of indices: quarter turns times the
  /// length of their ways along the surface, the least there is; in units of the mesh.
  double work = 0;
  std::vector<SingularityMove> moves; ///< a transport with this work
  /// Quarter turns that found no partner, because the sums on some component differ.
  long long unmatched = 0;
};

/// The least work that turns the singularities of one field into those of the other, component by component: exact as a
/// transport problem [Rubner et al. 1998], with ways as in GeodesicGraph, rounded to a millionth of the longest one.
/// What both fields have at the same vertex stays. Indices of opposite sign that one field has alone cancel each other
/// by the way between them. turns, otherTurns: #V each. threads: 0: all; the result does not depend on it. Throws
/// InvalidInput where sizes disagree.
SingularityDistance singularityDistance(const Mesh& mesh, const std::vector<int>& turns,
  const std::vector<int>& otherTurns, int threads = 0);

} // namespace quadrille

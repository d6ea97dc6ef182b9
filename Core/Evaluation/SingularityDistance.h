// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How far the singularities of two cross fields on one surface are apart [Ebke et al. 2016, Section 8].
///
/// Where we differ: paths run along edges of the mesh, which makes all distances up to about 10 % longer.
#pragma once

#include "Mesh/Mesh.h"

#include <map>
#include <vector>

namespace quadrille
{

/// Number of interior vertices per number of quarter turns (see CrossField::turns), regular ones left out.
std::map<int, std::size_t> singularityHistogram(const Mesh& mesh, const std::vector<int>& turns);

struct SingularityDistance
{
  double work = 0; ///< earth mover's distance: quarter turns times length, in units of the mesh
  /// Quarter turns that found no partner, because the sums on some component differ.
  long long unmatched = 0;
};

/// The least work that turns the singularities of one field into those of the other. turns: #V each.
SingularityDistance singularityDistance(
  const Mesh& mesh, const std::vector<int>& turns, const std::vector<int>& otherTurns);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The integers of a map stay, everything else moves until the distortion against the surface is least: "the same
/// integers, solved again on a finer level" [Ebke et al. 2016, Section 10].
///
/// The unknowns are displacements of vertices, each in the chart of one corner and rotated into those of the others, so
/// transitions stay exactly as they are, whatever charts the map has. Integer vertices stay; vertices of constrained
/// edges slide along their isoline.
/// No determinant ever reaches zero on the way, so no vertex changes its winding, and the quads keep their
/// connectivity.
#pragma once

#include "Base/Error.h"
#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "Mesh/Mesh.h"
#include "Requests/Guides.h"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

struct RelaxOptions
{
  /// Newton steps; each is a factorization.
  int maximumSteps = 15;
  /// It ends where a step lowers the energy by less than this fraction.
  double leastGain = 1e-3;
  /// Bytes that may be taken; where more are needed nothing is done and the status says so.
  double maximumBytes = kInfinity;
  /// Directions that the isolines should keep; empty or #F. In a region of them it is one family that keeps them.
  std::vector<Guide> guides;
  /// Empty or #H flags of boundary half-edges: in the map they move half a quad into the surface, so that an isoline
  /// becomes a line half way between two of them. Their ends slide along what they meet there. With at least one
  /// step.
  std::vector<std::uint8_t> inset;
  int threads = 0; ///< 0: all; the result does not depend on it
  ProgressCallback progress;
};

struct RelaxResult
{
  /// TooLarge: nothing was done; the message tells what it would take. NotConverged: an inset boundary did not get to
  /// its place, as other vertices that must not move are in the way; the message has a place, uv is undefined.
  Status status;
  double before = 0; ///< mean of the energy over the area, 1 where the map is an isometry
  double after = 0;
  int steps = 0;
  double bytes = 0; ///< of a factorization
};

/// Minimizes the symmetric Dirichlet energy |J|^2 + |J^-1|^2 of the map from the surface, each connected component
/// scaled to the area that its map has. uv: #H, changed in place; untouched triangles that are not positive stay as
/// they are, with their vertices.
/// integerVertex: #V flags of vertices that must not move. Throws InvalidInput when sizes disagree. Cancelled leaves uv
/// undefined.
/// Sources: energy and step bounds as in [Smith and Schaefer 2015], projected Hessians as in Untangler.h.
RelaxResult relaxMap(const Mesh& mesh, const std::vector<std::uint8_t>& integerVertex,
  const RelaxOptions& options, std::vector<FixedVec2>& uv);

} // namespace quadrille

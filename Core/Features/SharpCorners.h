// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Features that leave a point at an angle that no corner of a quad can have.
#pragma once

#include "Mesh/Mesh.h"

#include <cstddef>
#include <string>

namespace quadrille
{

struct SharpCornerReport
{
  std::size_t corners = 0;         ///< at which a feature begins later now
  std::size_t removedEdges = 0;    ///< that are no features any more
  double removedLength = 0;        ///< in edge lengths of the quads
  double longest = 0;              ///< at one corner, the same
  Vector3 place = Vector3::Zero(); ///< the corner of the longest one

  /// What the user should know; empty where there is no such corner.
  std::string text() const;
};

/// Where two features, or a feature and a boundary, leave a point at less than 10 degrees on one side, a quad in that
/// corner has a scaled Jacobian of the sine of this angle at most. So the blunter of the two begins later, where it is 0.12
/// s (times the size there) away from the other one, or after 4 s: the quads between them go on past its end, side by side
/// with the one that stays. Only detected features change (without kRequestedFeature). The most acute corners first, in
/// rounds of corners that share no vertex, until nothing changes. On triangles no larger than quads, as whole edges go.
/// Throws InvalidInput unless edgeLength is positive.
SharpCornerReport trimSharpCorners(Mesh& mesh, double edgeLength, int threads = 1);

} // namespace quadrille

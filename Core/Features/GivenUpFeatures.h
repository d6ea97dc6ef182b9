// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sharp edges that are not used as features, curve by curve, with the reason.
#pragma once

#include "Mesh/Mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

/// Why a curve of sharp edges is no feature of the quads.
enum class FeatureLoss : std::uint8_t
{
  Unresolved, ///< below the smallest detail: see removeUnresolvedFeatures
  NoCrease,   ///< noise that lies in a row: see removeFalseCreases
  FailedMap,  ///< near the place where a map, or its quads, failed
  MidLine     ///< in a mirror plane, where quads across it were asked for
};
/// "unresolved", "no crease", "failed map", "mid-line".
const char* nameOf(FeatureLoss reason);
/// "not followed: ...", for lists of small details.
const char* whyNotFollowed(FeatureLoss reason);

/// A run of such edges, through vertices where two of them meet and nothing else.
struct GivenUpCurve
{
  FeatureLoss reason = FeatureLoss::Unresolved;
  Vector3 place = Vector3::Zero(); ///< on the curve, in the middle of its middle edge
  double length = 0;               ///< in units of the mesh
  double lengthInQuads = 0;        ///< in edge lengths of the quads there
  std::size_t edges = 0;
};

/// The half-edges, one of each edge, of features that a mesh does not have any more. flagsBefore: #H, its flags then.
std::vector<Index> lostFeatures(const Mesh& mesh, const std::vector<std::uint8_t>& flagsBefore);

/// The curves of lost features, by their first half-edges. halfEdges: one of each edge, ascending; edgeLength: s, > 0.
std::vector<GivenUpCurve> givenUpCurves(
  const Mesh& mesh, const std::vector<Index>& halfEdges, double edgeLength, FeatureLoss reason);

} // namespace quadrille

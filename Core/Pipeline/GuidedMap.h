// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The map of the coarse level, turned along the guides on the intermediate one.
///
/// A coarse triangle has one Jacobian, so there the isolines follow the mean of the guides that it stands for; how they
/// turn within it, and what the decimation has sheared, is seen on the intermediate level only.
#pragma once

#include "Base/FixedPoint.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/Mesh.h"
#include "Mesh/Requests.h"
#include "Transfer/Transfer.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille
{

/// Carries the map of the coarse level (coarseUv: #H of it) to the finest mesh. Between the two, the guided regions of
/// the intermediate level and a few quads round them are solved again with their integers, see RelaxMap.h; all else is
/// as transferMap has it. turns, integerVertex: #V of the finest mesh, as for certify(). None where there are no
/// guides, or where the solve would take too much (see relaxMap()).
std::optional<TransferResult> transferAlongGuides(const Mesh& fine, const Hierarchy& levels,
  const std::vector<FixedVec2>& coarseUv, const std::vector<int>& turns,
  const std::vector<std::uint8_t>& integerVertex, const TransferOptions& options);

/// Faces of the finest mesh within an edge length of what is guided on the intermediate level, with the guide that is
/// nearest, ascending: points of quads there keep to it when they are smoothed. Over no feature.
std::vector<FaceGuide> guidesRoundRegions(const Mesh& fine, const Level& level, double edgeLength);

} // namespace quadrille

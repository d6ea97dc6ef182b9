// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Cycles that a user draws. They are features of the surface, which the quads go straight on along: no irregular
/// vertex lies on them.
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Requests.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

bool hasCycles(const std::vector<CurveRequest>& curves);

/// Features that are drawn, and then the cycles among the curves, closed.
std::vector<FeatureRequest> featuresWithCycles(
  std::vector<FeatureRequest> features, const std::vector<CurveRequest>& curves);

/// Flags the half-edges (#H) of features along cycles: of a mesh whose features these have become, maybe a coarser
/// level. Their points are the course that they got on the surface (see drawFeatures). tolerance: in units of the mesh.
std::vector<std::uint8_t> edgesOfCycles(
  const Mesh& mesh, const std::vector<CurveRequest>& curves, double tolerance);

/// Quarter turns of sectors (#H, see CrossFieldOptions::sectorTurns; may be empty) with those along flagged edges: two
/// on each side, where a feature meets them one on each side of that. Sectors that are asked for stay, and so do those
/// of vertices where more meet on one side.
std::vector<int> straightAlong(
  const Mesh& mesh, const std::vector<std::uint8_t>& edges, std::vector<int> sectorTurns);

/// Whether a field makes these turns (#H) at all vertices of flagged edges, and some are flagged.
bool isStraightAlong(const Mesh& mesh, const std::vector<std::uint8_t>& edges,
  const std::vector<std::int8_t>& sectorTurns);

} // namespace quadrille

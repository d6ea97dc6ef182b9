// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Lines that a user draws: cycles, and connections whose ends are known. They are features of the surface, which the
/// quads go straight on along: no irregular vertex lies on them but at the ends of connections.
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Requests.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

bool hasLines(const std::vector<CurveRequest>& curves);

/// Adds the lines of a kind, cycles closed.
void addFeatures(
  const std::vector<CurveRequest>& curves, CurveKind kind, std::vector<FeatureRequest>& features);

/// What lies along a line: of a mesh whose feature it has become, maybe a coarser level.
struct EdgesOfLine
{
  std::vector<std::uint8_t> edges; ///< #H flags of its half-edges
  std::vector<std::uint8_t>
    ends; ///< #V flags of the ends of a connection, where nothing is asked of sectors
};

/// The line's points are the course that it got on the surface, see drawFeatures.
EdgesOfLine edgesOfLine(const Mesh& mesh, const CurveRequest& line);

/// Quarter turns of sectors (#H, see CrossFieldOptions::sectorTurns; may be empty) with those along lines: two on each
/// side, where a feature meets them one on each side of that. Sectors that are asked for stay, and so do those of
/// vertices where more meet on one side.
std::vector<int> straightAlong(
  const Mesh& mesh, const std::vector<CurveRequest>& lines, std::vector<int> sectorTurns);

/// Whether a field makes these turns (#H) at all vertices of the line, and there are some.
bool isStraightAlong(
  const Mesh& mesh, const CurveRequest& line, const std::vector<std::int8_t>& sectorTurns);

} // namespace quadrille

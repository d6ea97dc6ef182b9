// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Irregular vertices of earlier quads that are to stay where they are, also where refinement has made the vertex, and
/// on features and boundaries, where each sector makes quarter turns of its own.
#pragma once

#include "Mesh/Requests.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

struct Mesh;
struct PreparedSurface;
struct SurfaceInput;

/// The vertices that are meant: of those that are corners of triangles at the point, on features or off them, the
/// nearest one to the place that is not taken yet; in the order of `held`. Those without such a vertex are left out.
/// requests: gets the valences of those off features, ascending by vertex.
void placeHeldVertices(const SurfaceInput& input, const PreparedSurface& surface,
  std::vector<ValenceRequest>& requests, std::vector<SectorRequest>& sectors);

/// Sectors of the vertices of a level on its features and boundary that are flagged. sectorTurns: #H, see CrossField;
/// fineVertex: #V, their ids.
std::vector<SectorRequest> sectorsOf(const Mesh& level, const std::vector<std::int8_t>& sectorTurns,
  const std::vector<std::uint8_t>& flags, const std::vector<Index>& fineVertex);

/// #H of a level: at the first half-edge of a sector the quarter turns that it has to make, else 0. All sectors of
/// curves that pass make two, but for the vertices that are requested; ends and corners are free unless they are.
/// Sectors of a single triangle, which nothing can change, are left as they are. Empty where the surface does not ask.
std::vector<int> levelSectors(
  const PreparedSurface& surface, const Mesh& level, const std::vector<Index>& fineVertex);

} // namespace quadrille

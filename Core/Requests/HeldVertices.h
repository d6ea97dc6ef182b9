// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Vertices of earlier quads on features and boundaries that are to stay as they are, where each sector makes quarter
/// turns of its own; also where refinement has made the vertex.
#pragma once

#include "Mesh/Requests.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

struct Mesh;
struct PreparedSurface;
struct SurfaceInput;

/// Of the vertices that are meant: of those on features and boundaries that are corners of triangles at the point, the
/// nearest one to the place that is not taken yet, by a valence that is asked for or another one; in the order of
/// `held`. Those without such a vertex are left out, but for what the rest had there where faces without a map were cut
/// out of the surface: a vertex may have had several fans then, whose sectors are those of the vertex together.
/// Ascending by vertex.
std::vector<SectorRequest> placeHeldVertices(
  const SurfaceInput& input, const PreparedSurface& surface);

/// Sectors of the vertices of a level on its features and boundary that are flagged. sectorTurns: #H, see CrossField;
/// fineVertex: #V, their ids.
std::vector<SectorRequest> sectorsOf(const Mesh& level, const std::vector<std::int8_t>& sectorTurns,
  const std::vector<std::uint8_t>& flags, const std::vector<Index>& fineVertex);

/// #H of a level: at the first half-edge of a sector the quarter turns that it has to make, else 0. All sectors of
/// curves that pass make two, but for the vertices that are requested; ends and corners are free unless they are.
/// Sectors of a single triangle, which nothing can change, are left as they are. Empty where the surface does not ask.
std::vector<int> levelSectors(
  const PreparedSurface& surface, const Mesh& level, const std::vector<Index>& fineVertex);

/// Of a vertex of a mesh, from which half-edge h leaves, the sectors like those that are held: each has the quarter
/// turns of that whose middle is nearest to its own.
std::vector<HeldSector> sectorsLike(const std::vector<HeldSector>& held, const Mesh& mesh, Index h);

} // namespace quadrille

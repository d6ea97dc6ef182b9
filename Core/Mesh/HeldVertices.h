// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Irregular vertices of earlier quads that are to stay where they are, also where refinement has made the vertex, and
/// on features and boundaries, where each sector makes quarter turns of its own.
#pragma once

#include "Base/Types.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

struct Frame;
struct Mesh;
struct PreparedSurface;
struct SurfaceInput;
struct ValenceRequest;

/// From one feature or boundary edge at a vertex counterclockwise to the next.
struct HeldSector
{
  Vector3 middle = Vector3::Zero(); ///< the direction that halves its angle, of length 1
  int turns = 2;                    ///< quarter turns of the map, >= 1

  bool operator==(const HeldSector& other) const
  {
    return middle == other.middle && turns == other.turns;
  }
};

/// A vertex of the surface near a point of the input.
struct HeldVertex
{
  Index point = kInvalidIndex; ///< a corner of the input's triangle that the vertex lies in
  Vector3 place = Vector3::Zero();
  /// Counterclockwise, of a vertex on features or the boundary; at the boundary from its first one on. Empty: a vertex
  /// off them, which is the one that the target valence of the point is for.
  std::vector<HeldSector> sectors;

  bool operator==(const HeldVertex& other) const
  {
    return point == other.point && place == other.place && sectors == other.sectors;
  }
};

/// The same at a vertex of a surface.
struct SectorRequest
{
  Index vertex = kInvalidIndex;
  std::vector<HeldSector> sectors; ///< see HeldVertex
};

/// As the frame sees them, and back.
void enterFrame(std::vector<HeldVertex>& held, const Frame& frame);
void leaveFrame(std::vector<SectorRequest>& sectors, const Frame& frame);

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

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Cross field on faces with integer matchings, aligned to features and boundaries, whose indices can
/// carry a quad mesh.
///
/// Conventions. The field of face f is the angle of its first axis d_f against half-edge 3f, counter-
/// clockwise about the face normal. matching[h] = r means: d_f of face(h), carried across h by unfolding,
/// is about d_g of face(twin h) rotated by r quarter turns counterclockwise. So the transition of a map that
/// follows the field is p_g = R90^r p_f + t: rotation of the transition of h equals matching[h].
/// alignment[h] = k for a constrained half-edge means that h runs along d_f rotated by k quarter turns: in
/// the map h runs along axis R90^k (1, 0); -1 for an unconstrained one. Across a feature edge
/// matching[h] = alignment[twin h] + 2 - alignment[h] (mod 4).
#pragma once

#include "Base/Error.h"
#include "Base/Progress.h"
#include "Mesh/Mesh.h"
#include "Requests/Guides.h"
#include "Requests/SeamRequests.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// Where sizes are asked for.
enum class SizeWish
{
  /// Nowhere: quads are smaller round short loops alone. What moves for their sake between the sides of a patch has to
  /// fit these, which nothing sees to; so irregular vertices move only where no feature or boundary is.
  None,
  Everywhere,
  /// At some places, whose quads are few: an irregular vertex more is worth what it does for some quads there, see
  /// kQuadsOfVertex, and not for a share of the surface.
  AtPlaces
};

struct CrossFieldOptions
{
  double targetEdgeLength = 0; ///< s > 0; features of the field below this size are smoothed away
  ProgressCallback progress;
  /// Empty or #F: directions that the field follows, the more the larger their weight; features and boundaries
  /// come before them.
  std::vector<Guide> guides;
  /// Empty or #V: turns that vertices must have, met exactly; 0 where free, else see ValenceRequest.
  std::vector<int> targetValences;
  /// Empty or #V flags: vertices that are to be regular as far as can be.
  std::vector<std::uint8_t> regular;
  /// Empty or #H: quarter turns that the sector from a constrained half-edge on must make, met exactly; 0 where free. A
  /// target valence of its vertex comes before it.
  std::vector<int> sectorTurns;
  /// Why the mesh has sizes, if it has some: for their sake irregular vertices move.
  SizeWish sizes = SizeWish::None;
};

/// A guide that the field follows in a face.
struct FieldGuide
{
  double angle = 0; ///< of its direction against half-edge 3f, radians
  double weight =
    0; ///< as Guide::weight; 0 where free, or where a constrained edge comes before it
};

struct CrossField
{
  std::vector<double> angle;          ///< #F, radians
  std::vector<std::int8_t> matching;  ///< #H, 0..3; 0 on boundary half-edges
  std::vector<std::int8_t> alignment; ///< #H, 0..3 on constrained half-edges, else -1
  /// #H: for each corner that begins a sector (its half-edge is constrained) the quarter turns that
  /// the map makes in that sector, from this constrained half-edge counterclockwise to the next one, >= 1;
  /// 0 at all other corners.
  std::vector<std::int8_t> sectorTurns;
  /// #V: quarter turns of the map round the vertex; the valence of an interior vertex (4: regular);
  /// for a boundary vertex the sum over its open fan (2: regular).
  std::vector<int> turns;
  /// #F or empty, set by who makes the map: the shape that a face should have in it is this, symmetric and in the plane
  /// of `angle`, times the flat face; see measureStretch.
  std::vector<Eigen::Matrix2d> stretch;
  /// Set by who makes the map: parts of the boundary that are equally long in the map, and whose ends are integer
  /// vertices.
  std::vector<SeamEdges> seams;
  std::vector<FieldGuide> guides; ///< #F, or empty without guides; the map follows them, too

  Status status;
  /// Vertices around which the mesh cannot carry the turns; empty when the status is ok. One vertex may
  /// stand here for several of its sectors.
  std::vector<Index> failedAt;
};

/// Computes the field. Never makes an interior valence below 3 or above 6 or a sector below one quarter
/// turn unless it is asked to or topology forces it; then the status says where. Target valences that
/// the free vertices of their component cannot complete are Infeasible with an empty failedAt: nothing that the mesh
/// could change helps. Ok also means that positive angles exist in all triangles that add up to the turns of every fan,
/// without which no map could follow the field.
CrossField computeCrossField(const Mesh& mesh, const CrossFieldOptions& options);

/// Vertices whose position in the map must be an integer point: interior ones with turns != 4, and
/// constrained ones whose sectors are not all straight (a smooth feature has sectors 2 and 2, a smooth boundary 2),
/// which includes feature ends, junctions and corners; also the ends of seams. #V flags.
std::vector<std::uint8_t> integerVertices(const Mesh& mesh, const CrossField& field);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Handles of a surface that is thinned out before its quads are made: on thinned triangles short ones come out longer,
/// so those that no quads can show are cut on the surface itself.
#pragma once

#include "Hierarchy/Hierarchy.h"
#include "Mesh/Surface.h"
#include "Pieces/CarriedPlaces.h"
#include "Pipeline/SmallDetails.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace quadrille
{

/// A handle that is to be cut.
struct ShortHandle
{
  std::vector<Index> onLevel; ///< vertices of the level near it
  SmallDetail detail;
};

/// Handles found on the level, a thinned surface, that are shorter round than closedLoop on the surface itself, in the
/// units of both; not those beside one of the kept places, which the level shows as they are. quadEdge: s.
std::vector<ShortHandle> findShortHandles(const Mesh& mesh, const Level& level, double closedLoop,
  double quadEdge, const std::vector<Vector3>& kept, int threads);

/// Cuts and closes them near these places, vertices of the surface, one each. Returns those that were cut.
std::vector<SmallDetail> cutShortHandles(PreparedSurface& surface,
  const std::vector<ShortHandle>& handles, const std::vector<std::vector<Index>>& places,
  double closedLoop, double quadEdge, int threads);

class HandlesOfPiece
{
public:
  /// closedLoop: handles that are shorter round are cut, in units of the surface; 0: none. quadEdge: s.
  HandlesOfPiece(double closedLoop, double quadEdge) : closedLoop_(closedLoop), quadEdge_(quadEdge)
  {
  }

  /// Cuts and closes those that findShortHandles finds, on the surface itself. Returns whether the surface has changed:
  /// its ids are others then. To be called once.
  bool close(
    PreparedSurface& surface, const Level& level, const std::vector<Vector3>& kept, int threads);

  const std::vector<SmallDetail>& closed() const { return closed_; }
  /// Whether a vertex of the surface was made by a cut: the middle of a cap, which the input does not have, or the copy
  /// of a vertex on its edge.
  bool isNew(Index v) const { return !isNew_.empty() && isNew_[v] != 0; }
  /// The place itself where the face has such a vertex: its source is beside it then.
  std::optional<Vector3> offInput(const SurfacePoint& place) const;

private:
  /// A face with a vertex that the input does not have.
  struct OffFace
  {
    Index face = kInvalidIndex;
    std::array<Vector3, 3> corners;
  };

  void findNewVertices(const PreparedSurface& surface);

  double closedLoop_;
  double quadEdge_;
  std::vector<SmallDetail> closed_;
  std::vector<std::uint8_t> isNew_; ///< #V; empty: no vertex is
  std::vector<OffFace> offFaces_;   ///< ascending by face
};

} // namespace quadrille

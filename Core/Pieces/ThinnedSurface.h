// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A surface whose triangles are far smaller than its quads, thinned out before anything else: the quads are made on
/// the thinned surface, and their points go back to the triangles of the input. What SurfacePiece.h does with a part of
/// a surface, of a whole one, of which nothing is shared.
#pragma once

#include "Base/Progress.h"
#include "Extraction/Extraction.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/Surface.h"
#include "Pieces/HandlesOfPiece.h"
#include "Pieces/SurfacePiece.h"
#include "Pipeline/FailedParts.h"
#include "Prepare/Frame.h"

#include <vector>

namespace quadrille
{

class ThinnedSurface
{
public:
  /// Decimates until the edges exceed the edge length, without handles that are too short; vertices of target valences
  /// stay. fine: without guides. options: the lengths are those of `fine`.
  ThinnedSurface(PreparedSurface fine, const PieceOptions& options);

  /// The thinned surface as one by itself: its polygons are its own triangles, its input's points its own vertices. It
  /// has what was found on the surface: area, diagonal, components, features, sizes, what repair did; and what is asked
  /// of it. Handles that are
  /// too short on the surface itself are cut and closed; on thinned triangles they come out longer. closed: gets them,
  /// with places on `fine`.
  PreparedSurface surface(int threads, std::vector<SmallDetail>& closed) const;
  std::size_t faceCount() const { return level_.fineFace.size(); }
  /// Of each triangle a polygon of the input, on the same side of features.
  std::vector<Index> polygonsBeside() const;
  /// Polygons of components that have no quads become those of the input.
  void putOnInput(FailedParts& failed) const;

  /// The user's positions of its vertices. points: of the user's input, see FramedInput.
  std::vector<Vector3> userPoints(const Frame& frame, const std::vector<Vector3>& points) const;

  struct Places
  {
    std::vector<SourceLocation> ofPoints, ofQuads;
  };

  /// Where points and centres of quads lie on the input. quads: of `mapped`, which was made of surface(); both with
  /// their points at userPoints. kInvalidIndex for what is on no triangle of the thinned surface, as where a handle was
  /// closed. Lets the log go.
  Places carry(const QuadMesh& quads, const PreparedSurface& mapped,
    const std::vector<Vector3>& userPoints, int threads, const ProgressCallback& progress);

private:
  SurfaceRequests requests() const;

  PreparedSurface fine_;
  double closedLoop_, quadEdge_;
  std::vector<ShortHandle> handles_;
  Level level_;
  DecimationLog log_;
};

/// Puts the points of the quads where they lie on the user's surface.
void putOnInput(const std::vector<SourceLocation>& places, const std::vector<Vector3>& points,
  std::vector<Vector3>& quadPoints);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A piece of a surface that no single process holds. Decimation is local: each process thins its piece out, to
/// triangles that are small against the quads, and keeps the points that it shares with other pieces. The thinned
/// pieces together are a surface whose size depends on the quads alone; whoever has it makes the quads (remesh()). The
/// log of the decimation then carries their points back to the piece.
///
///   process i                                one process
///   SurfacePiece(input, options)
///   boundary()          ->  which points are shared  (any exchange)
///   thinOut(shared)
///   level()             ->  joinPieces()  ->  remesh()
///   carry(places)       <-  places on the triangles of level()
///
/// What is carried is the point, not the map: undoing a removal lays its star out flat and finds the points of its
/// triangles again among those of the star with its vertex (as in [Lee et al. 1998]). So a process needs no image of
/// its piece, and what it gets grows with the quads.
#pragma once

#include "Base/Progress.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/Surface.h"
#include "Pieces/CarriedPlaces.h"
#include "Pieces/HandlesOfPiece.h"
#include "Pipeline/Options.h"
#include "Pipeline/SmallDetails.h"
#include "Pipeline/StageRecords.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// Edges of a thinned piece over those of the quads, s. With a fifth the triangles are far finer than those of the
/// intermediate level, so that features, handles and curvature are what they are on the surface itself.
constexpr double kEdgeOfPiece = 0.2;

struct PieceOptions
{
  double edgeLength = 0; ///< that edges of the thinned piece exceed, > 0, in units of the input
  double quadEdge = 0;   ///< s, in units of the input; only where handles are to be cut
  /// Handles that are shorter round than this, in units of the input, are cut and closed before the piece is thinned,
  /// as on thinned triangles they come out longer. 0: none. Those near shared points are left to the whole surface, and
  /// all of a piece with shared points away from its boundary.
  double closedLoop = 0;
  /// As RemeshOptions::featureAngle: edges that are sharp on the piece are kept as curves, all of them. Which of them
  /// the quads can follow is judged on the whole surface: where a piece ends a curve may end without being noise.
  std::optional<double> featureAngle;
  int threads = 0; ///< 0: all; the result does not depend on it
  ProgressCallback progress;
};

/// What the options of a run mean for the pieces of a surface of this area and diagonal of the box around it, all of
/// them together: the edge length is kEdgeOfPiece times s, smaller where smaller sizes are asked for. `threads` and
/// `progress` are left as they are by default.
PieceOptions pieceOptionsOf(const RemeshOptions& options, double area, double boundingBoxDiagonal);

/// An edge of a thinned piece that it has in common with another one.
struct BorderEdge
{
  Index triangle = kInvalidIndex;
  Index corner = 0;                 ///< the edge runs from this corner to the next one
  Vector3 normal = Vector3::Zero(); ///< of the piece beside it, before it was thinned; of length 1
};

/// A thinned piece.
struct PieceLevel
{
  std::vector<Vector3>
    points; ///< #V; those of the input, bit for bit, but for the middles of closed handles
  std::vector<Index>
    inputPoint; ///< #V; their ids in the input, of new points that of one beside it
  std::vector<std::uint8_t> shared;            ///< #V; 1: one of the shared points
  std::vector<std::array<Index, 3>> triangles; ///< #F
  std::vector<std::uint8_t>
    detectedFeatures; ///< #F; bit i: the edge from corner i to i + 1 was found to be a feature
  std::vector<BorderEdge> border;              ///< where PieceOptions::featureAngle is set
  std::vector<std::uint8_t> requestedFeatures; ///< #F; the same of features that the input names
};

/// Where a place of a PieceLevel lies on the piece.
struct CarriedPlace
{
  SourceLocation source; ///< polygon, points and weights of the input
  /// The place itself where the input has none, as a handle was cut and closed there: source is beside it then.
  std::optional<Vector3> offInput;
};

class SurfacePiece
{
public:
  /// Repairs and orders the piece. input: as for remesh(); of its arrays features, patches and sizes count:
  /// where quads are to be smaller, so are the triangles.
  /// Throws InvalidInput as prepareSurface does, also for an input without polygons.
  SurfacePiece(SurfaceInput input, const PieceOptions& options);

  /// Ids of the input's points on the boundary of the piece as it is after repair, ascending: those that other pieces
  /// may share.
  const std::vector<Index>& boundary() const { return boundary_; }
  /// What repair changed, see RepairReport::text().
  std::string repairText() const { return surface_.repair.text(); }
  /// The handles that thinOut() has cut and closed.
  const std::vector<SmallDetail>& closedHandles() const { return handles_.closed(); }

  /// Repair, order, connectivity, phase1 and carry, as far as they are done.
  const StageRecords& stages() const { return stages_; }

  /// Decimates until the edges exceed the edge length, and lets the rest of the piece go, boundary() included; shared
  /// points (ids of the input, ascending) and the edges between them that are on the boundary stay. To be called once.
  void thinOut(const std::vector<Index>& shared);
  const PieceLevel& level() const { return told_; }
  /// Lets level() go, which is not needed to carry places.
  void forgetLevel() { told_ = {}; }

  /// Where places of level() lie on the piece, one each. Throws InvalidInput for a triangle out of range. To be called
  /// once: it uses the log up.
  std::vector<CarriedPlace> carry(const std::vector<SurfacePoint>& places);

  /// Bytes held now.
  std::size_t bytes() const;

private:
  /// The normal beside a boundary edge between shared points.
  struct BorderNormal
  {
    std::array<Index, 2> ends; ///< vertices of the mesh
    Vector3 normal;

    bool operator<(const BorderNormal& other) const { return ends < other.ends; }
  };

  Hierarchy decimate(const std::vector<Index>& shared) const;
  bool isShared(Index v, const std::vector<Index>& shared) const;
  /// Of shared points, all of which the level has.
  std::vector<Vector3> placesOf(const std::vector<Index>& shared, const Level& level) const;
  /// Returns whether the surface has changed.
  bool closeHandles(const Level& level, const std::vector<Index>& shared);
  void letGo();
  /// Ascending by their ends.
  std::vector<BorderNormal> borderNormals(const std::vector<Index>& shared) const;
  void tellBorder(const std::vector<BorderNormal>& border);
  void findInputPoints();
  void findBoundary();
  void tellLevel(const std::vector<Index>& shared);

  PieceOptions options_;
  PreparedSurface surface_;
  std::vector<Index> inputPoint_; ///< #V
  std::vector<Index> boundary_;
  Level level_;
  DecimationLog log_;
  PieceLevel told_;
  HandlesOfPiece handles_;
  StageRecords stages_;
};

/// Thinned pieces as one surface.
struct JoinedPieces
{
  /// Triangles of the pieces, one piece after the other, with detectedFeatures; points that are shared are there once.
  SurfaceInput surface;
  std::vector<Index> firstTriangle; ///< #pieces + 1
  /// Of each point, one of the pieces that have it, and its number in the level there.
  std::vector<std::array<Index, 2>> origin;
  std::size_t sharedPoints = 0; ///< points of more than one piece
};

/// Joins pieces at their shared points. ids: of each piece empty, or of each of its points a number that is the same
/// where points of several pieces are (global ids); without, points with the same coordinates are. Edges between two
/// pieces that are sharper than featureAngle (radians) on the pieces become features. Throws InvalidInput where the
/// numbers of ids are not those of the points.
JoinedPieces joinPieces(const std::vector<PieceLevel>& pieces,
  const std::vector<std::vector<std::int64_t>>& ids, std::optional<double> featureAngle);

} // namespace quadrille

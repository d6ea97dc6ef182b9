// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads with a symmetry. Of a mirror symmetry: the half of the surface in front of a plane is remeshed, and its quads
/// and their images are one mesh. The plane's curve is a boundary of the half, hence an isoline. Connectivity is
/// symmetric by construction, whatever the surface is; points behind the plane are exact images where the surface is
/// symmetric to within kRoundingOfSingle, else they are put onto the surface.
///
/// Of a rotation: a wedge between two half planes is remeshed, with both cuts as boundaries that get the same number of
/// edges (see Requests/SeamRequests.h), and its quads and those turned by 1 to n - 1 steps are one mesh.
#pragma once

#include "Evaluation/ConstraintWords.h"
#include "Pipeline/Pipeline.h"
#include "Symmetry/Isometry.h"
#include "Symmetry/SymmetrySearch.h"

#include <optional>
#include <vector>

namespace quadrille
{

/// A surface whose image is farther from it, as the root of the mean square over the diagonal, is refused.
constexpr double kLeastSymmetric = 0.05;

/// The order of a rotation, at least.
constexpr int kLeastOrder = 2;
/// And at most: then a wedge has less than six degrees.
constexpr int kMostOrder = 64;

struct RotationRequest
{
  int order = 2; ///< in [kLeastOrder, kMostOrder]
  /// The direction may have any length but 0. None: found, see findIsometry.
  std::optional<RotationAxis> axis;
};

struct SymmetryOptions
{
  /// The normal may have any length but 0. None: found, see findIsometry.
  std::optional<MirrorPlane> plane;
  /// In place of a mirror plane.
  std::optional<RotationRequest> rotation = std::nullopt;
  /// Of a mirror plane only.
  PlaneCurve planeCurve = PlaneCurve::Isoline;
};

/// A rotation that quads have.
struct MadeRotation
{
  RotationAxis axis; ///< direction: unit
  int order = 2;
};

/// The symmetry that quads have.
struct MadeSymmetry
{
  MirrorPlane plane;                    ///< normal: unit; the half in front of it was remeshed
  std::optional<MadeRotation> rotation; ///< in place of the plane
  ImageDeviation deviation; ///< of the image, or of that turned by one step, in units of the input
  double diagonal = 0;      ///< of the input's box
  // Where the status is ok.
  std::vector<Index>
    mirrorPoint; ///< per point of the quads: its image. Maps quads to quads and is its own inverse.
  /// Of a rotation, per point: its image turned by one step. Maps quads to quads, n times in a row it is nothing.
  std::vector<Index> rotatedPoint;
  std::vector<SourceLocation> pointSources; ///< per point, on the input
  std::vector<Index> quadPolygons;          ///< per quad, of the input
  std::size_t movedPoints = 0;              ///< that were put onto the surface
  double farthestMoved = 0;                 ///< of them, in units of the input
  /// The quads have the topology of the surface, and no quad is turned over where points were put onto the surface.
  bool isAlike = true;
};

/// None for null, and where no quads were made.
std::optional<Isometry> isometryOf(const MadeSymmetry* made);

struct SymmetricResult : MadeSymmetry
{
  /// Of the whole surface are the quads, the surface, the map, its turns, charts and certificate, and the number of
  /// handles; of the half in front all else. `surface` behind the plane is the image of that in front, and `quads` have
  /// their sources there; where they lie on the input is in pointSources and quadPolygons.
  RemeshResult remeshed;
};

/// As remesh(), which see; the target number of quads is that of the whole. Guides, valences and sizes of one side are
/// asked of both, see askOfPart; features are those of the half in front, or of the wedge. Of a rotation
/// the mapped surface is n wedges side by side, not joined at the cuts. With a store plane, axis and surface are not
/// looked at again. Throws InvalidInput, too, for a normal or an axis without direction, an order out of its range, a
/// plane with nothing of the surface in front of it or behind, wedges that do not fit together, and a surface that is
/// not nearly symmetric.
SymmetricResult remeshSymmetric(SurfaceInput input, const RemeshOptions& options,
  const SymmetryOptions& symmetry, ResultStore* store = nullptr);

/// Its row of the constraint table.
ConstraintWord judgeSymmetry(const MadeSymmetry& made);

} // namespace quadrille

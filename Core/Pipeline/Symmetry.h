// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Quads with a mirror symmetry: the half of the surface in front of a plane is remeshed, and its quads and their
/// images are one mesh. The plane's curve is a boundary of the half, hence an isoline. Connectivity is symmetric by
/// construction, whatever the surface is; points behind the plane are exact images where the surface is symmetric to
/// within kMirrorTolerance, else they are put onto the surface.
#pragma once

#include "Mesh/MirrorPlane.h"
#include "Mesh/MirrorSearch.h"
#include "Pipeline/Pipeline.h"

#include <optional>
#include <vector>

namespace quadrille
{

/// Over the diagonal of the surface's box: vertices that are nearer to the plane are put into it, and images that are
/// nearer to the surface stay where they are. Coordinates in single precision are known to a tenth of it.
constexpr double kMirrorTolerance = 1e-6;
/// A surface whose image is farther from it, as the root of the mean square over the diagonal, is refused.
constexpr double kLeastSymmetric = 0.05;

struct SymmetryOptions
{
  /// The normal may have any length but 0. None: found, see findMirrorPlane.
  std::optional<MirrorPlane> plane;
};

struct SymmetricResult
{
  /// Of the whole surface are the quads, the surface, the map, its turns, charts and certificate, and the number of
  /// handles; of the half in front all else. `surface` behind the plane is the image of that in front, and `quads` have
  /// their sources there; where they lie on the input is in pointSources and quadPolygons.
  RemeshResult remeshed;
  MirrorPlane plane;         ///< normal: unit; the half in front of it was remeshed
  MirrorDeviation deviation; ///< in units of the input
  double diagonal = 0;       ///< of the input's box
  // Where the status is ok.
  std::vector<Index>
    mirrorPoint; ///< per point of the quads: its image. Maps quads to quads and is its own inverse.
  std::vector<SourceLocation> pointSources; ///< per point, on the input
  std::vector<Index> quadPolygons;          ///< per quad, of the input
  std::size_t movedPoints = 0;              ///< that were put onto the surface
  double farthestMoved = 0;                 ///< of them, in units of the input
  /// Both sides have the same topology, and no quad is turned over where points were put onto the surface.
  bool isAlike = true;
};

/// As remesh(), which see; the target number of quads is that of the whole. Guides, valences and sizes of one side are
/// asked of both, see askOfHalf; features are those of the half in front. With a store plane and surface are not looked
/// at again. Throws InvalidInput, too, for a normal without direction, a plane with nothing of the surface in front of
/// it or behind, and a surface that is not nearly symmetric.
SymmetricResult remeshSymmetric(SurfaceInput input, const RemeshOptions& options,
  const SymmetryOptions& symmetry, ResultStore* store = nullptr);

} // namespace quadrille

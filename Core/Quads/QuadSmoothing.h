// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Better-shaped quads without leaving the input surface.
#pragma once

#include "Base/Progress.h"
#include "Mesh/Mesh.h"
#include "Mesh/Requests.h"
#include "Quads/QuadMesh.h"

namespace quadrille
{

/// Edge lengths of the quads there by which an irregular vertex is moved away from where the map has it, at most.
constexpr double kReachOfSmoothing = 2;

struct SmoothingOptions
{
  int steps = 5; ///< sweeps over all points, >= 0
  int threads = 0;
  ProgressCallback progress;
  std::vector<Index> fixedVertices; ///< of the mesh, ascending; points on them stay
  /// Of faces of the mesh, ascending: points there do not turn their edges off these directions for the sake of shape.
  std::vector<FaceGuide> guides;
  /// Points whose quads all have a scaled Jacobian above this stay, in (0, 1]: moves for the sake
  /// of shape alone take the mesh away from the ridges and valleys of the surface that the map
  /// follows.
  double goodShape = 0.75;
};

struct SmoothingResult
{
  std::size_t moves = 0; ///< accepted moves of all sweeps
};

/// Moves points towards the average of their neighbours, straight over the faces of the mesh, so that sourceFace and
/// sourceWeights stay exact; points of features and boundaries slide along their curves, corners, ends and junctions
/// stay, and so do points of polygons and of a trimmed boundary. A move is made only if it does not lower the worst
/// scaled Jacobian of the quads at the point and raises their sum (or the worst one, where that is bad).
/// A point of a curve slides also to where the two edges to its neighbours lie nearest to the curve, so that its bends
/// get points, as far as no scaled Jacobian there falls below 0.3 for it; other moves leave the curve no farther, nor,
/// in guided faces, the direction of the guide, but where a scaled Jacobian is below 0.3.
/// Points that share no quad are moved in parallel; the result does not depend on the number of threads. quads must be
/// a manifold that was extracted from mesh.
SmoothingResult smoothQuads(const Mesh& mesh, QuadMesh& quads, const SmoothingOptions& options);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// From an integer-grid map to its quads.
#pragma once

#include "Base/Error.h"
#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "Extraction/FeatureEnds.h"
#include "Filling/QuadRepair.h"
#include "Mesh/Mesh.h"
#include "Mesh/Requests.h"
#include "Quads/QuadMesh.h"

#include <string>
#include <utility>
#include <vector>

namespace quadrille
{

struct SurfaceShape;

/// How the quads are found.
enum class ExtractionPath
{
  Automatic, ///< Fast where all triangles are positive, else Folded
  Fast,      ///< for maps with det > 0 everywhere only
  Folded     ///< for any map: triangles may be inverted or without area
};

/// What becomes of cells that a boundary off the isolines cuts.
enum class BoundaryMode
{
  Aligned,  ///< there must be none: the boundary has to lie on isolines
  Trimmed,  ///< they are left out
  Polygons, ///< they are kept as polygons, see FreeBoundary.h; always by the fast path
};

struct ExtractionOptions
{
  ExtractionPath path = ExtractionPath::Automatic;
  BoundaryMode boundary = BoundaryMode::Aligned;
  std::size_t maximumNumberOfQuads = 10000000; ///< refuse, before memory is spent, to make more
  /// Sweeps of tangential smoothing on the input surface afterwards (see QuadSmoothing.h), >= 0, before quads that are
  /// inverted are mended (see QuadUntangling.h); 0: the points stay where the map has them.
  int smoothingSteps = 5;
  /// Whether bad quads that this leaves are replaced by others (see QuadRepair.h).
  bool replacesBad = true;
  ChainsOfQuads keptChains; ///< see QuadRepairOptions
  /// Vertices of the mesh, ascending, whose quad vertices smoothing must not move (irregular ones that were asked for).
  std::vector<Index> fixedVertices;
  std::vector<FaceGuide> guides; ///< see SmoothingOptions
  /// Whether the map's certificate is valid (GridMap/Certificate.h): then edges are not checked again.
  bool mapIsCertified = false;
  const SurfaceShape* shape = nullptr; ///< shapeOf the mesh, where the caller has it
  int threads = 0;
  ProgressCallback progress;
};

/// What the extraction met; all zero for an integer-grid map.
struct ExtractionCounts
{
  std::size_t openPorts = 0; ///< edges of the grid that could not be followed to their end
  std::size_t zeroSides =
    0; ///< sides of cells that a fold leads back to a copy of their own vertex
  std::size_t mergedVertices =
    0; ///< further copies of a grid vertex in folds that were joined to it
  std::size_t zippedSides =
    0; ///< pairs of sides between copies of vertices that were closed on each other
  std::size_t cancelledQuads = 0; ///< quads that lay over others in the sheets of folds
  std::size_t droppedFaces = 0;   ///< outlines of cells that are no quads
  std::size_t filledHoles =
    0; ///< small holes that such cells left and that were closed, see HoleFilling.h
};

/// By their names in reports: open_ports, zero_sides, merged_vertices, zipped_sides, cancelled_quads, dropped_outlines,
/// filled_holes.
std::vector<std::pair<std::string, std::size_t>> namedCounts(const ExtractionCounts& counts);

struct ExtractionResult : ExtractionCounts
{
  QuadMesh mesh;
  /// Ok: the map is an integer-grid map, or its folds could be bridged, and mesh is a manifold with
  /// the Euler characteristic, the components and the boundary loops of the input and all its
  /// features. Where the boundary is free: polygons with quads are that but for loopsInCells, and
  /// trimmed quads are a manifold of all cells that are whole; features may end at any point.
  /// NotConverged: mesh holds what could be extracted; the message names the places.
  /// TooLarge: mesh is empty.
  Status status;
  /// BoundaryMode::Trimmed: copies of points where only corners of whole cells had touched.
  std::size_t separatedFans = 0;
  /// Not BoundaryMode::Aligned: boundary loops inside of one cell, which no quad mesh of this size
  /// shows: trimmed away with their cell, or covered by it.
  std::size_t loopsInCells = 0;
  /// Ends, corners and junctions of features that do not lie on integer points, see FeatureEnds.h.
  FeatureEnds features;
};

/// The quads are the unit cells of the grid: each port (a corner of a cell, [Ebke et al. 2013]) is
/// followed along its isoline to the next corner of the same cell, with exact predicates, and the
/// cycles of length four are the quads. For an integer-grid map with det > 0 everywhere the result
/// conforms by construction. Elsewhere, in the spirit of the same paper, the lines run through the
/// sheets of folds and the copies of a grid vertex there are joined, see FoldedCells.h. uv: #H,
/// see GridMap.h. Linear in triangles plus quads. Throws InvalidInput for an empty mesh, a wrong
/// size of uv, or a coordinate beyond 2^44.
ExtractionResult extractQuads(
  const Mesh& mesh, const std::vector<FixedVec2>& uv, const ExtractionOptions& options);

/// What follows once the quads are there, of smoothingSteps, replacesBad, keptChains, fixedVertices and guides: also
/// for quads of the mesh that were changed.
void improveShape(const Mesh& mesh, const ExtractionOptions& options, QuadMesh& quads);

} // namespace quadrille

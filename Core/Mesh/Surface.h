// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// From a polygon soup to the prepared surface: validation, repair, space-filling-curve order,
/// features, refinement where the triangles are too large for the quads that are asked for.
#pragma once

#include "Base/Progress.h"
#include "Mesh/CurveRequests.h"
#include "Mesh/Guides.h"
#include "Mesh/HeldVertices.h"
#include "Mesh/Mesh.h"
#include "Mesh/NamesBefore.h"
#include "Mesh/SeamRequests.h"
#include "Mesh/StraightRequests.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{

/// How the corners of a polygon are taken.
enum class FaceOrder
{
  AsGiven,    ///< one after the other from the first one on
  FromLowest, ///< from the lowest point id on
  Reversed    ///< from the lowest point id on, the other way round
};

/// What the user hands in. Nothing is assumed about it.
struct SurfaceInput
{
  std::vector<Vector3> points;
  std::vector<Index> polygonOffsets; ///< #P + 1 offsets into polygonPoints
  std::vector<Index> polygonPoints;  ///< point ids, polygon after polygon
  std::vector<std::uint8_t>
    featureEdges; ///< empty or #P; bit i: edge from corner i to i+1 is a feature
  std::vector<std::int64_t> patchIds; ///< empty or #P; an edge between two values is a feature
  /// Whether these features may be given up where no quads can follow them (kYieldingFeature).
  bool patchesYield = false;
  /// Empty or #P; bits as in featureEdges: what was found on a finer surface that these polygons stand for. They are
  /// features that nobody asked for, in place of those of PrepareOptions::featureAngle.
  std::vector<std::uint8_t> detectedFeatures;
  /// Empty or #P: a direction that edges of the quads should have in the polygon, of any length; zero: free.
  std::vector<Vector3> guideDirections;
  std::vector<double>
    guideWeights; ///< empty (1 everywhere) or #P; in (0, 1] where there is a direction
  std::vector<int> targetValences; ///< empty or #points; 0: free, else see ValenceRequest
  /// Empty or #points: the edge length that quads should have there as a multiple of the target edge length, > 0.
  std::vector<float> sizing;
  std::vector<CurveRequest> curves; ///< connections and cycles, in units of the points
  /// Vertices inside, on no feature, that no target valence names are to be regular.
  bool regularElsewhere = false;
  /// Irregular vertices that stay, see HeldVertices.h.
  std::vector<HeldVertex> held;
  /// Curves that pass a vertex, features and boundaries, are to run straight there but for those that are held.
  bool regularOnFeatures = false;
  /// Parts of the boundary that get the same number of quads' edges, see SeamRequests.h.
  std::vector<SeamRequest> seams;
  /// Parts of the boundary that are straight in the map, see StraightRequests.h.
  std::vector<StraightRequest> straight;
  FaceOrder faceOrder = FaceOrder::AsGiven; ///< see Frame.h
  /// By how much coordinates may differ from what was meant, in units of the points, >= 0; 0: not known.
  double precision = 0;
};

struct PrepareOptions
{
  /// Edges whose face normals differ by more than this are features; radians in (0, pi]; none: off.
  std::optional<double> featureAngle;
  int threads = 0; ///< 0: all
  ProgressCallback progress;
};

/// What repair changed; all counts. Zero everywhere for a clean triangle mesh.
struct RepairReport
{
  std::size_t triangulatedPolygons = 0;
  std::size_t mergedPoints = 0;        ///< coincident points of a soup (STL) that were joined
  std::size_t degenerateFaces = 0;     ///< removed or collapsed: repeated corner, zero area
  std::size_t duplicateFaces = 0;      ///< removed
  std::size_t isolatedPoints = 0;      ///< dropped
  std::size_t nonManifoldEdges = 0;    ///< edges of more than two faces, split into sheets
  std::size_t nonManifoldVertices = 0; ///< split into sheets
  std::size_t reorientedFaces = 0;     ///< flipped to agree with their component
  std::size_t removedComponents =
    0; ///< components too small to carry a quad (a closed one below 4 faces)
  std::size_t refinedFaces = 0;  ///< faces that were split by refineSurface
  std::size_t closedHandles = 0; ///< handles that closeHandles cut and closed
  std::size_t filledHoles = 0;   ///< boundary loops that fillHoles closed

  /// "12 duplicate faces removed, 3 non-manifold edges split"; empty when nothing changed.
  std::string text() const;
};

/// Where a point of the prepared surface lies on the user's input.
struct SourceLocation
{
  Index polygon = kInvalidIndex;
  std::array<Index, 3> points{};   ///< input point ids of the triangle of that polygon
  std::array<double, 3> weights{}; ///< barycentric, sum 1
};

/// Sharp edges that are no creases.
struct FacetReport
{
  std::size_t edges = 0;
  Vector3 place = Vector3::Zero(); ///< of one of them

  /// What the user should know; empty where there is none.
  std::string text() const;
};

/// The finest level: repaired, ordered, with features. Immutable after refinement.
struct PreparedSurface
{
  Mesh mesh;
  RepairReport repair;
  FacetReport facets;
  double area = 0;
  double boundingBoxDiagonal = 0;
  Index components = 0;
  /// Content hash of positions, connectivity and features; binds a decimation log to its mesh.
  std::uint64_t hash = 0;

  std::vector<Index> sourcePolygon; ///< #F
  /// #F; ids of the input points at the corners of the unrefined face. Repair may have moved a corner
  /// of a degenerate polygon's neighbour to another input point; then that point's id stands here.
  std::vector<std::array<Index, 3>> sourcePoints;
  /// Only where a face was split: index into cornerWeights, else kInvalidIndex. Empty when no face
  /// was split.
  std::vector<Index> refinedEntry;
  std::vector<std::array<std::array<double, 3>, 3>> cornerWeights; ///< [corner][source corner]

  /// Guides and valences that were asked for; not part of the hash, as the finest level does not depend on them.
  std::vector<PolygonGuide> polygonGuides;     ///< ascending by polygon; see surfaceGuides
  std::vector<ValenceRequest> valenceRequests; ///< ascending by vertex, one a vertex
  std::size_t unusedValences = 0;              ///< requests of points that no face uses
  std::vector<CurveRequest> curves;            ///< as they were given, in the frame
  bool regularElsewhere = false;               ///< as it was given
  std::vector<SectorRequest> sectorRequests;   ///< ascending by vertex
  bool regularOnFeatures = false;              ///< as it was given
  std::vector<SeamRequest> seams;              ///< as they were given, in the frame
  std::vector<StraightRequest> straight;       ///< as they were given, in the frame

  /// Set by who wants to know what becomes of the elements; orderSurface keeps it.
  std::optional<NamesBefore> namesBefore;

  /// Sub-stages with their seconds: repair, order, connectivity.
  std::vector<std::pair<std::string, double>> seconds;
  /// Empty, or why refineSurface left edges longer than it was asked to.
  std::string notice;

  /// Source of the point with barycentric coordinates `weights` in face `f` of the mesh.
  SourceLocation locate(Index f, const std::array<double, 3>& weights) const;
};

/// Validates, repairs and orders. Throws InvalidInput for an empty input, a non-finite coordinate
/// (names the point), a corner id out of range (names the polygon), a non-orientable component (names
/// a face of it), when nothing is left after repair, and for guides, valences and sizes as
/// checkRequests, collectRequests and checkSizing do.
PreparedSurface prepareSurface(const SurfaceInput& input, const PrepareOptions& options);

/// The same without a copy: the points and polygons of the input are used up.
PreparedSurface prepareSurface(SurfaceInput&& input, const PrepareOptions& options);

/// Splits edges longer than maximumEdgeLength times the size there, and times triangulationScale() in small components
/// (conforming, at edge midpoints, longest first), and
/// chords: unconstrained edges whose two ends lie on constrained edges, that no decimation could ever
/// repair. Afterwards every face has at most one constrained edge and no chord is left. The geometry
/// does not change: new vertices lie on the old triangles. Long thin triangles can multiply; past
/// about 16 #F + 20 area / maximumEdgeLength^2 faces (160 #F up to four million) the longest edges are
/// split and the rest is left, which `notice` tells. Throws InvalidInput unless maximumEdgeLength is
/// positive and finite. The hash is taken anew. threads: 0: all; the result does not depend on it.
void refineSurface(PreparedSurface& surface, double maximumEdgeLength,
  const ProgressCallback& progress, int threads = 1);

} // namespace quadrille

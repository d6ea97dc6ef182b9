// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The surface: as the user hands it in, and as runs see it, repaired and in order, with what was asked for.
#pragma once

#include "Mesh/KnownCurvature.h"
#include "Mesh/Mesh.h"
#include "Mesh/Requests.h"

#include <array>
#include <cstdint>
#include <memory>
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
  SharedArray<Vector3> points;
  SharedArray<Index> polygonOffsets; ///< #P + 1 offsets into polygonPoints
  SharedArray<Index> polygonPoints;  ///< point ids, polygon after polygon
  std::vector<std::uint8_t>
    featureEdges; ///< empty or #P; bit i: edge from corner i to i+1 is a feature
  std::vector<std::int64_t> patchIds; ///< empty or #P; an edge between two values is a feature
  bool isDesigned = false;            ///< featureEdges are all that a designed body has
  /// Empty or #P; bits as in featureEdges: what was found on a finer surface that these polygons stand for. They are
  /// features that nobody asked for, in place of those of PrepareOptions::featureAngle.
  std::vector<std::uint8_t> detectedFeatures;
  /// Empty or #P: a direction that edges of the quads should have in the polygon, of any length; zero: free.
  std::vector<Vector3> guideDirections;
  std::vector<double>
    guideWeights; ///< empty (1 everywhere) or #P; in (0, 1] where there is a direction
  std::vector<int> guideOrders;    ///< empty (0 everywhere) or #P; see StrokeRequest::order
  std::vector<int> targetValences; ///< empty or #points; 0: free, else see ValenceRequest
  /// Empty or #points: the edge length that quads should have there as a multiple of the target edge length, > 0.
  std::vector<float> sizing;
  std::vector<int> sizingOrders; ///< empty (0 everywhere) or #points; see SizeRequest::order
  /// Empty or #P: in place of what triangles show, see AdaptiveSizes; polygons of more corners have none.
  std::vector<KnownCurvature> curvatures;
  DrawnRequests drawn;              ///< in units of the points
  std::vector<CurveRequest> curves; ///< connections and cycles, in units of the points
  /// Vertices inside, on no feature, that no target valence names are to be regular.
  bool regularElsewhere = false;
  /// Vertices on features and boundaries that stay, see HeldVertices.h.
  std::vector<HeldVertex> held;
  /// Curves that pass a vertex, features and boundaries, are to run straight there but for those that are held.
  bool regularOnFeatures = false;
  /// Points inside of faces between features that are filled with quads without a map from the beginning, as those of
  /// earlier quads were; see RunMap::withoutMap.
  std::vector<Vector3> withoutMap;
  /// Parts of the boundary that get the same number of quads' edges, see SeamRequests.h.
  std::vector<SeamRequest> seams;
  /// Parts of the boundary that are straight in the map, see StraightRequests.h.
  std::vector<StraightRequest> straight;
  FaceOrder faceOrder = FaceOrder::AsGiven; ///< see Frame.h
  /// By how much coordinates may differ from what was meant, in units of the points, >= 0; 0: not known.
  double precision = 0;
};

/// What repair changed; all counts. Zero everywhere for a clean triangle mesh.
struct RepairReport
{
  std::size_t triangulatedPolygons = 0;
  std::size_t mergedPoints = 0;        ///< coincident points of a soup (STL) that were joined
  std::size_t degenerateFaces = 0;     ///< removed or collapsed: repeated corner, zero area
  std::size_t flippedCaps = 0;         ///< see flipCaps
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
  /// Whether the surface is one of designed bodies, all of whose sharp edges are creases.
  bool isDesigned = false;
  /// Whether it is made of the faces of cells, see isMadeOfCells.
  bool isOfCells = false;
  std::size_t edges = 0;
  Vector3 place = Vector3::Zero(); ///< of one of them

  /// What the user should know; empty where there is none.
  std::string text() const;
};

/// Of a face that refinement has made over several triangles of a flat part, see FlatFlips.h.
struct FlippedFace
{
  /// 0: the face is part of one triangle; else which of PreparedSurface::beforeFlips, counted from the first one.
  Index level = 0;
  std::array<Index, 3> points{ kInvalidIndex, kInvalidIndex, kInvalidIndex }; ///< as inputPointAt
  /// Of the corners, in the coordinates that they had then.
  std::array<Vector3, 3> places{ Vector3::Zero(), Vector3::Zero(), Vector3::Zero() };
  bool isReversed = false; ///< since then
};

class FlatSources;

/// Barycentric coordinates, in its face, of the corner where half-edge h begins.
inline std::array<double, 3> cornerWeight(Index h)
{
  return { double(h % 3 == 0), double(h % 3 == 1), double(h % 3 == 2) };
}

/// The finest level: repaired, ordered, with features. Copies share the triangles and where they come from; another
/// version of a surface, with other features, sizes or requests, is such a copy.
struct PreparedSurface : SurfaceRequests
{
  Mesh mesh;
  RepairReport repair;
  FacetReport facets;
  double area = 0;
  double boundingBoxDiagonal = 0;
  Index components = 0;
  /// Content hash of positions, connectivity and features; binds a decimation log to its mesh.
  std::uint64_t hash = 0;

  SharedArray<Index> sourcePolygon; ///< #F
  /// #F; ids of the input points at the corners of the unrefined face. Repair may have moved a corner
  /// of a degenerate polygon's neighbour to another input point; then that point's id stands here.
  SharedArray<std::array<Index, 3>> sourcePoints;
  /// Only where a face was split: index into cornerWeights, else kInvalidIndex. Empty when no face
  /// was split.
  SharedArray<Index> refinedEntry;
  /// [corner][source corner]. Of a flipped face: of the triangle under its centroid, in whose plane the others lie, so
  /// that weights may be negative.
  SharedArray<std::array<std::array<double, 3>, 3>> cornerWeights;
  SharedArray<FlippedFace> flipped; ///< as cornerWeights, or empty where no face was flipped
  /// What was there before the last flips; null where no face was flipped.
  std::shared_ptr<const FlatSources> beforeFlips;

  SharedArray<KnownCurvature> curvatures; ///< by sourcePolygon, or empty; see SurfaceInput

  /// Set by who wants to know what becomes of the vertices when a place is changed, else empty: #V, the ids before;
  /// orderSurface keeps it, with kInvalidIndex for vertices made since.
  std::vector<Index> vertexBefore;

  const SurfaceRequests& requests() const { return *this; }
  void setRequests(SurfaceRequests requests)
  {
    static_cast<SurfaceRequests&>(*this) = std::move(requests);
  }

  /// Sub-stages with their seconds: repair, order, connectivity.
  std::vector<std::pair<std::string, double>> seconds;
  /// Empty, or why refineSurface left edges longer than it was asked to.
  std::string notice;

  /// Whether refinement has made the face over several triangles.
  bool isFlipped(Index f) const
  {
    return !flipped.empty() && refinedEntry[f] != kInvalidIndex &&
      flipped[refinedEntry[f]].level > 0;
  }
  /// The input point at the corner where half-edge h begins; kInvalidIndex where refinement has put the corner.
  Index inputPointAt(Index h) const;
  /// Source of the point with barycentric coordinates `weights` in face `f` of the mesh.
  SourceLocation locate(Index f, const std::array<double, 3>& weights) const;
};

} // namespace quadrille

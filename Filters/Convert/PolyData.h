// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// vtkPolyData <-> Core: the surface a user hands in, the meshes between the stage filters, the map.
///
/// The arrays between the filters, besides those of the design's table of arrays:
///   cells: FineFace (id of the finest face), Twin (only where the corners' points do not tell), SourceCellId,
///          SourcePointIds and SourceWeights (the three input points of a face, and, where
///          refinement split it, the barycentric coordinates of its corners: 9 numbers)
///   points: FineVertex, Turns, Index, IntegerVertex, SurfacePointId (where points are split at seams)
/// On levels of the hierarchy GuidingDirection, GuidingWeight, TargetValence and Sizing (with a limited growth) hold
/// what the user asked for, where there is anything.
#pragma once

#include "Base/FixedPoint.h"
#include "GridMap/GridMap.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/Surface.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

class vtkPolyData;

namespace quadrille
{

namespace arrays
{
constexpr const char* kFeatureEdges = "FeatureEdges";
/// Six numbers a triangle: KnownCurvature::atCorner and alongSide; 1 over the unit of the points.
constexpr const char* kKnownCurvature = "KnownCurvature";
/// Field data; the features of such a surface are known.
constexpr const char* kCadShape = "CadShape";
/// Of joined pieces (unsigned char a cell): as FeatureEdges, of what was found on the pieces themselves.
constexpr const char* kDetectedFeatures = "QuadrilleDetectedFeatures";
constexpr const char* kPatchId = "PatchId";
constexpr const char* kGuidingDirection = "GuidingDirection";
constexpr const char* kGuidingWeight = "GuidingWeight";
constexpr const char* kGuidingRadius = "GuidingRadius";
constexpr const char* kSizeFactor = "SizeFactor";
constexpr const char* kTargetValence = "TargetValence";
constexpr const char* kConstraintType = "ConstraintType";
constexpr const char* kConnectId = "ConnectId";
constexpr const char* kSizing = "Sizing";
constexpr const char* kIgm = "IGM";
constexpr const char* kMatching = "Matching";
constexpr const char* kDeterminant = "Determinant";
constexpr const char* kTwin = "Twin";
constexpr const char* kFineFace = "FineFace";
constexpr const char* kFineVertex = "FineVertex";
constexpr const char* kCurveKinds = "CurveKinds";
constexpr const char* kCurveSizes = "CurveSizes";
constexpr const char* kCurvePoints = "CurvePoints";
constexpr const char* kSmoothedCells = "SmoothedCells";
constexpr const char* kSmoothedAlong = "SmoothedAlong";
constexpr const char* kTurns = "Turns";
constexpr const char* kIndex = "Index";
constexpr const char* kIntegerVertex = "IntegerVertex";
constexpr const char* kSurfacePointId = "SurfacePointId";
constexpr const char* kTextureCoordinates = "TextureCoordinates";
constexpr const char* kSourceCellId = "SourceCellId";
constexpr const char* kSourcePointIds = "SourcePointIds";
constexpr const char* kSourceWeights = "SourceWeights";
constexpr const char* kFlatCellId = "FlatCellId";
constexpr const char* kFlatPointIds = "FlatPointIds";
constexpr const char* kFlatPoints = "FlatPoints";
constexpr const char* kSourceBarycentric = "SourceBarycentric";
constexpr const char* kValence = "Valence";
constexpr const char* kMovableValence = "MovableValence";
constexpr const char* kPartial = "Partial";
constexpr const char* kOnBoundary = "OnBoundary";
constexpr const char* kLayoutPatch = "LayoutPatch";
constexpr const char* kMirrorPoint = "MirrorPoint";
constexpr const char* kRotatedPoint = "RotatedPoint";
constexpr const char* kQuadNormals = "QuadNormals";
}

/// A surface as Core wants it and the way back from its polygons to the cells of the vtkPolyData.
struct ConvertedSurface
{
  SurfaceInput input;                   ///< may be moved away; nothing below needs it
  vtkIdType firstCell = 0;              ///< cell id of polygon 0
  std::vector<vtkIdType> cellOfPolygon; ///< only where the surface has strips
  std::vector<std::array<Index, 3>>
    stripTriangles;             ///< corners of the polygons that come from strips
  std::size_t ignoredCells = 0; ///< vertices and lines
  std::string patchArray;       ///< name of the cell array that patchIds came from, or empty

  vtkIdType cell(Index polygon) const
  {
    return cellOfPolygon.empty() ? firstCell + polygon : cellOfPolygon[polygon];
  }
  /// Corners of a polygon of the converted vtkPolyData, if it is a triangle. Several threads may ask.
  std::optional<std::array<Index, 3>> triangle(vtkPolyData* surface, Index polygon) const;
};

/// Polygons and strips of a vtkPolyData. patchArray: see vtkQuadrilleSurfaceAlgorithm::PatchArrayName.
/// Throws InvalidInput naming the cell or array that is at fault.
ConvertedSurface convertSurface(
  vtkPolyData* surface, const std::string& patchArray, int threads = 1);

/// Directions of an array of three numbers on the cells, or else on the points, of the converted vtkPolyData, with the
/// weight 1, for polygons that have none; see vtkQuadrilleSurfaceAlgorithm::GuideArrayName. Throws InvalidInput naming
/// the array, or the cell or point that is at fault.
void addGuideArray(vtkPolyData* data, const std::string& name, ConvertedSurface& surface);

/// Points in double precision, triangles, FeatureEdges and Sizing where there are any.
vtkSmartPointer<vtkPolyData> writeMesh(const Mesh& mesh);
/// Throws InvalidInput naming the cell that is no triangle, or the edge that is not manifold.
Mesh readMesh(vtkPolyData* data, int threads = 1);

/// Parts of readMesh: the points of the triangles' corners, #H; positions, #points; FeatureEdges to the flags of a mesh
/// with these corners.
/// The first throws InvalidInput naming the cell that is no triangle.
std::vector<Index> readCorners(vtkPolyData* data, int threads = 1);
std::vector<Vector3> readPointPositions(vtkPolyData* data, int threads = 1);
void readFeatureFlags(vtkPolyData* data, Mesh& mesh, int threads = 1);
/// TargetValence, #points, or empty where the array is missing. Throws InvalidInput naming the point.
std::vector<int> readPointValences(vtkPolyData* data);

/// writeMesh with FineFace and FineVertex, and what is asked for: the level's guides, and targetValences (#V or empty).
vtkSmartPointer<vtkPolyData> writeLevel(const Level& level, const std::vector<int>& targetValences);
/// Guides of a mesh that writeLevel wrote, in the planes of its faces: #F, or empty where there are none. Throws
/// InvalidInput naming the cell, as for the user's surface.
std::vector<Guide> readGuides(vtkPolyData* data, const Mesh& mesh);
/// TargetValence by the vertices of readMesh: #V, or empty where no point asks. Throws InvalidInput naming the point.
std::vector<int> readTargetValences(vtkPolyData* data, const Mesh& mesh);
/// Cycles as field data, for the map of a coarse level: CurveKinds, CurveSizes, CurvePoints; nothing
/// where there are none.
void addCurveRequests(vtkPolyData* data, const std::vector<CurveRequest>& curves);
/// The exact inverse. Throws InvalidInput where the arrays do not fit each other.
std::vector<CurveRequest> readCurveRequests(vtkPolyData* data);

/// Throws InvalidInput when an array is missing or an id is out of range.
Level readLevel(vtkPolyData* data, const Mesh& fine);

/// Adds IGM and Determinant. Throws InvalidInput where a coordinate is too large for an exact double.
void addMap(vtkPolyData* data, const std::vector<FixedVec2>& uv, int threads = 1);
/// The exact inverse. Throws InvalidInput when the array is missing or not finite.
std::vector<FixedVec2> readMap(vtkPolyData* data, int threads = 1);
/// Adds Matching: three quarter turns a cell.
void addMatching(vtkPolyData* data, const std::vector<std::int8_t>& matching);
/// Adds Turns, and Index = 4 - turns (2 - turns on the boundary).
void addTurns(vtkPolyData* data, const Mesh& mesh, const std::vector<int>& turns);

/// The finest level with its map for display and extraction. source: what the surface was made from, its
/// arrays are carried over. With splitSeams points are doubled where the map is cut, so that
/// texture coordinates can be a point array. notCarried, if given, gets what carryPointArrays and carryCellArrays
/// return. earlier, if given, was written for the same triangles, made from the same cells: what says where these
/// come from is shared with it.
vtkSmartPointer<vtkPolyData> writeMappedSurface(const PreparedSurface& surface,
  const std::vector<FixedVec2>& uv, const std::vector<std::int8_t>& matching,
  const std::vector<int>& turns, vtkPolyData* source, const ConvertedSurface& converted,
  bool splitSeams, int threads, std::vector<std::string>* notCarried = nullptr,
  vtkPolyData* earlier = nullptr);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// QuadMesh -> vtkPolyData: the quads with their sources, carried arrays and layout, the feature and boundary lines,
/// the lines of the layout.
#pragma once

#include "Base/FixedPoint.h"
#include "Convert/Attributes.h"
#include "Convert/PolyData.h"
#include "Extraction/Extraction.h"
#include "Mesh/Surface.h"

#include <vtkSmartPointer.h>

#include <functional>
#include <string>
#include <vector>

class vtkPolyData;

namespace quadrille
{

/// What cell arrays of the quads come from; the values of the filters' CellDataFrom.
enum class CellDataFrom
{
  Centre = 0, ///< the cell under the quad's centre
  Area = 1    ///< all cells under the quad, by area
};

/// Where the quads' attributes come from. `carrier` holds the arrays; faces are those of the mapped mesh. The functions
/// are called from several threads.
struct QuadSource
{
  vtkPolyData* carrier = nullptr;
  /// Point with barycentric weights in a face, in points of the carrier.
  std::function<PointOrigin(Index face, const std::array<double, 3>& weights)> carrierPoint;
  std::function<vtkIdType(Index face)> carrierCell;
  /// The same in the user's own surface, for SourceCellId, SourcePointIds and SourceBarycentric; empty where that is
  /// the carrier.
  std::function<PointOrigin(Index face, const std::array<double, 3>& weights)> sourcePoint;
  std::function<vtkIdType(Index face)> sourceCell;
  /// Where points, and centres of quads, do not lie in their faces (mirror images): in their place. Empty, or one each.
  std::vector<PointOrigin> pointOrigins;
  std::vector<PointOrigin>
    sourceOrigins; ///< of points, in the user's own surface; empty, or one each
  std::vector<vtkIdType> pointCells, quadCells;
  std::string patchArray; ///< cell array of the carrier with patch ids, or empty
  CellDataFrom cellDataFrom = CellDataFrom::Centre;
  int threads = 0;
};

/// A point of the prepared surface in the user's points. Where the source cell is a triangle, its points
/// come in the cell's own order. data: what was converted.
PointOrigin pointOrigin(const PreparedSurface& surface, const ConvertedSurface& converted,
  vtkPolyData* data, Index face, const std::array<double, 3>& weights);
/// The same of a place on the input.
PointOrigin pointOrigin(
  const SourceLocation& at, const ConvertedSurface& converted, vtkPolyData* data);

/// Where there are polygons they are cells behind the quads, the cell array Partial is 1 on them, and they are in no
/// layout patch (-1).
struct QuadOutputs
{
  /// Points: Valence, OnBoundary, on surfaces without features QuadNormals (active where the carrier has no normals),
  /// SourceCellId, SourcePointIds, SourceBarycentric. Cells: SourceCellId, FeatureEdges (bit i: the edge from corner i
  /// to i+1 lies on a feature), LayoutPatch. All arrays of the carrier, and its field data. Field data, one tuple a
  /// layout patch: LayoutPatchShape (a PatchShape) and LayoutPatchSize (2: quads along and across).
  vtkSmartPointer<vtkPolyData> quads;
  /// Segments on features and boundaries. Cells: Boundary (0 or 1); PatchIds (the two patches that the segment
  /// separates, smaller one first; twice the same on a boundary), where there is a patch array; LayoutPatchIds, the
  /// same for layout patches, -1 along no quad; Separatrix (1: there would be a border of layout patches without
  /// features, too; 0 on boundaries). Points:
  /// QuadPointId.
  vtkSmartPointer<vtkPolyData> lines;
  /// The lines of the layout inside as polylines. Cells: StartKind and EndKind (a LineEnd), Feature (1: all on
  /// features, 0:
  /// none), Separatrix. Points: QuadPointId.
  vtkSmartPointer<vtkPolyData> separatrices;
  /// Irregular vertices as vertices: those without 4 edges inside, without 3 on a boundary. Points: Valence (number of
  /// edges), MovableValence (the same, and 0 where no move takes the vertex: on features and boundaries, and where no
  /// quad is of the map; active), Index (how many are missing to a regular one), OnBoundary, QuadPointId.
  vtkSmartPointer<vtkPolyData> irregular;
  /// Arrays that could not be carried, as text.
  std::vector<std::string> notCarried;
};

/// uv: the map that the quads were extracted from, in any charts; mapped: its mesh.
QuadOutputs writeOutputs(const QuadMesh& mesh, const Mesh& mapped, const std::vector<FixedVec2>& uv,
  const QuadSource& source);

/// Turns quads of writeOutputs().quads over, with FeatureEdges and QuadNormals. reversed: a flag a quad.
void reverseQuads(vtkPolyData* quads, const std::vector<std::uint8_t>& reversed);

/// Of a preview: points with Valence and OnBoundary, quads, and the irregular vertices; the rest is null.
QuadOutputs writePreview(const QuadMesh& mesh);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// QuadMesh -> vtkPolyData: the quads with their sources and carried arrays, the feature and boundary lines.
#pragma once

#include "Extraction/Extraction.h"
#include "Mesh/Surface.h"
#include "QuadrilleAttributes.h"
#include "QuadrilleConvert.h"

#include <vtkSmartPointer.h>

#include <functional>
#include <string>

class vtkPolyData;

namespace quadrille
{

/// Where the quads' attributes come from. `carrier` holds the arrays; faces are those of the mapped mesh.
struct QuadSource
{
  vtkPolyData* carrier = nullptr;
  /// Point with barycentric weights in a face, in points of the carrier.
  std::function<PointOrigin(Index face, const std::array<double, 3>& weights)> carrierPoint;
  std::function<vtkIdType(Index face)> carrierCell;
  /// The same in the user's own surface: SourceCellId, SourcePointIds and SourceBarycentric.
  std::function<PointOrigin(Index face, const std::array<double, 3>& weights)> sourcePoint;
  std::function<vtkIdType(Index face)> sourceCell;
  std::string patchArray; ///< cell array of the carrier with patch ids, or empty
};

/// A point of the prepared surface in the user's points. Where the source cell is a triangle, its points
/// come in the cell's own order. data: what was converted.
PointOrigin pointOrigin(const PreparedSurface& surface, const ConvertedSurface& converted,
  vtkPolyData* data, Index face, const std::array<double, 3>& weights);

/// Points: Valence, OnBoundary, SourceCellId, SourcePointIds, SourceBarycentric. Cells: SourceCellId and
/// FeatureEdges (bit i: the edge from corner i to i+1 lies on a feature). All arrays of the carrier.
vtkSmartPointer<vtkPolyData> writeQuads(const QuadMesh& mesh, const QuadSource& source);

/// Segments on features and boundaries. Cells: Boundary (0 or 1), PatchIds (the two patches that the segment
/// separates, smaller one first; twice the same on a boundary), where there are patches. Points: QuadPointId.
vtkSmartPointer<vtkPolyData> writeLines(
  const QuadMesh& mesh, const Mesh& mapped, const QuadSource& source);

} // namespace quadrille

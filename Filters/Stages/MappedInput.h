// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A surface with an integer-grid map, of ours or of another program, as the extraction wants it.
#pragma once

#include "ForeignMaps/MapSnapping.h"
#include "Mesh/Mesh.h"
#include "Mesh/Requests.h"
#include "Prepare/Frame.h"

#include <memory>
#include <string>
#include <vector>

class vtkDataObject;
class vtkPolyData;

namespace quadrille
{

struct SharedMap;

struct MappedInput
{
  std::shared_ptr<const SharedMap> shared; ///< of the filter that made the map; null: it was read
  Mesh mesh;                               ///< its faces are the cells
  SnapResult map;
  Frame frame;
  Mesh ownMeshInFrame; ///< only where it was read
  bool mirrored =
    false; ///< the map was in mirrored texture coordinates, so that v has the other sign now

  const Mesh& meshInFrame() const;
  /// What the user should know of the changes; empty where the map was exact.
  std::string notice() const;
};

/// The map is the cell array IGM, else the active texture coordinates of the points times
/// textureScale (> 0); then points at the same place are joined (see MapWelding.h). Features are in
/// FeatureEdges, quarter turns across edges in Matching (three whole numbers a cell, from the chart
/// of the cell to that of its neighbour, modulo 4) where there is one. What vtkIntegerGridMapUpmap has made in this
/// process is found by its contents and neither connected nor checked again, with the same result. Throws InvalidInput
/// naming the cell, the edge or the array.
MappedInput readMappedInput(vtkPolyData* data, double textureScale, int threads);

/// Vertices of the input's mesh, ascending, whose TargetValence asks for an irregular one.
std::vector<Index> requestedVertices(vtkPolyData* data, const Mesh& mesh);

/// Guides of a mapped surface's cells for the smoothing of the quads, in its frame, as field data: SmoothedCells and
/// SmoothedAlong; nothing where there are none.
void addSmoothingGuides(
  const std::vector<FaceGuide>& guides, const Frame& frame, vtkPolyData* data);
/// Empty where there are none. Throws InvalidInput where the two arrays do not fit each other or the mesh.
std::vector<FaceGuide> readSmoothingGuides(vtkPolyData* data, const Mesh& mesh, const Frame& frame);

/// MapLargestMove (in quads), MapFixedPoints and MapInconsistentVertices.
void addMapReport(vtkDataObject* data, const MappedInput& input);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Parts of CAD files as VTK data.
#pragma once

#include "Cad/CellValues.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkFieldData;
class vtkPolyData;

namespace quadrille
{

namespace arrays
{
constexpr const char* kCadTessellation = "CadTessellation";
constexpr const char* kCadFaceId = "CadFaceId";
}

/// Triangles. Cells: CadFaceId, PatchNames (the names of the faces), FeatureEdges (bits of the followed edges; free
/// ones are boundary without that), KnownCurvature (of faces and edges), CadColour (where the file has colours). Field
/// data: CadShape (bytes of the exact shape), CadTessellation (the options it was tessellated with, and whether tangent
/// edges are followed), CadFaceNames, CadSurfaceKinds (by id), CadUnitOfFile, and names and places of edges and
/// vertices, see CadNames.h.
vtkSmartPointer<vtkPolyData> cadPolyData(const CadPart& part, const std::string& unit,
  const TessellationOptions& options, CadFollow follow);

/// Of all parts. Polylines of all edges that have a length, with the cell arrays CadPart (its number), CadEdgeId,
/// CadEdgeKind (text), CadEdgeAngle (degrees) and CadEdgeName.
vtkSmartPointer<vtkPolyData> cadEdges(const std::vector<CadPart>& parts);

/// What cadPolyData has put there.
struct CadSource
{
  CadShape shape;
  TessellationOptions options;
  bool tangentEdges = false;
};
/// Throws InvalidInput where it is not there, or damaged.
CadSource cadSource(vtkFieldData* fields);

} // namespace quadrille

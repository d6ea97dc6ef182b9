// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Surfaces that are cut into pieces in one process (Pieces/RemeshInPieces.h): the arrays of VTK as they are, and the
/// sources of the quads.
#pragma once

#include "Convert/Quads.h"
#include "Pieces/RemeshInPieces.h"

#include <memory>
#include <string>

class vtkPolyData;

namespace quadrille
{

/// The triangles of the surface, which must stay as it is; nothing is copied. Null where it has polygons that are no
/// triangles, strips, or points in an array that is not float or double.
std::unique_ptr<TriangleSource> trianglesOf(vtkPolyData* surface);

/// The first array of the surface that constrains the quads, which pieces do not take; empty where there is none.
std::string constrainingArray(vtkPolyData* surface, const std::string& patchArray);

/// What convertSurface() says beside the polygons themselves.
ConvertedSurface polygonsOf(vtkPolyData* surface);

/// Sets where the points and centres of the quads come from. A point without a place on the surface has that of a point
/// near it along edges.
void addPieceSources(const PiecesResult& made, const QuadMesh& mesh,
  const ConvertedSurface& converted, vtkPolyData* surface, QuadSource& source);

} // namespace quadrille

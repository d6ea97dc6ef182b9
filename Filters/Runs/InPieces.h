// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Surfaces that are cut into pieces in one process (Pieces/RemeshInPieces.h): the arrays of VTK as they are.
#pragma once

#include "Convert/PolyData.h"
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

} // namespace quadrille

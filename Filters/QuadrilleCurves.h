// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Feature curves and guiding strokes of the second input, drawn along the edges of the surface.
#pragma once

#include "QuadrilleConvert.h"

#include <string>
#include <vector>

class vtkPolyData;

namespace quadrille
{

/// Marks the edges along each polyline: every point of the curve goes to the nearest surface point, and
/// between two of them runs the path along edges that stays closest to the straight segment.
/// Features (ConstraintType 0) fill surface.curveMarks and surface.input.featureEdges; guiding strokes (1) give the polygons at
/// these edges the direction of the segment, with weight 1. Returns what the user should know.
/// Throws InvalidInput for a curve type that is not supported and for a curve that cannot be followed.
std::vector<std::string> applyCurves(
  ConvertedSurface& surface, vtkPolyData* surfaceData, vtkPolyData* curves);

} // namespace quadrille

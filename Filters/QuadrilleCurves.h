// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Feature curves of the second input, drawn along the edges of the surface.
#pragma once

#include "QuadrilleConvert.h"

#include <string>
#include <vector>

class vtkPolyData;

namespace quadrille
{

/// Marks the edges along each polyline: every point of the curve goes to the nearest surface point, and
/// between two of them runs the path along edges that stays closest to the straight segment.
/// Fills surface.curveMarks and surface.input.featureEdges; returns what the user should know.
/// Throws InvalidInput for a curve type that is not supported and for a curve that cannot be followed.
std::vector<std::string> applyCurves(
  ConvertedSurface& surface, vtkPolyData* surfaceData, vtkPolyData* curves);

} // namespace quadrille

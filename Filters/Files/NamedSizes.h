// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Data of VTK with sizes by names: of faces (cell array PatchNames), and of edges and vertices of a CAD file
/// (CadNames.h).
#pragma once

#include "Sizes/NamedSizes.h"

#include <vtkSmartPointer.h>

class vtkPolyData;

namespace quadrille
{

/// Throws InvalidInput where a cell is no triangle.
NamedSurface namedSurface(vtkPolyData* data);

/// The triangles with all arrays of the data that they were made of, and the point array Sizing.
vtkSmartPointer<vtkPolyData> sizedPolyData(const SizedTriangles& triangles, vtkPolyData* data);

} // namespace quadrille

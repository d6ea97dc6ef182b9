// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Reader of PLY files that keeps every scalar property: VTK's drops all but a few, and the patch ids of
/// CAD surfaces are among them.
#pragma once

#include <vtkSmartPointer.h>

#include <string>

class vtkPolyData;

namespace quadrille
{

/// Text and binary, both byte orders. Scalar properties of vertices and faces become point and cell arrays of
/// their own type and name; nx ny nz become Normals, red green blue (alpha) RGB or RGBA, and pairs of texture
/// coordinates TCoords. `tristrips` become triangle strips. Throws InvalidInput naming the file and the line of the
/// header or the element that is damaged, before it asks for more memory than the file can fill.
/// threads: 0: all.
vtkSmartPointer<vtkPolyData> readPly(const std::string& path, int threads = 0);

} // namespace quadrille

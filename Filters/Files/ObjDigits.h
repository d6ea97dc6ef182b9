// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// vtkOBJReader gives points in single precision, in double precision, or in either by the file: versions of VTK
/// differ. With the digits that are in the file points, and so quads, are the same with each of them.
#pragma once

#include <string>

class vtkPolyData;

namespace quadrille
{

/// Points in double precision with the digits of the OBJ file that the surface was read from. False, and nothing is
/// changed, where the points of the file are not told apart in single precision, and the reader has made copies of some
/// at seams of textures.
bool restoreObjDigits(vtkPolyData* surface, const std::string& path);

} // namespace quadrille

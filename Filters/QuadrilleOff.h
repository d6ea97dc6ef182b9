// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Reader of the Object File Format in text form, for which VTK 9.2 has none.
#pragma once

#include <vtkSmartPointer.h>

#include <string>

class vtkPolyData;

namespace quadrille
{

/// Reads OFF, COFF, NOFF, STOFF and their mixtures, with comments and any white space. Normals and texture coordinates
/// of vertices become the point arrays Normals and TCoords, colours of vertices and faces RGB or RGBA, an index that a
/// face has in place of a colour the cell array ColorIndex. Colours have parts from 0 to 255, or from 0 to 1 where one
/// of the file's vertices (or faces) has one with a decimal point. Faces keep colours where all have some, of one kind.
/// Throws InvalidInput naming the file and the vertex or face that is damaged.
vtkSmartPointer<vtkPolyData> readOff(const std::string& path);

} // namespace quadrille

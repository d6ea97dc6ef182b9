// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Reader of binary STL files by several threads.
#pragma once

#include <vtkSmartPointer.h>

#include <string>

class vtkPolyData;

namespace quadrille
{

/// Whether the file is as long as its count of triangles says: 80 bytes of text, four of the count, 50 a triangle.
bool isBinaryStl(const std::string& path);

/// The triangles, with equal points joined: what vtkSTLReader makes of them with the locator vtkQuadrilleUniquePoints,
/// in the same order, but with 32-bit ids. Triangles with a point twice are left out. Throws InvalidInput unless
/// isBinaryStl(path), and for more than 400 million triangles. threads: 0: all.
vtkSmartPointer<vtkPolyData> readBinaryStl(const std::string& path, int threads = 0);

} // namespace quadrille

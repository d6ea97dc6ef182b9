// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Files of surfaces and quad meshes, by their extension.
#pragma once

#include <vtkSmartPointer.h>

#include <stdexcept>
#include <string>

class vtkDataSet;
class vtkPolyData;

namespace quadrille
{

/// A file that cannot be read or written; the message names the file and the place.
class FileError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Lower case, without the dot; empty when there is none.
std::string extensionOf(const std::string& path);

/// Whether writeMeshFile knows the extension of the path: vtp obj ply vtu ex2 e.
bool canWrite(const std::string& path);
/// The same of a vtkUnstructuredGrid: vtu ex2 e.
bool canWriteElements(const std::string& path);

/// Reads ply, obj, stl, off, vtp or vtk. Throws FileError.
vtkSmartPointer<vtkPolyData> readMeshFile(const std::string& path);

/// Writes to a temporary file beside the target and renames it, so that a file of that name is always
/// whole. Throws FileError.
/// mesh: a vtkPolyData, or a vtkUnstructuredGrid where canWriteElements(path).
void writeMeshFile(vtkDataSet* mesh, const std::string& path);
/// The same for text.
void writeTextFile(const std::string& text, const std::string& path);

} // namespace quadrille

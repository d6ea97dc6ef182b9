// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Files of surfaces and quad meshes, by their extension.
#pragma once

#include "Export/OutputFile.h" // for extensionOf

#include <vtkSmartPointer.h>

#include <stdexcept>
#include <string>

class vtkDataSet;
class vtkPolyData;
class vtkQuadMeshWriter;

namespace quadrille
{

/// A file that cannot be read or written; the message names the file and the place.
class FileError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Whether writeMeshFile knows the extension of the path, and which ones it knows, with commas.
bool canWrite(const std::string& path);
std::string writtenExtensions();
/// Whether the format has elements of second order.
bool canWriteElements(const std::string& path);

/// Reads ply, obj, stl, off, vtp or vtk. threads: 0: all. Throws FileError.
vtkSmartPointer<vtkPolyData> readMeshFile(const std::string& path, int threads = 0);

/// The surface with sizes by name, see vtkQuadNamedSizes. Throws FileError.
vtkSmartPointer<vtkPolyData> withNamedSizes(
  const vtkSmartPointer<vtkPolyData>& surface, const std::string& path, const std::string& sizes);

/// Writes to a temporary file beside the target and renames it, so that a file of that name is always
/// whole. Returns what the user should know, one sentence a line. Throws FileError.
/// mesh: a vtkPolyData, or a vtkUnstructuredGrid; of second order where canWriteElements(path).
std::string writeMeshFile(vtkDataSet* mesh, const std::string& path, vtkQuadMeshWriter* writer);
/// With a writer as it is by default.
void writeMeshFile(vtkDataSet* mesh, const std::string& path);
/// The same for text.
void writeTextFile(const std::string& text, const std::string& path);

} // namespace quadrille

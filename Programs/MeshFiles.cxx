// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFiles.h"

#include "OffReader.h"

#include <vtkAlgorithm.h>
#include <vtkAppendFilter.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkExodusIIWriter.h>
#include <vtkFieldData.h>
#include <vtkGeometryFilter.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkQuadrillePLYReader.h>
#include <vtkSTLReader.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

namespace quadrille
{

namespace
{

namespace fs = std::filesystem;

/// Collects what a VTK object reports as errors and warnings instead of letting it print them.
class ErrorCollector
{
public:
  explicit ErrorCollector(vtkObject* object)
  {
    callback_->SetClientData(&text_);
    callback_->SetCallback([](vtkObject*, unsigned long, void* client, void* data)
      { *static_cast<std::string*>(client) += firstLine(static_cast<const char*>(data)); });
    object->AddObserver(vtkCommand::ErrorEvent, callback_);
  }
  const std::string& text() const { return text_; }

private:
  /// VTK's messages: "ERROR: In file, line n\nvtkClass (0x...): what is wrong\n\n".
  static std::string firstLine(const char* message)
  {
    std::string text = message ? message : "";
    const std::size_t body = text.find("): ");
    if (body != std::string::npos)
    {
      text = text.substr(body + 3);
    }
    return text.substr(0, text.find('\n')) + "; ";
  }

  vtkNew<vtkCallbackCommand> callback_;
  std::string text_;
};

[[noreturn]] void fail(const std::string& path, const std::string& reason)
{
  throw FileError(path + ": " + reason);
}

std::string withoutTail(const std::string& errors)
{
  return errors.size() > 2 ? errors.substr(0, errors.size() - 2) : errors;
}

template <class Reader>
vtkSmartPointer<vtkPolyData> readWith(const std::string& path)
{
  vtkNew<Reader> reader;
  const ErrorCollector errors(reader);
  const ErrorCollector pipelineErrors(reader->GetExecutive());
  reader->SetFileName(path.c_str());
  reader->Update();
  const std::string text = errors.text() + pipelineErrors.text();
  if (!text.empty())
  {
    fail(path, withoutTail(text));
  }
  vtkSmartPointer<vtkPolyData> data = reader->GetOutput();
  if (!data)
  {
    fail(path, "holds no polygons");
  }
  return data;
}

/// Its own texts name the file.
vtkSmartPointer<vtkPolyData> readPlyFile(const std::string& path)
{
  vtkNew<vtkQuadrillePLYReader> reader;
  const ErrorCollector errors(reader);
  const ErrorCollector pipelineErrors(reader->GetExecutive());
  reader->SetFileName(path.c_str());
  reader->Update();
  if (*reader->GetOutcomeText() != '\0')
  {
    throw FileError(reader->GetOutcomeText());
  }
  return reader->GetOutput();
}

//------------------------------------------------------------------------------
// Headers that promise more than the file holds: VTK's readers would ask for the memory first

/// A binary STL file is 80 bytes of text, a count of four bytes, and 50 bytes a triangle.
void checkStl(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  unsigned char header[84] = {};
  file.read(reinterpret_cast<char*>(header), sizeof(header));
  const std::string start(reinterpret_cast<const char*>(header), 5);
  if (start == "solid")
  {
    return; // text, or binary with a misleading name, which the reader tells apart
  }
  const std::uintmax_t size = fs::file_size(path);
  const std::uintmax_t triangles = header[80] | (header[81] << 8) | (header[82] << 16) |
    (static_cast<std::uintmax_t>(header[83]) << 24);
  if (size < 84 || (size - 84) / 50 < triangles)
  {
    fail(path,
      "is no STL file, or cut off: it announces " + std::to_string(triangles) +
        " triangles and has " + std::to_string(size) + " bytes");
  }
}

//------------------------------------------------------------------------------
// Writers

template <class Write>
void writeThenRename(const std::string& path, Write write)
{
  // The extension stays last, as some writers look at it.
  const fs::path target(path);
  const fs::path temporary = target.parent_path() /
    (target.stem().string() + ".part" + std::to_string(::getpid()) + target.extension().string());
  try
  {
    write(temporary.string());
    fs::rename(temporary, target);
  }
  catch (const fs::filesystem_error& error)
  {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    fail(path, error.code().message());
  }
  catch (...)
  {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

struct CloseFile
{
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

File openForWriting(const std::string& path)
{
  File file(std::fopen(path.c_str(), "wb"));
  if (!file)
  {
    fail(path, std::string("cannot be written: ") + std::strerror(errno));
  }
  return file;
}

void finish(File& file, const std::string& path)
{
  const bool failed = std::ferror(file.get()) != 0;
  if (std::fclose(file.release()) != 0 || failed)
  {
    fail(path, std::string("cannot be written: ") + std::strerror(errno));
  }
}

/// vtkOBJWriter wants a texture and writes floats; 17 digits keep every bit of a double.
void writeObj(vtkPolyData* mesh, const std::string& path)
{
  File file = openForWriting(path);
  std::fprintf(file.get(), "# quad mesh made by Quadrille: %lld points, %lld faces\n",
    static_cast<long long>(mesh->GetNumberOfPoints()),
    static_cast<long long>(mesh->GetNumberOfPolys()));
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    double p[3];
    mesh->GetPoint(i, p);
    std::fprintf(file.get(), "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
  }
  auto cells = vtk::TakeSmartPointer(mesh->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    std::fputc('f', file.get());
    for (vtkIdType i = 0; i < count; ++i)
    {
      std::fprintf(file.get(), " %lld", static_cast<long long>(ids[i] + 1));
    }
    std::fputc('\n', file.get());
  }
  finish(file, path);
}

template <class Writer>
void runWriter(Writer* writer, const std::string& path)
{
  const ErrorCollector errors(writer);
  writer->SetFileName(path.c_str());
  const int written = writer->Write();
  if (!errors.text().empty() || !written)
  {
    fail(path, "cannot be written: " + withoutTail(errors.text()));
  }
}

vtkSmartPointer<vtkUnstructuredGrid> toGrid(vtkPolyData* mesh)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(mesh->GetPoints());
  grid->SetCells(VTK_QUAD, mesh->GetPolys());
  grid->GetPointData()->ShallowCopy(mesh->GetPointData());
  grid->GetCellData()->ShallowCopy(mesh->GetCellData());
  grid->GetFieldData()->ShallowCopy(mesh->GetFieldData());
  return grid;
}

void writeVtp(vtkPolyData* mesh, const std::string& path)
{
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(mesh);
  // Appended, the default, cannot be read back with the libexpat of an updated Debian 12.
  writer->SetDataModeToBinary();
  runWriter(writer.Get(), path);
}

void writeVtu(vtkPolyData* mesh, const std::string& path)
{
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(toGrid(mesh));
  writer->SetDataModeToBinary();
  runWriter(writer.Get(), path);
}

void writePly(vtkPolyData* mesh, const std::string& path)
{
  vtkNew<vtkPLYWriter> writer;
  writer->SetInputData(mesh);
  writer->SetFileTypeToBinary();
  runWriter(writer.Get(), path);
}

/// Exodus knows whole numbers only as ids and maps, hence every array as real numbers; field data with
/// text has no place in it.
void writeExodus(vtkPolyData* mesh, const std::string& path)
{
  vtkSmartPointer<vtkUnstructuredGrid> grid = toGrid(mesh);
  grid->GetFieldData()->Initialize();
  vtkNew<vtkExodusIIWriter> writer;
  writer->SetInputData(grid);
  writer->WriteOutBlockIdArrayOn();
  writer->WriteOutGlobalNodeIdArrayOn();
  writer->WriteOutGlobalElementIdArrayOn();
  runWriter(writer.Get(), path);
}

} // namespace

std::string extensionOf(const std::string& path)
{
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
    [](unsigned char c) { return std::tolower(c); });
  return extension.empty() ? extension : extension.substr(1);
}

bool canWrite(const std::string& path)
{
  const std::string e = extensionOf(path);
  return e == "vtp" || e == "obj" || e == "ply" || e == "vtu" || e == "ex2";
}

vtkSmartPointer<vtkPolyData> readMeshFile(const std::string& path)
{
  std::error_code code;
  if (!fs::is_regular_file(path, code))
  {
    fail(path, "no such file");
  }
  if (std::ifstream file(path); !file)
  {
    fail(path, "cannot be opened for reading");
  }
  const std::string extension = extensionOf(path);
  if (extension == "ply")
  {
    return readPlyFile(path);
  }
  if (extension == "obj")
  {
    return readWith<vtkOBJReader>(path);
  }
  if (extension == "stl")
  {
    checkStl(path);
    return readWith<vtkSTLReader>(path);
  }
  if (extension == "vtp")
  {
    return readWith<vtkXMLPolyDataReader>(path);
  }
  if (extension == "vtk")
  {
    return readWith<vtkPolyDataReader>(path);
  }
  if (extension == "off")
  {
    return readOff(path);
  }
  fail(path, "unknown extension; known are ply, obj, stl, off, vtp and vtk");
}

void writeMeshFile(vtkPolyData* mesh, const std::string& path)
{
  const std::string extension = extensionOf(path);
  writeThenRename(path,
    [mesh, &extension, &path](const std::string& temporary)
    {
      if (extension == "vtp")
      {
        writeVtp(mesh, temporary);
      }
      else if (extension == "obj")
      {
        writeObj(mesh, temporary);
      }
      else if (extension == "ply")
      {
        writePly(mesh, temporary);
      }
      else if (extension == "vtu")
      {
        writeVtu(mesh, temporary);
      }
      else if (extension == "ex2")
      {
        writeExodus(mesh, temporary);
      }
      else
      {
        fail(path, "unknown extension; known are vtp, obj, ply, vtu and ex2");
      }
    });
}

void writeTextFile(const std::string& text, const std::string& path)
{
  writeThenRename(path,
    [&text](const std::string& temporary)
    {
      File file = openForWriting(temporary);
      std::fwrite(text.data(), 1, text.size(), file.get());
      finish(file, temporary);
    });
}

} // namespace quadrille

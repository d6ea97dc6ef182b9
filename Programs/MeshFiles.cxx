// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFiles.h"

#include "Common/Far.h"
#include "Common/VtkErrors.h"
#include "Export/OutputFile.h"
#include "Files/XmlReaders.h"

#include <vtkAlgorithm.h>
#include <vtkExecutive.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkQuadMeshWriter.h>
#include <vtkQuadNamedSizes.h>
#include <vtkQuadrilleFileReader.h>
#include <vtkQuadrilleOFFReader.h>
#include <vtkQuadrillePLYReader.h>
#include <vtkQuadrilleSTLReader.h>
#include <vtkQuadrilleUniquePoints.h>
#include <vtkSTLReader.h>
#include <vtkSmartPointer.h>
#include <vtkStringOutputWindow.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace quadrille
{

namespace
{

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& reason)
{
  throw FileError(path + ": " + reason);
}

/// Readers of VTK have parsers that report by themselves, and tell of cut files by warnings of nobody: all that is
/// printed while this is there.
class PrintedErrors
{
public:
  PrintedErrors()
    : before_(vtkOutputWindow::GetInstance()), level_(vtkLogger::GetCurrentVerbosityCutoff())
  {
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  PrintedErrors(const PrintedErrors&) = delete;
  PrintedErrors& operator=(const PrintedErrors&) = delete;
  ~PrintedErrors()
  {
    vtkLogger::SetStderrVerbosity(level_);
    vtkOutputWindow::SetInstance(before_);
  }

  /// The first line that speaks of an error; empty where none does.
  std::string first() const
  {
    std::istringstream lines(window_->GetOutput());
    for (std::string line; std::getline(lines, line);)
    {
      const std::size_t body = line.find("): ");
      const std::string text = body == std::string::npos ? line : line.substr(body + 3);
      if (text.rfind("ERROR: In ", 0) != 0 && text.find("rror") != std::string::npos)
      {
        return text;
      }
    }
    return {};
  }

private:
  vtkNew<vtkStringOutputWindow> window_;
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkLogger::Verbosity level_;
};

template <class Reader>
vtkSmartPointer<vtkPolyData> readWith(
  const std::string& path, const vtkSmartPointer<Reader>& reader = vtkSmartPointer<Reader>::New())
{
  const ErrorCollector errors(reader);
  const ErrorCollector pipelineErrors(reader->GetExecutive());
  reader->SetFileName(path.c_str());
  std::string printed;
  {
    const PrintedErrors printing;
    reader->Update();
    printed = printing.first();
  }
  const std::string text = errors.text().empty() ? pipelineErrors.sentence() : errors.sentence();
  if (!text.empty() || !printed.empty())
  {
    fail(path, printed.empty() ? text : printed);
  }
  vtkSmartPointer<vtkPolyData> data = reader->GetOutput();
  if (!data)
  {
    fail(path, "holds no polygons");
  }
  return data;
}

/// Joins equal points in time that grows with their number, wherever they lie.
class StlReader : public vtkSTLReader
{
public:
  static StlReader* New();
  vtkTypeMacro(StlReader, vtkSTLReader);

protected:
  StlReader() { this->SetLocator(vtkNew<vtkQuadrilleUniquePoints>()); }
};
vtkStandardNewMacro(StlReader);

/// With one of our own readers, whose texts name the file.
template <class Reader>
vtkSmartPointer<vtkPolyData> readWithOurs(const std::string& path, int threads)
{
  vtkNew<Reader> reader;
  reader->SetNumberOfThreads(threads);
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

vtkSmartPointer<vtkPolyData> readObj(const std::string& path)
{
  vtkSmartPointer<vtkPolyData> data = readWith<vtkOBJReader>(path);
  if (!vtkQuadrilleFileReader::RestoreObjDigits(data, path.c_str()) && isFar(data))
  {
    fail(path,
      "lies so far from the origin that its points are not told apart in single precision, which "
      "is what its reader has: remove the texture coordinates, move it to the origin, or save it "
      "as PLY or VTP in double precision");
  }
  return data;
}

} // namespace

bool canWrite(const std::string& path)
{
  return vtkQuadMeshWriter::CanWriteFile(path.c_str());
}

vtkSmartPointer<vtkPolyData> withNamedSizes(
  const vtkSmartPointer<vtkPolyData>& surface, const std::string& path, const std::string& sizes)
{
  vtkNew<vtkQuadNamedSizes> filter;
  const ErrorCollector errors(filter);
  const ErrorCollector executiveErrors(filter->GetExecutive());
  filter->SetSizes(sizes.c_str());
  filter->SetInputData(surface);
  filter->Update();
  if (*filter->GetOutcomeText() != '\0')
  {
    throw FileError(path + ": " + filter->GetOutcomeText());
  }
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
}

std::string writtenExtensions()
{
  return vtkQuadMeshWriter::GetExtensions();
}

bool canWriteElements(const std::string& path)
{
  const std::string e = extensionOf(path);
  return canWrite(path) && e != "vtp" && e != "obj" && e != "ply" && e != "mesh";
}

vtkSmartPointer<vtkPolyData> readMeshFile(const std::string& path, int threads)
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
  if (const std::string damage = vtkQuadrilleFileReader::GetHeaderError(path.c_str());
      !damage.empty())
  {
    fail(path, damage);
  }
  const std::string extension = extensionOf(path);
  if (extension == "ply")
  {
    return readWithOurs<vtkQuadrillePLYReader>(path, threads);
  }
  if (extension == "obj")
  {
    return readObj(path);
  }
  if (extension == "stl")
  {
    return vtkQuadrilleSTLReader::CanReadFile(path.c_str())
      ? readWithOurs<vtkQuadrilleSTLReader>(path, threads)
      : readWith<StlReader>(path);
  }
  if (extension == "vtp")
  {
    return readWith<vtkXMLPolyDataReader>(path, quadrille::newPolyDataReader());
  }
  if (extension == "vtk")
  {
    return readWith<vtkPolyDataReader>(path);
  }
  if (extension == "off")
  {
    return readWithOurs<vtkQuadrilleOFFReader>(path, threads);
  }
  fail(path, "unknown extension; known are ply, obj, stl, off, vtp and vtk");
}

std::string writeMeshFile(vtkDataSet* mesh, const std::string& path, vtkQuadMeshWriter* writer)
{
  const ErrorCollector errors(writer);
  writer->SetInputData(mesh);
  writer->SetFileName(path.c_str());
  writer->Write();
  if (*writer->GetOutcomeText() != '\0')
  {
    throw FileError(writer->GetOutcomeText());
  }
  return writer->GetNoticesText();
}

void writeMeshFile(vtkDataSet* mesh, const std::string& path)
{
  writeMeshFile(mesh, path, vtkNew<vtkQuadMeshWriter>());
}

void writeTextFile(const std::string& text, const std::string& path)
{
  try
  {
    writeThenRename(path,
      [&text](const std::string& temporary)
      {
        OutputFile file(temporary);
        file << text;
        file.close();
      });
  }
  catch (const WriteError& error)
  {
    throw FileError(error.what());
  }
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFiles.h"

#include "Export/OutputFile.h"
#include "QuadrilleFar.h"
#include "QuadrilleVtkErrors.h"

#include <vtkAlgorithm.h>
#include <vtkExecutive.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkQuadMeshWriter.h>
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
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
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
vtkSmartPointer<vtkPolyData> readWith(const std::string& path)
{
  vtkNew<Reader> reader;
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

//------------------------------------------------------------------------------
// Digits that VTK's OBJ reader leaves out

using Coordinates = std::array<double, 3>;

/// Of the lines "v x y z".
std::vector<Coordinates> readObjPoints(const std::string& path)
{
  std::vector<Coordinates> points;
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line))
  {
    Coordinates p{};
    if (std::sscanf(line.c_str(), " v %lf %lf %lf", &p[0], &p[1], &p[2]) == 3)
    {
      points.push_back(p);
    }
  }
  return points;
}

std::array<float, 3> inSinglePrecision(const Coordinates& p)
{
  return { static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]) };
}

/// Points of the file by those of the reader: in their order where the reader keeps it, else by their values, as it
/// makes copies at seams of textures. Empty where two points of the file are one in single precision.
std::vector<Coordinates> matchObjPoints(const std::vector<Coordinates>& inFile, vtkPoints* read)
{
  const auto count = static_cast<std::size_t>(read->GetNumberOfPoints());
  std::vector<std::array<float, 3>> values(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    Coordinates p{};
    read->GetPoint(static_cast<vtkIdType>(i), p.data());
    values[i] = inSinglePrecision(p);
  }
  const auto fits = [&](std::size_t i) { return inSinglePrecision(inFile[i]) == values[i]; };
  bool inOrder = count == inFile.size();
  for (std::size_t i = 0; inOrder && i < count; ++i)
  {
    inOrder = fits(i);
  }
  if (inOrder)
  {
    return inFile;
  }
  std::map<std::array<float, 3>, Coordinates> byValue;
  for (const Coordinates& p : inFile)
  {
    if (byValue.emplace(inSinglePrecision(p), p).first->second != p)
    {
      return {};
    }
  }
  std::vector<Coordinates> matched(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto found = byValue.find(values[i]);
    if (found == byValue.end())
    {
      return {};
    }
    matched[i] = found->second;
  }
  return matched;
}

bool isMoreThanFloat(const Coordinates& p)
{
  return std::any_of(
    p.begin(), p.end(), [](double x) { return static_cast<double>(static_cast<float>(x)) != x; });
}

/// vtkOBJReader keeps single precision: far from the origin the digits of the file are read again.
vtkSmartPointer<vtkPolyData> readObj(const std::string& path)
{
  vtkSmartPointer<vtkPolyData> data = readWith<vtkOBJReader>(path);
  if (data->GetNumberOfPoints() == 0 || !isFar(data))
  {
    return data;
  }
  const std::vector<Coordinates> inFile = readObjPoints(path);
  if (std::none_of(inFile.begin(), inFile.end(), isMoreThanFloat))
  {
    return data;
  }
  const std::vector<Coordinates> points = matchObjPoints(inFile, data->GetPoints());
  if (points.empty())
  {
    fail(path,
      "lies so far from the origin that its points are not told apart in single precision, which "
      "is what its "
      "reader has: remove the texture coordinates, move it to the origin, or save it as PLY or VTP "
      "in double precision");
  }
  vtkNew<vtkPoints> inDouble;
  inDouble->SetDataTypeToDouble();
  for (const Coordinates& p : points)
  {
    inDouble->InsertNextPoint(p.data());
  }
  data->SetPoints(inDouble);
  return data;
}

} // namespace

bool canWrite(const std::string& path)
{
  return vtkQuadMeshWriter::CanWriteFile(path.c_str());
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
    return readWith<vtkXMLPolyDataReader>(path);
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

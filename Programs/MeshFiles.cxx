// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFiles.h"

#include <vtkAlgorithm.h>
#include <vtkAppendFilter.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkExodusIIWriter.h>
#include <vtkFieldData.h>
#include <vtkGeometryFilter.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkQuadrilleFileReader.h>
#include <vtkQuadrilleOFFReader.h>
#include <vtkQuadrillePLYReader.h>
#include <vtkQuadrilleUniquePoints.h>
#include <vtkSTLReader.h>
#include <vtkSmartPointer.h>
#include <vtkStringOutputWindow.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>

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
  const std::string text = errors.text().empty() ? pipelineErrors.text() : errors.text();
  if (!text.empty() || !printed.empty())
  {
    fail(path, printed.empty() ? withoutTail(text) : printed);
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
vtkSmartPointer<vtkPolyData> readWithOurs(const std::string& path)
{
  vtkNew<Reader> reader;
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
/// Far from the origin single precision has lost what tells points apart: where a coordinate is above so many sides of
/// the box.
constexpr double kFarSides = 4;

bool isFar(vtkDataSet* mesh)
{
  double box[6];
  mesh->GetBounds(box);
  double side = 0;
  double largest = 0;
  for (int k = 0; k < 3; ++k)
  {
    side = std::max(side, box[2 * k + 1] - box[2 * k]);
    largest = std::max({ largest, std::abs(box[2 * k]), std::abs(box[2 * k + 1]) });
  }
  return largest > kFarSides * side;
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

/// A shallow copy where it is one.
vtkSmartPointer<vtkUnstructuredGrid> toGrid(vtkDataSet* data)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkPolyData* const mesh = vtkPolyData::SafeDownCast(data);
  if (!mesh)
  {
    grid->ShallowCopy(data);
    return grid;
  }
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

void writeVtu(vtkDataSet* mesh, const std::string& path)
{
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(toGrid(mesh));
  writer->SetDataModeToBinary();
  runWriter(writer.Get(), path);
}

template <class Value>
void writeValue(std::FILE* file, Value value)
{
  std::fwrite(&value, sizeof(value), 1, file);
}

/// vtkPLYWriter writes floats only. Points and faces, in the byte order of this machine, which is little-endian.
void writePlyInDouble(vtkPolyData* mesh, const std::string& path)
{
  File file = openForWriting(path);
  std::fprintf(file.get(),
    "ply\nformat binary_little_endian 1.0\ncomment quad mesh made by Quadrille\n"
    "element vertex %lld\nproperty double x\nproperty double y\nproperty double z\n"
    "element face %lld\nproperty list uchar int vertex_indices\nend_header\n",
    static_cast<long long>(mesh->GetNumberOfPoints()),
    static_cast<long long>(mesh->GetNumberOfPolys()));
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    double p[3];
    mesh->GetPoint(i, p);
    std::fwrite(p, sizeof(p), 1, file.get());
  }
  auto cells = vtk::TakeSmartPointer(mesh->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    writeValue(file.get(), static_cast<unsigned char>(count));
    for (vtkIdType i = 0; i < count; ++i)
    {
      writeValue(file.get(), static_cast<std::int32_t>(ids[i]));
    }
  }
  finish(file, path);
}

void writePly(vtkPolyData* mesh, const std::string& path)
{
  if (isFar(mesh))
  {
    writePlyInDouble(mesh, path);
    return;
  }
  vtkNew<vtkPLYWriter> writer;
  writer->SetInputData(mesh);
  writer->SetFileTypeToBinary();
  runWriter(writer.Get(), path);
}

/// The Exodus writer takes the precision of the points from the first array of real numbers that it finds, whatever it
/// is told of doubles.
void toDouble(vtkDataSetAttributes* attributes)
{
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = attributes->GetArray(i);
    if (array && array->GetDataType() == VTK_FLOAT)
    {
      vtkNew<vtkDoubleArray> copy;
      copy->DeepCopy(array);
      copy->SetName(array->GetName());
      attributes->AddArray(copy); // in the place of the one of this name
    }
  }
}

/// Exodus knows whole numbers only as ids and maps, hence every array as real numbers; field data with
/// text has no place in it.
void writeExodus(vtkDataSet* mesh, const std::string& path)
{
  vtkSmartPointer<vtkUnstructuredGrid> grid = toGrid(mesh);
  grid->GetFieldData()->Initialize();
  if (isFar(mesh))
  {
    toDouble(grid->GetPointData());
    toDouble(grid->GetCellData());
  }
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
  return e == "vtp" || e == "obj" || e == "ply" || canWriteElements(path);
}

bool canWriteElements(const std::string& path)
{
  const std::string e = extensionOf(path);
  return e == "vtu" || e == "ex2" || e == "e";
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
  if (const std::string damage = vtkQuadrilleFileReader::GetHeaderError(path.c_str());
      !damage.empty())
  {
    fail(path, damage);
  }
  const std::string extension = extensionOf(path);
  if (extension == "ply")
  {
    return readWithOurs<vtkQuadrillePLYReader>(path);
  }
  if (extension == "obj")
  {
    return readObj(path);
  }
  if (extension == "stl")
  {
    return readWith<StlReader>(path);
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
    return readWithOurs<vtkQuadrilleOFFReader>(path);
  }
  fail(path, "unknown extension; known are ply, obj, stl, off, vtp and vtk");
}

void writeMeshFile(vtkDataSet* data, const std::string& path)
{
  const std::string extension = extensionOf(path);
  vtkPolyData* const mesh = vtkPolyData::SafeDownCast(data);
  if (!mesh && !canWriteElements(path))
  {
    fail(path, "elements of an unstructured grid need the extension vtu, ex2 or e");
  }
  writeThenRename(path,
    [data, mesh, &extension, &path](const std::string& temporary)
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
        writeVtu(data, temporary);
      }
      else if (extension == "ex2" || extension == "e")
      {
        writeExodus(data, temporary);
      }
      else
      {
        fail(path, "unknown extension; known are vtp, obj, ply, vtu, ex2 and e");
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

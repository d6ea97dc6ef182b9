// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkQuadrilleFileReader.h"

#include "Base/Error.h"
#include "Files/ObjDigits.h"
#include "Files/XmlReaders.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkPolyData.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLUnstructuredGridReader.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>
#include <sstream>

namespace
{

/// A binary STL file is 80 bytes of text, a count of four bytes, and 50 bytes a triangle.
std::string headerErrorOfStl(std::istream& file, std::uintmax_t size)
{
  unsigned char header[84] = {};
  file.read(reinterpret_cast<char*>(header), sizeof(header));
  const std::string start(reinterpret_cast<const char*>(header), 5);
  if (start == "solid")
  {
    return {}; // text, or binary with a misleading name, which the reader tells apart
  }
  const std::uintmax_t triangles = header[80] | (header[81] << 8) | (header[82] << 16) |
    (static_cast<std::uintmax_t>(header[83]) << 24);
  return size >= 84 && triangles <= (size - 84) / 50 ? std::string()
                                                     : "is no STL file, or cut off: it announces " +
      std::to_string(triangles) + " triangles and has " + std::to_string(size) + " bytes";
}

/// Compressed blocks hold at most about a thousand times their own bytes [zlib's documentation].
constexpr double kMostCompressed = 1100;
/// No array of a surface has more components; VTK's reader counts through all of them.
constexpr double kMostComponents = 100000;
/// An attribute is shorter than this.
constexpr std::size_t kOverlap = 200;

/// Of the attributes NumberOfPoints="12" and the like.
std::string announcedTooMuch(const std::string& text, double size)
{
  const std::string attribute = " NumberOf";
  std::size_t from = 0;
  for (std::size_t at = text.find(attribute); at != std::string::npos;
       at = text.find(attribute, from))
  {
    from = at + attribute.size();
    const std::size_t equals = text.find_first_of("=<> ", from);
    if (equals == std::string::npos || text[equals] != '=' || equals + 1 >= text.size())
    {
      continue;
    }
    const double number = std::strtod(text.c_str() + equals + 2, nullptr);
    const std::string what = text.substr(from, equals - from);
    const double most = what == "Components" ? kMostComponents : kMostCompressed * size;
    if (!(number >= 0 && number <= most))
    {
      std::ostringstream told;
      told.precision(15);
      told << "is damaged: it announces " << number << " " << what << " and has " << size
           << " bytes";
      return told.str();
    }
  }
  return {};
}

std::string headerErrorOfXml(std::istream& file, std::uintmax_t size)
{
  std::string block(std::size_t(1) << 20, '\0');
  std::string text;
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0)
  {
    text.append(block, 0, static_cast<std::size_t>(file.gcount()));
    std::string error = announcedTooMuch(text, static_cast<double>(size));
    if (!error.empty())
    {
      return error;
    }
    text.erase(0, text.size() - std::min(text.size(), kOverlap));
  }
  return {};
}

} // namespace

//------------------------------------------------------------------------------
bool vtkQuadrilleFileReader::RestoreObjDigits(vtkPolyData* surface, const char* path)
{
  return quadrille::restoreObjDigits(surface, path);
}

//------------------------------------------------------------------------------
vtkAlgorithm* vtkQuadrilleFileReader::NewXMLReader(const char* extension)
{
  vtkSmartPointer<vtkAlgorithm> reader;
  if (extension != nullptr && std::string(extension) == ".vtp")
  {
    reader = quadrille::newPolyDataReader();
  }
  else
  {
    reader = quadrille::newUnstructuredGridReader();
  }
  reader->Register(nullptr);
  return reader;
}

//------------------------------------------------------------------------------
std::string vtkQuadrilleFileReader::GetHeaderError(const char* path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::error_code code;
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  std::ifstream file(path, std::ios::binary);
  if (code || !file)
  {
    return {}; // which the reader itself tells
  }
  if (extension == ".stl")
  {
    return headerErrorOfStl(file, size);
  }
  return extension == ".vtp" || extension == ".vtu" ? headerErrorOfXml(file, size) : std::string();
}

//------------------------------------------------------------------------------
vtkQuadrilleFileReader::vtkQuadrilleFileReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkQuadrilleFileReader::~vtkQuadrilleFileReader() = default;

//------------------------------------------------------------------------------
void vtkQuadrilleFileReader::SetFileName(const char* name)
{
  const std::string value = name ? name : "";
  if (value != this->FileName)
  {
    this->FileName = value;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkQuadrilleFileReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  this->OutcomeText.clear();
  try
  {
    if (this->FileName.empty())
    {
      throw quadrille::InvalidInput("no file is named: set FileName");
    }
    vtkPolyData::GetData(outputs, 0)->ShallowCopy(this->ReadSurface(this->FileName));
    return 1;
  }
  catch (const std::bad_alloc&)
  {
    this->OutcomeText = this->FileName + ": there is not enough memory for it";
  }
  catch (const std::exception& error)
  {
    this->OutcomeText = error.what();
  }
  vtkErrorMacro(<< this->OutcomeText);
  return 0;
}

//------------------------------------------------------------------------------
void vtkQuadrilleFileReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "OutcomeText: " << this->OutcomeText << "\n";
}

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrillePly.h"

#include "Base/Error.h"
#include "QuadrilleFixedRows.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkType.h>
#include <vtkTypeInt32Array.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

namespace quadrille
{

namespace
{

struct Property
{
  std::string name;
  int type = VTK_VOID;
  int countType = VTK_VOID; ///< of a list; VTK_VOID: a scalar
  bool isList() const { return countType != VTK_VOID; }
};

struct Element
{
  std::string name;
  vtkIdType count = 0;
  std::vector<Property> properties;
};

enum class Format
{
  Text,
  LittleEndian,
  BigEndian
};

int typeOf(const std::string& name)
{
  static const std::map<std::string, int> types = { { "char", VTK_SIGNED_CHAR },
    { "int8", VTK_SIGNED_CHAR }, { "uchar", VTK_UNSIGNED_CHAR }, { "uint8", VTK_UNSIGNED_CHAR },
    { "short", VTK_SHORT }, { "int16", VTK_SHORT }, { "ushort", VTK_UNSIGNED_SHORT },
    { "uint16", VTK_UNSIGNED_SHORT }, { "int", VTK_INT }, { "int32", VTK_INT },
    { "uint", VTK_UNSIGNED_INT }, { "uint32", VTK_UNSIGNED_INT }, { "float", VTK_FLOAT },
    { "float32", VTK_FLOAT }, { "double", VTK_DOUBLE }, { "float64", VTK_DOUBLE } };
  const auto found = types.find(name);
  return found == types.end() ? VTK_VOID : found->second;
}

std::size_t sizeOf(int type)
{
  switch (type)
  {
    case VTK_SIGNED_CHAR:
    case VTK_UNSIGNED_CHAR:
      return 1;
    case VTK_SHORT:
    case VTK_UNSIGNED_SHORT:
      return 2;
    case VTK_DOUBLE:
      return 8;
    default:
      return 4;
  }
}

/// Scalars that belong together in one array.
struct Bundle
{
  std::vector<const char*> parts;
  const char* name;
  int attribute;
};

const std::vector<Bundle>& bundles()
{
  static const std::vector<Bundle> all = {
    { { "nx", "ny", "nz" }, "Normals", vtkDataSetAttributes::NORMALS },
    { { "red", "green", "blue", "alpha" }, "RGBA", vtkDataSetAttributes::SCALARS },
    { { "red", "green", "blue" }, "RGB", vtkDataSetAttributes::SCALARS },
    { { "u", "v" }, "TCoords", vtkDataSetAttributes::TCOORDS },
    { { "s", "t" }, "TCoords", vtkDataSetAttributes::TCOORDS },
    { { "texture_u", "texture_v" }, "TCoords", vtkDataSetAttributes::TCOORDS },
  };
  return all;
}

/// What is read at first, for the header.
constexpr std::uint64_t kHeaderBytes = 65536;

using Columns = std::vector<vtkSmartPointer<vtkDataArray>>;

class PlyReader
{
public:
  PlyReader(const std::string& path, int threads) : path_(path), threads_(threads)
  {
    std::error_code code;
    size_ = std::filesystem::file_size(path, code);
    if (code || !std::ifstream(path))
    {
      throw InvalidInput(path + ": cannot be opened for reading");
    }
    load(kHeaderBytes);
  }

  vtkSmartPointer<vtkPolyData> read()
  {
    readHeader();
    for (const Element& element : elements_)
    {
      if (readFixed(element))
      {
        continue;
      }
      load(size_);
      if (element.name == "vertex")
      {
        readVertices(element);
      }
      else if (element.name == "face")
      {
        readFaces(element);
      }
      else if (element.name == "tristrips")
      {
        readStrips(element);
      }
      else
      {
        skip(element);
      }
    }
    return finish();
  }

private:
  [[noreturn]] void fail(const std::string& reason) const
  {
    throw InvalidInput(path_ + ": " + reason);
  }
  [[noreturn]] void failAt(const Element& element, vtkIdType i, const std::string& reason) const
  {
    fail(element.name + " " + std::to_string(i) + " " + reason);
  }

  /// The first bytes of the file, at least so many where it has them.
  void load(std::uint64_t count)
  {
    count = std::min<std::uint64_t>(count, size_);
    if (bytes_.size() >= count)
    {
      return;
    }
    bytes_.resize(count);
    std::ifstream file(path_, std::ios::binary);
    file.read(bytes_.data(), static_cast<std::streamsize>(count));
    if (file.gcount() != static_cast<std::streamsize>(count))
    {
      fail("cannot be read to its end");
    }
  }

  //----------------------------------------------------------------------------
  // Header

  std::string nextLine()
  {
    if (bytes_.find('\n', position_) == std::string::npos)
    {
      load(size_);
    }
    if (position_ >= bytes_.size())
    {
      fail("the header has no end");
    }
    const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
    std::string line = bytes_.substr(position_, end - position_);
    position_ = std::min(end + 1, bytes_.size());
    if (!line.empty() && line.back() == '\r')
    {
      line.pop_back();
    }
    return line;
  }

  void readHeader()
  {
    if (bytes_.compare(0, 3, "ply") != 0 || nextLine() != "ply")
    {
      fail("is no PLY file");
    }
    for (std::string line = nextLine(); line != "end_header"; line = nextLine())
    {
      std::istringstream words(line);
      std::string keyword;
      words >> keyword;
      if (keyword == "format")
      {
        readFormat(words, line);
      }
      else if (keyword == "element")
      {
        readElement(words, line);
      }
      else if (keyword == "property")
      {
        readProperty(words, line);
      }
      else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty())
      {
        fail("the header has the line '" + line + "'");
      }
    }
    if (!format_)
    {
      fail("the header names no format");
    }
    for (const Element& element : elements_)
    {
      checkSize(element);
    }
  }

  void readFormat(std::istringstream& words, const std::string& line)
  {
    std::string name;
    words >> name;
    static const std::map<std::string, Format> formats = { { "ascii", Format::Text },
      { "binary_little_endian", Format::LittleEndian },
      { "binary_big_endian", Format::BigEndian } };
    const auto found = formats.find(name);
    if (found == formats.end())
    {
      fail("the header has the line '" + line + "'");
    }
    format_ = found->second;
  }

  void readElement(std::istringstream& words, const std::string& line)
  {
    Element element;
    if (!(words >> element.name >> element.count) || element.count < 0)
    {
      fail("the header has the line '" + line + "'");
    }
    elements_.push_back(element);
  }

  void readProperty(std::istringstream& words, const std::string& line)
  {
    Property property;
    std::string type;
    words >> type;
    if (type == "list")
    {
      std::string count;
      words >> count >> type;
      property.countType = typeOf(count);
      if (property.countType == VTK_VOID || property.countType == VTK_FLOAT ||
        property.countType == VTK_DOUBLE)
      {
        fail("the header has the line '" + line + "'");
      }
    }
    property.type = typeOf(type);
    if (elements_.empty() || property.type == VTK_VOID || !(words >> property.name))
    {
      fail("the header has the line '" + line + "'");
    }
    elements_.back().properties.push_back(property);
  }

  /// Before any memory is spent: every element takes so many bytes at least.
  void checkSize(const Element& element) const
  {
    std::size_t least = 0;
    for (const Property& property : element.properties)
    {
      const bool text = *format_ == Format::Text;
      least += text ? 1 : sizeOf(property.isList() ? property.countType : property.type);
    }
    if (least == 0 && element.count > 0)
    {
      fail("the element " + element.name + " has no property");
    }
    if (least > 0 && static_cast<std::size_t>(element.count) > size_ / least)
    {
      fail("announces " + std::to_string(element.count) + " of the element " + element.name +
        ", more than fit into its " + std::to_string(size_) + " bytes");
    }
  }

  //----------------------------------------------------------------------------
  // Values

  /// False at the end of the file or, in text, where there is no number of this type.
  bool nextValue(int type, double& value)
  {
    return *format_ == Format::Text ? nextText(value) : nextBinary(type, value);
  }

  bool nextText(double& value)
  {
    while (position_ < bytes_.size() && isSpace(bytes_[position_]))
    {
      ++position_;
    }
    const std::size_t begin = position_;
    while (position_ < bytes_.size() && !isSpace(bytes_[position_]))
    {
      ++position_;
    }
    const char* first = bytes_.data() + begin;
    const char* last = bytes_.data() + position_;
    first += first != last && *first == '+' ? 1 : 0;
    const auto [end, error] = std::from_chars(first, last, value);
    return first != last && error == std::errc() && end == last;
  }

  static bool isSpace(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

  template <class Number>
  static double convert(const unsigned char* bytes)
  {
    Number number;
    std::memcpy(&number, bytes, sizeof(Number));
    return static_cast<double>(number);
  }

  bool nextBinary(int type, double& value)
  {
    const std::size_t size = sizeOf(type);
    if (bytes_.size() - position_ < size)
    {
      return false;
    }
    unsigned char bytes[8];
    std::memcpy(bytes, bytes_.data() + position_, size);
    position_ += size;
    if (*format_ == Format::BigEndian)
    {
      std::reverse(bytes, bytes + size); // x86 and ARM are little-endian
    }
    switch (type)
    {
      case VTK_SIGNED_CHAR:
        value = convert<signed char>(bytes);
        break;
      case VTK_UNSIGNED_CHAR:
        value = convert<unsigned char>(bytes);
        break;
      case VTK_SHORT:
        value = convert<short>(bytes);
        break;
      case VTK_UNSIGNED_SHORT:
        value = convert<unsigned short>(bytes);
        break;
      case VTK_INT:
        value = convert<int>(bytes);
        break;
      case VTK_UNSIGNED_INT:
        value = convert<unsigned int>(bytes);
        break;
      case VTK_FLOAT:
        value = convert<float>(bytes);
        break;
      default:
        value = convert<double>(bytes);
        break;
    }
    return true;
  }

  double scalar(const Element& element, vtkIdType i, const Property& property)
  {
    double value = 0;
    if (!nextValue(property.type, value))
    {
      failAt(element, i, "has no valid " + property.name);
    }
    return value;
  }

  void list(
    const Element& element, vtkIdType i, const Property& property, std::vector<vtkIdType>& values)
  {
    double count = 0;
    if (!nextValue(property.countType, count) || !(count >= 0) ||
      count > static_cast<double>(bytes_.size() - position_))
    {
      failAt(element, i, "has no valid length of " + property.name);
    }
    values.clear();
    for (double k = 0; k < count; ++k)
    {
      values.push_back(
        static_cast<vtkIdType>(std::clamp(scalar(element, i, property), -1e15, 1e15)));
    }
  }

  //----------------------------------------------------------------------------
  // Elements whose rows have one length

  /// Whether it is one of those, and read. Whatever else there is to say about it, the other way says.
  bool readFixed(const Element& element)
  {
    const bool isVertex = element.name == "vertex";
    if (*format_ == Format::Text || element.count == 0 || (!isVertex && element.name != "face"))
    {
      return false;
    }
    return isVertex ? readFixedVertices(element) : readTriangles(element);
  }

  bool isSwapped() const { return *format_ == Format::BigEndian; } // x86 and ARM are little-endian

  bool readFixedVertices(const Element& element)
  {
    std::size_t rowBytes = 0;
    std::vector<std::size_t> offsets;
    for (const Property& property : element.properties)
    {
      if (property.isList())
      {
        return false;
      }
      offsets.push_back(rowBytes);
      rowBytes += sizeOf(property.type);
    }
    std::array<std::size_t, 3> xyz{};
    constexpr std::array<const char*, 3> kNames{ "x", "y", "z" };
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto found = std::find_if(element.properties.begin(), element.properties.end(),
        [&](const Property& property) { return property.name == kNames[k]; });
      xyz[k] = static_cast<std::size_t>(found - element.properties.begin());
      if (found == element.properties.end() || found->type != element.properties[xyz[0]].type ||
        (found->type != VTK_FLOAT && found->type != VTK_DOUBLE))
      {
        return false;
      }
    }
    vtkNew<vtkPoints> points;
    points->SetDataType(element.properties[xyz[0]].type);
    points->SetNumberOfPoints(element.count);
    auto* to = static_cast<unsigned char*>(points->GetVoidPointer(0));
    const std::size_t size = sizeOf(element.properties[xyz[0]].type);
    Columns columns;
    std::vector<RowTarget> targets;
    for (std::size_t p = 0; p < offsets.size(); ++p)
    {
      const auto axis = std::find(xyz.begin(), xyz.end(), p);
      if (axis != xyz.end())
      {
        targets.push_back(
          { offsets[p], size, to + size * static_cast<std::size_t>(axis - xyz.begin()), 3 * size });
        continue;
      }
      columns.push_back(columnOf(element, element.properties[p]));
      targets.push_back(targetOf(columns.back(), offsets[p]));
    }
    if (!readAll(element, rowBytes,
          [&](std::size_t first, std::size_t rows, const unsigned char* bytes)
          {
            copyRows(bytes, first, rows, rowBytes, isSwapped(), targets);
            return rows;
          }))
    {
      return false;
    }
    data_->SetPoints(points);
    addColumns(columns, data_->GetPointData());
    return true;
  }

  bool readTriangles(const Element& element)
  {
    constexpr vtkIdType kMostIds = std::numeric_limits<std::int32_t>::max();
    if (element.count > kMostIds / 3 || vertexCount() > kMostIds)
    {
      return false;
    }
    const Property* corners = nullptr;
    std::size_t rowBytes = 0, cornersAt = 0;
    Columns columns;
    std::vector<RowTarget> targets;
    for (const Property& property : element.properties)
    {
      if (!property.isList())
      {
        columns.push_back(columnOf(element, property));
        targets.push_back(targetOf(columns.back(), rowBytes));
        rowBytes += sizeOf(property.type);
        continue;
      }
      const bool isWhole = property.type == VTK_INT || property.type == VTK_UNSIGNED_INT;
      if (corners != nullptr || !isWhole || !isListOfCorners(property))
      {
        return false;
      }
      corners = &property;
      cornersAt = rowBytes;
      rowBytes += sizeOf(property.countType) + 3 * sizeOf(property.type);
    }
    if (corners == nullptr)
    {
      return false;
    }
    vtkNew<vtkTypeInt32Array> offsets, ids;
    offsets->SetNumberOfValues(element.count + 1);
    ids->SetNumberOfValues(3 * element.count);
    const std::size_t countBytes = sizeOf(corners->countType);
    auto* to = reinterpret_cast<unsigned char*>(ids->GetPointer(0));
    for (std::size_t i = 0; i < 3; ++i)
    {
      targets.push_back({ cornersAt + countBytes + 4 * i, 4, to + 4 * i, 12 });
    }
    std::array<unsigned char, 4> three{};
    three[isSwapped() ? countBytes - 1 : 0] = 3;
    if (!readAll(element, rowBytes,
          [&](std::size_t first, std::size_t rows, const unsigned char* bytes)
          {
            for (std::size_t i = 0; i < rows; ++i)
            {
              if (std::memcmp(bytes + i * rowBytes + cornersAt, three.data(), countBytes) != 0)
              {
                return i;
              }
            }
            copyRows(bytes, first, rows, rowBytes, isSwapped(), targets);
            for (std::size_t f = first; f < first + rows; ++f)
            {
              offsets->SetValue(static_cast<vtkIdType>(f), static_cast<std::int32_t>(3 * f));
              for (std::size_t i = 3 * f; i < 3 * f + 3; ++i)
              {
                const std::int32_t id = ids->GetValue(static_cast<vtkIdType>(i));
                if (id < 0 || id >= vertexCount())
                {
                  return f - first;
                }
              }
            }
            return rows;
          }))
    {
      return false;
    }
    offsets->SetValue(element.count, static_cast<std::int32_t>(3 * element.count));
    vtkNew<vtkCellArray> faces;
    faces->SetData(offsets, ids);
    data_->SetPolys(faces);
    addColumns(columns, data_->GetCellData());
    return true;
  }

  /// Whether body took all rows of an element; the position is behind it then.
  template <class Body>
  bool readAll(const Element& element, std::size_t rowBytes, const Body& body)
  {
    const std::size_t rows = static_cast<std::size_t>(element.count);
    const bool isRead = readFixedRows(path_, position_, rows, rowBytes, threads_, body) == rows;
    position_ += isRead ? rows * rowBytes : 0;
    return isRead;
  }

  static vtkSmartPointer<vtkDataArray> columnOf(const Element& element, const Property& property)
  {
    auto column = vtk::TakeSmartPointer(vtkDataArray::CreateDataArray(property.type));
    column->SetName(property.name.c_str());
    column->SetNumberOfTuples(element.count);
    return column;
  }

  static RowTarget targetOf(vtkDataArray* column, std::size_t offset)
  {
    const std::size_t size = sizeOf(column->GetDataType());
    return { offset, size, static_cast<unsigned char*>(column->GetVoidPointer(0)), size };
  }

  static bool isListOfCorners(const Property& property)
  {
    return property.name == "vertex_indices" || property.name == "vertex_index";
  }

  //----------------------------------------------------------------------------
  // Elements

  static Columns columnsOf(const Element& element)
  {
    Columns columns;
    for (const Property& property : element.properties)
    {
      columns.push_back(nullptr);
      if (!property.isList())
      {
        columns.back() = columnOf(element, property);
      }
    }
    return columns;
  }

  /// Reads all values of an element; the list of this name goes to onList.
  template <class OnList>
  Columns readRows(const Element& element, OnList onList)
  {
    Columns columns = columnsOf(element);
    std::vector<vtkIdType> values;
    for (vtkIdType i = 0; i < element.count; ++i)
    {
      for (std::size_t p = 0; p < columns.size(); ++p)
      {
        const Property& property = element.properties[p];
        if (!property.isList())
        {
          columns[p]->SetComponent(i, 0, scalar(element, i, property));
          continue;
        }
        list(element, i, property, values);
        if (isListOfCorners(property))
        {
          onList(i, values);
        }
      }
    }
    return columns;
  }

  void skip(const Element& element)
  {
    readRows(element, [](vtkIdType, const std::vector<vtkIdType>&) {});
  }

  void readVertices(const Element& element)
  {
    auto columns = readRows(element, [](vtkIdType, const std::vector<vtkIdType>&) {});
    vtkDataArray* xyz[3] = { take(columns, "x"), take(columns, "y"), take(columns, "z") };
    if (!xyz[0] || !xyz[1] || !xyz[2])
    {
      fail("its vertices have no x, y and z");
    }
    vtkNew<vtkPoints> points;
    points->SetDataType(xyz[0]->GetDataType() == VTK_FLOAT ? VTK_FLOAT : VTK_DOUBLE);
    points->SetNumberOfPoints(element.count);
    for (vtkIdType i = 0; i < element.count; ++i)
    {
      points->SetPoint(
        i, xyz[0]->GetComponent(i, 0), xyz[1]->GetComponent(i, 0), xyz[2]->GetComponent(i, 0));
    }
    data_->SetPoints(points);
    columns.erase(std::remove_if(columns.begin(), columns.end(),
                    [&xyz](vtkDataArray* c)
                    { return std::find(std::begin(xyz), std::end(xyz), c) != std::end(xyz); }),
      columns.end());
    addColumns(columns, data_->GetPointData());
  }

  void readFaces(const Element& element)
  {
    vtkNew<vtkCellArray> faces;
    vtkIdType lists = 0;
    const auto columns = readRows(element,
      [&](vtkIdType i, const std::vector<vtkIdType>& corners)
      {
        checkCorners(element, i, corners);
        faces->InsertNextCell(static_cast<vtkIdType>(corners.size()), corners.data());
        ++lists;
      });
    if (lists != element.count)
    {
      fail("its faces have no list vertex_indices");
    }
    data_->SetPolys(faces);
    addColumns(columns, data_->GetCellData());
  }

  /// Strips in one list are parted by -1.
  void readStrips(const Element& element)
  {
    vtkNew<vtkCellArray> strips;
    std::vector<vtkIdType> strip;
    readRows(element,
      [&](vtkIdType i, std::vector<vtkIdType> ids)
      {
        ids.push_back(-1);
        for (const vtkIdType id : ids)
        {
          if (id >= 0)
          {
            strip.push_back(id);
            continue;
          }
          checkCorners(element, i, strip);
          if (strip.size() >= 3)
          {
            strips->InsertNextCell(static_cast<vtkIdType>(strip.size()), strip.data());
          }
          strip.clear();
        }
      });
    data_->SetStrips(strips);
  }

  void checkCorners(
    const Element& element, vtkIdType i, const std::vector<vtkIdType>& corners) const
  {
    for (const vtkIdType corner : corners)
    {
      if (corner < 0 || corner >= vertexCount())
      {
        failAt(element, i,
          "refers to vertex " + std::to_string(corner) + ", but there are " +
            std::to_string(vertexCount()));
      }
    }
  }

  vtkIdType vertexCount() const
  {
    for (const Element& element : elements_)
    {
      if (element.name == "vertex")
      {
        return element.count;
      }
    }
    return 0;
  }

  //----------------------------------------------------------------------------
  // Arrays

  static vtkDataArray* take(const Columns& columns, const std::string& name)
  {
    for (const auto& column : columns)
    {
      if (column && name == column->GetName())
      {
        return column;
      }
    }
    return nullptr;
  }

  static void addColumns(const Columns& columns, vtkDataSetAttributes* target)
  {
    std::vector<vtkDataArray*> bundled;
    for (const Bundle& bundle : bundles())
    {
      std::vector<vtkDataArray*> parts;
      for (const char* name : bundle.parts)
      {
        vtkDataArray* part = take(columns, name);
        const bool free = std::find(bundled.begin(), bundled.end(), part) == bundled.end();
        if (part && free && (parts.empty() || part->GetDataType() == parts[0]->GetDataType()))
        {
          parts.push_back(part);
        }
      }
      if (parts.size() == bundle.parts.size())
      {
        addBundle(parts, bundle, target);
        bundled.insert(bundled.end(), parts.begin(), parts.end());
      }
    }
    for (const auto& column : columns)
    {
      if (column && std::find(bundled.begin(), bundled.end(), column) == bundled.end())
      {
        target->AddArray(column);
      }
    }
  }

  static void addBundle(
    const std::vector<vtkDataArray*>& parts, const Bundle& bundle, vtkDataSetAttributes* target)
  {
    auto array = vtk::TakeSmartPointer(vtkDataArray::CreateDataArray(parts[0]->GetDataType()));
    array->SetName(bundle.name);
    array->SetNumberOfComponents(static_cast<int>(parts.size()));
    array->SetNumberOfTuples(parts[0]->GetNumberOfTuples());
    for (std::size_t k = 0; k < parts.size(); ++k)
    {
      array->CopyComponent(static_cast<int>(k), parts[k], 0);
    }
    target->AddArray(array);
    target->SetActiveAttribute(bundle.name, bundle.attribute);
  }

  vtkSmartPointer<vtkPolyData> finish()
  {
    if (!data_->GetPoints())
    {
      fail("has no vertices");
    }
    return data_;
  }

  std::string path_;
  int threads_;
  std::uint64_t size_ = 0;   ///< of the file
  std::string bytes_;        ///< its first ones; all where its rows are not of one length
  std::size_t position_ = 0; ///< in the file
  std::optional<Format> format_;
  std::vector<Element> elements_;
  vtkSmartPointer<vtkPolyData> data_ = vtkSmartPointer<vtkPolyData>::New();
};

} // namespace

vtkSmartPointer<vtkPolyData> readPly(const std::string& path, int threads)
{
  return PlyReader(path, threads).read();
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Import/SurfaceFile.h"

#include "Base/Error.h"
#include "Import/FixedRows.h"

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
  std::optional<NumberType> type;
  std::optional<NumberType> countType; ///< of a list; none: a scalar
  bool isList() const { return countType.has_value(); }
};

struct Element
{
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

enum class Format
{
  Text,
  LittleEndian,
  BigEndian
};

std::optional<NumberType> typeOf(const std::string& name)
{
  static const std::map<std::string, NumberType> kTypes = { { "char", NumberType::Int8 },
    { "int8", NumberType::Int8 }, { "uchar", NumberType::UInt8 }, { "uint8", NumberType::UInt8 },
    { "short", NumberType::Int16 }, { "int16", NumberType::Int16 },
    { "ushort", NumberType::UInt16 }, { "uint16", NumberType::UInt16 },
    { "int", NumberType::Int32 }, { "int32", NumberType::Int32 }, { "uint", NumberType::UInt32 },
    { "uint32", NumberType::UInt32 }, { "float", NumberType::Float32 },
    { "float32", NumberType::Float32 }, { "double", NumberType::Float64 },
    { "float64", NumberType::Float64 } };
  const auto found = kTypes.find(name);
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

/// Scalars that belong together in one array.
struct Bundle
{
  std::vector<const char*> parts;
  const char* name;
  ArrayRole role;
};

const std::vector<Bundle>& bundles()
{
  static const std::vector<Bundle> kAll = {
    { { "nx", "ny", "nz" }, "Normals", ArrayRole::Normals },
    { { "red", "green", "blue", "alpha" }, "RGBA", ArrayRole::Colours },
    { { "red", "green", "blue" }, "RGB", ArrayRole::Colours },
    { { "u", "v" }, "TCoords", ArrayRole::TextureCoordinates },
    { { "s", "t" }, "TCoords", ArrayRole::TextureCoordinates },
    { { "texture_u", "texture_v" }, "TCoords", ArrayRole::TextureCoordinates },
  };
  return kAll;
}

/// What is read at first, for the header.
constexpr std::uint64_t kLongestHeader = 65536;

/// One a property; those of lists have no numbers.
using Columns = std::vector<FileArray>;

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
    load(kLongestHeader);
  }

  SurfaceFile read()
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
  [[noreturn]] void failAt(const Element& element, std::int64_t i, const std::string& reason) const
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
    static const std::map<std::string, Format> kFormats = { { "ascii", Format::Text },
      { "binary_little_endian", Format::LittleEndian },
      { "binary_big_endian", Format::BigEndian } };
    const auto found = kFormats.find(name);
    if (found == kFormats.end())
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
      if (!property.countType || property.countType == NumberType::Float32 ||
        property.countType == NumberType::Float64)
      {
        fail("the header has the line '" + line + "'");
      }
    }
    property.type = typeOf(type);
    if (elements_.empty() || !property.type || !(words >> property.name))
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
      least += text ? 1 : sizeOf(property.isList() ? *property.countType : *property.type);
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
  bool nextValue(NumberType type, double& value)
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

  bool nextBinary(NumberType type, double& value)
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
      case NumberType::Int8:
        value = convert<signed char>(bytes);
        break;
      case NumberType::UInt8:
        value = convert<unsigned char>(bytes);
        break;
      case NumberType::Int16:
        value = convert<short>(bytes);
        break;
      case NumberType::UInt16:
        value = convert<unsigned short>(bytes);
        break;
      case NumberType::Int32:
        value = convert<int>(bytes);
        break;
      case NumberType::UInt32:
        value = convert<unsigned int>(bytes);
        break;
      case NumberType::Float32:
        value = convert<float>(bytes);
        break;
      default:
        value = convert<double>(bytes);
        break;
    }
    return true;
  }

  double scalar(const Element& element, std::int64_t i, const Property& property)
  {
    double value = 0;
    if (!nextValue(*property.type, value))
    {
      failAt(element, i, "has no valid " + property.name);
    }
    return value;
  }

  void list(const Element& element, std::int64_t i, const Property& property,
    std::vector<std::int64_t>& values)
  {
    double count = 0;
    if (!nextValue(*property.countType, count) || !(count >= 0) ||
      count > static_cast<double>(bytes_.size() - position_))
    {
      failAt(element, i, "has no valid length of " + property.name);
    }
    values.clear();
    for (double k = 0; k < count; ++k)
    {
      values.push_back(
        static_cast<std::int64_t>(std::clamp(scalar(element, i, property), -1e15, 1e15)));
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
      rowBytes += sizeOf(*property.type);
    }
    std::array<std::size_t, 3> xyz{};
    constexpr std::array<const char*, 3> kCoordinateNames{ "x", "y", "z" };
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto found = std::find_if(element.properties.begin(), element.properties.end(),
        [&](const Property& property) { return property.name == kCoordinateNames[k]; });
      xyz[k] = static_cast<std::size_t>(found - element.properties.begin());
      if (found == element.properties.end() || found->type != element.properties[xyz[0]].type ||
        (found->type != NumberType::Float32 && found->type != NumberType::Float64))
      {
        return false;
      }
    }
    const NumberType real = *element.properties[xyz[0]].type;
    NumberArray points(real, 3, static_cast<std::size_t>(element.count));
    unsigned char* const to = points.bytes();
    const std::size_t size = sizeOf(real);
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
    data_.points = std::move(points);
    addColumns(std::move(columns), data_.pointData);
    return true;
  }

  bool readTriangles(const Element& element)
  {
    constexpr std::int64_t kMostIds = std::numeric_limits<std::int32_t>::max();
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
        rowBytes += sizeOf(*property.type);
        continue;
      }
      const bool isWhole =
        property.type == NumberType::Int32 || property.type == NumberType::UInt32;
      if (corners != nullptr || !isWhole || !isListOfCorners(property))
      {
        return false;
      }
      corners = &property;
      cornersAt = rowBytes;
      rowBytes += sizeOf(*property.countType) + 3 * sizeOf(*property.type);
    }
    if (corners == nullptr)
    {
      return false;
    }
    const auto count = static_cast<std::size_t>(element.count);
    NumberArray offsetArray(NumberType::Int32, 1, count + 1),
      idArray(NumberType::Int32, 1, 3 * count);
    auto* const offsets = offsetArray.as<std::int32_t>();
    const auto* const ids = idArray.as<std::int32_t>();
    const std::size_t countBytes = sizeOf(*corners->countType);
    auto* to = idArray.bytes();
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
              offsets[f] = static_cast<std::int32_t>(3 * f);
              for (std::size_t i = 3 * f; i < 3 * f + 3; ++i)
              {
                if (ids[i] < 0 || ids[i] >= vertexCount())
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
    offsets[count] = static_cast<std::int32_t>(3 * count);
    data_.polygons = { std::move(offsetArray), std::move(idArray) };
    addColumns(std::move(columns), data_.cellData);
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

  static FileArray columnOf(const Element& element, const Property& property)
  {
    return { property.name, ArrayRole::None,
      NumberArray(*property.type, 1, static_cast<std::size_t>(element.count)) };
  }

  static RowTarget targetOf(FileArray& column, std::size_t offset)
  {
    const std::size_t size = sizeOf(column.numbers.type());
    return { offset, size, column.numbers.bytes(), size };
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
      columns.emplace_back();
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
    std::vector<std::int64_t> values;
    for (std::int64_t i = 0; i < element.count; ++i)
    {
      for (std::size_t p = 0; p < columns.size(); ++p)
      {
        const Property& property = element.properties[p];
        if (!property.isList())
        {
          columns[p].numbers.set(static_cast<std::size_t>(i), 0, scalar(element, i, property));
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
    readRows(element, [](std::int64_t, const std::vector<std::int64_t>&) {});
  }

  void readVertices(const Element& element)
  {
    auto columns = readRows(element, [](std::int64_t, const std::vector<std::int64_t>&) {});
    const FileArray* const xyz[3] = { take(columns, "x"), take(columns, "y"), take(columns, "z") };
    if (!xyz[0] || !xyz[1] || !xyz[2])
    {
      fail("its vertices have no x, y and z");
    }
    const bool isSingle = xyz[0]->numbers.type() == NumberType::Float32;
    data_.points = NumberArray(isSingle ? NumberType::Float32 : NumberType::Float64, 3,
      static_cast<std::size_t>(element.count));
    for (std::size_t i = 0; i < data_.points.rows(); ++i)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        data_.points.set(i, k, xyz[k]->numbers.get(i));
      }
    }
    Columns others;
    for (FileArray& column : columns)
    {
      if (std::find(std::begin(xyz), std::end(xyz), &column) == std::end(xyz))
      {
        others.push_back(std::move(column));
      }
    }
    addColumns(std::move(others), data_.pointData);
  }

  void readFaces(const Element& element)
  {
    std::vector<std::int64_t> offsets{ 0 }, ids;
    auto columns = readRows(element,
      [&](std::int64_t i, const std::vector<std::int64_t>& corners)
      {
        checkCorners(element, i, corners);
        ids.insert(ids.end(), corners.begin(), corners.end());
        offsets.push_back(static_cast<std::int64_t>(ids.size()));
      });
    if (static_cast<std::int64_t>(offsets.size()) != element.count + 1)
    {
      fail("its faces have no list vertex_indices");
    }
    data_.polygons = FileCells::of(offsets, ids);
    addColumns(std::move(columns), data_.cellData);
  }

  /// Strips in one list are parted by -1.
  void readStrips(const Element& element)
  {
    std::vector<std::int64_t> offsets{ 0 }, stripIds, strip;
    readRows(element,
      [&](std::int64_t i, std::vector<std::int64_t> ids)
      {
        ids.push_back(-1);
        for (const std::int64_t id : ids)
        {
          if (id >= 0)
          {
            strip.push_back(id);
            continue;
          }
          checkCorners(element, i, strip);
          if (strip.size() >= 3)
          {
            stripIds.insert(stripIds.end(), strip.begin(), strip.end());
            offsets.push_back(static_cast<std::int64_t>(stripIds.size()));
          }
          strip.clear();
        }
      });
    data_.strips = FileCells::of(offsets, stripIds);
  }

  void checkCorners(
    const Element& element, std::int64_t i, const std::vector<std::int64_t>& corners) const
  {
    for (const std::int64_t corner : corners)
    {
      if (corner < 0 || corner >= vertexCount())
      {
        failAt(element, i,
          "refers to vertex " + std::to_string(corner) + ", but there are " +
            std::to_string(vertexCount()));
      }
    }
  }

  std::int64_t vertexCount() const
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

  /// Null where there is no such column.
  static const FileArray* take(const Columns& columns, const std::string& name)
  {
    const auto found = std::find_if(
      columns.begin(), columns.end(), [&](const FileArray& column) { return column.name == name; });
    return found == columns.end() ? nullptr : &*found;
  }

  static void addColumns(Columns columns, std::vector<FileArray>& target)
  {
    std::vector<const FileArray*> bundled;
    for (const Bundle& bundle : bundles())
    {
      std::vector<const FileArray*> parts;
      for (const char* name : bundle.parts)
      {
        const FileArray* part = take(columns, name);
        const bool free = std::find(bundled.begin(), bundled.end(), part) == bundled.end();
        if (part && free && (parts.empty() || part->numbers.type() == parts[0]->numbers.type()))
        {
          parts.push_back(part);
        }
      }
      if (parts.size() == bundle.parts.size())
      {
        target.push_back(bundleOf(parts, bundle));
        bundled.insert(bundled.end(), parts.begin(), parts.end());
      }
    }
    for (FileArray& column : columns)
    {
      if (!column.name.empty() &&
        std::find(bundled.begin(), bundled.end(), &column) == bundled.end())
      {
        target.push_back(std::move(column));
      }
    }
  }

  static FileArray bundleOf(const std::vector<const FileArray*>& parts, const Bundle& bundle)
  {
    const NumberArray& first = parts[0]->numbers;
    FileArray array{ bundle.name, bundle.role,
      NumberArray(first.type(), parts.size(), first.rows()) };
    for (std::size_t i = 0; i < first.rows(); ++i)
    {
      for (std::size_t k = 0; k < parts.size(); ++k)
      {
        array.numbers.set(i, k, parts[k]->numbers.get(i));
      }
    }
    return array;
  }

  SurfaceFile finish()
  {
    if (data_.points.components() != 3)
    {
      fail("has no vertices");
    }
    return std::move(data_);
  }

  std::string path_;
  int threads_;
  std::uint64_t size_ = 0;   ///< of the file
  std::string bytes_;        ///< its first ones; all where its rows are not of one length
  std::size_t position_ = 0; ///< in the file
  std::optional<Format> format_;
  std::vector<Element> elements_;
  SurfaceFile data_;
};

} // namespace

SurfaceFile readPly(const std::string& path, int threads)
{
  return PlyReader(path, threads).read();
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Import/SurfaceFile.h"

#include "Import/FixedRows.h"
#include "Import/PlyFile.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{

namespace
{

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

/// One a property; those of lists have no numbers.
using Columns = std::vector<FileArray>;

FileArray columnOf(const PlyElement& element, const PlyProperty& property)
{
  return { property.name, ArrayRole::None,
    NumberArray(*property.type, 1, static_cast<std::size_t>(element.count)) };
}

RowTarget targetOf(FileArray& column, std::size_t offset)
{
  const std::size_t size = sizeOf(column.numbers.type());
  return { offset, size, column.numbers.bytes(), size };
}

bool isListOfCorners(const PlyProperty& property)
{
  return property.name == "vertex_indices" || property.name == "vertex_index";
}

Columns columnsOf(const PlyElement& element)
{
  Columns columns;
  for (const PlyProperty& property : element.properties)
  {
    columns.emplace_back();
    if (!property.isList())
    {
      columns.back() = columnOf(element, property);
    }
  }
  return columns;
}

/// Null where there is no such column.
const FileArray* take(const Columns& columns, const std::string& name)
{
  const auto found = std::find_if(
    columns.begin(), columns.end(), [&](const FileArray& column) { return column.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

FileArray bundleOf(const std::vector<const FileArray*>& parts, const Bundle& bundle)
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

void addColumns(Columns columns, std::vector<FileArray>& target)
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
    if (!column.name.empty() && std::find(bundled.begin(), bundled.end(), &column) == bundled.end())
    {
      target.push_back(std::move(column));
    }
  }
}

class PlyReader
{
public:
  PlyReader(const std::string& path, int threads) : file_(path), threads_(threads) {}

  SurfaceFile read()
  {
    file_.readHeader();
    for (const PlyElement& element : file_.elements())
    {
      if (readFixed(element))
      {
        continue;
      }
      file_.loadAll();
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
        readRows(element, kNoList);
      }
    }
    refuseIf(data_.points.components() != 3, file_.path(), ": has no vertices");
    return std::move(data_);
  }

private:
  //----------------------------------------------------------------------------
  // Elements whose rows have one length

  /// Whether it is one of those, and read. Whatever else there is to say about it, the other way says.
  bool readFixed(const PlyElement& element)
  {
    const bool isVertex = element.name == "vertex";
    if (file_.format() == PlyFormat::Text || element.count == 0 ||
      (!isVertex && element.name != "face"))
    {
      return false;
    }
    return isVertex ? readFixedVertices(element) : readTriangles(element);
  }

  /// x86 and ARM are little-endian.
  bool isSwapped() const { return file_.format() == PlyFormat::BigEndian; }

  bool readFixedVertices(const PlyElement& element)
  {
    std::size_t rowBytes = 0;
    std::vector<std::size_t> offsets;
    for (const PlyProperty& property : element.properties)
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
        [&](const PlyProperty& property) { return property.name == kCoordinateNames[k]; });
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

  bool readTriangles(const PlyElement& element)
  {
    constexpr std::int64_t kMostIds = std::numeric_limits<std::int32_t>::max();
    if (element.count > kMostIds / 3 || vertexCount() > kMostIds)
    {
      return false;
    }
    const PlyProperty* corners = nullptr;
    std::size_t rowBytes = 0, cornersAt = 0;
    Columns columns;
    std::vector<RowTarget> targets;
    for (const PlyProperty& property : element.properties)
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
  bool readAll(const PlyElement& element, std::size_t rowBytes, const Body& body)
  {
    const std::size_t rows = static_cast<std::size_t>(element.count);
    const bool isRead =
      readFixedRows(file_.path(), file_.position(), rows, rowBytes, threads_, body) == rows;
    file_.skipBytes(isRead ? rows * rowBytes : 0);
    return isRead;
  }

  //----------------------------------------------------------------------------
  // Elements

  static constexpr auto kNoList = [](std::int64_t, const std::vector<std::int64_t>&) {};

  /// Reads all values of an element; lists of corners go to onList.
  template <class OnList>
  Columns readRows(const PlyElement& element, OnList onList)
  {
    Columns columns = columnsOf(element);
    std::vector<std::int64_t> values;
    for (std::int64_t i = 0; i < element.count; ++i)
    {
      for (std::size_t p = 0; p < columns.size(); ++p)
      {
        const PlyProperty& property = element.properties[p];
        if (!property.isList())
        {
          columns[p].numbers.set(
            static_cast<std::size_t>(i), 0, file_.scalar(element, i, property));
          continue;
        }
        file_.list(element, i, property, values);
        if (isListOfCorners(property))
        {
          onList(i, values);
        }
      }
    }
    return columns;
  }

  void readVertices(const PlyElement& element)
  {
    Columns columns = readRows(element, kNoList);
    const FileArray* const xyz[3] = { take(columns, "x"), take(columns, "y"), take(columns, "z") };
    refuseIf(!xyz[0] || !xyz[1] || !xyz[2], file_.path(), ": its vertices have no x, y and z");
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

  void readFaces(const PlyElement& element)
  {
    std::vector<std::int64_t> offsets{ 0 }, ids;
    auto columns = readRows(element,
      [&](std::int64_t i, const std::vector<std::int64_t>& corners)
      {
        checkCorners(element, i, corners);
        ids.insert(ids.end(), corners.begin(), corners.end());
        offsets.push_back(static_cast<std::int64_t>(ids.size()));
      });
    refuseIf(static_cast<std::int64_t>(offsets.size()) != element.count + 1, file_.path(),
      ": its faces have no list vertex_indices");
    data_.polygons = FileCells::of(offsets, ids);
    addColumns(std::move(columns), data_.cellData);
  }

  /// Strips in one list are parted by -1.
  void readStrips(const PlyElement& element)
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
    const PlyElement& element, std::int64_t i, const std::vector<std::int64_t>& corners) const
  {
    for (const std::int64_t corner : corners)
    {
      if (corner < 0 || corner >= vertexCount())
      {
        file_.failAt(element, i,
          "refers to vertex " + std::to_string(corner) + ", but there are " +
            std::to_string(vertexCount()));
      }
    }
  }

  std::int64_t vertexCount() const
  {
    for (const PlyElement& element : file_.elements())
    {
      if (element.name == "vertex")
      {
        return element.count;
      }
    }
    return 0;
  }

  PlyFile file_;
  int threads_;
  SurfaceFile data_;
};

} // namespace

SurfaceFile readPly(const std::string& path, int threads)
{
  return PlyReader(path, threads).read();
}

} // namespace quadrille

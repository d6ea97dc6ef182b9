// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is in a file of a surface: points, polygons, strips and arrays, each number in the file's own type.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace quadrille
{

enum class NumberType : std::uint8_t
{
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Int64,
  Float32,
  Float64
};

/// Bytes.
std::size_t sizeOf(NumberType type);
/// The number of a type whose bytes stand there, in the order of this machine.
double numberAt(const unsigned char* bytes, NumberType type);

/// What an array is drawn as.
enum class ArrayRole
{
  None,
  Normals,
  Colours,
  TextureCoordinates
};

/// A table of numbers of one type, row by row. Who shows it (VTK, NumPy) can take its bytes over, without a copy.
class NumberArray
{
public:
  struct Free
  {
    void operator()(unsigned char* bytes) const { std::free(bytes); }
  };
  using Bytes = std::unique_ptr<unsigned char, Free>; ///< of malloc

  NumberArray() = default;
  /// Throws std::bad_alloc. The numbers are still to be set.
  NumberArray(NumberType type, std::size_t components, std::size_t rows);
  static NumberArray ofIds(const std::vector<std::int64_t>& ids);

  NumberType type() const { return type_; }
  std::size_t components() const { return components_; }
  std::size_t rows() const { return rows_; }
  /// The rows behind so many are given up.
  void shorten(std::size_t rows) { rows_ = rows; }
  unsigned char* bytes() { return bytes_.get(); }
  template <class Number>
  Number* as()
  {
    return reinterpret_cast<Number*>(bytes_.get());
  }
  double get(std::size_t row, std::size_t component = 0) const;
  void set(std::size_t row, std::size_t component, double value);
  Bytes release() { return std::move(bytes_); }

private:
  NumberType type_ = NumberType::Int64;
  std::size_t components_ = 1, rows_ = 0;
  Bytes bytes_;
};

struct FileArray
{
  std::string name;
  ArrayRole role = ArrayRole::None;
  NumberArray numbers;
};

/// Cell i has the points ids[offsets[i]] to ids[offsets[i + 1] - 1]; both Int32 or both Int64. Without offsets there
/// are no cells.
struct FileCells
{
  NumberArray offsets, ids;

  static FileCells of(
    const std::vector<std::int64_t>& offsets, const std::vector<std::int64_t>& ids);
  bool empty() const { return offsets.rows() < 2; }
};

struct SurfaceFile
{
  NumberArray points; ///< three components, Float32 or Float64
  FileCells polygons;
  FileCells strips;
  std::vector<FileArray> pointData;
  std::vector<FileArray> cellData; ///< of the polygons; strips come behind them and have none
};

/// Text and binary, both byte orders. Scalar properties of vertices and faces become point and cell arrays of
/// their own type and name; nx ny nz become Normals, red green blue (alpha) RGB or RGBA, and pairs of texture
/// coordinates TCoords. `tristrips` become triangle strips. Throws InvalidInput naming the file and the line of the
/// header or the element that is damaged, before it asks for more memory than the file can fill.
/// threads: 0: all.
SurfaceFile readPly(const std::string& path, int threads = 0);

/// Reads OFF, COFF, NOFF, STOFF and their mixtures, with comments and any white space. Normals and texture coordinates
/// of vertices become the point arrays Normals and TCoords, colours of vertices and faces RGB or RGBA, an index that a
/// face has in place of a colour the cell array ColorIndex. Colours have parts from 0 to 255, or from 0 to 1 where one
/// of the file's vertices (or faces) has one with a decimal point. Faces keep colours where all have some, of one kind.
/// Throws InvalidInput naming the file and the vertex or face that is damaged.
SurfaceFile readOff(const std::string& path);

/// Whether the file is as long as its count of triangles says: 80 bytes of text, four of the count, 50 a triangle.
bool isBinaryStl(const std::string& path);

/// The triangles, with equal points joined: what vtkSTLReader makes of them with the locator vtkQuadrilleUniquePoints,
/// in the same order, but with 32-bit ids. Triangles with a point twice are left out. Throws InvalidInput unless
/// isBinaryStl(path), and for more than 400 million triangles. threads: 0: all.
SurfaceFile readBinaryStl(const std::string& path, int threads = 0);

/// The same of a text, "solid NAME" and its facets; several solids are one surface. Throws InvalidInput naming the file
/// and the facet that is damaged.
SurfaceFile readTextStl(const std::string& path, int threads = 0);

/// Vertices and faces of a Wavefront OBJ file, in double precision; all else is left out. Ids below 0 count from the
/// last vertex. Throws InvalidInput naming the file and the line that is damaged.
SurfaceFile readObj(const std::string& path);

} // namespace quadrille

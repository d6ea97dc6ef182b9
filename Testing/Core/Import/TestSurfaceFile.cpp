// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The same surface in every format reads as the same points and polygons, and a damaged file is refused with its name
/// and the place in it.
#include "Import/SurfaceFile.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace quadrille
{
namespace
{

namespace fs = std::filesystem;

using Points = std::vector<std::array<double, 3>>;
using Polygons = std::vector<std::vector<std::int64_t>>;

/// A tetrahedron, whose coordinates single precision holds.
const Points kCorners{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1.5 } };
const Polygons kFaces{ { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 0, 3, 2 } };

class ImportedFile : public testing::Test
{
protected:
  ImportedFile()
  {
    std::string pattern = (fs::temp_directory_path() / "quadrilleXXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~ImportedFile() override { fs::remove_all(folder_); }

  std::string written(const std::string& name, const std::string& content) const
  {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }

private:
  fs::path folder_;
};

Points pointsOf(const SurfaceFile& file)
{
  Points points;
  for (std::size_t i = 0; i < file.points.rows(); ++i)
  {
    points.push_back({ file.points.get(i, 0), file.points.get(i, 1), file.points.get(i, 2) });
  }
  return points;
}

Polygons cellsOf(const FileCells& cells)
{
  Polygons polygons;
  for (std::size_t i = 0; i + 1 < cells.offsets.rows(); ++i)
  {
    std::vector<std::int64_t> polygon;
    for (auto k = static_cast<std::size_t>(cells.offsets.get(i));
         k < static_cast<std::size_t>(cells.offsets.get(i + 1)); ++k)
    {
      polygon.push_back(static_cast<std::int64_t>(cells.ids.get(k)));
    }
    polygons.push_back(polygon);
  }
  return polygons;
}

const FileArray* arrayOf(const std::vector<FileArray>& arrays, const std::string& name)
{
  for (const FileArray& array : arrays)
  {
    if (array.name == name)
    {
      return &array;
    }
  }
  return nullptr;
}

template <class Number>
void append(std::string& bytes, Number value, bool swapped = false)
{
  char raw[sizeof(Number)];
  std::memcpy(raw, &value, sizeof(Number));
  for (std::size_t i = 0; i < sizeof(Number); ++i)
  {
    bytes += raw[swapped ? sizeof(Number) - 1 - i : i];
  }
}

std::string plyText()
{
  return "ply\nformat ascii 1.0\ncomment of a test\nelement vertex 4\nproperty float x\nproperty "
         "float y\n"
         "property float z\nproperty int mark\nelement face 4\nproperty list uchar int "
         "vertex_indices\n"
         "property double heat\nend_header\n"
         "0 0 0 7\n1 0 0 8\n0 1 0 9\n0 0 1.5 -10\n"
         "3 0 2 1 0.25\n3 0 1 3 0.5\n3 1 2 3 0.75\n3 0 3 2 1\n";
}

std::string plyBinary(bool bigEndian)
{
  std::string bytes = std::string("ply\nformat binary_") + (bigEndian ? "big" : "little") +
    "_endian 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& corner : kCorners)
  {
    for (const double coordinate : corner)
    {
      append(bytes, coordinate, bigEndian);
    }
  }
  for (const auto& face : kFaces)
  {
    append(bytes, static_cast<unsigned char>(3));
    for (const std::int64_t id : face)
    {
      append(bytes, static_cast<std::int32_t>(id), bigEndian);
    }
  }
  return bytes;
}

std::string objText()
{
  return "# a test\no body\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1.5\nvn 0 0 1\n"
         "f 1 3 2\nf 1//1 2//1 4//1\ng other\nf -3 -2 -1\nf 1 4 3\n";
}

std::string offText()
{
  return "OFF # a test\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1.5\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
}

std::string stlText()
{
  std::string text = "solid test\n";
  for (const auto& face : kFaces)
  {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::int64_t id : face)
    {
      const auto& p = kCorners[static_cast<std::size_t>(id)];
      text += "vertex " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " +
        std::to_string(p[2]) + "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid test\n";
}

std::string stlBinary()
{
  std::string bytes(80, ' ');
  append(bytes, static_cast<std::uint32_t>(kFaces.size()));
  for (const auto& face : kFaces)
  {
    for (int i = 0; i < 3; ++i)
    {
      append(bytes, 0.0F);
    }
    for (const std::int64_t id : face)
    {
      for (const double coordinate : kCorners[static_cast<std::size_t>(id)])
      {
        append(bytes, static_cast<float>(coordinate));
      }
    }
    append(bytes, std::uint16_t{ 0 });
  }
  return bytes;
}

/// As triangles of places, since readers of STL number the points by themselves.
std::vector<Points> trianglesOf(const SurfaceFile& file)
{
  const Points points = pointsOf(file);
  std::vector<Points> triangles;
  for (const std::vector<std::int64_t>& polygon : cellsOf(file.polygons))
  {
    Points triangle;
    for (const std::int64_t id : polygon)
    {
      triangle.push_back(points[static_cast<std::size_t>(id)]);
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

std::vector<Points> triangles()
{
  std::vector<Points> all;
  for (const auto& face : kFaces)
  {
    Points triangle;
    for (const std::int64_t id : face)
    {
      triangle.push_back(kCorners[static_cast<std::size_t>(id)]);
    }
    all.push_back(triangle);
  }
  return all;
}

void expectRefused(
  const std::function<void()>& read, const std::string& path, const std::string& place)
{
  try
  {
    read();
    FAIL() << path << " was read";
  }
  catch (const InvalidInput& error)
  {
    const std::string text = error.what();
    EXPECT_EQ(text.find(path), 0U) << text;
    EXPECT_NE(text.find(place), std::string::npos) << text;
  }
}

TEST_F(ImportedFile, PlyOfTextHasItsPointsFacesAndArrays)
{
  const SurfaceFile file = readPly(written("a.ply", plyText()));
  EXPECT_EQ(pointsOf(file), kCorners);
  EXPECT_EQ(cellsOf(file.polygons), kFaces);
  const FileArray* mark = arrayOf(file.pointData, "mark");
  ASSERT_NE(mark, nullptr);
  EXPECT_EQ(mark->numbers.type(), NumberType::Int32);
  EXPECT_EQ(mark->numbers.get(3), -10);
  const FileArray* heat = arrayOf(file.cellData, "heat");
  ASSERT_NE(heat, nullptr);
  EXPECT_EQ(heat->numbers.type(), NumberType::Float64);
  EXPECT_EQ(heat->numbers.get(2), 0.75);
}

TEST_F(ImportedFile, PlyOfBothByteOrdersIsTheSameForAnyThreads)
{
  for (const bool bigEndian : { false, true })
  {
    const std::string path = written("b.ply", plyBinary(bigEndian));
    for (const int threads : { 1, 3 })
    {
      const SurfaceFile file = readPly(path, threads);
      EXPECT_EQ(file.points.type(), NumberType::Float64);
      EXPECT_EQ(pointsOf(file), kCorners) << bigEndian;
      EXPECT_EQ(cellsOf(file.polygons), kFaces) << bigEndian;
    }
  }
}

TEST_F(ImportedFile, ObjCountsIdsFromEitherEnd)
{
  const SurfaceFile file = readObj(written("a.obj", objText()));
  EXPECT_EQ(pointsOf(file), kCorners);
  EXPECT_EQ(cellsOf(file.polygons), kFaces);
}

TEST_F(ImportedFile, OffMayHaveCommentsAndColours)
{
  EXPECT_EQ(cellsOf(readOff(written("a.off", offText())).polygons), kFaces);
  const SurfaceFile file = readOff(written(
    "c.off", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n0 1 0 0 0 255 255\n\n3 0 1 2\n"));
  EXPECT_EQ(pointsOf(file), (Points{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }));
  ASSERT_EQ(file.pointData.size(), 1U);
  EXPECT_EQ(file.pointData[0].role, ArrayRole::Colours);
  EXPECT_EQ(file.pointData[0].numbers.get(1, 1), 255);
}

TEST_F(ImportedFile, StlOfTextAndBytesJoinsEqualPoints)
{
  const std::string text = written("a.stl", stlText()), binary = written("b.stl", stlBinary());
  EXPECT_FALSE(isBinaryStl(text));
  EXPECT_TRUE(isBinaryStl(binary));
  for (const SurfaceFile& file : { readTextStl(text), readBinaryStl(binary) })
  {
    EXPECT_EQ(file.points.rows(), kCorners.size());
    EXPECT_EQ(trianglesOf(file), triangles());
  }
}

TEST_F(ImportedFile, AFileThatIsNotThereIsRefusedByItsName)
{
  const std::string path = written("gone", "") + "/none";
  expectRefused([&] { readPly(path); }, path, "cannot be opened");
  expectRefused([&] { readObj(path); }, path, "cannot be opened");
  expectRefused([&] { readOff(path); }, path, "cannot be opened");
  expectRefused([&] { readTextStl(path); }, path, "cannot be opened");
}

TEST_F(ImportedFile, AFaceWithAPointThatIsNotThereIsRefusedByItsPlace)
{
  std::string ply = plyText();
  ply.replace(ply.find("3 1 2 3"), 7, "3 1 2 4");
  const std::string plyPath = written("a.ply", ply);
  expectRefused([&] { readPly(plyPath); }, plyPath, "face 2");
  std::string obj = objText();
  obj.replace(obj.find("f 1 4 3"), 7, "f 1 5 3");
  const std::string objPath = written("a.obj", obj);
  expectRefused([&] { readObj(objPath); }, objPath, "line 12");
  std::string off = offText();
  off.replace(off.find("3 0 3 2"), 7, "3 0 9 2");
  const std::string offPath = written("a.off", off);
  expectRefused([&] { readOff(offPath); }, offPath, "face 3");
}

TEST_F(ImportedFile, AFileThatEndsTooEarlyIsRefused)
{
  for (const bool bigEndian : { false, true })
  {
    const std::string whole = plyBinary(bigEndian);
    const std::size_t body = whole.find("end_header\n") + 11;
    for (std::size_t size = body; size < whole.size(); size += 5)
    {
      const std::string path = written("short.ply", whole.substr(0, size));
      expectRefused([&] { readPly(path); }, path, "");
    }
  }
  const std::string stl = stlBinary();
  const std::string path = written("short.stl", stl.substr(0, stl.size() - 1));
  EXPECT_FALSE(isBinaryStl(path));
}

TEST_F(ImportedFile, ACountThatTheFileCannotFillAsksForNoMemory)
{
  std::string ply = plyText();
  ply.replace(ply.find("vertex 4"), 8, "vertex 4000000000000");
  const std::string path = written("large.ply", ply);
  expectRefused([&] { readPly(path); }, path, "");
  const std::string off = written("large.off", "OFF\n4000000000000 1 0\n0 0 0\n");
  expectRefused([&] { readOff(off); }, off, "");
}

} // namespace
} // namespace quadrille

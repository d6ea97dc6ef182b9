// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Cad/CadFile.h"
#include "Shapes.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <random>
#include <sstream>

namespace quadrille
{

namespace
{

std::string errorOf(const std::string& path)
{
  try
  {
    readCadFile(path);
  }
  catch (const InvalidInput& error)
  {
    return error.what();
  }
  return {};
}

std::string bytesOf(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void writeBytes(const std::string& path, const std::string& bytes)
{
  std::ofstream(path, std::ios::binary) << bytes;
}

bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

std::string joined(const std::vector<std::string>& lines)
{
  std::string text;
  for (const std::string& line : lines)
  {
    text += line + "\n";
  }
  return text;
}

} // namespace

TEST(Read, NamesAreThoseOfTheFile)
{
  const std::string path = testFile("named.step");
  writeStep(boxWithHole(), path, namesOfBox());
  const CadFile file = readCadFile(path);
  ASSERT_EQ(file.parts.size(), 1U);
  const CadPart& part = file.parts.front();
  EXPECT_EQ(part.name, "the part");
  EXPECT_EQ(file.unit, "millimetre");
  EXPECT_EQ(part.shape.solidCount(), 1U);
  EXPECT_EQ(part.shape.faceCount(), 7U);
  EXPECT_EQ(part.shape.edgeCount(), 15U);
  EXPECT_EQ(part.shape.vertexCount(), 10U);
  ASSERT_EQ(part.faceNames.size(), 7U);
  EXPECT_EQ(std::count(part.faceNames.begin(), part.faceNames.end(), "support"), 1);
  EXPECT_EQ(std::count(part.faceNames.begin(), part.faceNames.end(), "bore"), 1);
  EXPECT_EQ(std::count(part.faceNames.begin(), part.faceNames.end(), ""), 5);
  EXPECT_EQ(std::count(part.edgeNames.begin(), part.edgeNames.end(), "upper rim"), 1);
  EXPECT_EQ(std::count(part.edgeNames.begin(), part.edgeNames.end(), "front edge"), 1);
  EXPECT_EQ(std::count(part.edgeNames.begin(), part.edgeNames.end(), ""), 13);
  EXPECT_EQ(std::count(part.vertexNames.begin(), part.vertexNames.end(), "origin"), 1);
  EXPECT_EQ(std::count(part.vertexNames.begin(), part.vertexNames.end(), ""), 9);
}

TEST(Read, InstancesArePartsAtTheirPlaces)
{
  const std::string path = testFile("assembly.step");
  writeAssembly(boxWithHole(), path);
  const CadFile file = readCadFile(path);
  ASSERT_EQ(file.parts.size(), 2U);
  EXPECT_EQ(file.parts[0].name, "left");
  EXPECT_EQ(file.parts[1].name, "right");
  const CadSurface &left = file.parts[0].surface, &right = file.parts[1].surface;
  ASSERT_EQ(left.points.size(), right.points.size());
  const Eigen::AngleAxisd turn(0.5, Vector3::UnitZ());
  for (std::size_t i = 0; i < left.points.size(); ++i)
  {
    // Rounding of coordinates up to 15, and what the digits of the file leave.
    EXPECT_LT((turn * left.points[i] + Vector3(10, 0, 0) - right.points[i]).norm(), 1e-9);
  }
  CadReadOptions options;
  options.joined = true;
  const CadFile joinedFile = readCadFile(path, options);
  ASSERT_EQ(joinedFile.parts.size(), 1U);
  const CadPart& both = joinedFile.parts.front();
  EXPECT_EQ(both.shape.faceCount(), 14U);
  EXPECT_EQ(both.faceNames.front(), "left/FACE_1");
  EXPECT_EQ(both.faceNames.back(), "right/FACE_7");
  // The plate is tessellated once, so that both have the same triangles there, too; and it is closed.
  std::array<std::size_t, 14> triangles{};
  for (const Index face : both.surface.faceOf)
  {
    ++triangles.at(face);
  }
  for (std::size_t f = 0; f < 7; ++f)
  {
    EXPECT_GT(triangles[f], 0U);
    EXPECT_EQ(triangles[f], triangles[f + 7]);
  }
  EXPECT_EQ(meshEdges(both.surface).open, 0U);
  EXPECT_EQ(area(both.surface), area(tessellate(both.shape))); // made again from the shape
}

TEST(Read, UnitsAreToldAndCoordinatesAreInMillimetres)
{
  const std::string metres = testFile("metres.step"), inches = testFile("inches.step");
  writeStep(boxWithHole(), metres, {}, "M");
  writeStep(boxWithHole(), inches, {}, "INCH");
  const CadFile inMetres = readCadFile(metres);
  EXPECT_EQ(inMetres.unit, "metre");
  EXPECT_TRUE(contains(joined(inMetres.notices), "metre")) << joined(inMetres.notices);
  EXPECT_NEAR(inMetres.parts.front().shape.diagonal(), std::sqrt(29.0), 1e-4);
  const CadFile inInches = readCadFile(inches);
  EXPECT_EQ(inInches.unit, "inch");
  EXPECT_NEAR(inInches.parts.front().shape.diagonal(), std::sqrt(29.0), 1e-5);
  EXPECT_TRUE(contains(joined(inInches.notices), "inch")) << joined(inInches.notices);
  const std::string plain = testFile("plain.step");
  writeStep(boxWithHole(), plain);
  EXPECT_TRUE(readCadFile(plain).notices.empty());
}

TEST(Read, FreeFacesOfIgesAreSewn)
{
  const std::string path = testFile("faces.igs");
  writeIges(boxWithHole(), path);
  const CadFile file = readCadFile(path);
  ASSERT_EQ(file.parts.size(), 1U);
  EXPECT_TRUE(contains(joined(file.notices), "sewn")) << joined(file.notices);
  EXPECT_EQ(file.parts.front().shape.faceCount(), 7U);
  EXPECT_EQ(file.parts.front().shape.edgeCount(), 15U);
  EXPECT_EQ(meshEdges(file.parts.front().surface).open, 0U);
}

TEST(Read, BrepFilesAreRead)
{
  const std::string path = testFile("rounded.brep");
  writeBrep(roundedCylinder(), path);
  const CadFile file = readCadFile(path);
  ASSERT_EQ(file.parts.size(), 1U);
  EXPECT_EQ(file.parts.front().name, "rounded");
  EXPECT_EQ(file.parts.front().shape.faceCount(), 4U);
}

TEST(Read, ShapesComeBackFromTheirBytes)
{
  const std::string path = testFile("assembly-bytes.step");
  writeAssembly(roundedCylinder(), path);
  CadReadOptions options;
  options.joined = true;
  const CadPart both = readCadFile(path, options).parts.front();
  const CadShape again = CadShape::ofBytes(both.shape.bytes());
  EXPECT_EQ(again.faceCount(), both.shape.faceCount());
  EXPECT_EQ(again.edgeCount(), both.shape.edgeCount());
  const CadSurface before = tessellate(both.shape), after = tessellate(again);
  EXPECT_EQ(before.points, after.points);
  EXPECT_EQ(before.triangles, after.triangles);
  EXPECT_EQ(before.faceOf, after.faceOf);
  std::vector<std::uint8_t> cut = both.shape.bytes();
  cut.resize(cut.size() / 2);
  EXPECT_THROW(CadShape::ofBytes(cut), InvalidInput);
  EXPECT_THROW(CadShape::ofBytes({}), InvalidInput);
}

TEST(Read, WhatIsNoCadFileIsRefused)
{
  EXPECT_TRUE(contains(errorOf(testFile("absent.step")), "no such file"));
  EXPECT_TRUE(contains(errorOf(testFile("absent.ply")), "unknown extension"));
  const std::string empty = testFile("empty.stp");
  writeBytes(empty, "");
  EXPECT_TRUE(contains(errorOf(empty), "empty"));
  for (const char* name : { "text.step", "text.igs", "text.brep" })
  {
    writeBytes(testFile(name), std::string(500, 'x'));
    EXPECT_TRUE(contains(errorOf(testFile(name)), "is no")) << name;
  }
  const std::string header = testFile("header.step");
  writeBytes(header, "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n");
  EXPECT_FALSE(errorOf(header).empty());
}

/// Open CASCADE reads what is left of it.
TEST(Read, TheMissingEndOfAnIgesFileIsTold)
{
  const std::string whole = testFile("end.igs"), cut = testFile("no-end.igs");
  writeIges(boxWithHole(), whole);
  const std::string bytes = bytesOf(whole);
  writeBytes(cut, bytes.substr(0, bytes.size() - 200));
  const auto isTold = [](const CadFile& file)
  {
    return std::any_of(file.notices.begin(), file.notices.end(),
      [](const std::string& notice) { return contains(notice, "the end of the file is missing"); });
  };
  EXPECT_FALSE(isTold(readCadFile(whole)));
  EXPECT_TRUE(isTold(readCadFile(cut)));
}

/// Each is read, or refused in words that name the file; neither ends the process.
TEST(Read, DamagedFilesAreReadOrRefused)
{
  const std::string step = testFile("whole.step"), iges = testFile("whole.igs"),
                    brep = testFile("whole.brep");
  writeStep(roundedCylinder(), step);
  writeIges(boxWithHole(), iges);
  writeBrep(roundedCylinder(), brep);
  std::mt19937 random(7);
  int refused = 0;
  for (const std::string& whole : { step, iges, brep })
  {
    const std::string bytes = bytesOf(whole);
    for (int i = 0; i < 20; ++i)
    {
      std::string damaged = bytes;
      if (i % 2 == 0)
      {
        damaged.resize(bytes.size() * static_cast<std::size_t>(i + 1) / 21);
      }
      else
      {
        for (int k = 0; k < 30; ++k)
        {
          damaged[random() % damaged.size()] = static_cast<char>(32 + random() % 95);
        }
      }
      const std::string path = testFile("damaged" + whole.substr(whole.rfind('.')));
      writeBytes(path, damaged);
      try
      {
        CadReadOptions options;
        options.timeLimit = 3; // some never end
        EXPECT_FALSE(readCadFile(path, options).parts.front().surface.triangles.empty());
      }
      catch (const InvalidInput& error)
      {
        ++refused;
        EXPECT_GT(std::string(error.what()).size(), 20U);
      }
    }
  }
  EXPECT_GT(refused, 10);
}

} // namespace quadrille

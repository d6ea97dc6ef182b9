// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Models from files, for tests of modules that know no VTK.
#pragma once

#include "Mesh/Surface.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace quadrille::test
{

/// A binary little-endian PLY file of triangles with three float coordinates a vertex, and nothing else but
/// patch ids of the faces.
inline std::optional<SurfaceInput> loadPly(const std::string& path)
{
  std::ifstream in(path, std::ios::binary);
  std::string line;
  std::size_t vertices = 0;
  std::size_t faces = 0;
  bool patches = false;
  while (std::getline(in, line) && line.rfind("end_header", 0) != 0)
  {
    std::istringstream words(line);
    std::string keyword, what, count;
    words >> keyword >> what >> count;
    if (keyword == "element")
    {
      (what == "vertex" ? vertices : faces) = std::stoul(count);
    }
    patches = patches || line.rfind("property int PatchId", 0) == 0;
  }
  SurfaceInput surface;
  for (std::size_t v = 0; v < vertices; ++v)
  {
    std::array<float, 3> p{};
    in.read(reinterpret_cast<char*>(p.data()), 12);
    surface.points.emplace_back(double{ p[0] }, double{ p[1] }, double{ p[2] });
  }
  surface.polygonOffsets.push_back(0);
  for (std::size_t f = 0; f < faces; ++f)
  {
    std::uint8_t count = 0;
    std::array<std::int32_t, 3> corner{};
    std::int32_t patch = 0;
    in.read(reinterpret_cast<char*>(&count), 1);
    in.read(reinterpret_cast<char*>(corner.data()), 12);
    if (patches)
    {
      in.read(reinterpret_cast<char*>(&patch), 4);
      surface.patchIds.push_back(patch);
    }
    if (!in || count != 3)
    {
      return std::nullopt;
    }
    for (const std::int32_t v : corner)
    {
      surface.polygonPoints.push_back(static_cast<Index>(v));
    }
    surface.polygonOffsets.push_back(static_cast<Index>(surface.polygonPoints.size()));
  }
  return faces > 0 ? std::optional<SurfaceInput>(surface) : std::nullopt;
}

/// Paths of the PLY files of a folder, in order; none where there is no such folder.
inline std::vector<std::string> plyFilesIn(const std::string& folder)
{
  std::vector<std::string> paths;
  if (std::filesystem::is_directory(folder))
  {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
    {
      if (entry.path().extension() == ".ply")
      {
        paths.push_back(entry.path().string());
      }
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

} // namespace quadrille::test

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Reading CAD files: STEP, IGES and Open CASCADE's own BREP.
#pragma once

#include "Cad/Shape.h"
#include "Cad/Tessellation.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// A leaf of the assembly at its place, or all that a file without an assembly has.
struct CadPart
{
  std::string name; ///< of the instance, or of the part; no two parts of a file have the same
  CadShape shape;
  CadSurface surface;                   ///< of the shape
  std::vector<std::string> faceNames;   ///< #faces, as the file has them; empty where it has none
  std::vector<std::string> edgeNames;   ///< #edges
  std::vector<std::string> vertexNames; ///< #vertices
  /// #faces; red, green and blue in [0, 1], of the face or of the part.
  std::vector<std::optional<std::array<double, 3>>> faceColours;
};

struct CadFile
{
  std::vector<CadPart> parts; ///< at least one, each with a face
  std::string
    unit; ///< that the file names, "inch"; coordinates are in millimetres; empty where it names none
  std::vector<std::string>
    notices; ///< what was repaired, and what could not be read, one sentence each
};

/// With the number of a face from 1 on, what faces without a name are called.
constexpr const char* kUnnamedFace = "FACE_";

struct CadReadOptions
{
  double timeLimit =
    0; ///< seconds after which a file is refused; 0: 20, and 10 more for each megabyte that it has
  /// Whether all parts become one. Names of faces, edges and vertices begin with that of their part then, where there
  /// are several: "plate/top"; faces without a name are "plate/FACE_1" and so on.
  bool joined = false;
  TessellationOptions tessellation;
};

/// In a process of its own, so that a file on which Open CASCADE ends, or does not end, does no harm. Throws
/// InvalidInput, which names the file and what is wrong.
CadFile readCadFile(const std::string& path, const CadReadOptions& options = {});

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The calls of the module with Open CASCADE, which is opened with the first of them: whoever needs no CAD files starts
/// without Open CASCADE's libraries.
#pragma once

#include "Cad/CadFile.h"
#include "Cad/Placement.h"
#include "Cad/Shape.h"
#include "Cad/Tessellation.h"
#include "Cad/VertexNodes.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

/// Each is the function of that name in Cad/, and throws as that does.
struct CadCalls
{
  CadFile (*readCadFile)(const std::string& path, const CadReadOptions& options);
  CadShape (*shapeOfBytes)(const std::vector<std::uint8_t>& bytes); ///< CadShape::ofBytes
  std::vector<std::uint8_t> (*bytesOfShape)(const CadShape& shape); ///< CadShape::bytes
  CadSurface (*tessellate)(const CadShape& shape, const TessellationOptions& options);
  std::vector<CadPlace> (*placeOnShape)(const CadShape& shape, const CadSurface& surface,
    const std::vector<Vector3>& points, const PlacementOptions& options,
    const std::vector<Index>& faces);
  TakenVertices (*takeVertices)(const CadShape& shape, const CadSurface& surface,
    const std::vector<std::array<Index, 4>>& quads, std::vector<CadPlace>& places);
  void (*keepQuads)(const std::vector<std::array<Index, 4>>& quads,
    const std::vector<Vector3>& before, std::vector<CadPlace>& places);
};

/// Opens the module, Cad/QuadrilleCad.so beside the library or program that this function is in, and keeps it open.
/// Throws InvalidInput, which says what is missing, where it is not there or lacks a library.
const CadCalls& cadCalls();

} // namespace quadrille

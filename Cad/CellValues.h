// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is said of a part to those who make quads of it.
#pragma once

#include "Cad/CadFile.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace quadrille
{

/// Which edges of a shape become features.
enum class CadFollow
{
  Sharp = 0,
  All = 1, ///< tangent ones, too
  None = 2
};

/// #triangles each.
struct CadCells
{
  std::vector<std::uint8_t>
    features; ///< bit i: the side from corner i to the next one is part of a followed edge
  /// Of the face at the corners, and of the edges that the sides are part of; see KnownCurvature.
  std::vector<std::array<float, 6>> curvatures;
};

/// surface: with curvatures.
CadCells cadCells(const CadSurface& surface, CadFollow follow);

/// Where edges and vertices are.
struct CadLines
{
  std::vector<std::array<int, 2>> ends; ///< by edge: ids of vertices, or -1
  std::vector<int> counts;              ///< by edge: how many of the points are of it
  std::vector<Vector3> points;          ///< polylines of all edges, one after the other
  std::vector<Vector3> vertexPoints;    ///< by vertex; NaN where no face has it
};

CadLines cadLines(const CadSurface& surface);

/// That of the file, or FACE_n, n from 1 on.
std::string nameOfFace(const CadPart& part, std::size_t face);

} // namespace quadrille

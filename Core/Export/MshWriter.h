// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Gmsh's format, as text. Source: Gmsh Reference Manual, MSH file format version 4.1 and the legacy version 2.
///
/// Corners are points, chains of edges between corners curves, sets of patches surfaces, with the curves round them;
/// each has a tag from 1. Boundary loops (of one or more curves), feature curves, corners and patches are physical
/// groups with their names. Elements: 15 (point) for corners, 1 or 8 (lines of 2 or 3 nodes) for curves, 3, 16 or 10
/// (quads of 4, 8 or 9 nodes). Nodes have the tags 1 to #V in the order of the mesh, quads the tags 1 to #E; lines and
/// points follow.
#pragma once

#include "Base/Progress.h"
#include "Export/MeshSets.h"

#include <string>
#include <vector>

namespace quadrille
{

enum class MshVersion
{
  V41,
  V22
};

/// Returns what the user should know. Throws WriteError.
std::vector<std::string> writeMsh(const ElementMesh& mesh, const MeshSets& sets,
  const std::string& path, MshVersion version, const ProgressCallback& progress);

} // namespace quadrille

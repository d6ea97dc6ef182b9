// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Formats of surfaces: MEDIT, Wavefront OBJ, PLY and STL. All return what the user should know and throw WriteError.
#pragma once

#include "Base/Progress.h"
#include "Export/MeshSets.h"

#include <string>
#include <vector>

namespace quadrille
{

/// MEDIT's .mesh, as text, version 2 (double precision). Source: P. Frey, MEDIT: an interactive mesh visualization
/// software, RT-0253, INRIA 2001, and libMeshb's documentation. References of quads are the sets of patches from 1, of
/// edges the boundary loops from 1 and then the feature curves, of vertices the corners from 1, else 0; comments say
/// their names. Edges of feature curves are ridges, corners are Corners and RequiredVertices. Elements of first order
/// only, else InvalidInput.
std::vector<std::string> writeMedit(const ElementMesh& mesh, const MeshSets& sets,
  const std::string& path, const ProgressCallback& progress);

/// OBJ, with 17 digits. withGroups: each set of patches is one group, "g NAME" and its elements, as many readers make
/// an object of each line "g"; elements keep their order within a group only. Of first order only, else InvalidInput.
/// Source: Wavefront, Advanced Visualizer Manual, appendix B1.
std::vector<std::string> writeObj(const ElementMesh& mesh, const MeshSets& sets, bool withGroups,
  const std::string& path, const ProgressCallback& progress);

/// PLY, binary in the byte order of this machine, which is little-endian; single precision, or double. patchProperty:
/// the name of an int property of faces with the number of the patch, and comments say the names of the sets; empty:
/// none, as some readers fail at a property behind the list of corners. Without groups or patches sets may be empty.
/// Throws InvalidInput for elements of second order, and for numbers of patches that an int cannot hold. Source: G.
/// Turk, The PLY Polygon File Format, 1994.
std::vector<std::string> writePly(const ElementMesh& mesh, const MeshSets& sets,
  const std::string& patchProperty, bool inDouble, const std::string& path,
  const ProgressCallback& progress);

/// Binary STL. Each quad is two triangles, cut along the diagonal that leaves the larger least angle; one of 8 nodes is
/// 6 triangles, one of 9 nodes 8. Single precision, so that points far from the origin may become one, which a notice
/// tells. Source: StereoLithography Interface Specification, 3D Systems, 1989.
std::vector<std::string> writeStl(
  const ElementMesh& mesh, const std::string& path, const ProgressCallback& progress);

} // namespace quadrille

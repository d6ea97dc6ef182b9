// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A patch of a map that is solved with fewer triangles, and whose vertices then come back one by one [Shen et al.
/// 2019].
///
/// Where a map is inverted or winds wrongly, half-edge collapses take the vertices inside of the patch away, and a
/// solver that the caller gives is asked for a map of what is left, at several levels, the coarsest one first. From the
/// first valid map on each vertex is put back inside of the kernel of its star, which is never empty there: before the
/// vertex came back all triangles were positive, and beside the vertex that it had gone to there is always room. Points
/// round it are then moved by the energy of the surface's shapes, so that triangles do not become small. So a patch has
/// a valid map whenever one of its levels has one; what has only one triangle in the whole patch is no different there.
///
/// The decimation log cannot do the same (Replay.h): its removals end in other triangulations than fans, and these may
/// leave a star no kernel.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"

#include <functional>
#include <vector>

namespace quadrille
{

/// How a vertex of a patch may move.
enum class PatchFreedom
{
  Fixed,
  AlongU, ///< in the chart of its first corner
  AlongV,
  Plane
};

/// A corner of a vertex and the rotation from the chart of the first corner of its fan to its own.
struct PatchCorner
{
  Index corner = 0; ///< of the mesh
  int rotation = 0;
};

/// A vertex of a patch with all its corners, counterclockwise.
struct PatchStar
{
  PatchFreedom freedom = PatchFreedom::Fixed;
  bool goesLast = false; ///< its place is right more often than those of others
  const PatchCorner* begin = nullptr;
  const PatchCorner* end = nullptr;
};

/// Makes a map of the faces `patch` of a mesh valid, in place; false where it cannot, and then uv may be anything.
/// turns: #V, of the vertices of these faces what is expected. Vertices that other faces touch stay.
using PatchSolver = std::function<bool(const Mesh& mesh, const std::vector<Index>& patch,
  const std::vector<int>& turns, std::vector<FixedVec2>& uv)>;

struct PatchLevelsResult
{
  bool valid = false;   ///< all inner stars are positive; the caller counts turns
  std::size_t work = 0; ///< triangles that were looked at when vertices came back
};

/// uv: #H of the mesh; only corners of the patch change, and only where the result is valid. patch: faces, ascending.
/// turns: #V of the mesh, as expected. stars: of all vertices of the patch. scale: of the map over the surface.
PatchLevelsResult solveByLevels(const Mesh& mesh, const std::vector<Index>& patch,
  const std::vector<PatchStar>& stars, const std::vector<int>& turns, double scale,
  const PatchSolver& solver, std::vector<FixedVec2>& uv);

/// The inverse of [ab, ac] laid out in the plane; where the triangle is too flat for that, of an equilateral one.
Eigen::Matrix2d inverseOfTriangle(const Vector3& ab, const Vector3& ac);

} // namespace quadrille

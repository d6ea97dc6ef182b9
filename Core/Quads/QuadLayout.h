// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The layout of a quad mesh (its base complex): patches that are grids of quads, and the lines between them.
///
/// A straight line runs along edges and leaves each regular vertex (four edges) opposite to where it came in. It ends
/// at the boundary or at an irregular vertex, or it closes. The boundary and all straight lines with an irregular end
/// (separatrices) or with a feature edge cut the quads into patches. Lines are never cut short: where a feature ends
/// or turns, its line goes on, and lines cross. Hence no side of a patch begins in the middle of another one's, and
/// every patch is a grid of n x m quads with four corners, except where a component has no irregular vertex:
///
///   x----+----+----x     x: irregular vertex     a patch beside a closed line or a round boundary may be a ring
///   |    |    |    |     +: lines cross          (n quads round, m across), and a whole torus may be one patch
///   +====+----+----+     =: feature that ends    (n quads along one line round it, n m quads).
///   |    |    |    |
#pragma once

#include "Quads/QuadMesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille
{

enum class PatchShape : std::uint8_t
{
  Rectangle, ///< four corners
  Ring,      ///< two closed sides, no corner
  Torus      ///< no side at all
};

struct LayoutPatch
{
  Index firstQuad = 0; ///< the lowest of its quads
  PatchShape shape = PatchShape::Rectangle;
  /// n and m, see above. The two directions of a rectangle come in the order of the sides of its first quad.
  std::array<Index, 2> size{};
};

enum class LineEnd : std::uint8_t
{
  Irregular, ///< at an irregular vertex, inside or on the boundary
  Boundary,  ///< at a regular vertex of the boundary
  Feature, ///< at a regular vertex, where the line goes on but is no feature any more, or becomes one
  Closed   ///< nowhere: the last point is the first
};

/// A piece of a straight line inside the mesh, all of it on features or none.
struct LayoutLine
{
  std::size_t first = 0; ///< in QuadLayout::linePoints
  std::size_t count = 0; ///< of points, >= 2
  LineEnd start = LineEnd::Irregular;
  LineEnd end = LineEnd::Irregular;
  bool feature = false;
  /// The straight line has an irregular end: it would be in the layout without features, too.
  bool separatrix = false;
};

struct QuadLayout
{
  std::vector<Index> patchOf; ///< per quad; patches are numbered by their first quads
  std::vector<LayoutPatch> patches;
  std::vector<LayoutLine> lines; ///< of the inside; the boundary is a border of patches as well
  std::vector<Index> linePoints;
  /// Per QuadMesh::lines: the patches on both sides, the lower one first; twice the same on the boundary.
  std::vector<std::array<Index, 2>> patchesOfLine;
  /// Per QuadMesh::lines: it is part of a separatrix; never on the boundary.
  std::vector<std::uint8_t> lineOnSeparatrix;
};

/// Uses the quads, the number of points and the lines. Where quads are no manifold, touch in a point only, or have no
/// neighbour, they are cut and at a boundary; a line along no quad has kInvalidIndex for both patches. Linear for
/// bounded valences; the result does not depend on the number of threads. Throws InvalidInput for a quad with a point
/// twice or beyond the points.
QuadLayout layoutOf(const QuadMesh& mesh, int threads = 1);

} // namespace quadrille

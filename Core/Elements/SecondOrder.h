// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Nodes between the corners of quads, for elements of second order: on the surface, on the curves of features and
/// boundaries where the edges lie on these, and such that the elements are not folded.
#pragma once

#include "Base/Progress.h"
#include "Quads/SurfaceWalk.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille
{

/// Quads and where their points lie on a surface.
struct QuadsOnSurface
{
  std::vector<Vector3> points;
  std::vector<std::array<Index, 4>> quads;
  std::vector<std::uint8_t>
    featureEdges;                   ///< empty or #quads; bit i: the edge from corner i to i + 1
  std::vector<SurfacePoint> places; ///< #points; face kInvalidIndex: on no face that is known
};

/// Where a node between the corners lies.
enum class NodePlace : std::uint8_t
{
  Surface = 0,    ///< in the middle, on the surface, or on the curve of its edge
  MovedAlong = 1, ///< on the surface or curve, but nearer to the straight edge's middle
  MovedOff = 2    ///< off the surface, towards the straight edge's middle or on it
};

struct SecondOrderOptions
{
  int nodes = 8; ///< an element, 8 or 9
  int threads = 0;
  ProgressCallback progress;
};

struct SecondOrderNodes
{
  std::vector<std::array<Index, 2>> edges;       ///< corners, the lower one first
  std::vector<std::array<Index, 4>> edgesOfQuad; ///< i: between corner i and i + 1
  std::vector<std::uint8_t> onBoundary;          ///< #edges; of the quads
  /// #edges, and with 9 nodes #quads behind them.
  std::vector<Vector3> points;
  std::vector<SurfacePoint>
    places; ///< of points off the surface: whence they were moved; or kInvalidIndex
  std::vector<NodePlace> kinds;

  /// Edges of features or of the boundary that no curve of the surface is found for: their nodes lie on the surface.
  std::vector<Index> withoutCurve; ///< ascending
  /// Nodes that no way over the faces leads to, or only one that goes farther from the straight edge than half its
  /// length: on the nearest place on the same side outside, or, where there is none as near, off the surface, in the
  /// middle of the straight edge.
  std::vector<Index> byNearest; ///< ascending
  std::vector<Index>
    invertedQuads; ///< ascending; their corners alone have a determinant that is not positive
};

/// A node between two corners lies halfway between them: in the plane that is perpendicular to the straight edge in its
/// middle, on an edge that lies on a feature or boundary on its curve (see chainBetween), on any other on the section
/// of the surface with the plane that contains the edge and the normal of its quads. The node in a quad's centre lies
/// so between those of two of its edges.
///
/// Then no element whose corners allow it has a determinant that is not positive at its nodes and Gauss points, see
/// QuadraticShape: of an element that has one a node moves towards the middle of its straight edge, at first along the
/// surface or its curve, then off the surface. A node that two elements share moves for both.
///
/// The result does not depend on the number of threads. Throws InvalidInput for other nodes than 8 or 9, and for a
/// size of an array or an id that does not fit.
SecondOrderNodes placeSecondOrderNodes(
  const Mesh& surface, const QuadsOnSurface& quads, const SecondOrderOptions& options);

} // namespace quadrille

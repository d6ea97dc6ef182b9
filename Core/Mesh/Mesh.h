// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Triangle-implicit half-edge mesh: the one mesh type of Core, on every level.
///
///            c
///           / \           half-edge 3f+i runs from corner i to corner (i+1)%3 of face f,
///   3f+2   / f \  3f+1    faces are counterclockwise seen from outside. A corner is named by
///         /     \         the half-edge that leaves it: corner 3f+i is at vertex origin[3f+i].
///        a------>b
///           3f
#pragma once

#include "Base/SharedArray.h"
#include "Base/Types.h"

#include <array>
#include <vector>

namespace quadrille
{

/// Bits of Mesh::flags.
enum HalfEdgeFlag : std::uint8_t
{
  kFeatureEdge = 1, ///< set on both half-edges of a feature edge; boundary edges need no flag
  kRequestedFeature =
    2 ///< the user asked for this feature; without it, the dihedral angle alone did
};

/// A copy shares all arrays until one of the two changes one: it costs next to nothing.
struct Mesh
{
  SharedArray<Vector3> position;   ///< #V points
  SharedArray<Index> origin;       ///< #H = 3 #F; vertex that the half-edge leaves
  SharedArray<Index> twin;         ///< #H; kInvalidIndex on the boundary
  SharedArray<std::uint8_t> flags; ///< #H; HalfEdgeFlag bits
  SharedArray<float>
    sizing; ///< #V, or empty: wanted edge length there as a multiple of s; see Sizing.h

  Index vertexCount() const { return static_cast<Index>(position.size()); }
  Index halfEdgeCount() const { return static_cast<Index>(origin.size()); }
  Index faceCount() const { return halfEdgeCount() / 3; }

  static Index face(Index h) { return h / 3; }
  // Without a branch: on walks round a vertex nothing predicts which corner of a face comes next. The steps from
  // corners 0, 1, 2 are two bits each: next 1, 2, 0 and previous 2, 0, 1.
  static Index next(Index h)
  {
    const Index first = h / 3 * 3;
    return first + (9U >> 2 * (h - first) & 3U);
  }
  static Index previous(Index h)
  {
    const Index first = h / 3 * 3;
    return first + (18U >> 2 * (h - first) & 3U);
  }

  Index target(Index h) const { return origin[next(h)]; }
  bool isBoundary(Index h) const { return twin[h] == kInvalidIndex; }
  bool isFeature(Index h) const { return (flags[h] & kFeatureEdge) != 0; }
  /// An edge that has to lie on an integer isoline: a feature or a boundary edge.
  bool isConstrained(Index h) const { return isBoundary(h) || isFeature(h); }

  Vector3 edgeVector(Index h) const { return position[target(h)] - position[origin[h]]; }
  /// The end of the edge of h that is not v.
  Index otherEnd(Index h, Index v) const { return origin[h] == v ? target(h) : origin[h]; }
  /// Normal of a face, as long as twice its area.
  Vector3 doubleAreaNormal(Index f) const { return edgeVector(3 * f).cross(edgeVector(3 * f + 1)); }
  double faceArea(Index f) const { return doubleAreaNormal(f).norm() / 2; }
  std::array<Vector3, 3> cornersOfFace(Index f) const
  {
    return { position[origin[3 * f]], position[origin[3 * f + 1]], position[origin[3 * f + 2]] };
  }
  Vector3 middleOfFace(Index f) const
  {
    return (position[origin[3 * f]] + position[origin[3 * f + 1]] + position[origin[3 * f + 2]]) /
      3;
  }

  /// The next half-edge that leaves the same vertex, counterclockwise; kInvalidIndex past a boundary.
  Index rotateCounterclockwise(Index h) const { return twin[previous(h)]; }
  /// The next one clockwise; kInvalidIndex when h itself is a boundary half-edge.
  Index rotateClockwise(Index h) const
  {
    return twin[h] == kInvalidIndex ? kInvalidIndex : next(twin[h]);
  }
};

/// Calls visit(g) for the half-edges that leave the vertex of h, counterclockwise from h on, all round it or up to the
/// boundary. Returns whether that is all round.
template <typename Visitor>
bool forEachFrom(const Mesh& mesh, Index h, Visitor&& visit)
{
  Index g = h;
  do
  {
    visit(g);
    g = mesh.rotateCounterclockwise(g);
  } while (g != kInvalidIndex && g != h);
  return g == h;
}

/// Calls visit(g) for each half-edge g that leaves the origin of h and is in the same fan: from h on counterclockwise,
/// and then what lies clockwise of it up to a boundary.
template <typename Visitor>
void forEachInFan(const Mesh& mesh, Index h, Visitor&& visit)
{
  if (forEachFrom(mesh, h, visit))
  {
    return;
  }
  for (Index g = mesh.rotateClockwise(h); g != kInvalidIndex; g = mesh.rotateClockwise(g))
  {
    visit(g);
  }
}

/// Calls visit(g) for each edge at the origin of h, if that has one fan: with a half-edge that leaves it, but for the
/// last one of a boundary vertex, which has none.
template <typename Visitor>
void forEachEdgeInFan(const Mesh& mesh, Index h, Visitor&& visit)
{
  forEachInFan(mesh, h,
    [&](Index g)
    {
      visit(g);
      if (mesh.isBoundary(Mesh::previous(g)))
      {
        visit(Mesh::previous(g));
      }
    });
}

} // namespace quadrille

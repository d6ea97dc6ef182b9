// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Exact questions about a map and the field it follows, shared by the stages of GridMap.
#pragma once

#include "Base/FixedPoint.h"
#include "Base/Progress.h"
#include "CrossField/CrossField.h"
#include "Mesh/Mesh.h"

#include <array>
#include <string>
#include <vector>

namespace quadrille
{

/// How many quadrants corner i of the triangle p enters, sweeping counterclockwise from the edge that leaves it
/// to the other one; negative where the triangle is inverted. Added up round a vertex, between
/// edges that lie on an axis or are equal up to quarter turns, this is the exact number of quarter turns.
int quadrantsEntered(const FixedVec2* p, int i, int orientationSign);

/// The quadrant [0, 90), [90, 180), ... degrees of a vector that is not zero.
inline int quadrantOfNonzero(FixedVec2 d)
{
  const bool lower = d.v < 0 || (d.v == 0 && d.u < 0);
  return 2 * static_cast<int>(lower) + static_cast<int>(lower ? d.u >= 0 : d.u <= 0);
}

/// quadrantsEntered of the three corners of a triangle with positive determinant, from one quadrant an edge: an
/// edge backwards is two quadrants on.
inline std::array<std::int8_t, 3> quadrantsEnteredByPositive(const FixedVec2* p)
{
  const int q0 = quadrantOfNonzero(p[1] - p[0]);
  const int q1 = quadrantOfNonzero(p[2] - p[1]);
  const int q2 = quadrantOfNonzero(p[0] - p[2]);
  return { static_cast<std::int8_t>((q2 + 2 - q0) & 3), static_cast<std::int8_t>((q0 + 2 - q1) & 3),
    static_cast<std::int8_t>((q1 + 2 - q2) & 3) };
}

/// quadrantsEntered of the three corners of any triangle.
inline std::array<std::int8_t, 3> quadrantsEnteredByAll(const FixedVec2* p, int orientationSign)
{
  if (orientationSign > 0)
  {
    return quadrantsEnteredByPositive(p);
  }
  std::array<std::int8_t, 3> entered{};
  for (int i = 0; i < 3; ++i)
  {
    entered[static_cast<std::size_t>(i)] =
      static_cast<std::int8_t>(quadrantsEntered(p, i, orientationSign));
  }
  return entered;
}

/// Quarter turns of a map round each vertex (#V), as seams and features are exact quarter turns: the sums of what its
/// corners enter, which entered(h) says.
template <typename Entered>
std::vector<int> sumTurns(const Mesh& mesh, const Entered& entered)
{
  std::vector<int> turns(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    turns[mesh.origin[h]] += entered(h);
  }
  return turns;
}

/// What keeps a map from following a field without inverted triangles.
struct MapDefects
{
  std::vector<Index> notPositive; ///< faces
  std::vector<Index>
    wrongTurns; ///< vertices where the winding, or that of a sector, is not the field's
  std::vector<Index> reversed; ///< constrained half-edges that do not run along their axis

  bool none() const { return notPositive.empty() && wrongTurns.empty() && reversed.empty(); }
  std::size_t count() const { return notPositive.size() + wrongTurns.size() + reversed.size(); }
  std::string text() const; ///< how many of each
};
MapDefects findDefects(const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& uv);

/// Faces with !(det > 0).
std::vector<Index> findNotPositive(const Mesh& mesh, const std::vector<FixedVec2>& uv);

/// The vertices at which the triangulation has too few triangles for the turns that the field asks for:
/// every triangle turns by less than half a circle.
std::vector<Index> crowdedVertices(const Mesh& mesh, const CrossField& field);

/// The corners of the faces, ascending.
std::vector<Index> cornerVertices(const Mesh& mesh, const std::vector<Index>& faces);

/// Where a map has failed, by faces.
struct FailedFaces
{
  std::vector<Index> faces; ///< ascending
  /// A constrained edge that is reversed in the map concerns the faces on both sides: without the one, or the other, it
  /// could be where it is. Twice the same on a boundary.
  std::vector<std::array<Index, 2>> either;

  bool empty() const { return faces.empty() && either.empty(); }
};
/// Where there are no other defects, faces round vertices with wrong turns.
FailedFaces failedFacesOf(const Mesh& mesh, const MapDefects& defects);

/// The vertices of all defects, ascending.
std::vector<Index> verticesOf(const Mesh& mesh, const MapDefects& defects);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Exact questions about a map and the field it follows, shared by the stages of GridMap.
#pragma once

#include "Base/FixedPoint.h"
#include "CrossField/CrossField.h"
#include "Mesh/Mesh.h"

#include <string>
#include <vector>

namespace quadrille
{

/// How many quadrants corner i of the triangle p enters, sweeping counterclockwise from the edge that leaves it
/// to the other one; negative where the triangle is inverted. Added up round a vertex, between
/// edges that lie on an axis or are equal up to quarter turns, this is the exact number of quarter turns.
int quadrantsEntered(const FixedVec2* p, int i, int orientationSign);

/// What keeps a map from following a field without inverted triangles.
struct MapDefects
{
  std::vector<Index> notPositive; ///< faces
  std::vector<Index>
    wrongTurns; ///< vertices where the winding, or that of a sector, is not the field's
  std::vector<Index> reversed; ///< constrained half-edges that do not run along their axis

  bool none() const { return notPositive.empty() && wrongTurns.empty() && reversed.empty(); }
  std::size_t count() const { return notPositive.size() + wrongTurns.size() + reversed.size(); }
  std::string text() const;
};
MapDefects findDefects(const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& uv);

/// Faces with !(det > 0).
std::vector<Index> findNotPositive(const Mesh& mesh, const std::vector<FixedVec2>& uv);

/// The vertices at which the triangulation has too few triangles for the turns that the field asks for:
/// every triangle turns by less than half a circle.
std::vector<Index> crowdedVertices(const Mesh& mesh, const CrossField& field);

/// The vertices of all defects, ascending.
std::vector<Index> verticesOf(const Mesh& mesh, const MapDefects& defects);

/// "3, 14, 15 and 7 more".
std::string listOf(const std::vector<Index>& ids);

} // namespace quadrille

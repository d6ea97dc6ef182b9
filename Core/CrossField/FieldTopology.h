// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Frames, unfolding and fans: the discrete connection that field, turns and repair share.
///
///  - Lengths, angles and areas are those of the mesh over the sizes that it wants, where it has any (Mesh/Sizing.h).
///  - The frame of face f is its half-edge 3f. direction(h) is the angle of half-edge h in it.
///  - A direction at angle x in face(h) has angle x + transport(h) in face(twin h).
///  - A fan is the set of corners between two constrained half-edges of a vertex (a sector), or the whole ring of
///    an unconstrained interior vertex. Quarter turns are counted per fan.
#pragma once

#include "Mesh/Mesh.h"

#include <array>
#include <vector>

namespace quadrille
{

struct Fan
{
  Index vertex = kInvalidIndex;
  Index first =
    kInvalidIndex; ///< first corner counterclockwise; constrained when the fan is a sector
  Index last =
    kInvalidIndex; ///< last corner; previous(last) is constrained when the fan is a sector
  Index corners = 0;
  double angle = 0; ///< sum of the corner angles, radians
  bool sector = false;
};

struct FieldTopology
{
  std::vector<double> direction;   ///< #H, angle of h in the frame of its face
  std::vector<double> cornerAngle; ///< #H, interior angle at origin[h], in (0, pi)
  std::vector<double> transport;   ///< #H, in (-pi, pi]; exactly antisymmetric; 0 on the boundary
  std::vector<double> edgeLength;  ///< #H
  std::vector<double> area;        ///< #F, never zero
  std::vector<double> edgeWeight;  ///< #H, primal over dual length; 0 across constrained edges
  std::vector<Fan> fans;
  std::vector<Index> fanOfCorner; ///< #H
  std::vector<std::array<Index, 2>>
    edges; ///< unconstrained edges: half-edge with the lower id, twin
  double totalArea = 0;
  double meanEdgeLength = 0;
};

/// The mesh has to be manifold and oriented; isolated vertices have no fan.
FieldTopology buildFieldTopology(const Mesh& mesh);

/// How often the three half-edges of face f are constrained.
int constrainedEdges(const Mesh& mesh, Index f);

/// #F: the lowest of the faces that unconstrained edges join a face with.
std::vector<Index> regionsOf(const Mesh& mesh);

/// x modulo 2 pi in (-pi, pi].
double wrapAngle(double x);

} // namespace quadrille

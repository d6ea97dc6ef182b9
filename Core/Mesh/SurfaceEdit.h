// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Local changes of a surface under preparation; source ids, weights and flags follow. Removed faces
/// keep their slot, with kInvalidIndex at their corners, until orderSurface.
#pragma once

#include "Mesh/Surface.h"

namespace quadrille
{

/// Vertices joined to the origin of h by an edge of its fan.
std::vector<Index> neighboursOf(const Mesh& mesh, Index h);

/// Splits the edge of h at a share of it in (0, 1) from the origin of h, by default at its midpoint; returns the new
/// vertex. Its 1 or 2 faces become 2 or 4: each keeps the half at its own half-edge's origin, and the other half is
/// appended.
Index splitEdge(PreparedSurface& surface, Index h, double share = 0.5);

/// Splits a face in three at its centroid; returns the new vertex. Half-edge 3f stays, the faces at
/// 3f+1 and 3f+2 are appended.
Index splitFace(PreparedSurface& surface, Index f);
/// The same at another place; weights: barycentric, above 0, sum 1.
Index splitFace(PreparedSurface& surface, Index f, const std::array<double, 3>& weights);

/// Cuts the surface open along a simple closed loop of at least 3 inner half-edges, each of which ends where the next
/// one begins, that meets no boundary; closes both sides with a fan round a new vertex at the mean of the loop's
/// vertices. The faces of a fan have the sources of the faces that they are joined to: a new vertex, and only it, lies
/// off its sources.
void cutAndClose(PreparedSurface& surface, const std::vector<Index>& loop);

/// Closes a boundary loop of at least 3 half-edges, each of which ends where the next one begins, with a fan round a
/// new vertex at `middle`. Sources as in cutAndClose; the edges of the loop are features no more.
void fillWithFan(PreparedSurface& surface, const std::vector<Index>& loop, const Vector3& middle);

/// Removes a face; its edges become boundary.
void removeFace(PreparedSurface& surface, Index f);

/// True when the surface stays a manifold without double edges after collapseEdge(h).
bool mayCollapse(const Mesh& mesh, Index h);

/// Moves the origin of h to its target and removes the faces at h. Not for faces with weights.
void collapseEdge(PreparedSurface& surface, Index h);

/// True when h has two faces and its two opposite vertices are not joined yet.
bool mayFlip(const Mesh& mesh, Index h);

/// Flips the edge of h, which mayFlip, to the opposite vertices. The faces keep their slots, h and its twin begin where
/// they did, and a flag of the edge stays on it.
void flipEdge(Mesh& mesh, Index h);

/// Flips the edge of h, whose face is a sliver on it, to the opposite vertices; both faces are parts of
/// the twin's polygon then, and a feature on the edge goes to the sliver's other two edges. Not for
/// faces with weights.
void flipSliver(PreparedSurface& surface, Index h);

/// flipEdge of an edge whose two faces are flat together, for the flips of this level of the surface
/// (PreparedSurface::flipped). The sources of the faces are those of before until FlatFlips tells them.
void flipFlat(PreparedSurface& surface, Index h, Index level);

} // namespace quadrille

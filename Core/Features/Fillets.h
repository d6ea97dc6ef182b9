// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Fillets narrower than a quad: the surface is sharp there at the scale of the quads, though no edge of it is.
#pragma once

#include "Mesh/Mesh.h"

#include <string>
#include <vector>

namespace quadrille
{

/// Marks as features, on both half-edges, the middle lines of fillets across which the normal turns by more than
/// `angle` (radians) within about an edge length of the quads, so that quads meet there in an edge as they do at a
/// sharp one.
///
/// From the middle of an edge the surface is walked straight across, as far to both sides as features are away or the
/// fillet may be wide. The edge is on the middle line where the normal turns as much on both sides, up to its own bend.
/// A curve of such edges is a fillet's where on average along it the normal turns by more than the angle, and hardly
/// more farther out: beyond, the surface is flat, which tells it from a thin rod. Of curves side by side, as where a
/// facet lies in the middle, the longest counts; one below two edge lengths is the corner between fillets and none.
/// Made for designed bodies, whose fillets have lines along them.
///
/// edgeLength: > 0, times Mesh::sizing. angle: > 0. Throws InvalidInput otherwise. Returns one half-edge of each edge.
std::vector<Index> markFillets(Mesh& mesh, double angle, double edgeLength, int threads);

/// What the user should know of these, as far as they are features; empty where none is.
std::string filletNotice(const Mesh& mesh, const std::vector<Index>& halfEdges, double edgeLength);

} // namespace quadrille

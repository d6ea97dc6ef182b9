// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Strips of quads along paths of edges, by which the boundary of a quad mesh gets edges where it lacks some.
///
///      +---+---v---+              +---+---v'--v---+      A path of edges from u to v, two points of the boundary, is
///      |   |   |   |              |   |   |   |   |      opened, and filled by a strip: the boundary has one edge more
///      +---+---p---+      ->      +---+---p'--p---+      at either end. Where the path goes straight on at points of
///      |   |   |   |              |   |   |   |   |      four edges, all stay regular; where it turns there is a pair
///      +---+---u---+              +---+---u'--u---+      of irregular points.
#pragma once

#include "Quads/QuadMesh.h"

#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace quadrille
{

/// A path of edges over the inside, as half-edges of quads (4 q + i), from a point of the boundary to another one.
using QuadPath = std::vector<Index>;

/// The cheapest path: an edge costs 1, a turn 20, an irregular point 10, and what `endCost` says of its end. It follows
/// no line of the mesh and meets the boundary at its ends only. starts: points of the boundary, with costs. endCost: of
/// another point of the boundary where a path from the given start may end, or none. None where there is no path.
std::optional<QuadPath> findStripPath(const QuadMesh& mesh,
  const std::vector<std::pair<Index, double>>& starts,
  const std::function<std::optional<double>(Index start, Index end)>& endCost);

struct InsertedStrip
{
  /// Per point of the path from its begin: it is on the left of the strip now, and its copy on the right. Both are at
  /// the same place.
  std::vector<std::pair<Index, Index>> points;
};

/// The quads across which one comes from an edge of the boundary, always by the opposite edge, to another one: a
/// half-edge of each, by which one enters. twin: of the quads' topology. None where the way crosses itself.
std::optional<QuadPath> chordFrom(const std::vector<Index>& twin, Index boundaryHalfEdge);

/// Splits all quads of a chord lengthwise, and so the edges of the boundary at both ends. points: the new ones, each
/// with the origin of the half-edge by which one enters; of the edge at the end with the target of that edge. All lie
/// at these places. Lines that are crossed are split.
InsertedStrip splitChord(QuadMesh& mesh, const QuadPath& chord);

/// Takes the quads of a chord out: the points on both sides become one, which is the one of higher rank, or lies in the
/// middle of two that are equal. The other one has no quads then. Of meshes without lines.
void removeChord(
  QuadMesh& mesh, const QuadPath& chord, const std::function<int(Index point)>& rank);

/// Opens the path. New quads are at the end, with the face of the quad on the left and no weights. Features that are
/// crossed go on over the strip, and the two new edges of the boundary are lines.
InsertedStrip insertStrip(QuadMesh& mesh, const QuadPath& path);

/// By how much each point of the strip goes towards those beside it in quads that are not on the strip, a third of the
/// way on average, so that both sides of the strip part.
std::map<Index, Vector3> waysApart(const InsertedStrip& strip, const QuadMesh& mesh);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The network of features as quads of edge length s can follow it: no arc between two junctions is shorter than half a
/// quad. Decided from the network alone, before there is a map.
#pragma once

#include "Features/FeatureFilter.h"
#include "Mesh/Mesh.h"

#include <cstddef>
#include <string>
#include <vector>

namespace quadrille
{

/// Arcs shorter than this part of s are taken out of the network.
constexpr double kShortestArc = 0.5;

struct NetworkReport
{
  std::size_t shortArcs = 0;       ///< that were found, in all rounds
  std::size_t removedCurves = 0;   ///< arcs that went
  std::size_t removedEdges = 0;    ///< their edges
  double removedLength = 0;        ///< in edge lengths of the quads
  double longest = 0;              ///< of the arcs that went, the same
  Vector3 place = Vector3::Zero(); ///< in the middle of the longest one
  double keptLength = 0;           ///< of all features, the same; where any went

  /// What the user should know; empty where none went.
  std::string text() const;
};

/// An arc runs between two nodes, the vertices where other than two constrained edges meet. A map gives each arc the
/// length of a quad at least, and nodes are whole points of it: so an arc much shorter than s crushes what is beside
/// it, and where the patches round it are rectangles, their sides may leave it no length at all. Each arc shorter than
/// kShortestArc s (times the size there) is resolved in the way that loses least length of features:
/// - one of its ends becomes an inner point of a curve: all other arcs there go but one, and the short arc is an end of
///   that one; where there would be a corner as near to the other end, that counts as a loss of 3 s on top;
/// - the arc itself goes; where both ends are nodes or corners without it, too, that counts as a loss of 3 s on top,
///   and they must be at least a quarter of s apart;
/// - what would lose more than 3 s by the first way, and may not go by the second, stays as it is.
/// Only detected features go (without kRequestedFeature), no boundaries. Shortest arcs first, in rounds of arcs that
/// share no node, with removeUnresolvedFeatures in between, until nothing changes. `filtered` gets what that removes.
/// Throws InvalidInput unless edgeLength is positive.
NetworkReport simplifyFeatureNetwork(
  Mesh& mesh, double edgeLength, bool isDesigned, FeatureFilterReport& filtered);

/// Of all features, boundaries aside, in edge lengths of the quads there.
double lengthOfFeatures(const Mesh& mesh, double edgeLength);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sharp edges that make a crease together, and those that are noise which happens to lie in a row: judged curve by
/// curve against s, the edge length of the quads.
#pragma once

#include "Features/FeatureFilter.h"
#include "Mesh/Mesh.h"

#include <string>
#include <vector>

namespace quadrille
{

/// A maximal run of detected features: through vertices where two of them meet, and straight on where more do.
struct CreaseCurve
{
  std::vector<Index> halfEdges; ///< one of each edge, in their order
  double length = 0;            ///< in edge lengths of the quads there
  int freeEnds = 0; ///< of its two ends, those from which no feature goes on; 0 for a closed one
  /// What follows is measured where the judgement needs it, of short curves with free ends, else 0; radians.
  double angle = 0; ///< mean angle between the two faces at its edges
  double wideAngle =
    0; ///< mean angle between the mean normals of both sides within half an edge length
  double roughness =
    0; ///< median of how far both sides turn about the curve's direction within that distance

  bool isCrease() const;
};

/// All curves of features that nobody asked for (without kRequestedFeature), judged for quads of this edge length;
/// where the mesh has sizes, times the size. Throws InvalidInput unless edgeLength is positive.
std::vector<CreaseCurve> traceCreases(const Mesh& mesh, double edgeLength, int threads);

struct CreaseReport
{
  std::size_t removedCurves = 0, removedEdges = 0;
  double removedLength = 0;        ///< of all, in edge lengths of the quads
  double longest = 0;              ///< of them, the same
  Vector3 place = Vector3::Zero(); ///< where the longest is
  std::size_t keptCurves = 0;
  double keptLength = 0;

  /// What the user should know; empty where none was removed.
  std::string text() const;
};

/// Unmarks the curves that are no creases. One that closes, or ends at others or at the boundary, is one, as noise
/// makes no networks, and so is one of at least 50 edge lengths. More is asked of others, which end in the surface:
/// - they are sharp over a distance, too: the mean normals on both sides differ by at least half the angle at edges;
/// - they stand out: within that distance both sides turn about their direction by no more than a part of the angle:
///   0.5 where one end is free, 0.15 where both are, which grows with the length from 25 edge lengths on to 0.3.
/// Repeated until nothing changes, as what ended at a curve that went has a free end now; with removeUnresolvedFeatures
/// in between, as what is left of a network may be less than quads resolve. `filtered` gets what that removes.
CreaseReport removeFalseCreases(
  Mesh& mesh, double edgeLength, int threads, FeatureFilterReport& filtered);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sharp edges of a scan are mostly noise: isolated edges and small tangles that no quad of the wanted
/// size can follow. Each would pin integers and make the map impossible.
#pragma once

#include "Mesh/Mesh.h"

#include <string>
#include <vector>

namespace quadrille
{

struct FeatureFilterReport
{
  std::size_t removedEdges = 0;
  std::size_t keptEdges = 0;
};

/// Unmarks features that nobody asked for (without kRequestedFeature) and that are details below the length d: chains
/// shorter than 4 d that end in the surface; whole groups of chains that hang together, loops among them, in a box with
/// a diagonal below d; and the bluntest side of each patch between features that is on average (2 area / perimeter)
/// narrower than 0.01 d. Chains run between vertices where other than two constrained edges meet. Features that the
/// user gave stay. Repeated until nothing changes.
/// smallest: d; 0: all stay. Throws InvalidInput where it is negative.
FeatureFilterReport removeUnresolvedFeatures(Mesh& mesh, double smallest, int threads = 1);

/// Whether there is a feature that nobody asked for; most surfaces have none.
bool hasDetectedFeature(const Mesh& mesh);
/// Whether h is that half-edge of a feature that stands for it, and nobody asked for the feature (kRequestedFeature).
bool isDetectedFeature(const Mesh& mesh, Index h);
/// The half-edges that stand for detected features (see isDetectedFeature) and come closer than `radius` to one of the
/// points. Throws InvalidInput when radius is not positive.
std::vector<Index> featuresNear(
  const Mesh& mesh, const std::vector<Vector3>& points, double radius);

/// What became of a place where a user wants no feature.
struct ClearedFeature
{
  double distance = 0;               ///< of the nearest feature; infinite where there is none
  Vector3 nearest = Vector3::Zero(); ///< the nearest place on it
  double length = 0;      ///< of the curve that is none any more; 0: the nearest is too far away
  std::size_t beside = 0; ///< curves that run along it and went with it
};

/// Unmarks, for each place, the curve of features that is nearest to it, if that is within a distance: one between
/// vertices where other than two constrained edges meet, or a loop; and others that pass the place within `beside` and
/// are nowhere farther from it, as the other side of a step that nobody sees. Also those that were asked for. What one
/// place clears the others do not see.
std::vector<ClearedFeature> clearFeatures(
  Mesh& mesh, const std::vector<Vector3>& places, double within, double beside);

/// A length of features as messages tell it, to two or three digits.
std::string inEdgeLengths(double length);

/// These half-edges and their twins are no features any more.
void unmarkFeatures(
  Mesh& mesh, const std::vector<Index>& halfEdges, std::uint8_t flags = kFeatureEdge);

} // namespace quadrille

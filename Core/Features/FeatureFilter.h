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

/// Unmarks features that nobody asked for (without kRequestedFeature) and that the edge length s cannot resolve:
/// dangling chains shorter than 4 s or zigzagging, closed loops and whole tangles whose chains are on average shorter
/// than s, and the bluntest side of each patch between features that is on average (2 area / perimeter) narrower than s
/// / 4, on a designed surface s / 8, as its edges are exact. Chains run between vertices where other than two
/// constrained edges meet. Features that the user gave stay. Repeated until nothing changes.
/// Throws InvalidInput when edgeLength is not positive.
FeatureFilterReport removeUnresolvedFeatures(
  Mesh& mesh, double edgeLength, bool isDesigned = false, int threads = 1);

/// Whether there is a feature that nobody asked for; most surfaces have none.
bool hasDetectedFeature(const Mesh& mesh);
/// Whether h is that half-edge of a feature that stands for it, and nobody asked for the feature (kRequestedFeature).
bool isDetectedFeature(const Mesh& mesh, Index h);
/// One half-edge of each feature that nobody asked for (without kRequestedFeature) and that comes closer than `radius`
/// to one of the points. Throws InvalidInput when radius is not positive.
std::vector<Index> detectedFeaturesNear(
  const Mesh& mesh, const std::vector<Vector3>& points, double radius);

/// Whether h is that half-edge of a feature that stands for it, and the feature may be given up though it was asked for
/// (kYieldingFeature).
bool isYieldingFeature(const Mesh& mesh, Index h);
/// One half-edge of each of these that comes closer than `radius` to one of the points. Throws InvalidInput when radius
/// is not positive.
std::vector<Index> yieldingFeaturesNear(
  const Mesh& mesh, const std::vector<Vector3>& points, double radius);

/// These half-edges and their twins become features that were asked for and yield. They must not be on the boundary.
void markYielding(Mesh& mesh, const std::vector<Index>& halfEdges);

/// A length of features as messages tell it, to two or three digits.
std::string inEdgeLengths(double length);

/// These half-edges and their twins are no features any more.
void unmarkFeatures(Mesh& mesh, const std::vector<Index>& halfEdges);

} // namespace quadrille

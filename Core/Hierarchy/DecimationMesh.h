// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The mesh that decimation works on: the arrays of the finest mesh, changed in place. Slots never move
/// (see DecimationLog.h); a dead face has kInvalidIndex at its first corner.
#pragma once

#include "Hierarchy/FeatureCurves.h"
#include "Hierarchy/Hierarchy.h"
#include "Hierarchy/LogRecords.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

class DecimationMesh
{
public:
  /// Copies the connectivity and shares the positions.
  DecimationMesh(const Mesh& fine, FeatureCurves featureCurves, int threads = 1);

  const SharedArray<Vector3> position;
  const SharedArray<float> sizing; ///< see Mesh
  std::vector<Index> origin;
  std::vector<Index> twin;
  std::vector<std::uint8_t> flags;
  /// A half-edge that leaves the vertex, the boundary half-edge for a boundary vertex; kInvalidIndex for a
  /// removed vertex.
  std::vector<Index> outgoing;
  std::vector<std::uint16_t> valence; ///< number of neighbours
  FeatureCurves curves;
  /// Largest distance by which the curve edges at a vertex already deviate from the input's curve.
  std::vector<float> curveError;

  /// Wanted size at a vertex as a multiple of s.
  double sizeOf(Index v) const { return sizing.empty() ? 1.0 : double{ sizing[v] }; }

  Index faceCount() const { return static_cast<Index>(origin.size() / 3); }
  bool isAlive(Index face) const { return origin[3 * face] != kInvalidIndex; }
  Index target(Index h) const { return origin[Mesh::next(h)]; }
  bool isBoundary(Index h) const { return twin[h] == kInvalidIndex; }
  bool isConstrained(Index h) const { return isBoundary(h) || (flags[h] & kFeatureEdge) != 0; }
  bool hasEdge(Index a, Index b) const;
  /// The same, looking round the one with fewer neighbours.
  bool areJoined(Index a, Index b) const
  {
    return valence[a] < valence[b] ? hasEdge(a, b) : hasEdge(b, a);
  }
  /// The one neighbour of `v` other than `from` along constrained edges; none at ends and junctions.
  Index nextOnCurve(Index v, Index from) const;

  /// Carries out the collapse of a record whose vertex sits in its slots.
  void collapse(const CollapseRecord& record);
  /// Flips the edge of h as drawn in DecimationLog.h.
  void flip(Index h);
  /// Makes `outgoing` right again for the corners of a face whose connectivity changed.
  void refreshOutgoing(Index face);

  /// The mesh of what is alive, in the order of the finest mesh.
  Level extract() const;

private:
  void countNeighbours(const Mesh& fine);
  void link(Index h, Index g, std::uint8_t flag);
};

} // namespace quadrille

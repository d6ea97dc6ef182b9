// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Connectivity of a quad mesh: twins, valences, and whether it is a manifold.
#pragma once

#include "Quads/QuadMesh.h"

#include <array>
#include <string>
#include <vector>

namespace quadrille
{

/// What is counted part by part.
struct QuadCounts
{
  std::size_t edges = 0;
  std::size_t boundaryEdges = 0;
  std::size_t nonManifoldEdges =
    0; ///< half-edges that appear twice: more than two quads or opposed orientation
  std::size_t nonManifoldVertices = 0; ///< more than one fan of quads
  std::size_t degenerateQuads = 0;     ///< a point twice in one quad
  std::size_t isolatedPoints = 0;
  std::vector<Index> defectPoints; ///< points where something is wrong, some more than once

  void add(const QuadCounts& other);
};

/// Half-edge 4q+i runs from corner i to corner (i+1)%4 of quad q.
struct QuadTopology : QuadCounts
{
  std::vector<Index> twin;  ///< per half-edge; kInvalidIndex on the boundary and where it is not
                            ///< unique
  std::vector<int> valence; ///< per point: number of edges
  std::vector<std::uint8_t> onBoundary; ///< per point

  std::size_t components = 0;
  std::size_t boundaryLoops = 0; ///< only meaningful for a manifold
  long long eulerCharacteristic = 0;

  bool manifold() const
  {
    return nonManifoldEdges == 0 && nonManifoldVertices == 0 && degenerateQuads == 0 &&
      isolatedPoints == 0;
  }
  bool closed() const { return boundaryEdges == 0; }
  /// "2 non-manifold edges, 1 vertex ..."; empty for a manifold.
  std::string text() const;
};

/// The half-edges of each boundary loop in order, quads on the left. At a vertex with several fans
/// a loop stays with its fan.
std::vector<std::vector<Index>> boundaryLoops(const QuadTopology& topology);

/// Linear in quads, parallel; the same for any number of threads. Throws InvalidInput for a corner beyond pointCount.
QuadTopology analyzeQuads(
  const std::vector<std::array<Index, 4>>& quads, std::size_t pointCount, int threads = 1);

/// Sets the valences of the mesh, and what lies on its boundary, by its quads.
void setValences(QuadMesh& mesh);

/// The same for the quads and the polygons together: half-edges of quads come first, then those of polygons, corner
/// after corner.
QuadTopology analyzeCells(const QuadMesh& mesh);

/// Whether a line is an edge of a quad or polygon, per line.
std::vector<std::uint8_t> linesOnEdges(const QuadMesh& mesh);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The maps that follow a field, as a linear space: seam and alignment equations are solved exactly, what is left
/// are free unknowns.
#pragma once

#include "Base/FixedPoint.h"
#include "CrossField/CrossField.h"
#include "GridMap/CutGraph.h"
#include "GridMap/MapShape.h"
#include "Mesh/Mesh.h"
#include "Numerics/ExactElimination.h"
#include "Numerics/Untangler.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// The seamless maps of a field as functions of free unknowns y. Variables of the equations, and rows of basis():
/// u and v of every wedge (2w, 2w + 1), then both coordinates of the translation of every segment s
/// (2 (#wedges + s), and one more); wedges, segments and their charts are those of graph().
class SeamlessSpace
{
public:
  /// edgeLength: length on the surface that one uv unit stands for, > 0. Mesh and field must outlive the space.
  /// One corner of each component lies at the origin: the first one of the vertices of highest rank (#V; empty: all
  /// alike). Throws InvalidInput when the field contradicts itself.
  SeamlessSpace(const Mesh& mesh, const CrossField& field, double edgeLength,
    const std::vector<std::uint8_t>& rank = {});

  /// False where the equations need more than 63 bits; nothing else may be asked then.
  bool solved() const { return !basis_.rows.empty(); }
  const CutGraph& graph() const { return graph_; }
  /// Every variable from the free unknowns, exactly.
  const ExactBasis& basis() const { return basis_; }
  /// Points are wedges, unknowns are y; triangles are the faces, then a guard for each constrained edge.
  const UntangleProblem& problem() const { return problem_; }
  /// Signed area of the map, in quads.
  double area(const Eigen::VectorXd& y) const;
  /// #H: the map with the unknowns rounded to multiples of their steps; all else then follows in integers.
  std::vector<FixedVec2> snap(const Eigen::VectorXd& y) const;
  /// Those of `candidates` (faces) whose determinant is zero for every choice of the unknowns: two edges, or both
  /// coordinates, are proportional.
  std::vector<Index> collapsedFaces(const std::vector<Index>& candidates) const;
  /// The unconstrained half-edges between constrained vertices that lie on an isoline for every choice of the
  /// unknowns: mostly chords of a straight feature, with no area left between the two.
  std::vector<Index> flattenedChords() const;

private:
  void buildProblem(const CrossField& field, double edgeLength);

  const Mesh& mesh_;
  CutGraph graph_;
  ExactBasis basis_;
  UntangleProblem problem_;
};

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The maps that share the integers of a given one: its transitions, its integer vertices and isolines are
/// locked, everything else is free. No elimination is needed, because all images of a vertex follow
/// from one of them by whole transitions.
#pragma once

#include "Base/FixedPoint.h"
#include "CrossField/CrossField.h"
#include "GridMap/MapCheck.h"
#include "Mesh/Mesh.h"
#include "Numerics/Untangler.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

class LockedMap
{
public:
  /// Throws InvalidInput, naming the element, when transitions are not whole or not those of the field,
  /// when constrained edges do not lie on integer isolines, or integer vertices not at whole points.
  LockedMap(const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& uv);

  /// Points of the problem are corners; references are in units of edgeLength.
  UntangleProblem problem(double edgeLength) const;
  /// The unknowns of the map that was given.
  Eigen::VectorXd start() const;
  /// The map with these unknowns, rounded to the grid; all else follows in integers.
  std::vector<FixedVec2> snap(const Eigen::VectorXd& y) const;
  /// What the integers alone already get wrong: faces whose three corners are locked and that are not
  /// positive, and half-edges that begin a chain of constrained ones from integer vertex to
  /// integer vertex whose end does not lie ahead of its beginning.
  MapDefects hopeless() const;

private:
  void checkTransitions() const;
  void checkIsolines() const;
  void placeCorners(Index v, Index start);
  void lockIntegers();
  void lockIsolines();
  void numberUnknowns();
  std::int64_t chainLength(Index h) const;
  bool isLocked(Index v) const { return lockedU_[v] && lockedV_[v]; }

  const Mesh& mesh_;
  const CrossField& field_;
  const std::vector<FixedVec2>& uv_;
  std::vector<Transition> place_; ///< #H: image of the corner from the master image of its vertex
  std::vector<FixedVec2> master_; ///< #V: the given map at the master corner
  std::vector<std::uint8_t> lockedU_, lockedV_; ///< #V, in the chart of the master corner
  std::vector<Index> unknownU_, unknownV_;      ///< #V, kInvalidIndex where locked
  Index unknowns_ = 0;
};

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// All constraints of a session, put on its surface.
#pragma once

#include "Prepare/ConstraintPlacement.h"
#include "Session/Constraints.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace quadrille
{

using SessionConstraints = std::vector<std::shared_ptr<const SessionConstraint>>;

/// What became of one constraint.
struct PlacedPart
{
  std::string whyNot;              ///< empty, or why it is left out
  Vector3 place = Vector3::Zero(); ///< on the surface
  std::vector<Vector3> path;       ///< of lines: the course on the surface
  std::string remark;              ///< of that, see PlacedConstraint
  std::vector<GuidedPlace> guided;
  std::optional<std::size_t> curve; ///< of connections and cycles: in the input's curves
  /// Of an irregular operation: places and their valences, but for those that a later operation has changed again.
  std::vector<std::pair<Vector3, int>> valences;
};

struct ComposedInput
{
  SurfaceInput input; ///< all but points and polygons, which are the surface's
  /// The constraint that asks for a symmetry, its place in `parts`; none: the quads have not to be symmetric.
  std::optional<std::size_t> symmetry;
  std::vector<PlacedPart> parts; ///< in the order of the constraints
  /// Irregular vertices that operations and valences lead to, in the order of places, and the last operation in force,
  /// its id.
  std::vector<IrregularVertex> irregular;
  int lastOperation = 0; ///< 0: none
  /// Irregular points of the quads that these lead to; none: not known.
  std::optional<std::vector<IrregularVertex>> shown;
  /// Why vertices on features and boundaries could not be left as they are all; empty: they were, or are free.
  std::string whyNotHeld;
  std::vector<std::string> notices; ///< what the user should know
};

/// To put constraints on a surface.
struct PlacesOfSession
{
  const SurfacePlaces& places;
  const SurfacePaths& paths;
  double sameWithin = 0; ///< places that are no farther apart are one
};

/// Where drawn lines lie on the surface, which depends on nothing else.
class LinePlacements
{
public:
  struct Placed
  {
    PlacedConstraint line;
    std::vector<std::string> notices;
    DrawnRequests requests;
    std::vector<CurveRequest> curves;
  };

  /// Of a feature, a stroke, a connection or a cycle.
  const Placed& of(const std::shared_ptr<const SessionConstraint>& constraint,
    const SurfaceInput& surface, const PlacesOfSession& where);

private:
  std::map<std::shared_ptr<const SessionConstraint>, Placed> known_;
};

/// leftOut: ids of constraints that are not put on, and why. Constraints that contradict an earlier one, or the
/// surface, are left out as well. holdFeatures: whether irregular operations leave features and boundaries as they
/// were.
ComposedInput composeInput(const SurfaceInput& surface, const PlacesOfSession& where,
  LinePlacements& lines, const SessionConstraints& constraints,
  const std::map<int, std::string>& leftOut, bool holdFeatures);

} // namespace quadrille

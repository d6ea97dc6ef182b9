// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// All constraints of a session, put on its surface.
#pragma once

#include "Requests/DrawnConstraints.h"
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
  std::vector<Vector3> path;       ///< of a feature
  std::vector<GuidedPolygon> guided;
  std::vector<Index> points;        ///< of the input, whose size it asks for
  std::optional<std::size_t> curve; ///< of connections and cycles: in the input's curves
  /// Of an irregular operation: points and their valences, but for those that a later operation has changed again.
  std::vector<std::pair<Index, int>> valences;
  /// Elements (polygons, points) on which later constraints count in its place, by the id of one of these.
  std::size_t overruled = 0;
  int overruledBy = 0;
};

struct ComposedInput
{
  SurfaceInput input; ///< all but points and polygons, which are the surface's
  /// The constraint that asks for a symmetry, its place in `parts`; none: the quads have not to be symmetric.
  std::optional<std::size_t> symmetry;
  std::vector<PlacedPart> parts; ///< in the order of the constraints
  /// Irregular vertices that operations and valences lead to, ascending by point, and the last operation in force, its
  /// id.
  std::vector<IrregularVertex> irregular;
  int lastOperation = 0; ///< 0: none
  /// Vertices on features and boundaries that these should leave as they are all, and why that was not possible. None
  /// where features are free.
  std::optional<std::vector<HeldVertex>> onFeatures;
  std::string whyNotHeld;
  std::vector<std::string> notices; ///< what the user should know
};

/// Where drawn lines lie on the surface, which depends on nothing else.
class LinePlacements
{
public:
  struct Placed
  {
    PlacedConstraint line;
    std::vector<std::string> notices;
    std::vector<GuideMark> guides;
    std::vector<FeatureMark> features;
  };

  /// Of a feature or a stroke.
  const Placed& of(const std::shared_ptr<const SessionConstraint>& constraint,
    const SurfaceInput& surface, const SurfacePlaces& places);

private:
  std::map<std::shared_ptr<const SessionConstraint>, Placed> known_;
};

/// leftOut: ids of constraints that are not put on, and why. Constraints that contradict an earlier one, or the
/// surface, are left out as well. holdFeatures: whether irregular operations leave features and boundaries as they
/// were.
ComposedInput composeInput(const SurfaceInput& surface, const SurfacePlaces& places,
  LinePlacements& lines, const SessionConstraints& constraints,
  const std::map<int, std::string>& leftOut, bool holdFeatures);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a user draws beside the surface: feature curves, guiding strokes, connections, cycles, and points with
/// valences, with sizes, or whose features are to be none; and where it lies on the surface, see ConstraintPlacement.
#pragma once

#include "Mesh/Requests.h"
#include "Requests/GuidedPlaces.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

enum class ConstraintKind
{
  Feature = 0,
  Stroke = 1,
  Valence = 2, ///< 3 in outputs where it is not met; connections and cycles the same
  Connection = 4,
  Cycle = 6,
  Move =
    8, ///< of an irregular vertex, see Session/IrregularEdits.h; its path leads from the old place to the new one
  Cleared = 12, ///< a feature that is to be none; 10 is the mirror plane
  Size = 14     ///< of quads within a radius of a place
};

/// What arrays and messages call it.
const char* nameOf(ConstraintKind kind);

/// That the quads with moves have irregular vertices otherwise than those without, where no move asks for it.
struct OtherChange
{
  Vector3 place = Vector3::Zero(); ///< one of those
  std::string text;                ///< of all, the end of a sentence
};

/// Where a constraint lies on the surface.
struct PlacedConstraint
{
  ConstraintKind kind = ConstraintKind::Feature;
  std::int64_t source = 0;    ///< line, or point, of its input; of a session the constraint's id
  std::vector<Vector3> given; ///< the points as they were drawn
  /// Its course on the surface; of one point for a valence, and for what is not followed.
  std::vector<Vector3> path;
  double distance =
    0; ///< of the farthest given point to its place on the surface, in units of the input
  double weight = 0; ///< of strokes
  double radius = 0; ///< the same, and of sizes
  double factor = 1; ///< of sizes, see SizeRequest
  int valence = 0;   ///< asked for; of a move that of its vertex
  std::vector<GuidedPlace>
    guided;              ///< of strokes: some of the places where they ask for a direction
  std::size_t curve = 0; ///< of connections and cycles: its place in SurfaceInput::curves
  std::string whyNot;    ///< empty, or why it is not followed; its path is then a point
  std::string remark; ///< of a feature or stroke, where it is not followed all along; mostly empty
  /// Of moves: the irregular vertices that the quads are to have with all moves, on features and boundaries too, where
  /// the quads without them show the others; null: not known.
  std::shared_ptr<const std::vector<ValencePlace>> irregular;
  std::optional<OtherChange> otherChange; ///< of the last move that is done; none: there is none
};

struct PlacedConstraints
{
  std::vector<PlacedConstraint> placed;
  std::vector<std::string> notices; ///< what the user should know
};

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Whether operations on irregular vertices have left all others where they were.
#pragma once

#include "Evaluation/ConstraintMeasures.h"
#include "Mesh/NearestTriangle.h"
#include "Quads/QuadMesh.h"
#include "Session/ComposedInput.h"
#include "Session/Constraints.h"

#include <optional>
#include <string>
#include <vector>

namespace quadrille
{

/// Faces whose quads fill them without a map: no operation says what they are, and their boundaries are shared.
class FacesWithoutMap
{
public:
  /// edgeLength: of the quads.
  FacesWithoutMap(const FixedPlaces& fixed, double edgeLength);
  bool has(const Vector3& place) const;

private:
  std::optional<NearestTriangle> triangles_; ///< none: there are none
  double within_ = 0;                        ///< so near places lie on these
};

/// What is judged elsewhere, so that irregular points there are no changes of others.
struct JudgedElsewhere
{
  std::vector<Vector3> told; ///< places of vertices with a word of their own
  std::vector<Vector3>
    failed; ///< of them those that are not as asked: what is there instead is in that word
  /// Lines that came after the operations: these have ends, and corners with features.
  std::vector<Vector3> drawn;
};

/// told and failed of what operations have changed. parts: of the constraints; irregular: all that the quads are to
/// have, see ConstraintMeasures::changedValence.
JudgedElsewhere judgedOf(const std::vector<PlacedPart>& parts, ConstraintMeasures& measures,
  const std::vector<ValencePlace>* irregular);

/// Places where irregular points of the quads came, went or moved, by more than two edge lengths there, though no
/// constraint asks for it. expected: all that the operations lead to, on features and boundaries too. measures: of the
/// quads.
std::vector<Vector3> otherChanges(const std::vector<IrregularVertex>& expected,
  const QuadMesh& quads, ConstraintMeasures& measures, const JudgedElsewhere& judged,
  const FacesWithoutMap& withoutMap);

/// What the word on the last operation says of these, at least one. whyNotHeld: see ComposedInput.
std::string otherChangesText(const std::vector<Vector3>& places, const std::string& whyNotHeld);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Untangling until a map winds like its field everywhere; shared by the seamless map and the re-embedding.
#pragma once

#include "GridMap/MapCheck.h"
#include "Numerics/Untangler.h"

#include <functional>
#include <utility>
#include <vector>

namespace quadrille
{

/// The options of all maps that follow a field.
UntangleOptions fieldUntangleOptions(const ProgressCallback& progress);

/// Thrown in place of WorkSpent: where the map had not become one by then.
class SpentInFaces : public WorkSpent
{
public:
  explicit SpentInFaces(FailedFaces left) : faces(std::move(left)) {}
  FailedFaces faces;
};

/// Rounds unknowns to a map, #H.
using Snap = std::function<std::vector<FixedVec2>(const Eigen::VectorXd&)>;

struct FieldUntangling
{
  std::vector<FixedVec2> uv; ///< of the attempt with the fewest defects
  Eigen::VectorXd y;         ///< its unknowns
  MapDefects defects;
  int newtonSteps = 0;
};

/// From the start. Seams fix the winding of a vertex modulo 4 only, so a start that is inverted there may end with a
/// wrong one: then the references are fitted again near it, with more weight round it [stiffening of Bommes et al.
/// 2009] and all else held, until it winds rightly from the start. The first triangles of the problem are the faces.
/// Throws SpentInFaces where a bound of work is reached.
FieldUntangling untangleAlongField(const Mesh& mesh, const CrossField& field,
  const UntangleProblem& problem, const Eigen::VectorXd& start, const Snap& snap,
  const ProgressCallback& progress);

/// Newton steps from a map without defects that bring the isolines along the guides of the field, and the ratio of the
/// two stretches of the faces towards `limit`, >= 1 or 0 for none; `untangling` changes only where the new map has no
/// defects either. The first triangles of the problem are the faces. Without guides and limit nothing is done.
void followRequests(const Mesh& mesh, const CrossField& field, const UntangleProblem& problem,
  double limit, const Snap& snap, const ProgressCallback& progress, FieldUntangling& untangling);

} // namespace quadrille

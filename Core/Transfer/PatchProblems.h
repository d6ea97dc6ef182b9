// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the untangler gets of a patch.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"
#include "Numerics/Untangler.h"
#include "Transfer/MendedPatch.h"

#include <vector>

namespace quadrille
{

/// Of a patch with its fans, and of the map as it is whenever something is asked for.
class PatchProblems
{
public:
  PatchProblems(const Mesh& mesh, const std::vector<FixedVec2>& uv, const MendedPatch& patch)
    : mesh_(mesh), uv_(uv), patch_(patch)
  {
  }

  /// Towards the shapes of the surface. rotations: per face, where these are turned as the map round the patch asks.
  UntangleProblem make(const std::vector<double>& rotations = {}) const;

  /// Per face, one over its squared distance from the nearest vertex inside the patch that stays, in patch sizes.
  std::vector<double> nearnessToFixed() const;
  /// Edges of curves between vertices that may slide past each other otherwise.
  void guardCurves(const std::vector<double>& rotations, const std::vector<double>& nearness,
    UntangleProblem& problem) const;

private:
  /// Of the map over the surface.
  double referenceScale() const;
  Eigen::Matrix2d inverseReference(Index f, double scale) const;

  const Mesh& mesh_;
  const std::vector<FixedVec2>& uv_;
  const MendedPatch& patch_;
};

} // namespace quadrille

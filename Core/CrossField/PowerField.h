// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The smooth field before integers: hard constraints, the complex fourth-power field
/// [Knoeppel et al. 2013], diffuse-and-normalize steps [Viertel and Osting 2019], and the angles
/// for fixed matchings [Bommes et al. 2009, the real part].
#pragma once

#include "Base/Progress.h"
#include "CrossField/FieldTopology.h"
#include "Requests/Guides.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// Faces at constrained edges. A face with one constrained edge follows it; with two, the frame stands
/// symmetrically in the corner between them, which maps to one quarter turn whatever its angle is.
struct FieldConstraints
{
  std::vector<std::uint8_t> fixed;    ///< #F flags
  std::vector<double> angle;          ///< #F, the field's angle where fixed
  std::vector<std::int8_t> alignment; ///< #H, as CrossField::alignment

  /// Guides, which the field follows as far as smoothness lets it. Empty when there are none.
  std::vector<double> guideAngle;    ///< #F
  std::vector<double> guideStrength; ///< #F; against the edge weights; 0 where free or fixed

  double strength(Index f) const { return guideStrength.empty() ? 0.0 : guideStrength[f]; }
};
FieldConstraints fieldConstraints(const Mesh& mesh, const FieldTopology& topology);

/// Adds guides (#F). One of weight 1 yields to the field round it within about a quarter of `length` (s > 0), one of
/// weight w within 1 / sqrt(w) of that. Throws InvalidInput for a wrong size.
void addGuides(const Mesh& mesh, const FieldTopology& topology, const std::vector<Guide>& guides,
  double length, FieldConstraints& constraints);

struct PowerFieldOptions
{
  double smoothingLength = 0; ///< s > 0: pairs of opposite singularities closer than this vanish
  ProgressCallback progress;
};

/// Smooth fields to choose from. Where constraints reach they are all the same; a component without
/// constraints has a first one along its principal directions and a second one that is the smoothest. Neither
/// is better always: a fat torus is regular only in the first one, a sphere has pairs too many in it. Where such a
/// component has guides, the first one spreads out from them, the others follow them near by.
struct PowerFields
{
  std::vector<std::vector<double>> candidates; ///< each #F angles; one to three
  std::vector<Index>
    looseComponent; ///< #F; id of the component without constraints or kInvalidIndex
  Index looseComponents = 0;
};
PowerFields powerFields(const Mesh& mesh, const FieldTopology& topology,
  const FieldConstraints& constraints, const PowerFieldOptions& options);

/// Residual of half-edge h in radians: how far the field rotates across it beyond its period jump.
double edgeResidual(const FieldTopology& topology, const std::vector<double>& angle,
  const Mesh& mesh, Index h, int jump);

/// Angles that minimize the weighted squared residuals for the period jumps `jump` (#H, antisymmetric), fixed faces
/// at their constraint, guided faces drawn to the nearest of the four directions of their guide. One face of each
/// component without constraints and guides keeps its angle.
std::vector<double> solveAngles(const Mesh& mesh, const FieldTopology& topology,
  const FieldConstraints& constraints, const std::vector<int>& jump,
  const std::vector<double>& start);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The smooth field before integers: hard constraints, the complex fourth-power field
/// [Knoeppel et al. 2013], diffuse-and-normalize steps [Viertel and Osting 2019], and the angles
/// for fixed matchings [Bommes et al. 2009, the real part].
#pragma once

#include "Base/Progress.h"
#include "CrossField/FieldTopology.h"

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
};
FieldConstraints fieldConstraints(const Mesh& mesh, const FieldTopology& topology);

struct PowerFieldOptions
{
  double smoothingLength = 0; ///< s > 0: pairs of opposite singularities closer than this vanish
  ProgressCallback progress;
};

/// Smooth fields to choose from. Where constraints reach they are all the same; a component without
/// constraints has a first one along its principal directions and a second one that is the smoothest. Neither
/// is better always: a fat torus is regular only in the first one, a sphere has pairs too many in it.
struct PowerFields
{
  std::vector<std::vector<double>> candidates; ///< each #F angles; one or two
  std::vector<Index>
    looseComponent; ///< #F; id of the component without constraints or kInvalidIndex
  Index looseComponents = 0;
};
PowerFields powerFields(const Mesh& mesh, const FieldTopology& topology,
  const FieldConstraints& constraints, const PowerFieldOptions& options);

/// Residual of half-edge h in radians: how far the field turns across it beyond `jump` quarter turns.
double edgeResidual(const FieldTopology& topology, const std::vector<double>& angle,
  const Mesh& mesh, Index h, int jump);

/// Angles that minimize the weighted squared residuals for the quarter turns `jump` (#H, antisymmetric), fixed faces
/// at their constraint. One face of each component without constraints keeps its angle.
std::vector<double> solveAngles(const Mesh& mesh, const FieldTopology& topology,
  const FieldConstraints& constraints, const std::vector<int>& jump,
  const std::vector<double>& start);

} // namespace quadrille

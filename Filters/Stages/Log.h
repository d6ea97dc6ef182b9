// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The decimation log as a data object, with what is needed to prepare its surface again.
#pragma once

#include "Convert/PolyData.h"
#include "Hierarchy/DecimationLog.h"
#include "Pipeline/Options.h"

#include <optional>
#include <string>
#include <vector>

class vtkDataObject;

namespace quadrille
{

/// How the finest level was made from the user's surface; the same recipe gives the same bytes.
struct SurfaceRecipe
{
  std::optional<double> featureAngle; ///< radians
  FeatureCriterion featureCriterion = FeatureCriterion::Creases;
  /// For the filter of features and the refinement; in the log in units of the user, where it is used in those of the
  /// surface's frame.
  double edgeLength = 0;
  std::string patchArray;
  /// What was drawn that changes the triangles, in units of the user. Strokes are guides of the levels.
  DrawnRequests drawn;
};

/// Field arrays DecimationLog, SurfaceHash, and the recipe.
void writeLog(const DecimationLog& log, const SurfaceRecipe& recipe, vtkDataObject* data);

/// Throws InvalidInput when the object is no log or is incomplete.
SurfaceRecipe readRecipe(vtkDataObject* data);
/// Throws InvalidInput when the bytes are damaged or belong to another surface.
DecimationLog readLog(vtkDataObject* data, std::uint64_t expectedHash);

} // namespace quadrille

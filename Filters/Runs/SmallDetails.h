// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Small details of a surface as VTK data.
#pragma once

#include "Features/GivenUpFeatures.h"
#include "Pipeline/SmallDetails.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkDataObject;
class vtkPolyData;

namespace quadrille
{

/// A vertex for each, in their order, with the point arrays Kind, Size, Decision, Result, and DecisionId (a
/// DetailDecision) to colour by; behind the details the sharp edges that quads do not follow, curve by curve, as the
/// kind "feature", with their length over s. See vtkQuadRemesh.
vtkSmartPointer<vtkPolyData> writeSmallDetails(
  const std::vector<SmallDetail>& details, const std::vector<GivenUpCurve>& features);

} // namespace quadrille

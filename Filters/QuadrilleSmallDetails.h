// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Small details of a surface as VTK data.
#pragma once

#include "Pipeline/SmallDetails.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkDataObject;
class vtkPolyData;

namespace quadrille
{

/// A vertex for each, in their order, with the point arrays Kind, Size, Decision, Result, and DecisionId (a
/// DetailDecision) to colour by. See vtkQuadRemesh.
vtkSmartPointer<vtkPolyData> writeSmallDetails(const std::vector<SmallDetail>& details);

/// Field data: Attempts, and RecoveryNames with RecoveryCounts, how often each strategy made one of them. attempts: see
/// RemeshResult.
void addAttempts(vtkDataObject* data, const std::vector<std::string>& attempts);

} // namespace quadrille

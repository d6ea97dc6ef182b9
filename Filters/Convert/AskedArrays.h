// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a user asks for in arrays of numbers on points and cells: guides, sizes.
#pragma once

#include "Base/Types.h"

#include <vtkType.h>

#include <vector>

class vtkDataArray;
class vtkPolyData;

namespace quadrille
{

/// Direction and weight of single cells; nothing where there are no directions.
class GuideArrays
{
public:
  explicit GuideArrays(vtkPolyData* data);
  bool empty() const { return !directions_; }
  bool hasWeights() const { return weights_ != nullptr; }

  Vector3 direction(vtkIdType cell) const;
  /// Of a cell with a direction.
  double weight(vtkIdType cell) const;

private:
  vtkDataArray* directions_;
  vtkDataArray* weights_;
};

/// Sizing, #points, or empty where the array is missing.
std::vector<float> pointSizes(vtkPolyData* data);

} // namespace quadrille

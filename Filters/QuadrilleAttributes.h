// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Carries point and cell arrays from a surface to what was made from it.
#pragma once

#include <vtkType.h>

#include <array>
#include <functional>

class vtkDataSetAttributes;

namespace quadrille
{

/// A point of the result as a barycentric combination of three points of the source.
struct PointOrigin
{
  std::array<vtkIdType, 3> ids{};
  std::array<double, 3> weights{}; ///< sum 1
};

/// Carries every array that is not one of Quadrille's own: real numbers and colours are interpolated,
/// whole numbers (ids, labels) and strings are taken from the point with the largest weight.
/// Normals keep unit length.
void carryPointArrays(vtkDataSetAttributes* source, vtkDataSetAttributes* target, vtkIdType count,
  const std::function<PointOrigin(vtkIdType)>& origin);

/// Carries every array that is not one of Quadrille's own from cell origin(i) to cell i.
void carryCellArrays(vtkDataSetAttributes* source, vtkDataSetAttributes* target, vtkIdType count,
  const std::function<vtkIdType(vtkIdType)>& origin);

} // namespace quadrille

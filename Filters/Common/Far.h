// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where single precision is not enough.
#pragma once

#include <vtkDataSet.h>

#include <algorithm>
#include <cmath>

namespace quadrille
{

/// Far from the origin single precision has lost what tells points apart: where a coordinate is above four sides of the
/// box.
inline bool isFar(vtkDataSet* mesh)
{
  constexpr double kFarSides = 4;
  double box[6];
  mesh->GetBounds(box);
  double side = 0;
  double largest = 0;
  for (int k = 0; k < 3; ++k)
  {
    side = std::max(side, box[2 * k + 1] - box[2 * k]);
    largest = std::max({ largest, std::abs(box[2 * k]), std::abs(box[2 * k + 1]) });
  }
  return largest > kFarSides * side;
}

} // namespace quadrille

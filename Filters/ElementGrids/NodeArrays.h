// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Point arrays of elements of second order: of the quads at their corners, of the surface at the new nodes.
#pragma once

#include "Base/Types.h"
#include "Elements/SecondOrder.h"

#include <array>
#include <vector>

class vtkPointData;
class vtkPolyData;

namespace quadrille
{

struct ElementSurface;

/// To `target`; see writeSecondOrder.
void addNodeArrays(vtkPolyData* quads, const std::vector<std::array<Index, 4>>& corners,
  const SecondOrderNodes& nodes, const ElementSurface& surface, int threads, vtkPointData* target);

} // namespace quadrille

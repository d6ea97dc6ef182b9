// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Between vtkPolyData and what Core/Repair takes and makes.
#pragma once

#include "Convert/PolyData.h"
#include "Repair/Soup.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkPolyData;

namespace quadrille
{

/// A surface as its triangles, and the way back to its cells.
struct ConvertedSoup
{
  ConvertedSurface surface; ///< without its input
  Soup soup;
};

/// Throws InvalidInput as convertSurface and soupOf do.
ConvertedSoup convertSoup(vtkPolyData* data, int threads);

/// Points in double precision and triangles.
vtkSmartPointer<vtkPolyData> writeTriangleList(const TriangleList& triangles);

/// All arrays of `source`, but Quadrille's own, on a surface near it: at points from the nearest place, at cells from
/// the cell nearest to the centre; and its field data. source: what `from` was converted from. Returns what could not
/// be carried, as text.
std::vector<std::string> carryFromNearest(
  vtkPolyData* source, const ConvertedSoup& from, vtkPolyData* target, int threads);

} // namespace quadrille

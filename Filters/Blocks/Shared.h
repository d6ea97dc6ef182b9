// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Curves and points that say something of all surfaces, and to which of several surfaces each belongs.
#pragma once

#include <vtkSmartPointer.h>

#include <cstddef>
#include <string>
#include <vector>

class vtkDataObject;
class vtkPolyData;

namespace quadrille
{

struct BlockRun;

/// The vtkPolyData among these as one, or null where there is no point. Arrays are joined as joinPieces does.
vtkSmartPointer<vtkPolyData> joinShared(
  const std::vector<vtkSmartPointer<vtkDataObject>>& pieces, std::vector<std::string>& notices);

/// What belongs to one surface as a whole: each line or polygon is an item, then each point that is in none of them.
std::size_t sharedItems(vtkPolyData* shared);

/// Distance of each item to the surface, the mean over its points; infinite where the surface has no cells.
std::vector<double> itemDistances(vtkPolyData* shared, vtkPolyData* surface);

/// The items with `isChosen`, with their arrays; null where there is none.
vtkSmartPointer<vtkPolyData> selectItems(vtkPolyData* shared, const std::vector<bool>& isChosen);

/// Gives each block of a run the items of the shared inputs that are nearest to it. Collective.
void shareOut(BlockRun& run);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The surface that a filter works on, from whatever data the user has.
#pragma once

#include "QuadrilleBlocks.h"

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkDataObject;
class vtkPolyData;

namespace quadrille
{

/// Whether there is anything to take a surface from: a data set with cells.
bool hasCells(vtkDataObject* data);

/// A vtkPolyData as it is; of any other data set the surface, with its arrays and vtkOriginalCellIds and vtkOriginalPointIds, which notices tell.
/// Throws InvalidInput for what is no data set.
vtkSmartPointer<vtkPolyData> surfaceOf(vtkDataObject* data, std::vector<std::string>& notices);

/// The one surface that pieces are parts of. One piece alone stays as it is.
vtkSmartPointer<vtkPolyData> joinSurface(
  const std::vector<vtkSmartPointer<vtkDataObject>>& pieces, std::vector<std::string>& notices);

/// The only piece that has anything in it, or null. Throws InvalidInput where there are several.
vtkSmartPointer<vtkDataObject> joinExact(
  const std::vector<vtkSmartPointer<vtkDataObject>>& pieces);

/// Everything in the tree's blocks as one vtkPolyData, or null where there is nothing.
vtkSmartPointer<vtkDataObject> joinShared(const BlockTree& tree);

} // namespace quadrille

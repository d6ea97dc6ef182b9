// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The surface that a filter works on, from whatever data the user has.
#pragma once

#include <vtkSmartPointer.h>

#include <cstddef>
#include <string>
#include <vector>

class vtkDataObject;
class vtkPolyData;

namespace quadrille
{

/// What was taken of pieces, and what was left; sums over all pieces of a block.
struct SurfaceCounts
{
  std::size_t volumeCells = 0; ///< cells that enclose a volume, whose surface was taken
  std::size_t ghostCells = 0;  ///< copies of cells of other pieces, left out

  std::vector<std::string> notices() const;
};

/// Number of cells; 0 for what is no data set.
std::size_t cellCount(vtkDataObject* data);

/// A vtkPolyData as it is; of any other data set the surface, with its arrays and vtkOriginalCellIds and
/// vtkOriginalPointIds. Ghost cells are left out. With markVolumeFaces faces of volume cells are marked for joinPieces.
/// Throws InvalidInput for what is no data set.
vtkSmartPointer<vtkPolyData> surfaceOf(
  vtkDataObject* data, bool markVolumeFaces, SurfaceCounts& counts);

/// The only piece that has anything in it, or null. Throws InvalidInput where there are several.
vtkSmartPointer<vtkDataObject> onlyPiece(const std::vector<vtkSmartPointer<vtkDataObject>>& pieces);

/// Sum of the areas of all polygons; 0 where a coordinate is not finite.
double areaOf(vtkPolyData* surface);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Thickness, direction of fibres, and vectors in the frames of elements.
#pragma once

#include "Base/Types.h"

#include <vtkType.h>

#include <string>
#include <vector>

class vtkUnstructuredGrid;

namespace quadrille
{

/// What becomes of an element whose direction is zero, or along its normal; the values of vtkQuadElements.
enum class AxisFallback
{
  None = 0, ///< an error
  X = 1,
  Y = 2,
  Z = 3,
  Element = 4 ///< from the middle of its edge 3 to that of edge 1
};

/// The frame of an element, at the centre of the quad of its corners. Rows: axis 1, axis 2 = axis 3 x axis 1, axis 3
/// the normal. NaN for an element without a normal.
using ElementFrame = Eigen::Matrix3d;

/// With axis 1 from the middle of the element's edge 3 to that of edge 1. threads: 0 for all.
std::vector<ElementFrame> elementFrames(vtkUnstructuredGrid* grid, int threads);

/// What the user should know, and where.
struct ElementNotice
{
  std::size_t count = 0; ///< of elements
  vtkIdType first = 0;   ///< of them
};

/// Adds the cell array Thickness: the cell array of the name as it is, or the mean of the point array over each
/// element. Returns the elements whose thickness is not positive. Throws InvalidInput for an array that is missing or
/// has more than one number.
ElementNotice addThickness(vtkUnstructuredGrid* grid, const std::string& name, int threads);

/// Turns axis 1 of the frames into the direction of the cell or point array of the name, projected into the element,
/// and adds the cell array ElementAxis. Of a point array the direction that the corners have in common counts, whatever
/// their signs are. Returns the elements that the fallback was taken for. Throws InvalidInput for an array that is
/// missing, has not three numbers, or is not finite, and for elements without a direction where the fallback has none
/// either.
ElementNotice addElementAxis(vtkUnstructuredGrid* grid, const std::string& name,
  AxisFallback fallback, std::vector<ElementFrame>& frames, int threads);

/// Adds the cell array <name>InElement: the components along axes 1, 2 and 3 of the cell array of the name, or of the
/// mean of the point array over each element. Throws InvalidInput as addElementAxis does.
void addVectorsInElement(vtkUnstructuredGrid* grid, const std::string& name,
  const std::vector<ElementFrame>& frames, int threads);

} // namespace quadrille

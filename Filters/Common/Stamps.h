// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Whether data is still the same, told without looking at it: VTK gives every change of every array a time of its own.
#pragma once

#include <utility>
#include <vector>

#include <vtkType.h>

class vtkDataObject;

namespace quadrille
{

/// Object and time of its last change.
using Stamp = std::pair<const void*, vtkMTimeType>;

/// Appends those of all points, cells and arrays, in order. Equal stamps mean equal contents, whatever the vtkPolyData
/// or vtkTable that holds them; any other data object counts as changed whenever it was touched.
void addStamps(vtkDataObject* data, std::vector<Stamp>& stamps);

} // namespace quadrille

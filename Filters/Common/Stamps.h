// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Whether data is still the same. Of surfaces that is told without a look at them: VTK gives every change of every
/// array a time of its own.
#pragma once

#include <utility>
#include <vector>

#include <vtkType.h>

class vtkDataObject;

namespace quadrille
{

/// Object and time of its last change, or null and a hash.
using Stamp = std::pair<const void*, vtkMTimeType>;

/// Appends those of all points, cells and arrays, in order. Equal stamps mean equal contents, whatever the vtkPolyData
/// or vtkTable that holds them; any other data object counts as changed whenever it was touched.
void addStamps(vtkDataObject* data, std::vector<Stamp>& stamps);
/// The same of data that is small enough to be looked at: equal contents have equal stamps, whatever arrays hold them,
/// as where an undo has made a source anew. Arrays that do not lie in memory in one piece have those above.
void addStampsOfContents(vtkDataObject* data, std::vector<Stamp>& stamps);

} // namespace quadrille

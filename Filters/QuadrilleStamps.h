// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Whether data is still the same, told without looking at it: VTK gives every change of every array a time of its own.
#pragma once

#include <utility>
#include <vector>

#include <vtkType.h>

class vtkInformationVector;

namespace quadrille
{

/// Object and time of its last change.
using Stamp = std::pair<const void*, vtkMTimeType>;

/// Of all points, cells and arrays of all inputs, in order. Equal stamps mean equal contents, whatever the data object that holds them.
std::vector<Stamp> stampsOf(vtkInformationVector** inputs, int ports);

} // namespace quadrille

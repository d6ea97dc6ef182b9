// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What Core has read from a file, as VTK data.
#pragma once

#include "Import/SurfaceFile.h"

#include <vtkSmartPointer.h>

class vtkPolyData;

namespace quadrille
{

/// Nothing is copied: the arrays take over the memory.
vtkSmartPointer<vtkPolyData> polyDataOf(SurfaceFile file);

} // namespace quadrille

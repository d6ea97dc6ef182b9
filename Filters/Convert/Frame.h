// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The frame of a surface (see Prepare/Frame.h) between the stage filters: their outputs lie on the user's surface, and
/// the arrays Frame (field: centre, unit, signs, reversed) and FramePosition (points) give back, to the last bit, what
/// the stage before has computed with.
#pragma once

#include "Prepare/Frame.h"

#include <vector>

class vtkPolyData;

namespace quadrille
{

namespace arrays
{
constexpr const char* kFrame = "Frame";
constexpr const char* kFramePosition = "FramePosition";
}

/// positions: in the frame, one a vertex of the mesh; points that were split at seams (SurfacePointId) share theirs.
void addFrame(vtkPolyData* data, const Frame& frame, const std::vector<Vector3>& positions);

/// A mesh as readMesh reads it from `data` goes into the frame of the arrays. Where there are none, or points have
/// moved since, into one of its own: round its box's centre, with the box's longest side as unit, nothing rounded and
/// nothing turned.
Frame enterFrame(vtkPolyData* data, Mesh& mesh);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A mesh as the user would hand it in.
#pragma once

#include "Mesh/Surface.h"

namespace quadrille::test
{

inline SurfaceInput toInput(const Mesh& mesh)
{
  SurfaceInput input;
  input.points = mesh.position;
  input.polygonPoints = mesh.origin;
  for (Index f = 0; f <= mesh.faceCount(); ++f)
  {
    input.polygonOffsets.push_back(3 * f);
  }
  return input;
}

} // namespace quadrille::test

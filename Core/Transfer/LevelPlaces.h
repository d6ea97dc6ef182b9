// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Places of vertices that come back to a patch, inside of the kernels of their stars.
#pragma once

#include "Transfer/LevelMesh.h"

#include <cstddef>

namespace quadrille
{

class LevelPlaces
{
public:
  /// scale: of the map over the surface.
  LevelPlaces(LevelMesh& mesh, double scale) : mesh_(mesh), scale_(scale) {}

  /// Of a vertex that is there again, and then of those round it. Not where rounding leaves its star no kernel.
  bool putBack(Index v);

  std::size_t work() const { return work_; } ///< triangles that were looked at

private:
  bool place(Index v);
  void relax(Index v, int steps);

  LevelMesh& mesh_;
  double scale_;
  std::size_t work_ = 0;
};

} // namespace quadrille

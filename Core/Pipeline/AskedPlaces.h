// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is asked of a surface, with the places of the vertices, to ask it of one that was made of it.
#pragma once

#include "Mesh/Surface.h"

#include <vector>

namespace quadrille
{

class AskedPlaces
{
public:
  AskedPlaces(const PreparedSurface& surface, int threads);

  /// Of the vertices at the same places of another surface; what has none there is dropped.
  void askOf(PreparedSurface& surface) const;

private:
  SurfaceRequests requests_;
  int threads_;
  std::vector<Vector3> valencePlaces_, sectorPlaces_;
};

} // namespace quadrille

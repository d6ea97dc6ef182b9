// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/PlacedQuads.h"

#include "Cad/Calls.h"

namespace quadrille
{

std::vector<CadPlace> placeQuads(const CadShape& shape, const TessellationOptions& tessellation,
  const CadQuads& quads, const PlacementOptions& options)
{
  const CadCalls& cad = cadCalls();
  const CadSurface surface = cad.tessellate(shape, tessellation);
  std::vector<CadPlace> places = cad.placeOnShape(shape, surface, quads.points, options);
  if (quads.isFirstOrder) // else nodes between the corners would have to follow
  {
    cad.takeVertices(shape, surface, quads.corners, places);
  }
  cad.keepQuads(quads.corners, quads.points, places);
  return places;
}

} // namespace quadrille

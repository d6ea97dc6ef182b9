// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/PlacedQuads.h"

#include "Cad/Calls.h"

namespace quadrille
{

PlacedQuads placeQuads(const CadShape& shape, const TessellationOptions& tessellation,
  const CadQuads& quads, const PlacementOptions& options)
{
  const CadCalls& cad = cadCalls();
  const CadSurface surface = cad.tessellate(shape, tessellation);
  PlacedQuads result;
  result.places = cad.placeOnShape(shape, surface, quads.points, options, quads.faces);
  if (quads.isFirstOrder) // else nodes between the corners would have to follow
  {
    const TakenVertices taken = cad.takeVertices(shape, surface, quads.corners, result.places);
    std::vector<Vector3> beside;
    std::vector<Index> faces;
    for (const Index node : taken.beside)
    {
      beside.push_back(result.places[node].point);
      faces.push_back(quads.faces.empty() ? kInvalidIndex : quads.faces[node]);
    }
    const std::vector<CadPlace> again = cad.placeOnShape(shape, surface, beside, options, faces);
    for (std::size_t i = 0; i < again.size(); ++i)
    {
      result.places[taken.beside[i]] = again[i];
    }
    result.verticesWithout = taken.without;
    for (const Index vertex : taken.without)
    {
      result.verticesWithoutAt.push_back(surface.points[surface.vertexPoints[vertex]]);
    }
  }
  cad.keepQuads(quads.corners, quads.points, result.places);
  return result;
}

} // namespace quadrille

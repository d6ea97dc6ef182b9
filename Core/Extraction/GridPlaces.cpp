// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/GridPlaces.h"

#include <cstdlib>

namespace quadrille
{
namespace
{

SurfacePoint placeOnEdge(const ExactMap& map, const GridVertex& vertex)
{
  const FixedVec2 e = map.edge(vertex.site);
  const FixedVec2 d = vertex.uv - map.at(vertex.site);
  const bool byU = std::abs(e.u) >= std::abs(e.v);
  const double t = byU ? static_cast<double>(d.u) / static_cast<double>(e.u)
                       : static_cast<double>(d.v) / static_cast<double>(e.v);
  return CurvePoint{ vertex.site, t }.onSurface();
}

} // namespace

std::array<double, 3> weightsInFace(const ExactMap& map, Index face, FixedVec2 uv)
{
  const Index h = 3 * face;
  const FixedVec2 a = map.at(h);
  const FixedVec2 b = map.at(h + 1);
  const FixedVec2 c = map.at(h + 2);
  const double whole = static_cast<double>(determinant(a, b, c));
  const double wa = static_cast<double>(determinant(uv, b, c)) / whole;
  const double wb = static_cast<double>(determinant(a, uv, c)) / whole;
  const double wc = static_cast<double>(determinant(a, b, uv)) / whole;
  return { wa, wb, wc };
}

SurfacePoint placeOf(const ExactMap& map, const GridVertex& vertex)
{
  SurfacePoint place{ vertex.face(), {} };
  switch (vertex.kind)
  {
    case Site::Face:
      place.weights = weightsInFace(map, vertex.site, vertex.uv);
      break;
    case Site::Edge:
      return placeOnEdge(map, vertex);
    default:
      place.weights[vertex.site % 3] = 1;
  }
  return place;
}

} // namespace quadrille

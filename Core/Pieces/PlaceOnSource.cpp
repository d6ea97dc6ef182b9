// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/PlaceOnSource.h"

#include "Base/Progress.h"

#include <algorithm>

namespace quadrille
{
std::optional<SurfacePoint> placeOnSource(const PreparedSurface& mapped, Index face,
  const std::array<double, 3>& weights, const SourceTriangles& source, const Vector3* point)
{
  const SourceLocation at = mapped.locate(face, weights);
  if (at.polygon >= source.corners.size() / 3)
  {
    return std::nullopt;
  }
  const Index* const corners = &source.corners[3 * std::size_t{ at.polygon }];
  SurfacePoint found;
  found.face = at.polygon;
  Vector3 place = Vector3::Zero();
  double sum = 0, size = 0;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const auto corner = std::find(at.points.begin(), at.points.end(), corners[k]);
    if (corner == at.points.end())
    {
      return std::nullopt;
    }
    double& weight = found.weights[k];
    weight = std::max(0.0, at.weights[static_cast<std::size_t>(corner - at.points.begin())]);
    sum += weight;
    place += weight * source.points[corners[k]];
    size = std::max(size, (source.points[corners[k]] - source.points[corners[0]]).norm());
  }
  // Or the point is off the place that its source names.
  if (!(sum > 0) ||
    (point != nullptr && !((place / sum - *point).norm() <= kRoundingOfSingle * size)))
  {
    return std::nullopt;
  }
  for (double& weight : found.weights)
  {
    weight /= sum;
  }
  return found;
}

PlacesOfQuads placesOfQuads(
  const PreparedSurface& mapped, const QuadMesh& quads, const SourceTriangles& source)
{
  PlacesOfQuads found;
  const auto add =
    [&](Index face, const std::array<double, 3>& weights, const Vector3* point, std::size_t who)
  {
    pollNowAndThen(who);
    if (const auto place = placeOnSource(mapped, face, weights, source, point))
    {
      found.places.push_back(*place);
      found.whose.push_back(who);
    }
  };
  const std::size_t points = quads.points.size();
  for (std::size_t p = 0; p < points; ++p)
  {
    add(quads.sourceFace[p], quads.sourceWeights[p], &quads.points[p], p);
  }
  for (std::size_t q = 0; q < quads.quads.size(); ++q)
  {
    // All zero where the quad is no unit square of the map, and its face is all that is known.
    constexpr std::array<double, 3> kMiddle{ 1.0 / 3, 1.0 / 3, 1.0 / 3 };
    const std::array<double, 3>& weights = quads.quadSourceWeights[q];
    const bool isKnown = weights[0] + weights[1] + weights[2] > 0;
    add(quads.quadSourceFace[q], isKnown ? weights : kMiddle, nullptr, points + q);
  }
  return found;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/QuadProjection.h"

#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Quads/QuadShape.h"

#include <cmath>

namespace quadrille
{

namespace
{

using QuadList = std::vector<std::array<Index, 4>>;

/// How far beyond a place the other side of a sheet lies at most, over the distance of a point before it. Walls with a
/// thickness of a quarter of that have two sides of their own.
constexpr double kSheet = 1.25;

enum class PointFate : std::uint8_t
{
  Moved,
  Far,
  Turned,
  TwoSided,
  Kept
};

Vector3 triangleNormal(const TriangleList& list, Index triangle)
{
  const std::array<Index, 3>& c = list.corners[triangle];
  return (list.points[c[1]] - list.points[c[0]])
    .cross(list.points[c[2]] - list.points[c[0]])
    .stableNormalized();
}

/// Where single points go, whatever becomes of the quads.
struct PointTargets
{
  const NearestTriangle& surface;
  const NearestTriangle& quads;
  double distance;
  double leastCosine;

  PointFate fateOf(const Vector3& p, const Vector3& normal, Vector3& target) const
  {
    const auto place = surface.at(p, Vector3::Zero(), distance);
    if (!place)
    {
      return PointFate::Far;
    }
    const Vector3 n = normal.stableNormalized();
    if (std::abs(n.dot(triangleNormal(surface.triangles(), place->triangle))) < leastCosine)
    {
      return PointFate::Turned;
    }
    // The other side of a sheet lies beyond the place, about as far as this point does before it.
    const double behind = kSheet * place->distance;
    if (behind > 0 && quads.at(place->point, -n, behind))
    {
      return PointFate::TwoSided;
    }
    target = place->point;
    return PointFate::Moved;
  }
};

/// Puts back the points of quads that became inverted, until there is none.
void keepQuadsConvex(const std::vector<Vector3>& before, const QuadList& quads,
  std::vector<Vector3>& points, std::vector<PointFate>& fates)
{
  std::vector<std::uint8_t> wasInverted(quads.size());
  for (std::size_t q = 0; q < quads.size(); ++q)
  {
    wasInverted[q] = isInverted(cornersOf(before, quads[q]));
  }
  for (bool isSettled = false; !isSettled;)
  {
    isSettled = true;
    std::vector<Index> back;
    for (std::size_t q = 0; q < quads.size(); ++q)
    {
      if (!wasInverted[q] && isInverted(cornersOf(points, quads[q])))
      {
        back.insert(back.end(), quads[q].begin(), quads[q].end());
      }
    }
    for (const Index p : back)
    {
      if (fates[p] == PointFate::Moved)
      {
        points[p] = before[p];
        fates[p] = PointFate::Kept;
        isSettled = false;
      }
    }
  }
}

QuadProjectionReport countFates(const std::vector<PointFate>& fates)
{
  QuadProjectionReport report;
  for (const PointFate fate : fates)
  {
    ++(fate == PointFate::Moved       ? report.moved
        : fate == PointFate::Far      ? report.far
        : fate == PointFate::Turned   ? report.turned
        : fate == PointFate::TwoSided ? report.twoSided
                                      : report.kept);
  }
  return report;
}

} // namespace

std::vector<Vector3> pointNormals(const std::vector<Vector3>& points, const QuadList& quads)
{
  std::vector<Vector3> normals(points.size(), Vector3::Zero());
  for (const std::array<Index, 4>& quad : quads)
  {
    const Vector3 normal = diagonalNormal(cornersOf(points, quad));
    for (const Index corner : quad)
    {
      normals[corner] += normal;
    }
  }
  return normals;
}

TriangleList halvesOf(const std::vector<Vector3>& points, const QuadList& quads)
{
  TriangleList halves;
  halves.points = points;
  for (const std::array<Index, 4>& quad : quads)
  {
    halves.corners.push_back({ quad[0], quad[1], quad[2] });
    halves.corners.push_back({ quad[0], quad[2], quad[3] });
  }
  return halves;
}

QuadProjectionReport projectQuads(std::vector<Vector3>& points, const QuadList& quads,
  const NearestTriangle& surface, const QuadProjectionOptions& options)
{
  refuseIf(!(options.distance > 0) || !std::isfinite(options.distance),
    "the distance within which points are projected must be positive, not ", options.distance);
  const std::vector<Vector3> before = points;
  const std::vector<Vector3> normals = pointNormals(before, quads);
  const NearestTriangle halves(halvesOf(before, quads));
  const PointTargets targets{ surface, halves, options.distance, std::cos(options.angle) };
  std::vector<PointFate> fates(points.size());
  parallelForEach(points.size(), kHeavyChunk, options.threads,
    [&](std::size_t i) { fates[i] = targets.fateOf(before[i], normals[i], points[i]); });
  keepQuadsConvex(before, quads, points, fates);
  return countFates(fates);
}

} // namespace quadrille

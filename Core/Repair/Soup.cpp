// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Repair/Soup.h"

#include "Base/Refuse.h"
#include "Mesh/Triangulate.h"
#include "Prepare/Repair.h"

#include <Eigen/Geometry>

namespace quadrille
{

namespace
{

void checkCloud(const std::vector<Vector3>& points)
{
  refuseIf(
    points.empty(), "there is no point in the input. Connect a surface with polygons, or points.");
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    refuseIf(!points[i].allFinite(), "point ", i,
      " has a coordinate that is not finite; remove or correct it");
  }
}

void measure(Soup& soup)
{
  const std::vector<Vector3>& points = soup.triangles.points;
  Eigen::AlignedBox3d box;
  for (const std::array<Index, 3>& corners : soup.triangles.corners)
  {
    for (const Index corner : corners)
    {
      box.extend(points[corner]);
    }
    const Vector3 a = points[corners[1]] - points[corners[0]];
    soup.area += 0.5 * a.cross(points[corners[2]] - points[corners[0]]).norm();
  }
  if (soup.triangles.corners.empty())
  {
    for (const Vector3& p : points)
    {
      box.extend(p);
    }
  }
  soup.diagonal = box.diagonal().norm();
}

} // namespace

Soup soupOf(const SurfaceInput& input, int threads)
{
  Soup soup;
  if (input.polygonOffsets.size() < 2)
  {
    checkCloud(input.points);
    soup.triangles.points = input.points;
    measure(soup);
    return soup;
  }
  checkInput(input, threads);
  PreparedSurface surface;
  triangulate(input, surface);
  soup.triangles.points = input.points;
  soup.polygon.assign(surface.sourcePolygon.begin(), surface.sourcePolygon.end());
  soup.degenerate = surface.repair.degenerateFaces;
  const auto& origin = surface.mesh.origin;
  soup.triangles.corners.resize(origin.size() / 3);
  for (std::size_t t = 0; t < soup.triangles.corners.size(); ++t)
  {
    soup.triangles.corners[t] = { origin[3 * t], origin[3 * t + 1], origin[3 * t + 2] };
  }
  measure(soup);
  return soup;
}

} // namespace quadrille

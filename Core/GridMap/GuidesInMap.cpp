// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/GuidesInMap.h"

#include "Base/DisjointSets.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// Between the guide of a face and the nearer of the two families of isolines, in its plane.
double angleToIsolines(
  const Mesh& mesh, const std::vector<FixedVec2>& uv, Index f, const Vector3& direction)
{
  const Vector3 e1 = mesh.edgeVector(3 * f), e2 = -mesh.edgeVector(3 * f + 2);
  const Vector3 x = e1.stableNormalized();
  const Vector3 y = x.cross(e2).stableNormalized().cross(x);
  Eigen::Matrix2d edges, images;
  edges << e1.dot(x), e2.dot(x), e1.dot(y), e2.dot(y);
  images << toDouble(uv[3 * f + 1] - uv[3 * f]), toDouble(uv[3 * f + 2] - uv[3 * f]);
  const Eigen::Matrix2d gradients = images * edges.inverse();
  const Vector2 guide = Vector2(direction.dot(x), direction.dot(y)).stableNormalized();
  double sine = 1;
  for (Eigen::Index coordinate = 0; coordinate < 2; ++coordinate)
  {
    const Vector2 gradient = gradients.row(coordinate).transpose();
    sine = std::min(sine, std::abs(gradient.stableNormalized().dot(guide)));
  }
  return std::asin(sine);
}

} // namespace

std::size_t unfollowedRegions(
  const Mesh& mesh, const std::vector<Guide>& guides, const std::vector<FixedVec2>& uv)
{
  DisjointSets regions(guides.size(), 1);
  for (Index h = 0; h < 3 * guides.size(); ++h)
  {
    const Index f = Mesh::face(h), g = mesh.isBoundary(h) ? f : Mesh::face(mesh.twin[h]);
    if (!guides[f].isFree() && !guides[g].isFree())
    {
      regions.join(f, g);
    }
  }
  std::vector<double> excess(guides.size(), 0.0); // of the area times the angle, by root
  for (Index f = 0; f < guides.size(); ++f)
  {
    const double area = mesh.doubleAreaNormal(f).norm();
    if (!guides[f].isFree() && area > 0)
    {
      excess[regions.find(f)] +=
        area * (angleToIsolines(mesh, uv, f, guides[f].direction) - kFollowedAngle);
    }
  }
  return static_cast<std::size_t>(
    std::count_if(excess.begin(), excess.end(), [](double sum) { return sum > 0; }));
}

} // namespace quadrille

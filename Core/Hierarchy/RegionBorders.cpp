// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/RegionBorders.h"

#include "Base/Angles.h"

#include <Eigen/Geometry>

#include <cmath>

namespace quadrille
{

namespace
{

/// Inner angles of a region from here on are no corners.
constexpr double kCornerLimit = 0.75 * kPi;

} // namespace

RegionBorders::RegionBorders(const DecimationMesh& mesh, double length)
  : mesh_(mesh), length_(length), degree_(mesh.position.size(), 0),
    leaving_(mesh.position.size(), kInvalidIndex), arriving_(mesh.position.size(), kInvalidIndex)
{
  for (Index h = 0; h < mesh.origin.size(); ++h)
  {
    if (mesh.isRegionBorder(h))
    {
      ++degree_[mesh.origin[h]];
      if (!mesh.guides[h / 3].isFree())
      {
        leaving_[mesh.origin[h]] = h;
        arriving_[mesh.target(h)] = h;
      }
    }
  }
}

double RegionBorders::sharpness(Index v) const
{
  if (!passes(v) || !(innerAngle(v) < kCornerLimit))
  {
    return 0;
  }
  const Vector3& p = mesh_.position[v];
  const Vector3 before = p - walk(v, false);
  const Vector3 after = walk(v, true) - p;
  Vector3 normal = Vector3::Zero();
  for (Index h = leaving_[v]; h != kInvalidIndex; h = nextInside(h))
  {
    const Vector3 out = mesh_.position[mesh_.target(h)] - p;
    normal += out.cross(mesh_.position[mesh_.origin[Mesh::previous(h)]] - p);
  }
  const Vector3 axis = before.cross(after);
  const double bend = std::atan2(axis.norm(), before.dot(after));
  return axis.dot(normal) > 0 && bend > kPi - kCornerLimit ? bend : 0;
}

Index RegionBorders::nextInside(Index h) const
{
  const Index incoming = Mesh::previous(h);
  return mesh_.isRegionBorder(incoming) ? kInvalidIndex : mesh_.twin[incoming];
}

double RegionBorders::innerAngle(Index v) const
{
  double angle = 0;
  const Vector3& p = mesh_.position[v];
  for (Index h = leaving_[v]; h != kInvalidIndex; h = nextInside(h))
  {
    const Vector3 a = mesh_.position[mesh_.target(h)] - p;
    const Vector3 b = mesh_.position[mesh_.origin[Mesh::previous(h)]] - p;
    angle += std::atan2(a.cross(b).norm(), a.dot(b));
  }
  return angle;
}

Vector3 RegionBorders::walk(Index v, bool forward) const
{
  double walked = 0;
  Index at = v;
  do
  {
    const Index h = forward ? leaving_[at] : arriving_[at];
    const Index to = forward ? mesh_.target(h) : mesh_.origin[h];
    walked += (mesh_.position[to] - mesh_.position[at]).norm();
    at = to;
  } while (walked < length_ && at != v && passes(at));
  return mesh_.position[at];
}

} // namespace quadrille

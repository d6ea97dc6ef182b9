// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/ComparedCosts.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace quadrille
{

ComparedCost::ComparedCost(const DecimationMesh& mesh, DecimationCost cost)
  : mesh_(mesh), quadric_(cost == DecimationCost::Quadric ? mesh.position.size() : 0)
{
  for (Index f = 0; f < mesh.faceCount() && !quadric_.empty(); ++f)
  {
    if (!mesh.isAlive(f))
    {
      continue;
    }
    const Vector3& p = mesh.position[mesh.origin[3 * f]];
    const Vector3 n =
      (mesh.position[mesh.origin[3 * f + 1]] - p).cross(mesh.position[mesh.origin[3 * f + 2]] - p);
    const double doubled = n.norm();
    for (Index h = 3 * f; h < 3 * f + 3 && doubled > 0; ++h)
    {
      quadric_[mesh.origin[h]].addPlane(n / doubled, -n.dot(p) / doubled, 0.5 * doubled);
    }
  }
}

double ComparedCost::of(const VertexRemoval& removal, double shortestEdge) const
{
  if (quadric_.empty())
  {
    return shortestEdge;
  }
  double cost = kInfinity;
  for (int i = 0; i < removal.ringSize(); ++i)
  {
    const Index w = removal.ringVertex(i);
    Quadric sum = quadric_[removal.vertex()];
    sum.add(quadric_[w]);
    cost = std::min(cost, sum.at(mesh_.position[w]));
  }
  return std::max(cost, 0.0);
}

void ComparedCost::remove(const VertexRemoval& removal)
{
  if (quadric_.empty())
  {
    return;
  }
  const Quadric& own = quadric_[removal.vertex()];
  const auto costAt = [&](int i) { return own.at(mesh_.position[removal.ringVertex(i)]); };
  int best = 0;
  for (int i = 1; i < removal.ringSize(); ++i)
  {
    best = costAt(i) < costAt(best) ? i : best;
  }
  quadric_[removal.ringVertex(best)].add(own);
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/GaussianCurvatureCost.h"

#include "Base/Angles.h"

#include <Eigen/Geometry>

#include <cmath>

namespace quadrille
{

namespace
{

template <typename AnyMesh>
std::vector<float> defectsOf(const AnyMesh& mesh)
{
  const Index corners = static_cast<Index>(mesh.origin.size());
  std::vector<double> defect(mesh.position.size(), 0.0);
  const auto isDead = [&](Index h) { return mesh.origin[h - h % 3] == kInvalidIndex; };
  for (Index h = 0; h < corners; ++h)
  {
    if (!isDead(h))
    {
      defect[mesh.origin[h]] = 2 * kPi;
    }
  }
  for (Index h = 0; h < corners; ++h)
  {
    if (!isDead(h) && mesh.isBoundary(h))
    {
      defect[mesh.origin[h]] = kPi;
    }
  }
  for (Index h = 0; h < corners; ++h)
  {
    if (isDead(h))
    {
      continue;
    }
    const Vector3& p = mesh.position[mesh.origin[h]];
    const Vector3 a = mesh.position[mesh.target(h)] - p;
    const Vector3 b = mesh.position[mesh.origin[Mesh::previous(h)]] - p;
    defect[mesh.origin[h]] -= std::atan2(a.cross(b).norm(), a.dot(b));
  }
  return { defect.begin(), defect.end() };
}

} // namespace

std::vector<float> angleDefects(const Mesh& mesh)
{
  return defectsOf(mesh);
}

std::vector<float> angleDefects(const DecimationMesh& mesh)
{
  return defectsOf(mesh);
}

double gaussianCurvatureCost(const VertexRemoval::Change& change, int ringSize)
{
  double cost = change.ownDefect;
  for (std::size_t i = 0; i < static_cast<std::size_t>(ringSize); ++i)
  {
    cost += std::abs(change.defect[i][0]) + std::abs(change.defect[i][1]);
  }
  return cost;
}

} // namespace quadrille

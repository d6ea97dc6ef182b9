// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/ComponentShares.h"

#include <algorithm>

namespace quadrille
{

namespace
{

/// Vertices that a component keeps for its topology.
constexpr Index kVerticesPerComponent = 12;
constexpr Index kVerticesPerHandleOrLoop = 8;

} // namespace

ComponentShares::ComponentShares(const DecimationMesh& mesh)
  : component_(mesh.position.size(), kInvalidIndex)
{
  std::vector<long> euler;
  std::vector<Index> stack;
  for (Index seed = 0; seed < component_.size(); ++seed)
  {
    if (mesh.outgoing[seed] == kInvalidIndex || component_[seed] != kInvalidIndex)
    {
      continue;
    }
    const Index id = static_cast<Index>(count_.size());
    count_.push_back(0);
    euler.push_back(0);
    component_[seed] = id;
    stack.assign(1, seed);
    while (!stack.empty())
    {
      const Index v = stack.back();
      stack.pop_back();
      ++count_[id];
      ++euler[id];
      visitNeighbours(mesh, v,
        [&](Index w)
        {
          if (component_[w] == kInvalidIndex)
          {
            component_[w] = id;
            stack.push_back(w);
          }
        });
    }
  }
  countEdgesAndFaces(mesh, euler);
  for (std::size_t id = 0; id < count_.size(); ++id)
  {
    const long handles = std::max(0L, 2 - euler[id]);
    keep_.push_back(std::min(
      count_[id], kVerticesPerComponent + kVerticesPerHandleOrLoop * static_cast<Index>(handles)));
  }
}

void ComponentShares::countEdgesAndFaces(const DecimationMesh& mesh, std::vector<long>& euler) const
{
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (!mesh.isAlive(f))
    {
      continue;
    }
    long& sum = euler[component_[mesh.origin[3 * f]]];
    ++sum;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      sum -= mesh.isBoundary(h) || h < mesh.twin[h] ? 1 : 0;
    }
  }
}

} // namespace quadrille

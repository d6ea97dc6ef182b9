// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/SharedStars.h"

namespace quadrille
{

StarCache& SharedStars::cacheFor(DecimationCost cost)
{
  if (cost_ != cost)
  {
    cache_.clear();
    cost_ = cost;
  }
  return cache_;
}

std::vector<Index> SharedStars::namesOf(const Level& level)
{
  std::vector<Index> names = level.fineVertex;
  for (std::size_t v = 0; v < names.size(); ++v)
  {
    if (names[v] >= sharedVertices_)
    {
      const Vector3& p = level.mesh.position[v];
      const Index next = sharedVertices_ + static_cast<Index>(added_.size());
      names[v] = added_.emplace(std::array<double, 3>{ p.x(), p.y(), p.z() }, next).first->second;
    }
  }
  return names;
}

} // namespace quadrille

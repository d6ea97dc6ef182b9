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

std::vector<Index> SharedStars::namesOf(const Level& level, const OwnVertices& own)
{
  std::vector<Index> names = level.fineVertex;
  for (std::size_t v = 0; v < names.size(); ++v)
  {
    if (own.contains(names[v]))
    {
      const Vector3& p = level.mesh.position[v];
      const std::array<double, 3> place{ p.x(), p.y(), p.z() };
      const Index next = own.shared + static_cast<Index>(added_.size());
      names[v] = added_.emplace(std::pair(own.features, place), next).first->second;
    }
  }
  return names;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/VerticesForSizes.h"

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// Between two of them, in radii of the region; and in quads of the size that is asked for, as irregular vertices that
/// are nearer to each other leave a map no room.
constexpr double kSpacingOfRegion = 0.15;

} // namespace

std::vector<Index> verticesForSizes(const PreparedSurface& surface, double edgeLength)
{
  std::vector<Index> all;
  if (surface.sizes.empty())
  {
    return all;
  }
  const Mesh& mesh = surface.mesh;
  const std::vector<std::uint8_t> isOn = constrainedVertices(mesh);
  for (const SizeRequest& size : surface.sizes)
  {
    const double reach = size.radius + std::abs(size.factor - 1) / kSizeGrowth * edgeLength;
    const double spacing = std::max(kSpacingOfRegion * reach, size.factor * edgeLength);
    std::vector<Index> kept;
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      pollNowAndThen(v);
      const Vector3& p = mesh.position[v];
      const bool isFree = isOn[v] == 0 && (p - size.place).norm() <= reach &&
        std::none_of(kept.begin(), kept.end(),
          [&](Index other) { return (mesh.position[other] - p).norm() < spacing; });
      if (isFree)
      {
        kept.push_back(v);
      }
    }
    all.insert(all.end(), kept.begin(), kept.end());
  }
  sortUnique(all);
  return all;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/SmallComponents.h"

#include "Base/Progress.h"
#include "Mesh/ContentHash.h"
#include "Mesh/Sizing.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/SurfaceEdit.h"
#include "Mesh/Topology.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace quadrille
{
namespace
{

/// quadsOfBlock for a mesh of one component in which each vertex has a face.
double blockOfConnected(const Mesh& mesh, int threads)
{
  const std::vector<Index> boundary = boundaryHalfEdges(mesh, threads);
  const auto edges =
    static_cast<long long>((std::size_t{ mesh.halfEdgeCount() } + boundary.size()) / 2);
  return quadsOfBlock(
    static_cast<long long>(mesh.vertexCount()) - edges + static_cast<long long>(mesh.faceCount()),
    countBoundaryLoops(mesh, boundary));
}

} // namespace

SmallComponents findSmallComponents(
  const PreparedSurface& surface, double edgeLength, double mostQuads, int threads)
{
  SmallComponents small;
  const Mesh& mesh = surface.mesh;
  const double quad = edgeLength * edgeLength;
  small.components = surface.components;
  if (surface.components <= 1 && mesh.sizing.empty() &&
    surface.area > (1 + kRoundingOfSingle) * blockOfConnected(mesh, threads) * quad)
  {
    return small;
  }
  const ComponentSizes sizes = measureComponents(mesh, threads);
  small.components = sizes.area.size();
  Index largest = kInvalidIndex;
  const auto isSmall = [&](Index c)
  { return sizes.area[c] < std::min(sizes.block[c], mostQuads) * quad; };
  std::vector<std::size_t> entry(sizes.area.size(), 0);
  for (Index c = 0; c < sizes.area.size(); ++c)
  {
    if (!isSmall(c))
    {
      continue;
    }
    entry[c] = small.each.size();
    small.each.push_back({ sizes.area[c], sizes.block[c], Vector3::Zero() });
    ++small.count;
    small.area += sizes.area[c];
    small.quads += sizes.block[c];
    if (largest == kInvalidIndex || sizes.area[c] > small.largest)
    {
      largest = c;
      small.largest = sizes.area[c];
    }
  }
  if (small.count == 0)
  {
    return small;
  }
  small.isSmall.resize(mesh.faceCount());
  std::vector<double> cornersOf(small.count, 0);
  double corners = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const Index c = sizes.componentOfFace[f];
    small.isSmall[f] = isSmall(c) ? 1 : 0;
    for (Index h = 3 * f; h < 3 * f + 3 && isSmall(c); ++h)
    {
      small.each[entry[c]].place += mesh.position[mesh.origin[h]];
      ++cornersOf[entry[c]];
    }
    for (Index h = 3 * f; h < 3 * f + 3 && c == largest; ++h)
    {
      small.place += mesh.position[mesh.origin[h]];
      ++corners;
    }
  }
  small.place /= corners;
  for (std::size_t i = 0; i < small.each.size(); ++i)
  {
    small.each[i].place /= cornersOf[i];
  }
  return small;
}

void removeComponents(
  PreparedSurface& surface, const std::vector<std::uint8_t>& isRemoved, std::size_t count)
{
  const Mesh& mesh = surface.mesh;
  std::vector<std::uint8_t> goes(mesh.vertexCount(), 0);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    if (isRemoved[f] == 0)
    {
      continue;
    }
    surface.area -= mesh.faceArea(f);
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      goes[mesh.origin[h]] = 1;
    }
  }
  std::vector<ValenceRequest>& requests = surface.valenceRequests;
  const auto lost = std::remove_if(requests.begin(), requests.end(),
    [&](const ValenceRequest& request) { return goes[request.vertex] != 0; });
  surface.unusedValences += static_cast<std::size_t>(requests.end() - lost);
  requests.erase(lost, requests.end());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (isRemoved[f] != 0)
    {
      removeFace(surface, f);
    }
  }
  orderSurface(surface, 1);
  surface.components -= static_cast<Index>(count);
  surface.hash = contentHash(mesh, 1);
}

std::size_t removeSmallComponents(PreparedSurface& surface, const SmallComponents& small)
{
  if (small.count == 0 || small.count == small.components)
  {
    return 0;
  }
  removeComponents(surface, small.isSmall, small.count);
  return small.count;
}

} // namespace quadrille

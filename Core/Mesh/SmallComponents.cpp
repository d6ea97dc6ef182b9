// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SmallComponents.h"

#include "Base/Progress.h"
#include "Mesh/ContentHash.h"
#include "Mesh/Sizing.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/SurfaceEdit.h"
#include "Mesh/Topology.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

constexpr double kQuadsOfSphere = 6;
constexpr double kQuadsOfDisc = 4;
constexpr double kQuadsOfHandle = 16;
constexpr double kQuadsOfLoop = 8;
/// An area is known to this factor without summing it up anew.
constexpr double kMoreThanRounding = 1.001;

/// Loops of the boundary in each component.
std::vector<std::size_t> countLoops(const Mesh& mesh, const ComponentSizes& sizes)
{
  std::vector<std::size_t> loops(sizes.area.size(), 0);
  std::vector<std::uint8_t> seen(mesh.halfEdgeCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (!mesh.isBoundary(h) || seen[h] != 0)
    {
      continue;
    }
    ++loops[sizes.componentOfFace[Mesh::face(h)]];
    for (Index g = h; seen[g] == 0; g = nextOnBoundary(mesh, g))
    {
      seen[g] = 1;
    }
  }
  return loops;
}

/// V - E + F of each component. Twice an edge is a half-edge, and once more where it has no twin.
std::vector<long long> countEuler(const Mesh& mesh, const ComponentSizes& sizes)
{
  std::vector<long long> twice(sizes.area.size(), 0);
  std::vector<std::uint8_t> seen(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    long long& sum = twice[sizes.componentOfFace[Mesh::face(h)]];
    sum +=
      (seen[mesh.origin[h]] == 0 ? 2 : 0) - (mesh.isBoundary(h) ? 2 : 1) + (h % 3 == 0 ? 2 : 0);
    seen[mesh.origin[h]] = 1;
  }
  for (long long& sum : twice)
  {
    sum /= 2;
  }
  return twice;
}

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

double triangulationScale(double area, double edgeLength)
{
  return std::min(1.0, std::sqrt(area / kQuadsOfSmallTriangulation) / edgeLength);
}

double quadsOfBlock(long long eulerCharacteristic, std::size_t boundaryLoops)
{
  const auto loops = static_cast<double>(boundaryLoops);
  const double handles = std::max(0.0, (2 - static_cast<double>(eulerCharacteristic) - loops) / 2);
  if (boundaryLoops == 0)
  {
    return handles == 0 ? kQuadsOfSphere : kQuadsOfHandle * handles;
  }
  return kQuadsOfDisc + kQuadsOfLoop * (loops - 1) + kQuadsOfHandle * handles;
}

ComponentSizes measureComponents(const Mesh& mesh, int threads)
{
  ComponentSizes sizes;
  Index count = 0;
  sizes.componentOfFace = faceComponents(mesh, count, threads);
  sizes.area.assign(count, 0.0);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    sizes.area[sizes.componentOfFace[f]] += sizedArea(mesh, f);
  }
  const std::vector<std::size_t> loops = countLoops(mesh, sizes);
  const std::vector<long long> euler = countEuler(mesh, sizes);
  for (Index c = 0; c < count; ++c)
  {
    sizes.block.push_back(quadsOfBlock(euler[c], loops[c]));
  }
  return sizes;
}

SmallComponents findSmallComponents(
  const PreparedSurface& surface, double edgeLength, double mostQuads, int threads)
{
  SmallComponents small;
  const Mesh& mesh = surface.mesh;
  const double quad = edgeLength * edgeLength;
  small.components = surface.components;
  if (surface.components <= 1 && mesh.sizing.empty() &&
    (surface.area > kSurelyLargeSurface * quad ||
      surface.area > kMoreThanRounding * blockOfConnected(mesh, threads) * quad))
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

std::size_t removeSmallComponents(PreparedSurface& surface, const SmallComponents& small)
{
  if (small.count == 0 || small.count == small.components)
  {
    return 0;
  }
  const Mesh& mesh = surface.mesh;
  std::vector<std::uint8_t> goes(mesh.vertexCount(), 0);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    if (small.isSmall[f] == 0)
    {
      continue;
    }
    surface.area -= mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1)).norm() / 2;
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
    if (small.isSmall[f] != 0)
    {
      removeFace(surface, f);
    }
  }
  orderSurface(surface, 1);
  surface.components -= static_cast<Index>(small.count);
  surface.hash = contentHash(mesh, 1);
  return small.count;
}

} // namespace quadrille

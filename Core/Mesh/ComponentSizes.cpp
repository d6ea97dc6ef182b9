// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/ComponentSizes.h"

#include "Base/Progress.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace quadrille
{
namespace
{

/// For each loop of the boundary, and twice for each handle.
constexpr double kQuadsOfCut = 8;

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

} // namespace

double triangulationScale(double area, double edgeLength)
{
  return std::min(1.0, std::sqrt(area / kQuadsOfSmallTriangulation) / edgeLength);
}

double quadsOfBlock(long long eulerCharacteristic, std::size_t boundaryLoops)
{
  const double cuts =
    std::max(static_cast<double>(boundaryLoops), 2 - static_cast<double>(eulerCharacteristic));
  if (cuts <= 0)
  {
    return 6; // a box
  }
  return boundaryLoops == 0 ? kQuadsOfCut * cuts : kQuadsOfCut * (cuts - 1) + 4;
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

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/VertexScales.h"

#include "Base/DisjointSets.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Mesh/ComponentSizes.h"
#include "Mesh/Sizing.h"

#include <Eigen/Geometry>

#include <cstddef>

namespace quadrille
{
namespace
{

/// The vertices of each component, joined along edges.
DisjointSets componentsOf(const Mesh& fine, int threads)
{
  DisjointSets components(fine.vertexCount(), threads);
  parallelForEach(fine.faceCount(), kLightChunk, threads,
    [&](Index f)
    {
      components.join(fine.origin[3 * f], fine.origin[3 * f + 1]);
      components.join(fine.origin[3 * f], fine.origin[3 * f + 2]);
    });
  return components;
}

/// Area of each component over its sizes, at its root.
std::vector<double> componentAreas(const Mesh& fine, DisjointSets& components, int threads)
{
  // Sums of consecutive faces of one component, chunk by chunk, so that the number of threads does not show.
  struct Sum
  {
    Index root = kInvalidIndex;
    double doubledArea = 0;
  };
  const auto sums = parallelParts<std::vector<Sum>>(fine.faceCount(), kLightChunk, threads,
    [&](Index begin, Index end, std::vector<Sum>& sum)
    {
      for (Index f = begin; f < end; ++f)
      {
        const Index root = components.find(fine.origin[3 * f]);
        if (sum.empty() || sum.back().root != root)
        {
          sum.push_back({ root, 0 });
        }
        sum.back().doubledArea +=
          fine.sizing.empty() ? fine.doubleAreaNormal(f).norm() : 2 * sizedArea(fine, f);
      }
    });
  std::vector<double> area(fine.vertexCount(), 0.0);
  for (const std::vector<Sum>& chunk : sums)
  {
    for (const Sum& sum : chunk)
    {
      area[sum.root] += 0.5 * sum.doubledArea;
    }
  }
  return area;
}

/// Whether a connected mesh surely is no small component, by the faces up to where that is clear.
bool isSurelyLarge(const Mesh& fine, double edgeLength)
{
  double doubledArea = 0;
  for (Index h = 0; h < fine.halfEdgeCount(); h += 3)
  {
    pollNowAndThen(h);
    doubledArea += fine.edgeVector(h).cross(fine.edgeVector(h + 1)).norm();
    if (doubledArea > 2 * kQuadsOfSmallTriangulation * edgeLength * edgeLength)
    {
      return true;
    }
  }
  return false;
}

double sizeAt(const std::vector<float>& sizing, Index v)
{
  return sizing.empty() ? 1.0 : double{ sizing[v] };
}

} // namespace

VertexScales vertexScales(const Mesh& fine, double edgeLength, bool isConnected, int threads)
{
  if (isConnected && fine.sizing.empty() && isSurelyLarge(fine, edgeLength))
  {
    return {};
  }
  DisjointSets components = componentsOf(fine, threads);
  const std::vector<double> area = componentAreas(fine, components, threads);
  const auto scale = [&](Index root) { return triangulationScale(area[root], edgeLength); };
  VertexScales result;
  bool& anySmall = result.anySmallComponent;
  for (Index v = 0; v < fine.vertexCount() && !anySmall; ++v)
  {
    pollNowAndThen(v);
    anySmall = components.find(v) == v && scale(v) < 1;
  }
  result.scale.resize(anySmall || !fine.sizing.empty() ? fine.vertexCount() : 0);
  for (Index v = 0; v < static_cast<Index>(result.scale.size()); ++v)
  {
    result.scale[v] = static_cast<float>(scale(components.find(v)) * sizeAt(fine, v));
  }
  return result;
}

std::vector<Index> smallerThan(const Mesh& fine, const std::vector<float>& sizes)
{
  std::vector<Index> smaller;
  if (fine.sizing.empty() && sizes.empty())
  {
    return smaller;
  }
  for (Index v = 0; v < fine.vertexCount(); ++v)
  {
    if (sizeAt(fine, v) < sizeAt(sizes, v))
    {
      smaller.push_back(v);
    }
  }
  return smaller;
}

} // namespace quadrille

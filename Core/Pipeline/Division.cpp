// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Division.h"

#include "Mesh/ComponentSizes.h"
#include "Mesh/SurfaceParts.h"
#include "Pipeline/Strategies.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

namespace quadrille
{
namespace
{

/// By component: whether it has one of the vertices.
std::vector<std::uint8_t> componentsOf(
  const std::vector<Index>& vertices, const Mesh& mesh, const ComponentSizes& sizes)
{
  std::vector<Index> componentOfVertex(mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    componentOfVertex[mesh.origin[h]] = sizes.componentOfFace[Mesh::face(h)];
  }
  std::vector<std::uint8_t> isHit(sizes.area.size(), 0);
  for (const Index v : vertices)
  {
    isHit[componentOfVertex[v]] = 1;
  }
  return isHit;
}

/// Each that has failed by itself, the others together.
std::vector<Index> failedAlone(const std::vector<std::uint8_t>& isFailed)
{
  const auto failed =
    static_cast<Index>(std::count(isFailed.begin(), isFailed.end(), std::uint8_t{ 1 }));
  std::vector<Index> partOf(isFailed.size(), failed);
  Index next = 0;
  for (std::size_t c = 0; c < isFailed.size(); ++c)
  {
    if (isFailed[c] != 0)
    {
      partOf[c] = next++;
    }
  }
  return partOf;
}

/// Two or more components in two parts, of which each has one.
std::vector<Index> halves(const std::vector<double>& area)
{
  const double all = std::accumulate(area.begin(), area.end(), 0.0);
  std::vector<Index> partOf(area.size(), 1);
  double first = 0;
  for (std::size_t c = 0; c + 1 < area.size() && (c == 0 || first + area[c] <= all / 2); ++c)
  {
    partOf[c] = 0;
    first += area[c];
  }
  return partOf;
}

} // namespace

bool isDivided(const SizedSurface& sized, const History& history)
{
  return sized.surface->components > 1 && !history.hasResult() && !isTooLarge(history.last());
}

std::vector<SizedPart> divide(
  const SizedSurface& whole, const std::vector<Index>& failed, int threads)
{
  const PreparedSurface& surface = *whole.surface;
  const ComponentSizes sizes = measureComponents(surface.mesh, threads);
  const std::vector<Index> partOf =
    failed.empty() ? halves(sizes.area) : failedAlone(componentsOf(failed, surface.mesh, sizes));
  const std::size_t count = std::size_t{ *std::max_element(partOf.begin(), partOf.end()) } + 1;
  std::vector<Index> partOfFace(surface.mesh.faceCount());
  std::transform(sizes.componentOfFace.begin(), sizes.componentOfFace.end(), partOfFace.begin(),
    [&](Index c) { return partOf[c]; });
  std::vector<ComponentPart> surfaces = splitSurface(surface, partOfFace, count, threads);

  const double all = std::accumulate(sizes.area.begin(), sizes.area.end(), 0.0);
  std::vector<SizedPart> parts(count);
  for (Index c = 0; c < partOf.size(); ++c)
  {
    parts[partOf[c]].share += sizes.area[c] / all;
    ++surfaces[partOf[c]].surface.components;
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    SizedSurface& sized = parts[i].sized;
    sized.edgeLength = whole.edgeLength;
    sized.hasBeside = whole.hasBeside;
    sized.quadsOfWhole = whole.quadsOfAll();
    sized.targetQuads = static_cast<std::size_t>(
      std::max(1.0, std::round(parts[i].share * static_cast<double>(whole.targetQuads))));
    sized.key = KeyMaker(whole.key).add(surfaces[i].surface.hash).key();
    sized.surface = std::make_shared<const PreparedSurface>(std::move(surfaces[i].surface));
    parts[i].curves = std::move(surfaces[i].curves);
  }
  return parts;
}

} // namespace quadrille

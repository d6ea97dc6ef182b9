// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/QuadMesh.h"

#include <algorithm>
#include <utility>

namespace quadrille
{
namespace
{

/// Per point visit(point, itemOf(half-edge)) of the half-edges that leave it.
template <typename ItemOf>
Grouped<> atPoints(
  const std::vector<std::array<Index, 4>>& quads, std::size_t points, const ItemOf& itemOf)
{
  return { points,
    [&](const auto& visit)
    {
      for (Index h = 0; h < 4 * quads.size(); ++h)
      {
        visit(quads[h / 4][h % 4], itemOf(h));
      }
    } };
}

} // namespace

Grouped<> halfEdgesAtPoints(const std::vector<std::array<Index, 4>>& quads, std::size_t points)
{
  return atPoints(quads, points, [](Index h) { return h; });
}

Grouped<> quadsAtPoints(const std::vector<std::array<Index, 4>>& quads, std::size_t points)
{
  return atPoints(quads, points, [](Index h) { return h / 4; });
}

std::optional<Index> meshCorner(const QuadMesh& quads, Index p)
{
  for (Index i = 0; i < 3; ++i)
  {
    if (quads.sourceWeights[p][i] == 1)
    {
      return 3 * quads.sourceFace[p] + i;
    }
  }
  return std::nullopt;
}

std::vector<std::uint8_t> pointsOnCurves(const QuadMesh& mesh)
{
  std::vector<std::uint8_t> isOnCurve = mesh.onBoundary;
  for (const QuadLine& line : mesh.lines)
  {
    isOnCurve[line.a] = isOnCurve[line.b] = 1;
  }
  return isOnCurve;
}

std::vector<Index> keepPoints(QuadMesh& mesh, const std::vector<std::uint8_t>& isKept)
{
  std::vector<Index> newId(isKept.size(), kInvalidIndex);
  Index kept = 0;
  for (Index p = 0; p < isKept.size(); ++p)
  {
    if (isKept[p] != 0)
    {
      mesh.points[kept] = mesh.points[p];
      mesh.sourceFace[kept] = mesh.sourceFace[p];
      mesh.sourceWeights[kept] = mesh.sourceWeights[p];
      newId[p] = kept++;
    }
  }
  mesh.points.resize(kept);
  mesh.sourceFace.resize(kept);
  mesh.sourceWeights.resize(kept);
  return newId;
}

std::vector<std::uint8_t> featureEdgeBits(const QuadMesh& mesh)
{
  const auto sortedEdge = [](Index a, Index b)
  { return std::pair(std::min(a, b), std::max(a, b)); };
  std::vector<std::pair<Index, Index>> features;
  for (const QuadLine& line : mesh.lines)
  {
    if (!line.boundary)
    {
      features.push_back(sortedEdge(line.a, line.b));
    }
  }
  std::sort(features.begin(), features.end());
  const auto bitsOf = [&](const Index* corners, std::size_t count)
  {
    constexpr std::size_t bitCount = 8; // a polygon may have more edges
    int bits = 0;
    for (std::size_t i = 0; i < std::min(count, bitCount); ++i)
    {
      const auto edge = sortedEdge(corners[i], corners[(i + 1) % count]);
      bits |= std::binary_search(features.begin(), features.end(), edge) ? 1 << i : 0;
    }
    return static_cast<std::uint8_t>(bits);
  };
  std::vector<std::uint8_t> bits;
  bits.reserve(mesh.quads.size() + mesh.polygonSourceFace.size());
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    bits.push_back(bitsOf(quad.data(), 4));
  }
  for (std::size_t i = 0; i < mesh.polygonSourceFace.size(); ++i)
  {
    const Index first = mesh.polygonOffsets[i];
    bits.push_back(bitsOf(mesh.polygonPoints.data() + first, mesh.polygonOffsets[i + 1] - first));
  }
  return bits;
}

} // namespace quadrille

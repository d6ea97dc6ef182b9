// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/CellValues.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace quadrille
{

namespace
{

bool isFollowed(CadEdgeKind kind, CadFollow follow)
{
  return follow != CadFollow::None &&
    (kind == CadEdgeKind::Sharp || (kind == CadEdgeKind::Tangent && follow == CadFollow::All));
}

struct Segment
{
  bool isFollowed = false;
  float curvature = 0;
};

/// Of edges, by both ends, the lower one first.
std::map<std::pair<Index, Index>, Segment> segmentsOf(const CadSurface& surface, CadFollow follow)
{
  std::map<std::pair<Index, Index>, Segment> segments;
  for (const CadEdge& edge : surface.edges)
  {
    for (std::size_t i = 0; i + 1 < edge.points.size(); ++i)
    {
      Segment& segment = segments[std::minmax(edge.points[i], edge.points[i + 1])];
      segment.isFollowed = segment.isFollowed || isFollowed(edge.kind, follow);
      segment.curvature = std::max(segment.curvature, edge.curvatures[i]);
    }
  }
  return segments;
}

} // namespace

CadCells cadCells(const CadSurface& surface, CadFollow follow)
{
  const std::map<std::pair<Index, Index>, Segment> segments = segmentsOf(surface, follow);
  CadCells cells;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
  {
    const std::array<Index, 3>& corners = surface.triangles[t];
    unsigned bits = 0;
    std::array<float, 6> curvatures{};
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto found = segments.find(std::minmax(corners[i], corners[(i + 1) % 3]));
      const Segment segment = found == segments.end() ? Segment() : found->second;
      bits |= segment.isFollowed ? 1U << i : 0U;
      curvatures[i] = surface.curvatures[t][i];
      curvatures[3 + i] = segment.curvature;
    }
    cells.features.push_back(static_cast<std::uint8_t>(bits));
    cells.curvatures.push_back(curvatures);
  }
  return cells;
}

CadLines cadLines(const CadSurface& surface)
{
  CadLines lines;
  std::map<Index, int> vertexAt;
  for (const Index point : surface.vertexPoints)
  {
    constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
    vertexAt.emplace(point, static_cast<int>(lines.vertexPoints.size()));
    lines.vertexPoints.push_back(
      point == kInvalidIndex ? Vector3::Constant(kNowhere) : surface.points[point]);
  }
  const auto vertexOf = [&](Index point)
  {
    const auto found = vertexAt.find(point);
    return found == vertexAt.end() ? -1 : found->second;
  };
  for (const CadEdge& edge : surface.edges)
  {
    const std::vector<Index>& along = edge.points;
    lines.ends.push_back(along.empty()
        ? std::array{ -1, -1 }
        : std::array{ vertexOf(along.front()), vertexOf(along.back()) });
    lines.counts.push_back(static_cast<int>(along.size()));
    std::transform(along.begin(), along.end(), std::back_inserter(lines.points),
      [&](Index point) { return surface.points[point]; });
  }
  return lines;
}

std::string nameOfFace(const CadPart& part, std::size_t face)
{
  return part.faceNames[face].empty() ? kUnnamedFace + std::to_string(face + 1)
                                      : part.faceNames[face];
}

} // namespace quadrille

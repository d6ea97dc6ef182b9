// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/DrawnLines.h"

#include "Mesh/Distance.h"

#include <algorithm>
#include <cstddef>

namespace quadrille
{
namespace
{

constexpr int kTurnsBesideLine = 2;
/// Vertices of a line lie on its course but for rounding, over the course's diagonal.
constexpr double kOnCourse = 1e-9;

/// Calls visit(h) for the half-edges that leave the vertex of `first`, counterclockwise from it on. Returns whether
/// they go all round it.
template <typename Visitor>
bool forFanOf(const Mesh& mesh, Index first, const Visitor& visit)
{
  Index h = first;
  do
  {
    visit(h);
    h = mesh.rotateCounterclockwise(h);
  } while (h != kInvalidIndex && h != first);
  return h == first;
}

/// Calls visit(half-edge, turns) for the sectors at the vertex that h, a flagged edge, leaves: those on each side of
/// the line make two turns together, where so many have room.
template <typename Visitor>
void forSectorsBeside(const Mesh& mesh, const EdgesOfLines& lines, Index h, const Visitor& visit)
{
  std::vector<std::vector<Index>> sides;
  const bool isWhole = forFanOf(mesh, h,
    [&](Index g)
    {
      if (lines.edges[g] != 0)
      {
        sides.emplace_back();
      }
      if (mesh.isConstrained(g))
      {
        sides.back().push_back(g);
      }
    });
  if (!isWhole || sides.size() < 2)
  {
    return; // on a boundary
  }
  // Two that cross have two edges each, and a quarter of the turns between two of them.
  const int most = sides.size() > 2 ? 1 : kTurnsBesideLine;
  for (const std::vector<Index>& side : sides)
  {
    const int turns = std::min(most, kTurnsBesideLine / static_cast<int>(side.size()));
    for (const Index sector : side)
    {
      if (turns > 0)
      {
        visit(sector, turns);
      }
    }
  }
}

/// The same for all edges of lines.
template <typename Visitor>
void forSectorsOfLines(const Mesh& mesh, const EdgesOfLines& lines, const Visitor& visit)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (lines.edges[h] != 0 && lines.isFree[mesh.origin[h]] == 0)
    {
      forSectorsBeside(mesh, lines, h, visit);
    }
  }
}

/// That of a cycle ends where it begins.
std::vector<Vector3> courseOf(const CurveRequest& line)
{
  std::vector<Vector3> course = line.points;
  if (line.kind == CurveKind::Cycle)
  {
    course.push_back(line.points.front());
  }
  return course;
}

/// The diagonal of its box.
double spanOf(const std::vector<Vector3>& course)
{
  Vector3 low = course.front(), high = low;
  for (const Vector3& p : course)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

bool isOnCourse(const std::vector<Vector3>& course, const Vector3& p, double tolerance)
{
  for (std::size_t i = 0; i + 1 < course.size(); ++i)
  {
    if (distanceToSegment(p, course[i], course[i + 1]) <= tolerance)
    {
      return true;
    }
  }
  return false;
}

} // namespace

bool hasLines(const std::vector<CurveRequest>& curves)
{
  return std::any_of(
    curves.begin(), curves.end(), [](const CurveRequest& curve) { return curve.isDrawn(); });
}

void addFeatures(
  const std::vector<CurveRequest>& curves, CurveKind kind, std::vector<FeatureRequest>& features)
{
  for (const CurveRequest& curve : curves)
  {
    if (curve.kind == kind && curve.isDrawn())
    {
      features.push_back({ courseOf(curve) });
    }
  }
}

EdgesOfLines edgesOfLines(const Mesh& mesh, const std::vector<CurveRequest>& curves)
{
  EdgesOfLines lines{ std::vector<std::uint8_t>(mesh.halfEdgeCount(), 0),
    std::vector<std::uint8_t>(mesh.vertexCount(), 0) };
  for (const CurveRequest& curve : curves)
  {
    if (!curve.isDrawn())
    {
      continue;
    }
    const std::vector<Vector3> course = courseOf(curve);
    const double tolerance = kOnCourse * spanOf(course);
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const Vector3& p = mesh.position[mesh.origin[h]];
      const bool isOf = mesh.isFeature(h) && !mesh.isBoundary(h) &&
        isOnCourse(course, p, tolerance) &&
        isOnCourse(course, mesh.position[mesh.target(h)], tolerance);
      lines.edges[h] |= isOf ? 1 : 0;
      const bool ends = isOf && curve.kind == CurveKind::Connection &&
        std::min((p - course.front()).norm(), (p - course.back()).norm()) <= tolerance;
      lines.isFree[mesh.origin[h]] |= ends ? 1 : 0;
    }
  }
  return lines;
}

std::vector<int> straightAlong(
  const Mesh& mesh, const EdgesOfLines& lines, std::vector<int> sectorTurns)
{
  sectorTurns.resize(mesh.halfEdgeCount(), 0);
  forSectorsOfLines(mesh, lines,
    [&](Index sector, int turns)
    { sectorTurns[sector] = sectorTurns[sector] == 0 ? turns : sectorTurns[sector]; });
  return sectorTurns;
}

bool isStraightAlong(
  const Mesh& mesh, const EdgesOfLines& lines, const std::vector<std::int8_t>& sectorTurns)
{
  bool isStraight = true;
  forSectorsOfLines(mesh, lines,
    [&](Index sector, int turns) { isStraight = isStraight && sectorTurns[sector] == turns; });
  return isStraight &&
    std::any_of(
      lines.edges.begin(), lines.edges.end(), [](std::uint8_t flag) { return flag != 0; });
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/DrawnLines.h"

#include "Mesh/Distance.h"
#include "Requests/SurfacePlaces.h"

#include <algorithm>
#include <cstddef>

namespace quadrille
{
namespace
{

/// Calls visit(half-edge, turns) for the sectors at the vertex that h, a flagged edge, leaves: those on each side of
/// the line make two turns together, where so many have room.
template <typename Visitor>
void forSectorsBeside(const Mesh& mesh, const EdgesOfLine& line, Index h, const Visitor& visit)
{
  std::vector<std::vector<Index>> sides;
  const bool isWhole = forEachFrom(mesh, h,
    [&](Index g)
    {
      if (line.edges[g] != 0)
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
  // One that crosses itself has four edges there, and a quarter of the turns between two of them.
  const int most = sides.size() > 2 ? 1 : kStraightTurns;
  for (const std::vector<Index>& side : sides)
  {
    const int turns = std::min(most, kStraightTurns / static_cast<int>(side.size()));
    for (const Index sector : side)
    {
      if (turns > 0)
      {
        visit(sector, turns);
      }
    }
  }
}

/// The same for all edges of a line.
template <typename Visitor>
void forSectorsOfLine(const Mesh& mesh, const EdgesOfLine& line, const Visitor& visit)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (line.edges[h] != 0 && line.ends[mesh.origin[h]] == 0)
    {
      forSectorsBeside(mesh, line, h, visit);
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

EdgesOfLine edgesOfLine(const Mesh& mesh, const CurveRequest& line)
{
  EdgesOfLine found{ std::vector<std::uint8_t>(mesh.halfEdgeCount(), 0),
    std::vector<std::uint8_t>(mesh.vertexCount(), 0) };
  const std::vector<Vector3> course = courseOf(line);
  const double tolerance = kRounding * diagonalOf(course);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Vector3& p = mesh.position[mesh.origin[h]];
    if (mesh.isFeature(h) && !mesh.isBoundary(h) && isOnCourse(course, p, tolerance) &&
      isOnCourse(course, mesh.position[mesh.target(h)], tolerance))
    {
      found.edges[h] = 1;
      const bool ends = line.kind == CurveKind::Connection &&
        std::min((p - course.front()).norm(), (p - course.back()).norm()) <= tolerance;
      found.ends[mesh.origin[h]] |= ends ? 1 : 0;
    }
  }
  return found;
}

std::vector<int> straightAlong(
  const Mesh& mesh, const std::vector<CurveRequest>& lines, std::vector<int> sectorTurns)
{
  sectorTurns.resize(mesh.halfEdgeCount(), 0);
  for (const CurveRequest& line : lines)
  {
    if (line.isDrawn())
    {
      forSectorsOfLine(mesh, edgesOfLine(mesh, line),
        [&](Index sector, int turns)
        { sectorTurns[sector] = sectorTurns[sector] == 0 ? turns : sectorTurns[sector]; });
    }
  }
  return sectorTurns;
}

bool isStraightAlong(
  const Mesh& mesh, const CurveRequest& line, const std::vector<std::int8_t>& sectorTurns)
{
  const EdgesOfLine found = edgesOfLine(mesh, line);
  bool isStraight = true;
  forSectorsOfLine(mesh, found,
    [&](Index sector, int turns) { isStraight = isStraight && sectorTurns[sector] == turns; });
  return isStraight &&
    std::any_of(
      found.edges.begin(), found.edges.end(), [](std::uint8_t flag) { return flag != 0; });
}

} // namespace quadrille

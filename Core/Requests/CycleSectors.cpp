// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/CycleSectors.h"

#include "Mesh/Distance.h"

#include <algorithm>
#include <cstddef>

namespace quadrille
{
namespace
{

constexpr int kTurnsBesideCycle = 2;

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
/// the cycle make two turns together, where so many have room.
template <typename Visitor>
void forSectorsBeside(
  const Mesh& mesh, const std::vector<std::uint8_t>& edges, Index h, const Visitor& visit)
{
  std::vector<std::vector<Index>> sides;
  const bool isWhole = forFanOf(mesh, h,
    [&](Index g)
    {
      if (edges[g] != 0)
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
    return; // on a boundary, or an end
  }
  // Two that cross have two edges each, and a quarter of the turns between two of them.
  const int most = sides.size() > 2 ? 1 : kTurnsBesideCycle;
  for (const std::vector<Index>& side : sides)
  {
    const int turns = std::min(most, kTurnsBesideCycle / static_cast<int>(side.size()));
    for (const Index sector : side)
    {
      if (turns > 0)
      {
        visit(sector, turns);
      }
    }
  }
}

bool isOnCourse(const CurveRequest& cycle, const Vector3& p, double tolerance)
{
  for (std::size_t i = 0; i < cycle.points.size(); ++i)
  {
    const Vector3& next = cycle.points[(i + 1) % cycle.points.size()];
    if (distanceToSegment(p, cycle.points[i], next) <= tolerance)
    {
      return true;
    }
  }
  return false;
}

} // namespace

bool hasCycles(const std::vector<CurveRequest>& curves)
{
  return std::any_of(curves.begin(), curves.end(),
    [](const CurveRequest& curve) { return curve.kind == CurveKind::Cycle; });
}

std::vector<FeatureRequest> featuresWithCycles(
  std::vector<FeatureRequest> features, const std::vector<CurveRequest>& curves)
{
  for (const CurveRequest& curve : curves)
  {
    if (curve.kind == CurveKind::Cycle)
    {
      features.push_back({ curve.points });
      features.back().points.push_back(curve.points.front());
    }
  }
  return features;
}

std::vector<std::uint8_t> edgesOfCycles(
  const Mesh& mesh, const std::vector<CurveRequest>& curves, double tolerance)
{
  std::vector<std::uint8_t> edges(mesh.halfEdgeCount(), 0);
  for (const CurveRequest& curve : curves)
  {
    if (curve.kind != CurveKind::Cycle)
    {
      continue;
    }
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      const bool isOf = edges[h] == 0 && mesh.isFeature(h) && !mesh.isBoundary(h) &&
        isOnCourse(curve, mesh.position[mesh.origin[h]], tolerance) &&
        isOnCourse(curve, mesh.position[mesh.target(h)], tolerance);
      edges[h] |= isOf ? 1 : 0;
    }
  }
  return edges;
}

std::vector<int> straightAlong(
  const Mesh& mesh, const std::vector<std::uint8_t>& edges, std::vector<int> sectorTurns)
{
  sectorTurns.resize(mesh.halfEdgeCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (edges[h] != 0)
    {
      forSectorsBeside(mesh, edges, h,
        [&](Index sector, int turns)
        { sectorTurns[sector] = sectorTurns[sector] == 0 ? turns : sectorTurns[sector]; });
    }
  }
  return sectorTurns;
}

bool isStraightAlong(const Mesh& mesh, const std::vector<std::uint8_t>& edges,
  const std::vector<std::int8_t>& sectorTurns)
{
  bool isAny = false, isStraight = true;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (edges[h] != 0)
    {
      isAny = true;
      forSectorsBeside(mesh, edges, h,
        [&](Index sector, int turns) { isStraight = isStraight && sectorTurns[sector] == turns; });
    }
  }
  return isAny && isStraight;
}

} // namespace quadrille

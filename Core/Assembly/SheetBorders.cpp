// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Assembly/SheetBorders.h"

#include "Mesh/Topology.h"

#include <algorithm>
#include <cstdint>

namespace quadrille
{

Index SheetBorders::inputAt(Index corner) const
{
  return result_.surface.inputPointAt(corner);
}

void SheetBorders::findFineLoops()
{
  std::vector<std::uint8_t> seen(mesh_.halfEdgeCount(), 0);
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    if (!mesh_.isBoundary(h) || seen[h] != 0)
    {
      continue;
    }
    FineLoop& loop = fineLoops_.emplace_back();
    loop.sheet = sheetOfFace(Mesh::face(h));
    loop.arc.push_back(0);
    for (Index g = h; seen[g] == 0; g = nextOnBoundary(mesh_, g))
    {
      seen[g] = 1;
      loop.halfEdges.push_back(g);
      loop.arc.push_back(loop.arc.back() + mesh_.edgeVector(g).norm());
      const Index input = inputAt(g);
      loop.jointPoint.push_back(input == kInvalidIndex ? kInvalidIndex : sheets_.jointPoint[input]);
    }
  }
}

SheetBorders::OnLoop SheetBorders::nearestOnLoops(Index sheet, const Vector3& p) const
{
  OnLoop best;
  for (std::size_t l = 0; l < fineLoops_.size(); ++l)
  {
    const FineLoop& loop = fineLoops_[l];
    for (std::size_t i = 0; loop.sheet == sheet && i < loop.halfEdges.size(); ++i)
    {
      const Index h = loop.halfEdges[i];
      const CurvePoint at = nearestOnEdge(h, p);
      const double length = mesh_.edgeVector(h).norm();
      const double distance =
        (mesh_.position[mesh_.origin[h]] + at.t * mesh_.edgeVector(h) - p).norm();
      if (distance < best.distance)
      {
        best = { l, at, loop.arc[i] + at.t * length, distance };
      }
    }
  }
  return best;
}

std::optional<SurfacePoint> SheetBorders::nearestOnFeatures(Index sheet, const Vector3& p) const
{
  std::optional<CurvePoint> best;
  double least = kInfinity;
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    if (mesh_.isBoundary(h) || !mesh_.isFeature(h) || h > mesh_.twin[h] ||
      sheetOfFace(Mesh::face(h)) != sheet)
    {
      continue;
    }
    const CurvePoint at = nearestOnEdge(h, p);
    const double distance = (positionOf(mesh_, at.onSurface()) - p).norm();
    if (distance < least)
    {
      least = distance;
      best = at;
    }
  }
  return best ? std::optional<SurfacePoint>(best->onSurface()) : std::nullopt;
}

CurvePoint SheetBorders::nearestOnEdge(Index h, const Vector3& p) const
{
  const Vector3 along = mesh_.edgeVector(h);
  const double squared = along.squaredNorm();
  const double t = squared > 0
    ? std::clamp((p - mesh_.position[mesh_.origin[h]]).dot(along) / squared, 0.0, 1.0)
    : 0.0;
  return { h, t };
}

void SheetBorders::move(Index p, Index sheet, const Vector3& to)
{
  const OnLoop place = nearestOnLoops(sheet, to);
  const SurfacePoint at = place.at.onSurface();
  quads_.points[p] = to;
  quads_.sourceFace[p] = at.face;
  quads_.sourceWeights[p] = at.weights;
}

} // namespace quadrille

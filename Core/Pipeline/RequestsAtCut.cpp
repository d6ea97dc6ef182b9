// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/RequestsAtCut.h"

#include "Mesh/NearestTriangle.h"
#include "Requests/HeldVertices.h"

#include <algorithm>
#include <map>
#include <utility>

namespace quadrille
{
namespace
{

/// By vertex of a mesh that was cut open, of which there are several at its place: a half-edge that leaves each.
std::map<Index, std::vector<Index>> cornersAtCut(
  const Mesh& opened, const std::vector<Index>& copied)
{
  const Index before = opened.vertexCount() - static_cast<Index>(copied.size());
  std::vector<Index> leaving(opened.vertexCount(), kInvalidIndex);
  for (Index h = 0; h < opened.halfEdgeCount(); ++h)
  {
    leaving[opened.origin[h]] = h;
  }
  std::map<Index, std::vector<Index>> corners;
  for (Index i = 0; i < copied.size(); ++i)
  {
    std::vector<Index>& there = corners[copied[i]];
    if (there.empty())
    {
      there.push_back(leaving[copied[i]]);
    }
    there.push_back(leaving[before + i]);
  }
  return corners;
}

} // namespace

void moveRequestsToSides(
  const std::vector<std::uint8_t>& isOut, const std::vector<Index>& copied, PreparedSurface& opened)
{
  if (opened.valenceRequests.empty() && opened.sectorRequests.empty())
  {
    return;
  }
  const Mesh& mesh = opened.mesh;
  const std::map<Index, std::vector<Index>> corners = cornersAtCut(mesh, copied);
  for (ValenceRequest& request : opened.valenceRequests)
  {
    const auto found = corners.find(request.vertex);
    if (found != corners.end())
    {
      const auto& there = found->second;
      request.vertex = mesh.origin[*std::find_if(
        there.begin(), there.end(), [&](Index h) { return isOut[Mesh::face(h)] != 0; })];
    }
  }
  sortByVertex(opened.valenceRequests);
  std::vector<SectorRequest> held;
  for (SectorRequest& request : opened.sectorRequests)
  {
    const auto found = corners.find(request.vertex);
    if (found == corners.end())
    {
      held.push_back(std::move(request));
      continue;
    }
    for (const Index h : found->second)
    {
      if (isOut[Mesh::face(h)] == 0)
      {
        held.push_back({ mesh.origin[h], sectorsLike(request.sectors, mesh, h) });
      }
    }
  }
  sortByVertex(held);
  opened.sectorRequests = std::move(held);
}

void divideCurves(const PreparedSurface& whole, const std::vector<std::uint8_t>& isOut,
  double within, std::vector<ComponentPart>& parts)
{
  if (whole.curves.empty())
  {
    return;
  }
  for (ComponentPart& part : parts)
  {
    part.curves.clear();
    part.surface.curves.clear();
  }
  const NearestTriangle triangles(trianglesOf(whole.mesh));
  const auto isInside = [&](const Vector3& place)
  {
    const NearestTriangle::Place at = *triangles.at(place);
    const std::vector<Index> there = triangles.within(at.point, within);
    return std::all_of(there.begin(), there.end(), [&](Index f) { return isOut[f] != 0; });
  };
  for (Index i = 0; i < whole.curves.size(); ++i)
  {
    const CurveRequest& curve = whole.curves[i];
    const bool passes = std::any_of(curve.points.begin(), curve.points.end(), isInside);
    ComponentPart& part = parts[passes ? 0 : 1];
    part.curves.push_back(i);
    part.surface.curves.push_back(curve);
  }
}

} // namespace quadrille

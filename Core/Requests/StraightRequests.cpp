// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/StraightRequests.h"

#include "Base/Lists.h"
#include "Mesh/BoundaryPlaces.h"
#include "Mesh/Distance.h"

#include <algorithm>
#include <utility>

namespace quadrille
{

namespace
{

/// At the end of a straight part.
constexpr int kCornerTurns = 1;

/// Walks along the boundary of a mesh between places.
class StraightFinder
{
public:
  explicit StraightFinder(const Mesh& mesh) : mesh_(mesh), boundary_(mesh) {}

  /// kInvalidIndex where there is no boundary.
  Index vertexAt(const Vector3& place) const { return boundary_.nearest(place); }

  std::vector<Index> find(const StraightRequest& request) const
  {
    const Index from = vertexAt(request.from);
    const Index to = vertexAt(request.to);
    if (from == kInvalidIndex || to == kInvalidIndex)
    {
      return {};
    }
    std::vector<Index> there = walk(from, to);
    if (request.isClosed())
    {
      return there;
    }
    std::vector<Index> back = walk(to, from);
    return distance(there, request.via) <= distance(back, request.via) ? there : back;
  }

private:
  /// All round where both are the same.
  std::vector<Index> walk(Index from, Index to) const
  {
    return boundary_.walk(from, to, [&](Index v) { return v == to || v == from; });
  }

  double distance(const std::vector<Index>& edges, const Vector3& place) const
  {
    double nearest = kInfinity;
    for (const Index h : edges)
    {
      nearest = std::min(nearest,
        distanceToSegment(place, mesh_.position[mesh_.origin[h]], mesh_.position[mesh_.target(h)]));
    }
    return nearest;
  }

  const Mesh& mesh_;
  BoundaryPlaces boundary_;
};

} // namespace

std::vector<std::vector<Index>> findStraightParts(
  const Mesh& mesh, const std::vector<StraightRequest>& requests)
{
  std::vector<std::vector<Index>> parts;
  if (!requests.empty())
  {
    const StraightFinder finder(mesh);
    for (const StraightRequest& request : requests)
    {
      parts.push_back(finder.find(request));
    }
  }
  return parts;
}

std::vector<Index> straightVertices(const Mesh& mesh, const std::vector<StraightRequest>& requests)
{
  std::vector<Index> vertices;
  if (requests.empty())
  {
    return vertices;
  }
  const StraightFinder finder(mesh);
  for (const StraightRequest& request : requests)
  {
    for (const Vector3& place : { request.from, request.via, request.to })
    {
      if (const Index v = finder.vertexAt(place); v != kInvalidIndex)
      {
        vertices.push_back(v);
      }
    }
  }
  sortUnique(vertices);
  return vertices;
}

OutsetMesh withOutset(Mesh mesh, const std::vector<StraightRequest>& requests, double length)
{
  const std::vector<std::vector<Index>> parts = findStraightParts(mesh, requests);
  const SharedArray<Vector3> positions = mesh.position;
  OutsetMesh result{ {}, requests };
  std::vector<std::uint8_t> isMoved(mesh.vertexCount(), 0);
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    const Vector3& outward = requests[i].outward;
    const auto move = [&](Vector3& p, Index v)
    { p += length * (mesh.sizing.empty() ? 1 : double{ mesh.sizing[v] }) * outward; };
    if (parts[i].empty())
    {
      continue;
    }
    const Index start = mesh.origin[parts[i].front()], end = mesh.target(parts[i].back());
    const bool isForth =
      (positions[start] - requests[i].from).norm() <= (positions[end] - requests[i].from).norm();
    for (const Index h : parts[i])
    {
      for (const Index v : { mesh.origin[h], mesh.target(h) })
      {
        if (isMoved[v] == 0)
        {
          isMoved[v] = 1;
          move(mesh.position.edit()[v], v);
        }
      }
    }
    result.requests[i].from = mesh.position[isForth ? start : end];
    result.requests[i].to = mesh.position[isForth ? end : start];
    move(result.requests[i].via, start);
  }
  result.mesh = std::move(mesh);
  return result;
}

std::vector<int> straightSectors(
  const Mesh& mesh, const std::vector<std::vector<Index>>& parts, std::vector<int> sectorTurns)
{
  // Counterclockwise from a boundary half-edge on: each constrained one begins a sector.
  const auto ask = [&](Index first, int turns)
  {
    std::vector<Index> sectors;
    forEachFrom(mesh, first,
      [&](Index h)
      {
        if (mesh.isConstrained(h))
        {
          sectors.push_back(h);
        }
      });
    if (static_cast<int>(sectors.size()) > turns)
    {
      return;
    }
    sectorTurns.resize(mesh.halfEdgeCount(), 0);
    for (const Index h : sectors)
    {
      sectorTurns[h] = turns / static_cast<int>(sectors.size());
    }
  };
  for (const std::vector<Index>& part : parts)
  {
    if (part.empty())
    {
      continue;
    }
    const Index end = mesh.target(part.back());
    const bool closed = mesh.origin[part.front()] == end;
    for (std::size_t i = 0; i < part.size(); ++i)
    {
      ask(part[i], closed || i > 0 ? kStraightTurns : kCornerTurns);
    }
    for (Index h = 0; h < mesh.halfEdgeCount() && !closed; ++h)
    {
      if (mesh.isBoundary(h) && mesh.origin[h] == end)
      {
        ask(h, kCornerTurns);
      }
    }
  }
  return sectorTurns;
}

} // namespace quadrille

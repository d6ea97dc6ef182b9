// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/SeamRequests.h"

#include "Base/Lists.h"
#include "Mesh/BoundaryPlaces.h"

#include <algorithm>

namespace quadrille
{

namespace
{

/// Walks along the boundary of a mesh between places.
class SeamFinder
{
public:
  SeamFinder(const Mesh& mesh, const std::vector<SeamRequest>& requests)
    : isEnd_(mesh.vertexCount(), 0), boundary_(mesh)
  {
    for (const SeamRequest& request : requests)
    {
      for (const Vector3& place : { request.from, request.to, request.imageFrom, request.imageTo })
      {
        ends_.push_back(boundary_.nearest(place));
        if (ends_.back() != kInvalidIndex)
        {
          isEnd_[ends_.back()] = 1;
        }
      }
    }
  }

  SeamEdges find(std::size_t i) const
  {
    const Index from = ends_[4 * i], to = ends_[4 * i + 1];
    const Index imageFrom = ends_[4 * i + 2], imageTo = ends_[4 * i + 3];
    SeamEdges edges{ walk(from, to), walk(imageTo, imageFrom) };
    if (edges.empty())
    {
      edges = { walk(to, from), walk(imageFrom, imageTo) };
    }
    return edges.empty() ? SeamEdges{} : edges;
  }

  const std::vector<Index>& ends() const { return ends_; }

private:
  std::vector<Index> walk(Index from, Index to) const
  {
    return boundary_.walk(from, to, [this](Index v) { return isEnd_[v] != 0; });
  }

  std::vector<Index> ends_; ///< four a request
  std::vector<std::uint8_t> isEnd_;
  BoundaryPlaces boundary_;
};

} // namespace

std::vector<SeamEdges> findSeams(const Mesh& mesh, const std::vector<SeamRequest>& requests)
{
  std::vector<SeamEdges> seams;
  if (requests.empty())
  {
    return seams;
  }
  const SeamFinder finder(mesh, requests);
  for (std::size_t i = 0; i < requests.size(); ++i)
  {
    seams.push_back(finder.find(i));
  }
  return seams;
}

std::vector<Index> seamVertices(const Mesh& mesh, const std::vector<SeamRequest>& requests)
{
  if (requests.empty())
  {
    return {};
  }
  std::vector<Index> vertices = SeamFinder(mesh, requests).ends();
  sortUnique(vertices);
  eraseIf(vertices, [](Index v) { return v == kInvalidIndex; });
  return vertices;
}

std::vector<int> seamSectors(
  const Mesh& mesh, const std::vector<SeamEdges>& seams, std::vector<int> sectorTurns)
{
  std::vector<std::uint8_t> isFeature(seams.empty() ? 0 : mesh.vertexCount(), 0);
  for (Index h = 0; h < mesh.halfEdgeCount() && !seams.empty(); ++h)
  {
    if (!mesh.isBoundary(h) && mesh.isFeature(h))
    {
      isFeature[mesh.origin[h]] = 1;
    }
  }
  const auto straighten = [&](const std::vector<Index>& edges)
  {
    // A closed part runs straight at its end, too.
    const bool closed = mesh.origin[edges.front()] == mesh.target(edges.back());
    for (std::size_t i = closed ? 0 : 1; i < edges.size(); ++i)
    {
      const Index h = edges[i];
      const bool single = mesh.isBoundary(Mesh::previous(h));
      if (isFeature[mesh.origin[h]] == 0 && !single)
      {
        sectorTurns.resize(mesh.halfEdgeCount(), 0);
        sectorTurns[h] = kStraightTurns;
      }
    }
  };
  for (const SeamEdges& seam : seams)
  {
    if (!seam.empty())
    {
      straighten(seam.left);
      straighten(seam.right);
    }
  }
  return sectorTurns;
}

} // namespace quadrille

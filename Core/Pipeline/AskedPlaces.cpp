// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/DetailSteps.h"

#include "Base/Lists.h"
#include "Requests/Guides.h"

#include <algorithm>
#include <cstddef>
#include <map>

namespace quadrille
{
namespace
{

/// The vertices at the same places of another surface, of several at one place that of the lowest id; a request without
/// one is dropped. requests: ascending by vertex, before and afterwards.
template <class Request>
void moveRequests(
  const Mesh& mesh, const std::vector<Vector3>& places, std::vector<Request>& requests)
{
  if (requests.empty())
  {
    return;
  }
  const auto isBefore = [](const Vector3& a, const Vector3& b)
  { return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3); };
  std::map<Vector3, Index, decltype(isBefore)> vertexAt(isBefore);
  for (const Vector3& p : places)
  {
    vertexAt.emplace(p, kInvalidIndex);
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    const auto found = vertexAt.find(mesh.position[v]);
    if (found != vertexAt.end() && found->second == kInvalidIndex)
    {
      found->second = v;
    }
  }
  for (std::size_t i = 0; i < requests.size(); ++i)
  {
    requests[i].vertex = vertexAt.at(places[i]);
  }
  eraseIf(requests, [](const Request& request) { return request.vertex == kInvalidIndex; });
  sortByVertex(requests);
}

} // namespace

AskedPlaces askedPlaces(const PreparedSurface& surface)
{
  AskedPlaces asked{ surface.requests(), {}, {} };
  for (const ValenceRequest& request : surface.valenceRequests)
  {
    asked.valencePlaces.push_back(surface.mesh.position[request.vertex]);
  }
  for (const SectorRequest& request : surface.sectorRequests)
  {
    asked.sectorPlaces.push_back(surface.mesh.position[request.vertex]);
  }
  return asked;
}

void ask(const AskedPlaces& asked, PreparedSurface& surface, double edgeLength, int threads)
{
  surface.setRequests(asked.requests);
  placeStrokes(surface, edgeLength, threads);
  moveRequests(surface.mesh, asked.valencePlaces, surface.valenceRequests);
  moveRequests(surface.mesh, asked.sectorPlaces, surface.sectorRequests);
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/ThinnedSurface.h"

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Mesh/ContentHash.h"
#include "Mesh/Topology.h"
#include "Pieces/CarriedPlaces.h"
#include "Pieces/PlaceOnSource.h"

#include <algorithm>
#include <utility>

namespace quadrille
{
ThinnedSurface::ThinnedSurface(PreparedSurface fine, const PieceOptions& options)
  : fine_(std::move(fine)), closedLoop_(options.closedLoop), quadEdge_(options.quadEdge)
{
  HierarchyOptions thinning;
  thinning.targetEdgeLength = 2 * options.edgeLength; // phase 1 ends at a half of it
  thinning.isRough = true;
  thinning.isConnected = fine_.components == 1;
  for (const ValenceRequest& request : fine_.valenceRequests)
  {
    thinning.keepVertices.push_back(request.vertex);
  }
  thinning.threads = options.threads;
  thinning.progress = options.progress;
  Hierarchy made = Redecimation(fine_.mesh, fine_.hash, thinning).take();
  level_ = std::move(made.intermediate);
  log_ = std::move(made.log);
  handles_ = findShortHandles(fine_.mesh, level_, closedLoop_, quadEdge_, {}, options.threads);
}

PreparedSurface ThinnedSurface::surface(int threads, std::vector<SmallDetail>& closed) const
{
  PreparedSurface thinned;
  thinned.mesh = level_.mesh;
  thinned.repair = fine_.repair;
  thinned.facets = fine_.facets;
  thinned.area = fine_.area;
  thinned.boundingBoxDiagonal = fine_.boundingBoxDiagonal;
  thinned.components = fine_.components;
  thinned.setRequests(requests());
  thinned.hash = contentHash(thinned.mesh, threads);
  const Mesh& mesh = thinned.mesh;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    thinned.sourcePolygon.push_back(f);
    thinned.sourcePoints.push_back(
      { mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] });
  }
  if (!handles_.empty())
  {
    std::vector<std::vector<Index>> places(handles_.size());
    std::transform(handles_.begin(), handles_.end(), places.begin(),
      [](const ShortHandle& handle) { return handle.onLevel; });
    closed = cutShortHandles(thinned, handles_, places, closedLoop_, quadEdge_, threads);
  }
  return thinned;
}

SurfaceRequests ThinnedSurface::requests() const
{
  SurfaceRequests asked = fine_.requests();
  for (ValenceRequest& request : asked.valenceRequests)
  {
    const auto kept =
      std::lower_bound(level_.fineVertex.begin(), level_.fineVertex.end(), request.vertex);
    request.vertex = static_cast<Index>(kept - level_.fineVertex.begin());
  }
  return asked;
}

std::vector<Index> ThinnedSurface::polygonsBeside() const
{
  std::vector<Index> polygons(level_.fineFace.size());
  std::transform(level_.fineFace.begin(), level_.fineFace.end(), polygons.begin(),
    [this](Index f) { return fine_.sourcePolygon[f]; });
  return polygons;
}

void ThinnedSurface::putOnInput(FailedParts& failed) const
{
  if (failed.polygons.empty())
  {
    return;
  }
  Index components = 0;
  const std::vector<Index> componentOf = faceComponents(fine_.mesh, components);
  std::vector<std::uint8_t> isFailed(components, 0);
  for (const Index triangle : failed.polygons)
  {
    isFailed[componentOf[level_.fineFace[triangle]]] = 1;
  }
  failed.polygons.clear();
  for (Index f = 0; f < componentOf.size(); ++f)
  {
    if (isFailed[componentOf[f]] != 0)
    {
      failed.polygons.push_back(fine_.sourcePolygon[f]);
    }
  }
  sortUnique(failed.polygons);
}

std::vector<Vector3> ThinnedSurface::userPoints(
  const Frame& frame, const std::vector<Vector3>& points) const
{
  const Mesh& fine = fine_.mesh;
  std::vector<Index> corner(fine.vertexCount(), kInvalidIndex);
  for (Index h = 0; h < fine.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    corner[fine.origin[h]] = h;
  }
  std::vector<Vector3> positions;
  positions.reserve(level_.fineVertex.size());
  for (const Index v : level_.fineVertex)
  {
    positions.push_back(userPosition(fine_, corner[v], frame, points));
  }
  return positions;
}

ThinnedSurface::Places ThinnedSurface::carry(const QuadMesh& quads, const PreparedSurface& mapped,
  const std::vector<Vector3>& userPoints, int threads, const ProgressCallback& progress)
{
  const SourceTriangles source{ level_.mesh.origin, userPoints };
  Places made;
  made.ofPoints.resize(quads.points.size());
  made.ofQuads.resize(quads.quads.size());
  const PlacesOfQuads found = placesOfQuads(mapped, quads, source);
  const std::vector<SurfacePoint> onFine =
    carryPlaces(level_, log_, log_.rounds.size(), found.places, threads, progress);
  log_ = {};
  for (std::size_t i = 0; i < onFine.size(); ++i)
  {
    const std::size_t who = found.whose[i];
    SourceLocation& at =
      who < made.ofPoints.size() ? made.ofPoints[who] : made.ofQuads[who - made.ofPoints.size()];
    at = fine_.locate(onFine[i].face, onFine[i].weights);
  }
  return made;
}

void putOnInput(const std::vector<SourceLocation>& places, const std::vector<Vector3>& points,
  std::vector<Vector3>& quadPoints)
{
  for (std::size_t p = 0; p < quadPoints.size(); ++p)
  {
    const SourceLocation& at = places[p];
    if (at.polygon != kInvalidIndex)
    {
      quadPoints[p] = at.weights[0] * points[at.points[0]] + at.weights[1] * points[at.points[1]] +
        at.weights[2] * points[at.points[2]];
    }
  }
}

} // namespace quadrille

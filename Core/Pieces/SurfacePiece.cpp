// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/SurfacePiece.h"

#include "Base/Clock.h"
#include "Base/Lists.h"
#include "Base/Refuse.h"
#include "Features/Features.h"
#include "Mesh/NearestTriangle.h"
#include "Mesh/Topology.h"
#include "Pipeline/PlannedSurface.h"
#include "Pipeline/QuadsOfShape.h"
#include "Pipeline/ResultStore.h"
#include "Pipeline/SmallParts.h"
#include "Prepare/Prepare.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace quadrille
{
namespace
{

/// Edges over the smallest ones of quads that are asked for, where these are much smaller than s: those of the
/// intermediate level.
constexpr double kEdgeOfSmallest = 0.5;

} // namespace

PieceOptions pieceOptionsOf(const RemeshOptions& options, double area, double boundingBoxDiagonal)
{
  PieceOptions piece;
  const std::optional<std::size_t> quads = mostQuads(options);
  const double s = quads ? std::sqrt(area / static_cast<double>(*quads))
    : options.edgeLength ? *options.edgeLength
                         : options.relativeEdgeLength * boundingBoxDiagonal;
  piece.edgeLength = s *
    (options.sizes.any() ? std::min(kEdgeOfPiece, kEdgeOfSmallest * options.sizes.smallest)
                         : kEdgeOfPiece);
  piece.featureAngle = options.featureAngle;
  piece.quadEdge = s;
  // Where sizes vary, a handle is short against the size there, which the whole surface knows.
  if (maySimplify(options) && !options.sizes.any())
  {
    piece.closedLoop = s *
      std::max(options.smallestDetail,
        options.smallDetails == SmallDetails::Simplify ? kQuadsOfLoop : 0.0);
  }
  return piece;
}

SurfacePiece::SurfacePiece(SurfaceInput input, const PieceOptions& options)
  : options_(options), handles_(options.closedLoop, options.quadEdge)
{
  refuseIf(!(options.edgeLength > 0) || !std::isfinite(options.edgeLength),
    "the edge length of the pieces of a surface must be above 0 and finite.");
  PrepareOptions prepare;
  prepare.featureAngle = options.featureAngle;
  prepare.threads = options.threads;
  prepare.progress = options.progress;
  const std::size_t polygons = input.polygonOffsets.empty() ? 0 : input.polygonOffsets.size() - 1;
  surface_ = prepareSurface(std::move(input), prepare);
  for (const auto& [name, seconds] : surface_.seconds)
  {
    stages_.add(name, seconds, polygons, surface_.mesh.faceCount());
  }
  findInputPoints();
  findBoundary();
}

void SurfacePiece::thinOut(const std::vector<Index>& shared)
{
  Mesh& mesh = surface_.mesh;
  Stopwatch watch;
  Hierarchy made = decimate(shared);
  stages_.add("phase1", watch.lap(), mesh.faceCount(), made.intermediate.mesh.faceCount());
  if (closeHandles(made.intermediate, shared))
  {
    made = decimate(shared);
  }
  stages_.add("handles", watch.lap(), mesh.faceCount(), handles_.closed().size());
  const std::vector<BorderNormal> border = borderNormals(shared);
  level_ = std::move(made.intermediate);
  log_ = std::move(made.log);
  tellLevel(shared);
  tellBorder(border);
  letGo();
}

std::vector<CarriedPlace> SurfacePiece::carry(const std::vector<SurfacePoint>& places)
{
  Stopwatch watch;
  const std::vector<SurfacePoint> onPiece =
    carryPlaces(level_, log_, log_.rounds.size(), places, options_.threads, options_.progress);
  stages_.add("carry", watch.lap(), places.size(), places.size());
  log_ = {};
  level_ = {};
  std::vector<CarriedPlace> result(places.size());
  std::transform(onPiece.begin(), onPiece.end(), result.begin(),
    [this](const SurfacePoint& place) {
      return CarriedPlace{ surface_.locate(place.face, place.weights), handles_.offInput(place) };
    });
  return result;
}

std::size_t SurfacePiece::bytes() const
{
  return bytesOf(surface_) + bytesOf(inputPoint_) + bytesOf(boundary_) + log_.recordBytes() +
    bytesOf(level_.mesh);
}

Hierarchy SurfacePiece::decimate(const std::vector<Index>& shared) const
{
  HierarchyOptions hierarchy;
  hierarchy.targetEdgeLength = 2 * options_.edgeLength; // phase 1 ends at a half of it
  hierarchy.threads = options_.threads;
  hierarchy.progress = options_.progress;
  hierarchy.keepVertices =
    idsWhere(surface_.mesh.vertexCount(), [&](Index v) { return isShared(v, shared); });
  return Redecimation(surface_.mesh, surface_.hash, hierarchy).take();
}

bool SurfacePiece::isShared(Index v, const std::vector<Index>& shared) const
{
  return !handles_.isNew(v) && std::binary_search(shared.begin(), shared.end(), inputPoint_[v]);
}

std::vector<Vector3> SurfacePiece::placesOf(
  const std::vector<Index>& shared, const Level& level) const
{
  std::vector<Vector3> places;
  for (const Index v : level.fineVertex)
  {
    if (isShared(v, shared))
    {
      places.push_back(surface_.mesh.position[v]);
    }
  }
  return places;
}

bool SurfacePiece::closeHandles(const Level& level, const std::vector<Index>& shared)
{
  if (!(options_.closedLoop > 0) ||
    !std::includes(boundary_.begin(), boundary_.end(), shared.begin(), shared.end()) ||
    !handles_.close(surface_, level, placesOf(shared, level), options_.threads))
  {
    return false;
  }
  findInputPoints();
  return true;
}

/// What only the decimation needed: to carry a place takes the log, and the polygon of each face.
void SurfacePiece::letGo()
{
  surface_.mesh = {};
  std::vector<Index>().swap(inputPoint_);
  std::vector<Index>().swap(boundary_);
}

std::vector<SurfacePiece::BorderNormal> SurfacePiece::borderNormals(
  const std::vector<Index>& shared) const
{
  const Mesh& mesh = surface_.mesh;
  if (!options_.featureAngle || shared.empty())
  {
    return {};
  }
  const std::vector<Index> halfEdges = elementsWhere(boundaryHalfEdges(mesh, options_.threads),
    [&](Index h) { return isShared(mesh.origin[h], shared) && isShared(mesh.target(h), shared); });
  const std::vector<Vector3> normals = normalsBeside(mesh, halfEdges, options_.threads);
  std::vector<BorderNormal> border;
  for (std::size_t i = 0; i < halfEdges.size(); ++i)
  {
    border.push_back({ { mesh.origin[halfEdges[i]], mesh.target(halfEdges[i]) }, normals[i] });
  }
  std::sort(border.begin(), border.end());
  return border;
}

void SurfacePiece::tellBorder(const std::vector<BorderNormal>& border)
{
  const Mesh& mesh = level_.mesh;
  for (Index h = 0; h < mesh.halfEdgeCount() && !border.empty(); ++h)
  {
    if (!mesh.isBoundary(h))
    {
      continue;
    }
    const BorderNormal wanted{
      { level_.fineVertex[mesh.origin[h]], level_.fineVertex[mesh.target(h)] }, {}
    };
    const auto found = std::lower_bound(border.begin(), border.end(), wanted);
    if (found != border.end() && found->ends == wanted.ends)
    {
      told_.border.push_back({ Mesh::face(h), h % 3, found->normal });
    }
  }
}

/// Of each vertex the lowest id of the points that repair has joined there.
void SurfacePiece::findInputPoints()
{
  const Mesh& mesh = surface_.mesh;
  inputPoint_.assign(mesh.vertexCount(), kInvalidIndex);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    Index& point = inputPoint_[mesh.origin[h]];
    point = std::min(point, surface_.sourcePoints[Mesh::face(h)][h % 3]);
  }
}

void SurfacePiece::findBoundary()
{
  const Mesh& mesh = surface_.mesh;
  for (const Index h : boundaryHalfEdges(mesh, options_.threads))
  {
    boundary_.push_back(inputPoint_[mesh.origin[h]]);
    boundary_.push_back(inputPoint_[mesh.target(h)]);
  }
  sortUnique(boundary_);
}

void SurfacePiece::tellLevel(const std::vector<Index>& shared)
{
  const Mesh& mesh = level_.mesh;
  TriangleList triangles = trianglesOf(mesh);
  told_.points = std::move(triangles.points);
  told_.triangles = std::move(triangles.corners);
  for (const Index v : level_.fineVertex)
  {
    told_.inputPoint.push_back(inputPoint_[v]);
    told_.shared.push_back(isShared(v, shared) ? 1 : 0);
  }
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    unsigned detected = 0, requested = 0;
    for (Index i = 0; i < 3; ++i)
    {
      const unsigned flags = mesh.flags[3 * f + i];
      const bool isRequested = (flags & kRequestedFeature) != 0;
      detected |= ((flags & kFeatureEdge) != 0 && !isRequested ? 1U : 0U) << i;
      requested |= (isRequested ? 1U : 0U) << i;
    }
    told_.detectedFeatures.push_back(static_cast<std::uint8_t>(detected));
    told_.requestedFeatures.push_back(static_cast<std::uint8_t>(requested));
  }
}

} // namespace quadrille

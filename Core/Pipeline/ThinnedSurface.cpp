// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/ThinnedSurface.h"

#include "Base/Progress.h"
#include "Mesh/ContentHash.h"
#include "Transfer/CarriedPlaces.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace quadrille
{
namespace
{

/// By how much a point may be off the place that its source names, over the size of the triangle.
constexpr double kSamePlace = 1e-6;

/// What carries places of the mapped surface to triangles of the thinned one.
class OnThinned
{
public:
  OnThinned(const Mesh& thinned, const PreparedSurface& mapped, const std::vector<Vector3>& points)
    : thinned_(thinned), mapped_(mapped), points_(points)
  {
  }

  /// None where the place is on no triangle, or where `point` lies elsewhere.
  std::optional<FacePlace> find(
    Index face, const std::array<double, 3>& weights, const Vector3* point) const
  {
    const SourceLocation at = mapped_.locate(face, weights);
    if (at.polygon >= thinned_.faceCount())
    {
      return std::nullopt;
    }
    const Index* const corners = &thinned_.origin[3 * std::size_t{ at.polygon }];
    FacePlace found;
    found.face = at.polygon;
    Vector3 place = Vector3::Zero();
    double sum = 0, size = 0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto corner = std::find(at.points.begin(), at.points.end(), corners[k]);
      if (corner == at.points.end())
      {
        return std::nullopt;
      }
      double& weight = found.weights[k];
      weight = std::max(0.0, at.weights[static_cast<std::size_t>(corner - at.points.begin())]);
      sum += weight;
      place += weight * points_[corners[k]];
      size = std::max(size, (points_[corners[k]] - points_[corners[0]]).norm());
    }
    if (!(sum > 0) || (point != nullptr && !((place / sum - *point).norm() <= kSamePlace * size)))
    {
      return std::nullopt;
    }
    for (double& weight : found.weights)
    {
      weight /= sum;
    }
    return found;
  }

private:
  const Mesh& thinned_;
  const PreparedSurface& mapped_;
  const std::vector<Vector3>& points_;
};

/// Of a quad that is no unit square of the map its face is all that is known.
std::array<double, 3> centreWeights(const std::array<double, 3>& weights)
{
  return weights[0] + weights[1] + weights[2] > 0 ? weights
                                                  : std::array{ 1.0 / 3, 1.0 / 3, 1.0 / 3 };
}

} // namespace

ThinnedSurface::ThinnedSurface(
  PreparedSurface fine, double edgeLength, int threads, const ProgressCallback& progress)
  : fine_(std::move(fine))
{
  HierarchyOptions options;
  options.targetEdgeLength = 2 * edgeLength; // phase 1 ends at a half of it
  options.isRough = true;
  options.isConnected = fine_.components == 1;
  options.threads = threads;
  options.progress = progress;
  Hierarchy made = Redecimation(fine_.mesh, fine_.hash, options).take();
  level_ = std::move(made.intermediate);
  log_ = std::move(made.log);
}

PreparedSurface ThinnedSurface::surface(int threads) const
{
  PreparedSurface thinned;
  thinned.mesh = level_.mesh;
  thinned.repair = fine_.repair;
  thinned.facets = fine_.facets;
  thinned.area = fine_.area;
  thinned.boundingBoxDiagonal = fine_.boundingBoxDiagonal;
  thinned.components = fine_.components;
  thinned.hash = contentHash(thinned.mesh, threads);
  const Mesh& mesh = thinned.mesh;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    thinned.sourcePolygon.push_back(f);
    thinned.sourcePoints.push_back(
      { mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] });
  }
  return thinned;
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
  const OnThinned onThinned(level_.mesh, mapped, userPoints);
  Places made;
  made.ofPoints.resize(quads.points.size());
  made.ofQuads.resize(quads.quads.size());
  std::vector<FacePlace> places;
  std::vector<SourceLocation*> whose;
  const auto add = [&](const std::optional<FacePlace>& place, SourceLocation& who)
  {
    if (place)
    {
      places.push_back(*place);
      whose.push_back(&who);
    }
  };
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    add(onThinned.find(quads.sourceFace[p], quads.sourceWeights[p], &quads.points[p]),
      made.ofPoints[p]);
  }
  for (std::size_t q = 0; q < quads.quads.size(); ++q)
  {
    add(onThinned.find(quads.quadSourceFace[q], centreWeights(quads.quadSourceWeights[q]), nullptr),
      made.ofQuads[q]);
  }
  const std::vector<FacePlace> onFine =
    carryPlaces(fine_.mesh, level_, log_, places, threads, progress);
  log_ = {};
  for (std::size_t i = 0; i < onFine.size(); ++i)
  {
    *whose[i] = fine_.locate(onFine[i].face, onFine[i].weights);
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

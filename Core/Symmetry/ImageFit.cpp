// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/ImageFit.h"

#include "Base/Parallel.h"
#include "Pipeline/PlannedSurface.h"
#include "Quads/QuadProjection.h"
#include "Quads/QuadShape.h"

#include <algorithm>
#include <array>
#include <utility>

namespace quadrille
{

namespace
{

/// How often moves are evened out before points go to the nearest place again: first the surface is followed as a
/// whole, then in its detail.
constexpr std::array<int, 8> kEvenings{ 64, 32, 16, 8, 4, 2, 1, 1 };

/// Edges of the boundary, or features inside.
TriangleList linesOf(const Mesh& mesh, bool boundary)
{
  TriangleList list;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const bool wanted =
      boundary ? mesh.isBoundary(h) : !mesh.isBoundary(h) && mesh.isFeature(h) && h < mesh.twin[h];
    if (wanted)
    {
      list.addSegment(mesh.position[mesh.origin[h]], mesh.position[mesh.target(h)]);
    }
  }
  return list;
}

class ImageFit
{
public:
  ImageFit(
    CopiedQuads& copied, const SearchedSurface& whole, double tolerance, double reach, int threads)
    : copied_(copied), quads_(copied.quads), whole_(whole), tolerance_(tolerance), reach_(reach),
      threads_(threads), first_(copied.partPoints),
      count_(copied.quads.points.size() - copied.partPoints)
  {
  }

  FittedImages run()
  {
    normals_ = pointNormals(quads_.points, quads_.quads);
    findLines();
    targets_.assign(
      quads_.points.begin() + static_cast<std::ptrdiff_t>(first_), quads_.points.end());
    const std::vector<Vector3> exact = targets_;
    std::vector<Vector3> nearest = nearestPlaces();
    std::vector<std::uint8_t> isOff(count_, 0);
    FittedImages fit;
    for (std::size_t i = 0; i < count_; ++i)
    {
      const double distance = (nearest[i] - exact[i]).norm();
      isOff[i] = distance > tolerance_ ? 1 : 0;
      fit.moved += isOff[i];
      if (isOff[i] != 0 && distance > fit.farthest)
      {
        fit.farthest = distance;
        fit.place = exact[i];
      }
    }
    for (const int evenings : kEvenings)
    {
      if (fit.moved == 0)
      {
        break;
      }
      aim(exact, nearest, evenings);
      nearest = nearestPlaces();
    }
    for (std::size_t i = 0; i < count_; ++i)
    {
      quads_.points[first_ + i] = isOff[i] != 0 ? nearest[i] : exact[i];
    }
    locate(fit);
    return fit;
  }

private:
  void findLines()
  {
    onFeature_.assign(quads_.points.size(), 0);
    for (const QuadLine& line : quads_.lines)
    {
      if (!line.boundary)
      {
        onFeature_[line.a] = onFeature_[line.b] = 1;
      }
    }
  }

  Vector3 nearestPlace(std::size_t i) const
  {
    const std::size_t point = first_ + i;
    const NearestTriangle& lines =
      quads_.onBoundary[point] != 0 ? whole_.boundary : whole_.features;
    if (quads_.onBoundary[point] != 0 || onFeature_[point] != 0)
    {
      if (const auto place = lines.at(targets_[i], Vector3::Zero(), reach_))
      {
        return place->point;
      }
    }
    return whole_.nearestFace(targets_[i], normals_[point]).point;
  }

  std::vector<Vector3> nearestPlaces() const
  {
    std::vector<Vector3> places(count_);
    parallelForEach(
      count_, kHeavyChunk, threads_, [&](std::size_t i) { places[i] = nearestPlace(i); });
    return places;
  }

  /// Targets become the exact images, moved as the nearest places are, but evenly.
  void aim(const std::vector<Vector3>& exact, const std::vector<Vector3>& nearest, int evenings)
  {
    std::vector<Vector3> moves(quads_.points.size(), Vector3::Zero());
    for (std::size_t i = 0; i < count_; ++i)
    {
      moves[first_ + i] = nearest[i] - exact[i];
    }
    for (int k = 0; k < evenings; ++k)
    {
      evenOut(moves);
    }
    for (std::size_t i = 0; i < count_; ++i)
    {
      targets_[i] = exact[i] + moves[first_ + i];
    }
  }

  /// Each move becomes the mean over the quads round the point; points in the plane stay.
  void evenOut(std::vector<Vector3>& moves) const
  {
    std::vector<Vector3> sum(moves.size(), Vector3::Zero());
    std::vector<double> weight(moves.size(), 0);
    for (std::size_t q = copied_.partQuads; q < quads_.quads.size(); ++q)
    {
      const std::array<Index, 4>& quad = quads_.quads[q];
      const Vector3 mean = (moves[quad[0]] + moves[quad[1]] + moves[quad[2]] + moves[quad[3]]) / 4;
      for (const Index corner : quad)
      {
        sum[corner] += mean;
        weight[corner] += 1;
      }
    }
    for (std::size_t p = first_; p < moves.size(); ++p)
    {
      moves[p] = sum[p] / std::max(weight[p], 1.0);
    }
  }

  void locate(FittedImages& fit) const
  {
    fit.images.resize(count_);
    fit.quadPolygons.resize(quads_.quads.size() - copied_.partQuads);
    const PreparedSurface& surface = whole_.surface;
    parallelForEach(count_, kHeavyChunk, threads_,
      [&](std::size_t i)
      {
        const auto at = whole_.nearestFace(quads_.points[first_ + i], normals_[first_ + i]);
        fit.images[i] = surface.locate(at.triangle, at.weights);
      });
    parallelForEach(fit.quadPolygons.size(), kHeavyChunk, threads_,
      [&](std::size_t q)
      {
        const std::array<Index, 4>& quad = quads_.quads[copied_.partQuads + q];
        const Vector3 centre = (quads_.points[quad[0]] + quads_.points[quad[1]] +
                                 quads_.points[quad[2]] + quads_.points[quad[3]]) /
          4;
        const Vector3 normal = diagonalNormal(cornersOf(quads_.points, quad));
        fit.quadPolygons[q] = surface.sourcePolygon[whole_.nearestFace(centre, normal).triangle];
      });
  }

  CopiedQuads& copied_;
  QuadMesh& quads_;
  const SearchedSurface& whole_;
  double tolerance_, reach_;
  int threads_;
  std::size_t first_, count_;
  std::vector<Vector3> normals_; ///< per point
  std::vector<std::uint8_t> onFeature_;
  std::vector<Vector3> targets_; ///< per image: where it would go
};

} // namespace

SearchedSurface::SearchedSurface(PreparedSurface prepared)
  : surface(std::move(prepared)), faces(trianglesOf(surface.mesh)),
    features(linesOf(surface.mesh, false)), boundary(linesOf(surface.mesh, true))
{
}

NearestTriangle::Place SearchedSurface::nearestFace(const Vector3& p, const Vector3& normal) const
{
  const auto facing = faces.at(p, normal);
  return facing ? *facing : *faces.at(p);
}

std::size_t SearchedSurface::bytes() const
{
  return bytesOf(surface) + faces.bytes() + features.bytes() + boundary.bytes();
}

FittedImages fitImages(
  CopiedQuads& copied, const SearchedSurface& whole, double tolerance, double reach, int threads)
{
  return ImageFit(copied, whole, tolerance, reach, threads).run();
}

} // namespace quadrille

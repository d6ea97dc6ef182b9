// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/PartSources.h"

#include "Base/Parallel.h"

#include <algorithm>

namespace quadrille
{

namespace
{

/// The faces of the whole under faces of images that come one after the other.
class NearImages
{
public:
  NearImages(const SearchedSurface& whole, double deviation, double tolerance)
    : whole_(whole), mesh_(whole.surface.mesh), deviation_(deviation), tolerance_(tolerance)
  {
  }

  /// The face of the whole under the centre of face f.
  Index faceUnder(const Mesh& images, Index f)
  {
    const std::array<Vector3, 3> corners = images.cornersOfFace(f);
    const Vector3 centre = (corners[0] + corners[1] + corners[2]) / 3;
    const Vector3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (!climb(centre, normal))
    {
      const NearestTriangle::Place place = whole_.nearestFace(centre, normal);
      face_ = place.triangle;
      searched_ = centre;
      distance_ = place.distance;
    }
    return face_;
  }

  /// The corners of face f, each at the nearest corner of the face under it.
  FaceWeights weightsIn(Index found, const Mesh& images, Index f) const
  {
    const std::array<Vector3, 3> corners = images.cornersOfFace(f);
    FaceWeights weights{};
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto distance = [&](Index k)
      { return (mesh_.position[mesh_.origin[3 * found + k]] - corners[i]).squaredNorm(); };
      Index best = 0;
      for (const Index k : { 1U, 2U })
      {
        best = distance(k) < distance(best) ? k : best;
      }
      weights[i][best] = 1;
    }
    return weights;
  }

private:
  /// From face to face, nearer to the place each time: a small part of the time of a search in the tree, where the
  /// place is beside the surface. False where that ends too far away or on the other side of a wall: the distance can
  /// have grown by no more than the way from where it was found.
  bool climb(const Vector3& p, const Vector3& normal)
  {
    if (face_ == kInvalidIndex)
    {
      return false;
    }
    Index face = face_;
    double distance = whole_.faces.on(face, p).distance;
    for (bool moves = true; moves;)
    {
      moves = false;
      for (Index h = 3 * face; h < 3 * face + 3; ++h)
      {
        const Index next = mesh_.isBoundary(h) ? face : Mesh::face(mesh_.twin[h]);
        const double nearer = whole_.faces.on(next, p).distance;
        if (nearer < distance)
        {
          face = next;
          distance = nearer;
          moves = true;
          break;
        }
      }
    }
    const Vector3 across = mesh_.edgeVector(3 * face).cross(mesh_.edgeVector(3 * face + 1));
    const double farther = std::min((p - searched_).norm(), 2 * deviation_);
    const bool isNear = distance <= 1.25 * distance_ + farther + 1e-3 * tolerance_;
    if (isNear && across.dot(normal) > 0)
    {
      face_ = face;
      return true;
    }
    return false;
  }

  const SearchedSurface& whole_;
  const Mesh& mesh_;
  double deviation_, tolerance_;
  Index face_ = kInvalidIndex;         ///< under the last place
  Vector3 searched_ = Vector3::Zero(); ///< the last place that was searched for in the tree
  double distance_ = 0;                ///< from there
};

} // namespace

FaceWeights PartSources::weightsOf(Index f) const
{
  const Index t = made_.sourcePolygon[f];
  FaceWeights inPart = kWholeFace;
  if (!made_.refinedEntry.empty() && made_.refinedEntry[f] != kInvalidIndex)
  {
    inPart = made_.cornerWeights[made_.refinedEntry[f]];
  }
  FaceWeights corners;
  for (std::size_t k = 0; k < 3; ++k)
  {
    corners[k] = part_.weights[t][cornerOf(t, made_.sourcePoints[f][k])];
  }
  return composed(inPart, corners);
}

/// Of triangle t of the part: the corner at this point, or, where repair has moved it, the one nearest to it.
std::size_t PartSources::cornerOf(Index t, Index point) const
{
  const SurfaceInput& input = part_.input;
  const Vector3& p = input.points[point];
  std::size_t best = 0;
  for (std::size_t i = 1; i < 3; ++i)
  {
    const auto distance = [&](std::size_t k)
    { return (input.points[input.polygonPoints[3 * t + k]] - p).squaredNorm(); };
    best = distance(i) < distance(best) ? i : best;
  }
  return best;
}

SourceLocation PartSources::locate(Index f, const std::array<double, 3>& weights) const
{
  const SourceLocation inPart = made_.locate(f, weights);
  const Index t = inPart.polygon;
  std::array<double, 3> sum{};
  for (std::size_t i = 0; i < 3; ++i)
  {
    const std::array<double, 3>& corner = part_.weights[t][cornerOf(t, inPart.points[i])];
    for (std::size_t k = 0; k < 3; ++k)
    {
      sum[k] += inPart.weights[i] * corner[k];
    }
  }
  return whole_.surface.locate(part_.face[t], sum);
}

ImageSources PartSources::ofImages(
  const CopiedMesh& copied, double deviation, double tolerance, int threads) const
{
  ImageSources images;
  const Index count = copied.mesh.faceCount() - copied.partFaces;
  images.face.resize(count);
  images.weights.resize(count);
  parallelFor(count, kMediumChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      NearImages near(whole_, deviation, tolerance);
      for (std::size_t i = begin; i < end; ++i)
      {
        const Index f = copied.partFaces + static_cast<Index>(i);
        images.face[i] = near.faceUnder(copied.mesh, f);
        images.weights[i] = near.weightsIn(images.face[i], copied.mesh, f);
      }
    });
  return images;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/FlatSources.h"

#include "Base/Lists.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace quadrille
{
namespace
{

TriangleList trianglesOf(const Mesh& mesh, const std::vector<Index>& faces)
{
  TriangleList triangles;
  for (const Index f : faces)
  {
    const std::array<Vector3, 3> corners = mesh.cornersOfFace(f);
    triangles.add(corners[0], corners[1], corners[2]);
  }
  return triangles;
}

/// Barycentric coordinates in face f of the foot of a place in its plane, which may lie outside of the face.
std::array<double, 3> weightsInPlane(const Mesh& mesh, Index f, const Vector3& place)
{
  const Vector3& a = mesh.position[mesh.origin[3 * f]];
  const Vector3 ab = mesh.edgeVector(3 * f), ac = -mesh.edgeVector(3 * f + 2), ap = place - a;
  const Vector3 normal = ab.cross(ac);
  const double square = normal.squaredNorm();
  if (!(square > 0))
  {
    return { 1, 0, 0 };
  }
  const double b = ap.cross(ac).dot(normal) / square, c = ab.cross(ap).dot(normal) / square;
  return { 1 - b - c, b, c };
}

} // namespace

std::array<double, 3> withoutRounding(std::array<double, 3> weights)
{
  double sum = 0;
  for (double& weight : weights)
  {
    weight = weight < kRounding ? 0 : weight; // on the edge
    sum += weight;
  }
  for (double& weight : weights)
  {
    weight /= sum;
  }
  return weights;
}

FlatSources::FlatSources(PreparedSurface before, std::vector<Index> faces)
  : before_(std::move(before)), faces_(std::move(faces)), tree_(trianglesOf(before_.mesh, faces_)),
    level_(before_.beforeFlips ? before_.beforeFlips->level() + 1 : 1)
{
}

std::shared_ptr<const FlatSources> FlatSources::movedOnto(
  std::shared_ptr<const FlatSources> before, Index shared, Index shift) const
{
  PreparedSurface moved = before_;
  moved.beforeFlips = std::move(before);
  for (FlippedFace& face : moved.flipped.editAll())
  {
    face.level += face.level > shared ? shift : 0;
  }
  return std::make_shared<const FlatSources>(std::move(moved), faces_);
}

/// A place of the face on the triangles of before. Where sheets touch, its own side counts, even where the other one is
/// nearer by rounding.
NearestTriangle::Place FlatSources::under(
  const FlippedFace& face, const std::array<double, 3>& weights) const
{
  const auto& [a, b, c] = face.places;
  const Vector3 place = weights[0] * a + weights[1] * b + weights[2] * c;
  const std::optional<NearestTriangle::Place> nearest = tree_.at(place);
  assert(nearest);
  const Vector3 normal = face.isReversed ? (c - a).cross(b - a) : (b - a).cross(c - a);
  const std::optional<NearestTriangle::Place> facing =
    tree_.at(place, normal, nearest->distance + kFlatHeight * before_.boundingBoxDiagonal);
  return facing ? *facing : *nearest;
}

SourceLocation FlatSources::locate(
  const FlippedFace& face, const std::array<double, 3>& weights) const
{
  if (face.level < level_)
  {
    return before_.beforeFlips->locate(face, weights);
  }
  const NearestTriangle::Place at = under(face, weights);
  return before_.locate(faces_[at.triangle], withoutRounding(at.weights));
}

FlatSources::Source FlatSources::sourceOf(const FlippedFace& face) const
{
  const Index f = faces_[under(face, { 1.0 / 3, 1.0 / 3, 1.0 / 3 }).triangle];
  Source source;
  source.polygon = before_.sourcePolygon[f];
  source.points = before_.sourcePoints[f];
  const Index entry = before_.refinedEntry.empty() ? kInvalidIndex : before_.refinedEntry[f];
  for (std::size_t i = 0; i < 3; ++i)
  {
    const std::array<double, 3> weights = weightsInPlane(before_.mesh, f, face.places[i]);
    for (std::size_t k = 0; k < 3; ++k)
    {
      double sum = 0;
      for (std::size_t j = 0; j < 3; ++j)
      {
        sum += weights[j] *
          (entry == kInvalidIndex ? double(j == k) : before_.cornerWeights[entry][j][k]);
      }
      source.cornerWeights[i][k] = sum;
    }
  }
  return source;
}

std::vector<FlatSources::Triangle> FlatSources::triangles() const
{
  std::vector<Triangle> found;
  if (before_.beforeFlips)
  {
    found = before_.beforeFlips->triangles();
  }
  for (const Index f : faces_)
  {
    if (!before_.isFlipped(f))
    {
      found.push_back({ before_.sourcePolygon[f], before_.sourcePoints[f] });
    }
  }
  sortUniqueBy(
    found, [](const Triangle& triangle) { return std::pair(triangle.polygon, triangle.points); });
  return found;
}

std::size_t FlatSources::bytes() const
{
  return tree_.bytes() + faces_.size() * sizeof(Index) +
    before_.mesh.faceCount() * (sizeof(Index) * 10 + 3) +
    before_.mesh.vertexCount() * sizeof(Vector3) +
    (before_.beforeFlips ? before_.beforeFlips->bytes() : 0);
}

} // namespace quadrille

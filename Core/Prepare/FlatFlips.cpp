// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/FlatFlips.h"

#include "Base/Progress.h"
#include "Mesh/FlatSources.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

/// Least height of a face that is made, over its longest edge.
constexpr double kLeastHeight = 1e-7;

/// Of the angle opposite to half-edge h.
double oppositeCotangent(const Mesh& mesh, Index h)
{
  const Vector3 a = mesh.edgeVector(Mesh::next(h)), b = mesh.edgeVector(Mesh::previous(h));
  return -a.dot(b) / std::max(a.cross(b).norm(), 1e-300);
}

/// Twice the area of a triangle, against a unit normal.
double areaAlong(const Vector3& normal, const Vector3& a, const Vector3& b, const Vector3& c)
{
  return (b - a).cross(c - a).dot(normal);
}

bool isThin(double doubleArea, const Vector3& a, const Vector3& b, const Vector3& c)
{
  const double longest =
    std::max({ (b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm() });
  return !(doubleArea > kLeastHeight * longest);
}

/// The two triangles at an inner half-edge from a to b, with the corners c and d beyond it on either side.
struct TrianglePair
{
  Vector3 a, b, c, d;
  Vector3 normal; ///< unit, of both diagonals
};

TrianglePair pairOf(const Mesh& mesh, Index h)
{
  const Index g = mesh.twin[h];
  const Vector3& a = mesh.position[mesh.origin[h]];
  const Vector3& b = mesh.position[mesh.origin[g]];
  const Vector3& c = mesh.position[mesh.origin[Mesh::previous(h)]];
  const Vector3& d = mesh.position[mesh.origin[Mesh::previous(g)]];
  return { a, b, c, d, (b - a).cross(c - d).stableNormalized() };
}

} // namespace

FlatFlips::FlatFlips(PreparedSurface& surface, const std::vector<Index>& edges)
  : surface_(surface), tolerance_(kFlatHeight * surface.boundingBoxDiagonal),
    level_(surface.beforeFlips ? surface.beforeFlips->level() + 1 : 1)
{
  if (std::any_of(edges.begin(), edges.end(), [&](Index h) { return isFlat(h); }))
  {
    before_ = std::make_unique<PreparedSurface>(surface);
  }
}

/// Whether both diagonals of the two faces of h are at one place, and each face is in the same half of that plane.
bool FlatFlips::isFlat(Index h) const
{
  const Mesh& mesh = surface_.mesh;
  if (mesh.isConstrained(h))
  {
    return false;
  }
  const auto [a, b, c, d, normal] = pairOf(mesh, h);
  return std::abs((c - a).dot(normal)) <= tolerance_ && areaAlong(normal, a, b, c) > 0 &&
    areaAlong(normal, b, a, d) > 0;
}

bool FlatFlips::isFlippable(Index h) const
{
  const Mesh& mesh = surface_.mesh;
  if (mesh.isConstrained(h) ||
    !(oppositeCotangent(mesh, h) + oppositeCotangent(mesh, mesh.twin[h]) < -kRoundingOfSingle) ||
    !isFlat(h))
  {
    return false;
  }
  const auto [a, b, c, d, normal] = pairOf(mesh, h);
  return !isThin(areaAlong(normal, a, d, c), a, d, c) &&
    !isThin(areaAlong(normal, b, c, d), b, c, d) && mayFlip(mesh, h);
}

void FlatFlips::finish()
{
  if (!any() || surface_.flipped.empty())
  {
    return;
  }
  const Mesh& mesh = surface_.mesh;
  const Mesh& before = before_->mesh;
  std::vector<Index> changed; // splits and flips leave faces in their slots
  for (Index f = 0; f < before.faceCount(); ++f)
  {
    if (!std::equal(&before.origin[3 * f], &before.origin[3 * f] + 3, &mesh.origin[3 * f]))
    {
      changed.push_back(f);
    }
  }
  const auto sources = std::make_shared<const FlatSources>(std::move(*before_), std::move(changed));
  before_.reset();
  surface_.beforeFlips = sources;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const Index entry = surface_.refinedEntry[f];
    if (surface_.isFlipped(f) && surface_.flipped[entry].level == level_)
    {
      const FlatSources::Source source = sources->sourceOf(surface_.flipped[entry]);
      surface_.sourcePolygon.edit()[f] = source.polygon;
      surface_.sourcePoints.edit()[f] = source.points;
      surface_.cornerWeights.edit()[entry] = source.cornerWeights;
    }
  }
}

} // namespace quadrille

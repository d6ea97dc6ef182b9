// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/CollapseCosts.h"

#include "Hierarchy/LogRecords.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <iterator>
#include <vector>

namespace quadrille
{
namespace
{

/// A triangle of less quality than this counts as one of this quality.
constexpr double kLeastQuality = 0.01;
/// Triangles that a vertex that stays keeps round it, in each of its sectors, where it has them.
constexpr std::size_t kLeastSector = 2;

/// Twice the area over the longest edge squared, 1 for the equilateral triangle.
double qualityOf(const Vector3& a, const Vector3& b, const Vector3& c)
{
  const double longest =
    std::max({ (b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm() });
  return longest > 0 ? (b - a).cross(c - a).norm() / longest * 1.1547005383792517 : 0;
}

} // namespace

/// How many triangles are left of the sector between curves that has this face, once it is gone.
std::size_t CollapseCosts::sectorWithout(Index v, Index without) const
{
  const std::vector<Index> corners = mesh_.cornersAround(v);
  std::size_t at = 0;
  while (at < corners.size() && Mesh::face(corners[at]) != without)
  {
    ++at;
  }
  std::size_t count = 0;
  const bool closed = mesh_.isClosed(v);
  const std::size_t n = corners.size();
  for (std::size_t i = at; i + 1 < n + (closed ? at : 0); ++i) // counterclockwise
  {
    const Index c = corners[(i + 1) % n];
    if (mesh_.isConstrained(c))
    {
      break;
    }
    ++count;
  }
  if (count + 1 < n || !closed)
  {
    for (std::size_t i = at, steps = 0; steps + 1 < n; ++steps) // clockwise
    {
      if (mesh_.isConstrained(corners[i]) || (i == 0 && !closed))
      {
        break;
      }
      i = (i + n - 1) % n;
      ++count;
    }
  }
  return count;
}

/// None where the vertex that h leaves cannot go to the other end.
std::optional<double> CollapseCosts::costOf(Index h) const
{
  const Index v = mesh_.origin(h), to = mesh_.target(h);
  const LevelMesh::Vertex& vertex = mesh_.vertex(v);
  const Index g = mesh_.twin(h);
  if (vertex.freedom != PatchFreedom::Plane && !mesh_.isConstrained(h))
  {
    return std::nullopt;
  }
  if (g == kInvalidIndex && mesh_.isClosed(v))
  {
    return std::nullopt;
  }
  // Link condition: the ends have just the apexes as common neighbours.
  const std::vector<Index> a = mesh_.neighbours(v), b = mesh_.neighbours(to);
  std::vector<Index> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  if (common.size() != (g == kInvalidIndex ? 1U : 2U) || (mesh_.isClosed(v) && a.size() < 4) ||
    (!mesh_.isClosed(v) && a.size() < 3))
  {
    return std::nullopt;
  }
  const std::vector<Index> corners = mesh_.cornersAround(v);
  const std::vector<Index> there = mesh_.cornersAround(to);
  if (there.size() + corners.size() > static_cast<std::size_t>(kMaximumRing))
  {
    return std::nullopt;
  }
  // What comes between the spokes to the apexes must be less than a whole turn round an irregular vertex.
  const std::size_t kept = corners.size() - (g == kInvalidIndex ? 1U : 2U);
  if (mesh_.vertex(to).isIrregular && mesh_.vertex(to).turns > 4 &&
    3 * kept > 2 * (there.size() + kept))
  {
    return std::nullopt;
  }
  const Index left = Mesh::face(h), right = g == kInvalidIndex ? kInvalidIndex : Mesh::face(g);
  const auto keepsApex = [&](Index apex, Index goes)
  {
    const LevelMesh::Vertex& end = mesh_.vertex(apex);
    const bool bends = end.freedom == PatchFreedom::Fixed;
    std::size_t least = end.freedom == PatchFreedom::Plane ? 3 : kLeastSector;
    if (bends && end.isIrregular)
    {
      least = static_cast<std::size_t>(std::max(end.turns, 2));
    }
    return sectorWithout(apex, goes) >= least;
  };
  if (!keepsApex(mesh_.origin(Mesh::previous(h)), left) ||
    (g != kInvalidIndex && !keepsApex(mesh_.origin(Mesh::previous(g)), right)))
  {
    return std::nullopt;
  }
  double worst = 1;
  for (const Index c : corners)
  {
    if (Mesh::face(c) == left || Mesh::face(c) == right)
    {
      continue;
    }
    const Index x = mesh_.target(c), y = mesh_.origin(Mesh::previous(c));
    const bool allStay = mesh_.vertex(to).freedom != PatchFreedom::Plane &&
      mesh_.vertex(x).freedom != PatchFreedom::Plane &&
      mesh_.vertex(y).freedom != PatchFreedom::Plane;
    if (allStay)
    {
      return std::nullopt; // its corners may be on one isoline
    }
    worst = std::min(worst,
      qualityOf(mesh_.vertex(to).position, mesh_.vertex(x).position, mesh_.vertex(y).position));
  }
  return (vertex.position - mesh_.vertex(to).position).squaredNorm() /
    std::max(worst, kLeastQuality);
}

std::optional<std::pair<double, Index>> CollapseCosts::best(Index v) const
{
  std::optional<std::pair<double, Index>> best;
  if (mesh_.vertex(v).freedom == PatchFreedom::Fixed || mesh_.vertex(v).corner == kInvalidIndex)
  {
    return best;
  }
  for (const Index h : mesh_.cornersAround(v))
  {
    const std::optional<double> cost = costOf(h);
    if (cost && (!best || *cost < best->first))
    {
      best = { *cost, h };
    }
  }
  return best;
}

} // namespace quadrille

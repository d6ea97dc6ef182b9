// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/MeshPlaces.h"

#include "Base/Parallel.h"
#include "Mesh/Distance.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace quadrille
{
namespace
{

struct FoundPlace
{
  double squared = kInfinity;
  MeshPlace place;

  bool operator<(const FoundPlace& other) const
  {
    return std::tie(squared, place.face) < std::tie(other.squared, other.place.face);
  }
};

/// Points in the order of x.
struct SortedPoints
{
  std::vector<std::size_t> order;
  std::vector<double> x;

  explicit SortedPoints(const std::vector<Vector3>& points)
  {
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      order.push_back(i);
    }
    std::sort(order.begin(), order.end(),
      [&](std::size_t a, std::size_t b)
      { return std::make_pair(points[a].x(), a) < std::make_pair(points[b].x(), b); });
    for (const std::size_t i : order)
    {
      x.push_back(points[i].x());
    }
  }
};

/// The nearest faces of the points among those whose box, made larger by `slack`, has the point inside.
std::vector<FoundPlace> nearestWithin(
  const Mesh& mesh, const std::vector<Vector3>& points, double slack, int threads)
{
  const SortedPoints sorted(points);
  using Candidate = std::pair<std::size_t, FoundPlace>;
  const auto candidates = parallelGather<Candidate>(mesh.faceCount(), kLightChunk, threads,
    [&](Index f, std::vector<Candidate>& list)
    {
      const auto [a, b, c] = mesh.cornersOfFace(f);
      const Vector3 low = (a.cwiseMin(b).cwiseMin(c).array() - slack).matrix();
      const Vector3 high = (a.cwiseMax(b).cwiseMax(c).array() + slack).matrix();
      auto at = std::lower_bound(sorted.x.begin(), sorted.x.end(), low.x());
      for (; at != sorted.x.end() && *at <= high.x(); ++at)
      {
        const std::size_t i = sorted.order[static_cast<std::size_t>(at - sorted.x.begin())];
        const Vector3& p = points[i];
        if ((p.array() >= low.array()).all() && (p.array() <= high.array()).all())
        {
          const Vector3 nearest = nearestOnTriangle(p, a, b, c);
          list.push_back({ i, { (nearest - p).squaredNorm(), { f, nearest } } });
        }
      }
    });
  std::vector<FoundPlace> best(points.size());
  for (const auto& [i, found] : candidates)
  {
    best[i] = std::min(best[i], found);
  }
  return best;
}

MeshPlace nearestOfAll(const Mesh& mesh, const Vector3& p, int threads)
{
  const auto parts = parallelParts<FoundPlace>(mesh.faceCount(), kLightChunk, threads,
    [&](Index begin, Index end, FoundPlace& best)
    {
      for (Index f = begin; f < end; ++f)
      {
        const Vector3 nearest = nearestOnFace(mesh, f, p);
        best = std::min(best, FoundPlace{ (nearest - p).squaredNorm(), { f, nearest } });
      }
    });
  return std::min_element(parts.begin(), parts.end())->place;
}

} // namespace

Vector3 nearestOnFace(const Mesh& mesh, Index f, const Vector3& p)
{
  const auto [a, b, c] = mesh.cornersOfFace(f);
  return nearestOnTriangle(p, a, b, c);
}

std::vector<MeshPlace> placesOnMesh(
  const Mesh& mesh, const std::vector<Vector3>& points, int threads)
{
  double size = 0;
  for (const Vector3& p : points)
  {
    size = std::max(size, p.cwiseAbs().maxCoeff());
  }
  const std::vector<FoundPlace> near =
    nearestWithin(mesh, points, kRoundingOfSingle * size, threads);
  std::vector<MeshPlace> places;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    places.push_back(
      near[i].place.face != kInvalidIndex ? near[i].place : nearestOfAll(mesh, points[i], threads));
  }
  return places;
}

} // namespace quadrille

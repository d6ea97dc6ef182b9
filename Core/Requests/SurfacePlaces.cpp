// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/SurfacePlaces.h"

#include "Base/Error.h"
#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Mesh/Distance.h"
#include "Mesh/Triangulate.h"

#include <algorithm>
#include <string>
#include <vector>

namespace quadrille
{

double meanEdge(const SurfaceInput& input, Index polygon)
{
  const Index begin = input.polygonOffsets[polygon];
  const Index corners = input.polygonOffsets[polygon + 1] - begin;
  double sum = 0;
  for (Index i = 0; i < corners; ++i)
  {
    sum += (input.points[input.polygonPoints[begin + i]] -
      input.points[input.polygonPoints[begin + (i + 1) % corners]])
             .norm();
  }
  return sum / std::max<Index>(corners, 1);
}

double diagonalOf(const std::vector<Vector3>& points)
{
  if (points.empty())
  {
    return 0;
  }
  Vector3 low = points.front();
  Vector3 high = low;
  for (const Vector3& p : points)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

double areaOfPolygons(const SurfaceInput& input)
{
  double area = 0;
  for (std::size_t i = 0; i + 1 < input.polygonOffsets.size(); ++i)
  {
    const Index first = input.polygonOffsets[i];
    for (Index k = first + 2; k < input.polygonOffsets[i + 1]; ++k)
    {
      const Vector3& a = input.points[input.polygonPoints[first]];
      area += 0.5 *
        (input.points[input.polygonPoints[k - 1]] - a)
          .cross(input.points[input.polygonPoints[k]] - a)
          .norm();
    }
  }
  return area;
}

void requirePolygons(const SurfaceInput& input)
{
  const auto fail = [](const std::string& text) { throw InvalidInput(text + "."); };
  for (std::size_t i = 0; i + 1 < input.polygonOffsets.size(); ++i)
  {
    if (input.polygonOffsets[i] > input.polygonOffsets[i + 1])
    {
      fail("polygon " + std::to_string(i) + " ends before it begins");
    }
  }
  if (!input.polygonOffsets.empty() && input.polygonOffsets.back() > input.polygonPoints.size())
  {
    fail("the polygons have " + std::to_string(input.polygonOffsets.back()) +
      " corners, but only " + std::to_string(input.polygonPoints.size()) + " are given");
  }
  for (std::size_t i = 0; i + 1 < input.polygonOffsets.size(); ++i)
  {
    pollNowAndThen(i);
    for (Index k = input.polygonOffsets[i]; k < input.polygonOffsets[i + 1]; ++k)
    {
      const Index p = input.polygonPoints[k];
      if (p >= input.points.size())
      {
        fail("polygon " + std::to_string(i) + " has the point " + std::to_string(p) +
          ", but there are only " + std::to_string(input.points.size()));
      }
      if (!input.points[p].allFinite())
      {
        fail("point " + std::to_string(p) + " has a coordinate that is not finite");
      }
    }
  }
}

SurfacePlaces::SurfacePlaces(const SurfaceInput& input, int threads)
  : input_(input), threads_(threads), diagonal_(diagonalOf(input.points))
{
  requirePolygons(input);
}

void SurfacePlaces::makeTriangles() const
{
  if (hasTriangles_)
  {
    return;
  }
  hasTriangles_ = true;
  bool onlyTriangles = true;
  for (std::size_t i = 0; i + 1 < input_.polygonOffsets.size(); ++i)
  {
    onlyTriangles &= input_.polygonOffsets[i + 1] - input_.polygonOffsets[i] == 3;
  }
  if (!onlyTriangles)
  {
    PreparedSurface triangles;
    triangulate(input_, triangles);
    trianglePoints_ = triangles.mesh.origin.take();
    trianglePolygon_ = triangles.sourcePolygon.take();
  }
}

Index SurfacePlaces::triangleCount() const
{
  return static_cast<Index>(
    (trianglePoints_.empty() ? input_.polygonPoints.size() : trianglePoints_.size()) / 3);
}

void SurfacePlaces::makeTriangleTree() const
{
  std::vector<BoxTree::Box> boxes(triangleCount());
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    pollNowAndThen(i);
    const std::array<Vector3, 3> corner = triangle(static_cast<Index>(i));
    boxes[i] = { corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]),
      corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]) };
  }
  triangleTree_.emplace(boxes, threads_);
}

Index SurfacePlaces::nearestOfAll(const Vector3& p) const
{
  struct Found
  {
    double squared = kInfinity;
    Index triangle = kInvalidIndex;
  };
  const auto parts = parallelParts<Found>(triangleCount(), kLightChunk, threads_,
    [&](Index begin, Index end, Found& best)
    {
      for (Index i = begin; i < end; ++i)
      {
        const std::array<Vector3, 3> corner = triangle(i);
        const BoxTree::Box box{ corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]),
          corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]) };
        if (box.squaredDistance(p) < best.squared)
        {
          const double squared =
            (nearestOnTriangle(p, corner[0], corner[1], corner[2]) - p).squaredNorm();
          best = squared < best.squared ? Found{ squared, i } : best;
        }
      }
    });
  Found best;
  for (const Found& part : parts)
  {
    best = part.squared < best.squared ? part : best;
  }
  return best.triangle;
}

std::array<Vector3, 3> SurfacePlaces::triangle(Index i) const
{
  const std::vector<Index>& points =
    trianglePoints_.empty() ? input_.polygonPoints.vector() : trianglePoints_;
  const Index first =
    trianglePoints_.empty() ? input_.polygonOffsets[i] : static_cast<Index>(3 * i);
  return { input_.points[points[first]], input_.points[points[first + 1]],
    input_.points[points[first + 2]] };
}

SurfacePlaces::Place SurfacePlaces::nearestPlace(const Vector3& p) const
{
  constexpr int kQuestionsForTree = 8; // so many looks at all triangles take as long as making one
  makeTriangles();
  if (!triangleTree_ && ++questions_ > kQuestionsForTree)
  {
    makeTriangleTree();
  }
  const auto placeOn = [&](Index i)
  {
    const std::array<Vector3, 3> corner = triangle(i);
    return nearestOnTriangle(p, corner[0], corner[1], corner[2]);
  };
  const Index nearest = triangleTree_
    ? triangleTree_->nearest(p, [&](Index i) { return (placeOn(i) - p).squaredNorm(); })
    : nearestOfAll(p);
  if (nearest == kInvalidIndex)
  {
    throw InvalidInput("no place on the surface was found for the point " + placeText(p));
  }
  const Vector3 place = placeOn(nearest);
  const bool isOn = (place - p).norm() <= kLastDigits * diagonal_;
  return { trianglePolygon_.empty() ? nearest : trianglePolygon_[nearest], isOn ? p : place };
}

bool SurfacePlaces::isOnBoundary(const Place& place) const
{
  struct Edge
  {
    Vector3 a, b;
    int polygons = 0;
  };
  std::vector<Edge> edges; // at the place
  const double near = kRoundingOfSingle * meanEdge(input_, place.polygon);
  for (std::size_t polygon = 0; polygon + 1 < input_.polygonOffsets.size(); ++polygon)
  {
    const Index begin = input_.polygonOffsets[polygon];
    const Index corners = input_.polygonOffsets[polygon + 1] - begin;
    for (Index i = 0; i < corners; ++i)
    {
      const Vector3& a = input_.points[input_.polygonPoints[begin + i]];
      const Vector3& b = input_.points[input_.polygonPoints[begin + (i + 1) % corners]];
      if (a == b || distanceToSegment(place.point, a, b) > near)
      {
        continue;
      }
      const auto found = std::find_if(edges.begin(), edges.end(),
        [&](const Edge& edge)
        { return (edge.a == a && edge.b == b) || (edge.a == b && edge.b == a); });
      ++(found == edges.end() ? *edges.insert(edges.end(), { a, b, 0 }) : *found).polygons;
    }
  }
  return std::any_of(
    edges.begin(), edges.end(), [](const Edge& edge) { return edge.polygons == 1; });
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Triangulate.h"

#include "Base/LargeArray.h"
#include "Base/Parallel.h"

#include <algorithm>

namespace quadrille
{

namespace
{

/// One polygon's corner: the input point, and whether the edge to the next corner is a feature.
struct Corner
{
  Index point;
  bool feature;
  Vector2 at = Vector2::Zero(); ///< in the polygon's plane
};

/// Appends the triangle made of three corners of a polygon; `features` holds a bit per edge.
void appendTriangle(PreparedSurface& surface, Index polygon, const std::array<Index, 3>& points,
  std::uint8_t features)
{
  surface.mesh.origin.append(points.begin(), points.end());
  for (int i = 0; i < 3; ++i)
  {
    surface.mesh.flags.push_back((features >> i & 1) != 0 ? kFeatureEdge | kRequestedFeature : 0);
  }
  surface.sourcePolygon.push_back(polygon);
  surface.sourcePoints.push_back(points);
}

/// The polygon's corners in the order that is asked for.
class CornerOrder
{
public:
  CornerOrder(const Index* points, Index count, FaceOrder order)
    : count_(count), order_(order),
      first_(order == FaceOrder::AsGiven
          ? 0
          : static_cast<Index>(std::min_element(points, points + count) - points))
  {
  }
  /// The polygon's own number of corner i.
  Index corner(Index i) const
  {
    return (order_ == FaceOrder::Reversed ? first_ + count_ - i : first_ + i) % count_;
  }
  /// The polygon's own number of the edge that follows corner i.
  Index edge(Index i) const { return order_ == FaceOrder::Reversed ? corner(i + 1) : corner(i); }

private:
  Index count_;
  FaceOrder order_;
  Index first_;
};

struct Triangle
{
  std::array<Index, 3> points{};
  std::uint8_t features = 0;
};

Triangle orderedTriangle(const Index* points, unsigned features, FaceOrder faceOrder)
{
  const CornerOrder order(points, 3, faceOrder);
  Triangle triangle;
  for (Index i = 0; i < 3; ++i)
  {
    triangle.points[i] = points[order.corner(i)];
    triangle.features =
      static_cast<std::uint8_t>(triangle.features | (features >> order.edge(i) & 1U) << i);
  }
  return triangle;
}

/// The polygon's corners without those that repeat the one before.
std::vector<Corner> distinctCorners(
  const SurfaceInput& input, Index begin, Index end, unsigned features)
{
  std::vector<Corner> corners;
  const CornerOrder order(input.polygonPoints.data() + begin, end - begin, input.faceOrder);
  for (Index i = 0; i < end - begin; ++i)
  {
    // A byte holds the first eight edges only.
    const bool feature = order.edge(i) < 8 && (features >> order.edge(i) & 1u) != 0;
    const Index point = input.polygonPoints[begin + order.corner(i)];
    if (!corners.empty() && corners.back().point == point)
    {
      corners.back().feature = feature;
      continue;
    }
    corners.push_back({ point, feature });
  }
  while (corners.size() > 1 && corners.back().point == corners.front().point)
  {
    corners.pop_back();
  }
  return corners;
}

/// Projects the corners to the plane of the polygon's area vector, so that it turns left.
void projectToPlane(const std::vector<Vector3>& points, std::vector<Corner>& corners)
{
  const Vector3& base = points[corners.front().point];
  Vector3 normal = Vector3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    const Vector3 p = points[corners[i].point] - base;
    const Vector3 q = points[corners[(i + 1) % corners.size()].point] - base;
    normal += p.cross(q);
  }
  const Vector3 x = normal.unitOrthogonal();
  const Vector3 y = normal.normalized().cross(x);
  for (Corner& corner : corners)
  {
    const Vector3 p = points[corner.point] - base;
    corner.at = { p.dot(x), p.dot(y) };
  }
}

double cross(const Vector2& a, const Vector2& b, const Vector2& c)
{
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Clips ears off one polygon, always the best shaped one.
class EarClipper
{
public:
  explicit EarClipper(std::vector<Corner> corners)
    : corners_(std::move(corners)), quality_(corners_.size())
  {
    for (std::size_t i = 0; i < corners_.size(); ++i)
    {
      quality_[i] = quality(i);
    }
  }

  void clipAll(PreparedSurface& surface, Index polygon)
  {
    while (corners_.size() > 3)
    {
      const std::size_t ear = std::max_element(quality_.begin(), quality_.end()) - quality_.begin();
      emit(surface, polygon, ear);
      corners_[before(ear)].feature = false; // the cut is no edge of the polygon
      corners_.erase(corners_.begin() + ear);
      quality_.erase(quality_.begin() + ear);
      updateAround(ear % corners_.size());
    }
    emit(surface, polygon, 1);
  }

private:
  std::size_t before(std::size_t i) const { return i == 0 ? corners_.size() - 1 : i - 1; }
  std::size_t after(std::size_t i) const { return i + 1 == corners_.size() ? 0 : i + 1; }

  void emit(PreparedSurface& surface, Index polygon, std::size_t i) const
  {
    const Corner& a = corners_[before(i)];
    const Corner& b = corners_[i];
    const Corner& c = corners_[after(i)];
    const bool closing = corners_.size() == 3 && c.feature;
    appendTriangle(surface, polygon, { a.point, b.point, c.point },
      static_cast<std::uint8_t>((a.feature ? 1 : 0) | (b.feature ? 2 : 0) | (closing ? 4 : 0)));
  }

  /// The cut can only turn blocked corners into ears where it changed the polygon, and near it; all
  /// blocked corners are tested again because the clipped corner may have been what blocked them.
  void updateAround(std::size_t i)
  {
    for (std::size_t j = 0; j < corners_.size(); ++j)
    {
      if (j == i || j == before(i) || quality_[j] < 0)
      {
        quality_[j] = quality(j);
      }
    }
  }

  bool isBlocked(std::size_t i) const
  {
    const Corner& a = corners_[before(i)];
    const Corner& b = corners_[i];
    const Corner& c = corners_[after(i)];
    for (std::size_t j = 0; j < corners_.size(); ++j)
    {
      const Corner& p = corners_[j];
      if (p.point != a.point && p.point != b.point && p.point != c.point &&
        cross(a.at, b.at, p.at) >= 0 && cross(b.at, c.at, p.at) >= 0 &&
        cross(c.at, a.at, p.at) >= 0)
      {
        return true;
      }
    }
    return false;
  }

  /// Area over squared longest side for an ear; less than zero for what is none, worst where turned
  /// over, so that even a polygon that crosses itself gets cut up.
  double quality(std::size_t i) const
  {
    const Vector2& a = corners_[before(i)].at;
    const Vector2& b = corners_[i].at;
    const Vector2& c = corners_[after(i)].at;
    const double longest =
      std::max({ (b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm() });
    const double shape = longest > 0 ? cross(a, b, c) / longest : 0;
    if (shape < 0)
    {
      return -3 + shape;
    }
    if (shape == 0)
    {
      return -1; // collinear: better than crossing the boundary
    }
    return isBlocked(i) ? -2 : shape;
  }

  std::vector<Corner> corners_;
  std::vector<double> quality_;
};

void triangulatePolygon(const SurfaceInput& input, Index polygon, PreparedSurface& surface)
{
  const Index begin = input.polygonOffsets[polygon];
  const Index end = input.polygonOffsets[polygon + 1];
  const unsigned features = input.featureEdges.empty() ? 0u : input.featureEdges[polygon];
  std::vector<Corner> corners = distinctCorners(input, begin, end, features);
  if (corners.size() < 3)
  {
    ++surface.repair.degenerateFaces;
    return;
  }
  if (end - begin > 3)
  {
    ++surface.repair.triangulatedPolygons;
  }
  if (corners.size() > 3)
  {
    projectToPlane(input.points, corners);
  }
  EarClipper(std::move(corners)).clipAll(surface, polygon);
}

bool isProperTriangle(const SurfaceInput& input, Index polygon)
{
  const Index* p = input.polygonPoints.data() + input.polygonOffsets[polygon];
  return input.polygonOffsets[polygon + 1] - input.polygonOffsets[polygon] == 3 && p[0] != p[1] &&
    p[1] != p[2] && p[2] != p[0];
}

bool hasOnlyTriangles(const SurfaceInput& input, int threads)
{
  const std::size_t polygons = input.polygonOffsets.size() - 1;
  return firstRefused(polygons, kLightChunk, threads,
           [&](std::size_t polygon)
           { return isProperTriangle(input, static_cast<Index>(polygon)); }) == polygons;
}

/// The common case by whole arrays; element by element it took as long as the pairing of half-edges.
void copyTriangles(const SurfaceInput& input, PreparedSurface& surface, int threads)
{
  const std::size_t faces = input.polygonOffsets.size() - 1;
  std::vector<Index> origin, sourcePolygon;
  std::vector<std::array<Index, 3>> sourcePoints;
  std::vector<std::uint8_t> flags;
  reserveWithRoom(origin, 3 * faces, threads);
  reserveWithRoom(flags, 3 * faces, threads);
  reserveWithRoom(sourcePoints, faces, threads);
  reserveWithRoom(sourcePolygon, faces, threads);
  growLarge(origin, 3 * faces);
  growLarge(flags, 3 * faces);
  growLarge(sourcePoints, faces);
  growLarge(sourcePolygon, faces);
  parallelForEach(faces, kLightChunk, threads,
    [&](std::size_t f)
    {
      const Triangle triangle = orderedTriangle(input.polygonPoints.data() + 3 * f,
        input.featureEdges.empty() ? 0 : input.featureEdges[f], input.faceOrder);
      sourcePoints[f] = triangle.points;
      sourcePolygon[f] = static_cast<Index>(f);
      for (std::size_t i = 0; i < 3; ++i)
      {
        origin[3 * f + i] = triangle.points[i];
        flags[3 * f + i] = (triangle.features >> i & 1) != 0 ? kFeatureEdge | kRequestedFeature : 0;
      }
    });
  surface.mesh.origin = std::move(origin);
  surface.mesh.flags = std::move(flags);
  surface.sourcePoints = std::move(sourcePoints);
  surface.sourcePolygon = std::move(sourcePolygon);
}

/// The edges that detectedFeatures names, by the points at their ends.
void markDetected(const SurfaceInput& input, PreparedSurface& surface)
{
  if (input.detectedFeatures.empty())
  {
    return;
  }
  for (Index f = 0; f < surface.mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const Index polygon = surface.sourcePolygon[f];
    const Index begin = input.polygonOffsets[polygon];
    const Index corners = input.polygonOffsets[polygon + 1] - begin;
    const unsigned bits = input.detectedFeatures[polygon];
    for (Index i = 0; i < std::min<Index>(corners, 8); ++i)
    {
      const Index a = input.polygonPoints[begin + i];
      const Index b = input.polygonPoints[begin + (i + 1) % corners];
      for (Index h = 3 * f; h < 3 * f + 3 && (bits >> i & 1U) != 0; ++h)
      {
        const Index from = surface.mesh.origin[h], to = surface.mesh.target(h);
        if ((from == a && to == b) || (from == b && to == a))
        {
          surface.mesh.flags.edit()[h] |= kFeatureEdge;
        }
      }
    }
  }
}

void makeTriangles(const SurfaceInput& input, PreparedSurface& surface, int threads)
{
  const Index polygons = static_cast<Index>(input.polygonOffsets.size() - 1);
  if (hasOnlyTriangles(input, threads))
  {
    copyTriangles(input, surface, threads);
    return;
  }
  surface.mesh.origin.reserve(input.polygonPoints.size());
  surface.mesh.flags.reserve(input.polygonPoints.size());
  surface.sourcePolygon.reserve(polygons);
  surface.sourcePoints.reserve(polygons);
  for (Index polygon = 0; polygon < polygons; ++polygon)
  {
    pollNowAndThen(polygon);
    if (isProperTriangle(input, polygon))
    {
      const Triangle triangle =
        orderedTriangle(input.polygonPoints.data() + input.polygonOffsets[polygon],
          input.featureEdges.empty() ? 0 : input.featureEdges[polygon], input.faceOrder);
      appendTriangle(surface, polygon, triangle.points, triangle.features);
    }
    else
    {
      triangulatePolygon(input, polygon, surface);
    }
  }
}

} // namespace

void triangulate(const SurfaceInput& input, PreparedSurface& surface, int threads)
{
  makeTriangles(input, surface, threads);
  markDetected(input, surface);
}

} // namespace quadrille

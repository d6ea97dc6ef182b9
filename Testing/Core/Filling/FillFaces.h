// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Faces to be filled: plane ones by their loops, triangulated as CAD kernels do, which put no vertex inside; and what
/// is made of them.
#pragma once

#include "TestMeshes.h"

#include "Base/Lists.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace quadrille::test
{

/// A loop of a plane face, with the face on its left.
struct PinLoop
{
  std::vector<Vector2> points;
  std::vector<std::uint8_t> isPin;

  void add(const Vector2& p, bool pin)
  {
    points.push_back(p);
    isPin.push_back(pin ? 1 : 0);
  }
};

/// `between`: vertices between two pins.
inline PinLoop circleLoop(
  const Vector2& centre, double radius, int pins, int between, bool isHole = false)
{
  PinLoop loop;
  const int count = pins * (between + 1);
  for (int i = 0; i < count; ++i)
  {
    const double angle = (isHole ? -1 : 1) * 2 * kPi * i / count;
    loop.add(centre + radius * Vector2(std::cos(angle), std::sin(angle)), i % (between + 1) == 0);
  }
  return loop;
}

/// Straight from corner to corner, with a pin at each and others at about this distance.
inline PinLoop polygonLoop(const std::vector<Vector2>& corners, double spacing, int between)
{
  PinLoop loop;
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    const Vector2 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const int count =
      std::max(1, static_cast<int>(std::lround((b - a).norm() / spacing))) * (between + 1);
    for (int k = 0; k < count; ++k)
    {
      loop.add(a + (b - a) * k / count, k % (between + 1) == 0);
    }
  }
  return loop;
}

struct FillCase
{
  Mesh mesh;
  std::vector<std::uint8_t> isPin;
};

/// The polygon of all loops, with bridges from one to the next; ids of points.
inline std::vector<Index> bridged(
  const std::vector<Vector2>& points, std::vector<std::vector<Index>> loops)
{
  std::vector<Index> polygon = loops[0];
  loops.erase(loops.begin());
  const auto crosses = [&](const Vector2& a, const Vector2& b, const std::vector<Index>& ring)
  {
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
      const Vector2 &p = points[ring[i]], &q = points[ring[(i + 1) % ring.size()]];
      if (p == a || p == b || q == a || q == b)
      {
        continue;
      }
      if (parallelogram(b - a, p - a) * parallelogram(b - a, q - a) <= 0 &&
        parallelogram(q - p, a - p) * parallelogram(q - p, b - p) <= 0)
      {
        return true;
      }
    }
    return false;
  };
  while (!loops.empty())
  {
    double best = 1e300;
    std::size_t loop = 0, from = 0, to = 0;
    for (std::size_t l = 0; l < loops.size(); ++l)
    {
      for (std::size_t i = 0; i < polygon.size(); ++i)
      {
        for (std::size_t k = 0; k < loops[l].size(); ++k)
        {
          const Vector2 &a = points[polygon[i]], &b = points[loops[l][k]];
          bool blocked = (b - a).norm() >= best || crosses(a, b, polygon);
          for (const std::vector<Index>& ring : loops)
          {
            blocked = blocked || crosses(a, b, ring);
          }
          // A point that a bridge meets already is left alone: it is there twice.
          if (!blocked && std::count(polygon.begin(), polygon.end(), polygon[i]) == 1)
          {
            best = (b - a).norm();
            loop = l;
            from = i;
            to = k;
          }
        }
      }
    }
    std::vector<Index> ring = loops[loop];
    std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(to), ring.end());
    ring.push_back(ring.front());
    ring.push_back(polygon[from]);
    polygon.insert(
      polygon.begin() + static_cast<std::ptrdiff_t>(from) + 1, ring.begin(), ring.end());
    loops.erase(loops.begin() + static_cast<std::ptrdiff_t>(loop));
  }
  return polygon;
}

/// Cuts off the ear that is widest.
inline std::vector<Triangle> clipEars(
  const std::vector<Vector2>& points, std::vector<Index> polygon)
{
  std::vector<Triangle> triangles;
  while (polygon.size() > 3)
  {
    double best = -1;
    std::size_t ear = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
      const std::size_t n = polygon.size();
      const Index a = polygon[(i + n - 1) % n], b = polygon[i], c = polygon[(i + 1) % n];
      const Vector2 u = points[b] - points[a], v = points[c] - points[b];
      const double area = parallelogram(u, v);
      if (area <= 1e-12)
      {
        continue;
      }
      const bool isFree = std::none_of(polygon.begin(), polygon.end(),
        [&](Index p)
        {
          return points[p] != points[a] && points[p] != points[b] && points[p] != points[c] &&
            parallelogram(u, points[p] - points[a]) >= 0 &&
            parallelogram(v, points[p] - points[b]) >= 0 &&
            parallelogram(points[a] - points[c], points[p] - points[c]) >= 0;
        });
      const double shape = area / (u.squaredNorm() + v.squaredNorm() + (u + v).squaredNorm());
      if (isFree && shape > best)
      {
        best = shape;
        ear = i;
      }
    }
    const std::size_t n = polygon.size();
    triangles.push_back({ polygon[(ear + n - 1) % n], polygon[ear], polygon[(ear + 1) % n] });
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({ polygon[0], polygon[1], polygon[2] });
  return triangles;
}

inline FillCase planeCase(const std::vector<PinLoop>& loops)
{
  std::vector<Vector2> points;
  std::vector<std::vector<Index>> rings;
  FillCase result;
  for (const PinLoop& loop : loops)
  {
    rings.emplace_back();
    for (std::size_t i = 0; i < loop.points.size(); ++i)
    {
      rings.back().push_back(static_cast<Index>(points.size()));
      points.push_back(loop.points[i]);
      result.isPin.push_back(loop.isPin[i]);
    }
  }
  std::vector<Vector3> places;
  places.reserve(points.size());
  for (const Vector2& p : points)
  {
    places.emplace_back(p.x(), p.y(), 0);
  }
  result.mesh = makeMesh(std::move(places), clipEars(points, bridged(points, rings)));
  return result;
}

/// Each triangle becomes four, so many times.
inline FillCase refined(FillCase c, int times)
{
  for (int i = 0; i < times; ++i)
  {
    std::vector<Vector3> points = c.mesh.position;
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index h)
    {
      const auto [found, isNew] =
        middles.emplace(std::minmax(Index{ c.mesh.origin[h] }, c.mesh.target(h)),
          static_cast<Index>(points.size()));
      if (isNew)
      {
        points.emplace_back(
          (c.mesh.position[c.mesh.origin[h]] + c.mesh.position[c.mesh.target(h)]) / 2);
        c.isPin.push_back(0);
      }
      return found->second;
    };
    std::vector<Triangle> triangles;
    for (Index h = 0; h < c.mesh.halfEdgeCount(); h += 3)
    {
      const Index a = middle(h), b = middle(h + 1), d = middle(h + 2);
      triangles.insert(triangles.end(),
        { { c.mesh.origin[h], a, d }, { a, c.mesh.origin[h + 1], b },
          { d, b, c.mesh.origin[h + 2] }, { a, b, d } });
    }
    c.mesh = makeMesh(std::move(points), triangles);
  }
  return c;
}

inline FillCase bent(FillCase c, const std::function<Vector3(const Vector3&)>& to)
{
  for (Vector3& p : c.mesh.position.editAll())
  {
    p = to(p);
  }
  return c;
}

/// What is left of a mesh; every `step`-th vertex of its one loop is a pin.
inline FillCase partOf(const Mesh& mesh, const std::function<bool(Index f)>& keep, int step)
{
  std::vector<Index> ids(mesh.vertexCount(), kInvalidIndex);
  std::vector<Vector3> points;
  std::vector<Triangle> triangles;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (!keep(f))
    {
      continue;
    }
    Triangle triangle{};
    for (Index i = 0; i < 3; ++i)
    {
      Index& id = ids[mesh.origin[3 * f + i]];
      if (id == kInvalidIndex)
      {
        id = static_cast<Index>(points.size());
        points.push_back(mesh.position[mesh.origin[3 * f + i]]);
      }
      triangle[i] = id;
    }
    triangles.push_back(triangle);
  }
  FillCase result;
  result.mesh = makeMesh(std::move(points), triangles);
  result.isPin.assign(result.mesh.vertexCount(), 0);
  const Mesh& part = result.mesh;
  Index h = 0;
  while (!part.isBoundary(h))
  {
    ++h;
  }
  const Index first = h;
  int count = 0;
  do
  {
    result.isPin[part.origin[h]] = count++ % step == 0 ? 1 : 0;
    for (h = Mesh::next(h); !part.isBoundary(h); h = Mesh::next(part.twin[h]))
    {
    }
  } while (h != first);
  return result;
}

} // namespace quadrille::test

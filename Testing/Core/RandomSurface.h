// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Surfaces with random damage.
#pragma once

#include "SurfaceInputs.h"

namespace quadrille::test
{

/// The same for the same seed.
class RandomSurface
{
public:
  explicit RandomSurface(unsigned seed) : random_(seed) {}

  SurfaceInput make()
  {
    switch (pick(4))
    {
      case 0:
        makeSoup();
        break;
      case 1:
        makeVoxels();
        break;
      default:
        take(pick(2) == 0 ? sphere(1) : torus(4 + static_cast<int>(pick(5)), 5));
        break;
    }
    const std::size_t damages = triangles_.empty() ? 0 : pick(12);
    for (std::size_t i = 0; i < damages; ++i)
    {
      damage();
    }
    return finish();
  }

private:
  std::size_t pick(std::size_t count) { return random_() % count; }
  Index anyPoint() { return static_cast<Index>(pick(points_.size())); }
  Triangle& anyTriangle() { return triangles_[pick(triangles_.size())]; }
  Triangle randomTriangle() { return { anyPoint(), anyPoint(), anyPoint() }; }

  /// Points on a small lattice: many collinear and coincident ones.
  void makeSoup()
  {
    const std::size_t points = 4 + pick(20);
    for (std::size_t i = 0; i < points; ++i)
    {
      points_.emplace_back(pick(3), pick(3), pick(3));
    }
    const std::size_t triangles = 1 + pick(60);
    for (std::size_t i = 0; i < triangles; ++i)
    {
      triangles_.push_back(randomTriangle());
    }
  }

  /// Voxels that touch along edges and in corners.
  void makeVoxels()
  {
    std::array<bool, 27> solid{};
    for (bool& cell : solid)
    {
      cell = pick(2) == 0;
    }
    LatticeBuilder builder = voxelSides({ 3, 3, 3 }, 1,
      [&solid](int x, int y, int z) { return solid[static_cast<std::size_t>(x + 3 * y + 9 * z)]; });
    points_ = std::move(builder.points);
    triangles_ = std::move(builder.triangles);
  }

  void take(const Mesh& mesh)
  {
    points_ = mesh.position;
    for (Index h = 0; h < mesh.halfEdgeCount(); h += 3)
    {
      triangles_.push_back({ mesh.origin[h], mesh.origin[h + 1], mesh.origin[h + 2] });
    }
  }

  void damage()
  {
    switch (pick(7))
    {
      case 0: // repeat a face
        triangles_.push_back(Triangle(anyTriangle()));
        break;
      case 1: // give a face a back side
      {
        const Triangle t = anyTriangle();
        triangles_.push_back({ t[1], t[0], t[2] });
        break;
      }
      case 2: // turn a face over
      {
        Triangle& t = anyTriangle();
        std::swap(t[0], t[1]);
        break;
      }
      case 3: // join two points anywhere
        joinPoints(anyPoint(), anyPoint());
        break;
      case 4: // move a point onto another one
        points_[anyPoint()] = Vector3(points_[anyPoint()]);
        break;
      case 5: // add a face anywhere
        triangles_.push_back(randomTriangle());
        break;
      default: // flatten a face
      {
        const Triangle t = anyTriangle();
        points_[t[0]] = (points_[t[1]] + points_[t[2]]) / 2;
        break;
      }
    }
  }

  void joinPoints(Index from, Index to)
  {
    for (Triangle& t : triangles_)
    {
      std::replace(t.begin(), t.end(), from, to);
    }
  }

  SurfaceInput finish()
  {
    const bool explode = pick(4) == 0;
    std::vector<Vector3> points;
    std::vector<std::vector<Index>> polygons;
    for (const Triangle& t : triangles_)
    {
      polygons.push_back({ t[0], t[1], t[2] });
      for (Index& v : polygons.back())
      {
        points.push_back(points_[v]);
        v = explode ? static_cast<Index>(points.size() - 1) : v;
      }
    }
    return makeInput(explode ? points : points_, polygons);
  }

  std::mt19937 random_;
  std::vector<Vector3> points_;
  std::vector<Triangle> triangles_;
};

} // namespace quadrille::test

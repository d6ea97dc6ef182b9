// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Small meshes that all tests of Core share. All of them pass validate(); closed ones point outwards.
#pragma once

#include "Base/Angles.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace quadrille::test
{

using quadrille::kPi;

using Triangle = std::array<Index, 3>;

/// A mesh without features from a triangle list; throws like pairHalfEdges.
inline Mesh makeMesh(std::vector<Vector3> points, const std::vector<Triangle>& triangles)
{
  Mesh mesh;
  mesh.position = std::move(points);
  for (const Triangle& t : triangles)
  {
    mesh.origin.append(t.begin(), t.end());
  }
  mesh.twin = pairHalfEdges(mesh.origin, mesh.vertexCount());
  mesh.flags.assign(mesh.origin.size(), 0);
  return mesh;
}

/// With a size at each vertex, by its position.
inline Mesh withSizes(Mesh mesh, const std::function<double(const Vector3&)>& size)
{
  for (const Vector3& p : mesh.position)
  {
    mesh.sizing.push_back(static_cast<float>(size(p)));
  }
  return mesh;
}

inline Vector3 faceNormal(const Mesh& mesh, Index f)
{
  return mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1)).normalized();
}

/// Flags the inner edges whose two face normals differ by more than the angle (radians).
inline Mesh markFeatures(Mesh mesh, double angleRadians)
{
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Index g = mesh.twin[h];
    if (g != kInvalidIndex &&
      faceNormal(mesh, Mesh::face(h)).dot(faceNormal(mesh, Mesh::face(g))) < std::cos(angleRadians))
    {
      mesh.flags.edit()[h] |= kFeatureEdge;
    }
  }
  return mesh;
}

/// Collects points on an integer lattice once each, and quads as two triangles each.
class LatticeBuilder
{
public:
  Index point(int x, int y, int z)
  {
    const auto found = ids_.try_emplace({ x, y, z }, static_cast<Index>(points.size()));
    if (found.second)
    {
      points.emplace_back(x, y, z);
    }
    return found.first->second;
  }
  void quad(Index a, Index b, Index c, Index d)
  {
    triangles.push_back({ a, b, c });
    triangles.push_back({ a, c, d });
  }

  std::vector<Vector3> points;
  std::vector<Triangle> triangles;

private:
  std::map<std::array<int, 3>, Index> ids_;
};

/// Cells of [0, columns] x [0, rows] in the plane z = 0 that `keep` wants; edge length 1, normal +z.
inline Mesh planeCells(int columns, int rows, const std::function<bool(int, int)>& keep)
{
  LatticeBuilder builder;
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < columns; ++i)
    {
      if (keep(i, j))
      {
        builder.quad(builder.point(i, j, 0), builder.point(i + 1, j, 0),
          builder.point(i + 1, j + 1, 0), builder.point(i, j + 1, 0));
      }
    }
  }
  return makeMesh(std::move(builder.points), builder.triangles);
}

/// Flat and open, columns x rows unit cells, 2 triangles each. chi 1.
inline Mesh gridPlane(int columns, int rows)
{
  return planeCells(columns, rows, [](int, int) { return true; });
}

/// Square plate of (3 n)^2 unit cells without its middle n x n. chi 0, two boundary loops.
inline Mesh plateWithHole(int n)
{
  return planeCells(3 * n, 3 * n, [n](int i, int j) { return i / n != 1 || j / n != 1; });
}

/// L-shaped plate: (2 n)^2 unit cells without the upper right n x n. chi 1, one reflex corner.
inline Mesh plateL(int n)
{
  return planeCells(2 * n, 2 * n, [n](int i, int j) { return i < n || j < n; });
}

/// Sides of the unit voxels that `inside` holds, each cut into n x n cells of length 1/n. Voxels may
/// touch along edges or in corners only; the surface is no manifold then.
inline LatticeBuilder voxelSides(
  std::array<int, 3> size, int n, const std::function<bool(int, int, int)>& inside)
{
  LatticeBuilder builder;
  const auto solid = [&](std::array<int, 3> c)
  {
    return c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && c[0] < size[0] && c[1] < size[1] &&
      c[2] < size[2] && inside(c[0], c[1], c[2]);
  };
  const auto addSide = [&](std::array<int, 3> cell, int axis, bool positive)
  {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const auto corner = [&](int i, int j)
    {
      std::array<int, 3> p{};
      p[axis] = n * (cell[axis] + (positive ? 1 : 0));
      p[u] = n * cell[u] + i;
      p[v] = n * cell[v] + j;
      return builder.point(p[0], p[1], p[2]);
    };
    for (int i = 0; i < n; ++i)
    {
      for (int j = 0; j < n; ++j)
      {
        const Index a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1),
                    d = corner(i, j + 1);
        positive ? builder.quad(a, b, c, d) : builder.quad(a, d, c, b);
      }
    }
  };
  for (int x = 0; x < size[0]; ++x)
  {
    for (int y = 0; y < size[1]; ++y)
    {
      for (int z = 0; z < size[2]; ++z)
      {
        for (int axis = 0; solid({ x, y, z }) && axis < 3; ++axis)
        {
          for (const int step : { -1, 1 })
          {
            std::array<int, 3> neighbour{ x, y, z };
            neighbour[axis] += step;
            if (!solid(neighbour))
            {
              addSide({ x, y, z }, axis, step > 0);
            }
          }
        }
      }
    }
  }
  for (Vector3& p : builder.points)
  {
    p /= n;
  }
  return builder;
}

/// Surface of the unit voxels that `inside` holds, each voxel side cut into n x n cells of length 1/n.
inline Mesh voxelSurface(
  std::array<int, 3> size, int n, const std::function<bool(int, int, int)>& inside)
{
  LatticeBuilder builder = voxelSides(size, n, inside);
  return makeMesh(std::move(builder.points), builder.triangles);
}

/// Surface of the unit cube [0, 1]^3, n x n cells a side, 12 n^2 triangles. chi 2.
inline Mesh unitCube(int n)
{
  return voxelSurface({ 1, 1, 1 }, n, [](int, int, int) { return true; });
}

/// Block of 5 x 3 x 1 voxels with two square holes, n x n cells a voxel side. Closed, chi -2.
inline Mesh doubleTorus(int n)
{
  return voxelSurface({ 5, 3, 1 }, n, [](int x, int y, int) { return y != 1 || x % 2 == 0; });
}

/// Block of 3 x 3 x 1 voxels without its middle, n x n cells a voxel side. Closed, chi 0, sharp.
inline Mesh squareTorus(int n)
{
  return voxelSurface({ 3, 3, 1 }, n, [](int x, int y, int) { return x != 1 || y != 1; });
}

/// Unit sphere: icosahedron with every triangle cut in four `level` times; 20 * 4^level faces. chi 2.
inline Mesh sphere(int level)
{
  const double t = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vector3> points{ { -1, t, 0 }, { 1, t, 0 }, { -1, -t, 0 }, { 1, -t, 0 }, { 0, -1, t },
    { 0, 1, t }, { 0, -1, -t }, { 0, 1, -t }, { t, 0, -1 }, { t, 0, 1 }, { -t, 0, -1 },
    { -t, 0, 1 } };
  std::vector<Triangle> triangles{ { 0, 11, 5 }, { 0, 5, 1 }, { 0, 1, 7 }, { 0, 7, 10 },
    { 0, 10, 11 }, { 1, 5, 9 }, { 5, 11, 4 }, { 11, 10, 2 }, { 10, 7, 6 }, { 7, 1, 8 }, { 3, 9, 4 },
    { 3, 4, 2 }, { 3, 2, 6 }, { 3, 6, 8 }, { 3, 8, 9 }, { 4, 9, 5 }, { 2, 4, 11 }, { 6, 2, 10 },
    { 8, 6, 7 }, { 9, 8, 1 } };
  for (int i = 0; i < level; ++i)
  {
    std::map<std::pair<Index, Index>, Index> midpoints;
    const auto midpoint = [&](Index a, Index b)
    {
      const auto found =
        midpoints.try_emplace(std::minmax(a, b), static_cast<Index>(points.size()));
      if (found.second)
      {
        points.push_back((points[a] + points[b]) / 2);
      }
      return found.first->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& f : triangles)
    {
      const Index ab = midpoint(f[0], f[1]), bc = midpoint(f[1], f[2]), ca = midpoint(f[2], f[0]);
      finer.insert(
        finer.end(), { { f[0], ab, ca }, { f[1], bc, ab }, { f[2], ca, bc }, { ab, bc, ca } });
    }
    triangles = std::move(finer);
  }
  for (Vector3& p : points)
  {
    p.normalize();
  }
  return makeMesh(std::move(points), triangles);
}

/// Grid of columns x rows cells, closed in u and, if asked, in v; position from (u, v) in [0, 1].
inline Mesh parametricGrid(
  int columns, int rows, bool closedV, const std::function<Vector3(double u, double v)>& position)
{
  LatticeBuilder builder;
  const auto point = [&](int i, int j)
  { return builder.point(i % columns, closedV ? j % rows : j, 0); };
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < columns; ++i)
    {
      builder.quad(point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1));
    }
  }
  for (Vector3& p : builder.points)
  {
    p = position(p.x() / columns, p.y() / rows);
  }
  return makeMesh(std::move(builder.points), builder.triangles);
}

/// Torus about the z axis, `around` x `across` cells (3 or more each). chi 0.
inline Mesh torus(int around, int across, double radius = 1, double tubeRadius = 0.4)
{
  return parametricGrid(around, across, true,
    [=](double u, double v)
    {
      const double r = radius + tubeRadius * std::cos(2 * kPi * v);
      return Vector3(
        r * std::cos(2 * kPi * u), r * std::sin(2 * kPi * u), tubeRadius * std::sin(2 * kPi * v));
    });
}

/// Cylinder about the z axis without lids, `around` (3 or more) x `along` cells. chi 0.
inline Mesh openCylinder(int around, int along, double radius = 1, double height = 2)
{
  return parametricGrid(around, along, false,
    [=](double u, double v) {
      return Vector3(radius * std::cos(2 * kPi * u), radius * std::sin(2 * kPi * u), height * v);
    });
}

/// Both meshes side by side as one, flags kept; the second one moved by `offset`.
inline Mesh disjointUnion(Mesh a, const Mesh& b, const Vector3& offset)
{
  const Index vertices = a.vertexCount();
  const Index halfEdges = a.halfEdgeCount();
  for (const Vector3& p : b.position)
  {
    a.position.push_back(p + offset);
  }
  for (Index h = 0; h < b.halfEdgeCount(); ++h)
  {
    a.origin.push_back(b.origin[h] + vertices);
    a.twin.push_back(b.isBoundary(h) ? kInvalidIndex : b.twin[h] + halfEdges);
    a.flags.push_back(b.flags[h]);
  }
  return a;
}

/// #F, bits as SurfaceInput::featureEdges: edges that join all vertices of a connected mesh, and close no loop.
inline std::vector<std::uint8_t> spanningTree(const Mesh& mesh)
{
  std::vector<std::uint8_t> bits(mesh.faceCount(), 0), isReached(mesh.vertexCount(), 0);
  isReached[mesh.origin[0]] = 1;
  for (bool grows = true; grows;)
  {
    grows = false;
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      if (isReached[mesh.origin[h]] != 0 && isReached[mesh.target(h)] == 0)
      {
        isReached[mesh.target(h)] = 1;
        bits[Mesh::face(h)] |= static_cast<std::uint8_t>(1U << h % 3);
        grows = true;
      }
    }
  }
  return bits;
}

/// A sphere and a cube, disjoint. chi 4.
inline Mesh twoComponents()
{
  return disjointUnion(sphere(2), unitCube(4), Vector3(3, 0, 0));
}

/// A plain OBJ of triangles (v and f lines, also f a/b/c); none when the file is missing or has
/// other polygons.
inline std::optional<Mesh> loadObj(const std::string& path)
{
  std::ifstream file(path);
  if (!file)
  {
    return std::nullopt;
  }
  std::vector<Vector3> points;
  std::vector<Triangle> triangles;
  std::string line;
  while (std::getline(file, line))
  {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v")
    {
      Vector3 p;
      words >> p.x() >> p.y() >> p.z();
      points.push_back(p);
    }
    else if (kind == "f")
    {
      std::vector<Index> corners;
      for (std::string corner; words >> corner;)
      {
        corners.push_back(static_cast<Index>(std::stoul(corner)) - 1);
      }
      if (corners.size() != 3)
      {
        return std::nullopt;
      }
      triangles.push_back({ corners[0], corners[1], corners[2] });
    }
  }
  return makeMesh(std::move(points), triangles);
}

} // namespace quadrille::test

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: GPL-3.0-or-later
/// CGAL's types for the sources of this module; nothing else includes it. GPL as they include headers of CGAL that are.
#pragma once

#include "Mesh/NearestTriangle.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <vector>

namespace quadrille::cgal
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Corners = std::array<std::size_t, 3>;

inline std::vector<Point> pointsOf(const TriangleList& triangles)
{
  std::vector<Point> points;
  points.reserve(triangles.points.size());
  for (const Vector3& p : triangles.points)
  {
    points.emplace_back(p.x(), p.y(), p.z());
  }
  return points;
}

inline std::vector<Corners> cornersOf(const TriangleList& triangles)
{
  std::vector<Corners> corners;
  corners.reserve(triangles.corners.size());
  for (const std::array<Index, 3>& triangle : triangles.corners)
  {
    corners.push_back({ triangle[0], triangle[1], triangle[2] });
  }
  return corners;
}

inline Vector3 vectorOf(const Point& p)
{
  return { p.x(), p.y(), p.z() };
}

/// Of a mesh of triangles; ids follow each other as in the mesh, without those that were removed.
inline TriangleList trianglesOf(const SurfaceMesh& mesh)
{
  TriangleList triangles;
  std::vector<Index> id(mesh.number_of_vertices() + mesh.number_of_removed_vertices());
  for (const SurfaceMesh::Vertex_index v : mesh.vertices())
  {
    id[v] = static_cast<Index>(triangles.points.size());
    triangles.points.push_back(vectorOf(mesh.point(v)));
  }
  for (const SurfaceMesh::Face_index f : mesh.faces())
  {
    std::array<Index, 3> corners{};
    std::size_t k = 0;
    for (const SurfaceMesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f)))
    {
      corners[k++] = id[v];
    }
    triangles.corners.push_back(corners);
  }
  return triangles;
}

} // namespace quadrille::cgal

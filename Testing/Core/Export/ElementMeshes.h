// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Small meshes of elements.
#pragma once

#include "Export/ElementMesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace quadrille::testing
{

/// columns x rows unit squares in the plane z = 0, node (i, j) is i + (columns + 1) j, element (i, j) i + columns j.
inline ElementMesh flatGrid(Index columns, Index rows)
{
  ElementMesh mesh;
  for (Index j = 0; j <= rows; ++j)
  {
    for (Index i = 0; i <= columns; ++i)
    {
      mesh.nodes.emplace_back(i, j, 0);
    }
  }
  for (Index j = 0; j < rows; ++j)
  {
    for (Index i = 0; i < columns; ++i)
    {
      const Index a = i + (columns + 1) * j;
      for (const Index node : { a, a + 1, a + columns + 2, a + columns + 1 })
      {
        mesh.elements.push_back(node);
      }
    }
  }
  mesh.patches.push_back({ 1, {} });
  mesh.featureEdges.assign(std::size_t{ columns } * rows, 0);
  return mesh;
}

/// Marks the edge between two nodes in all elements that have it.
inline void markFeature(ElementMesh& mesh, Index a, Index b)
{
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      const Index p = mesh.corner(e, i);
      const Index q = mesh.corner(e, i + 1);
      if ((p == a && q == b) || (p == b && q == a))
      {
        mesh.featureEdges[e] = static_cast<std::uint8_t>(mesh.featureEdges[e] | (1U << i));
      }
    }
  }
}

/// The sides of a unit cube, n x n elements each, with its edges on features, a patch a side from 1.
inline ElementMesh cube(Index n)
{
  ElementMesh mesh;
  std::map<std::array<Index, 3>, Index> nodes;
  const auto node = [&](const std::array<Index, 3>& p)
  {
    const auto found = nodes.emplace(p, static_cast<Index>(mesh.nodes.size()));
    if (found.second)
    {
      mesh.nodes.emplace_back(Vector3(p[0], p[1], p[2]) / n);
    }
    return found.first->second;
  };
  for (Index side = 0; side < 6; ++side)
  {
    const Index axis = side / 2;
    const Index u = (axis + 1) % 3;
    const Index v = (axis + 2) % 3;
    const bool isHigh = side % 2 == 1;
    mesh.patches.push_back({ static_cast<std::int64_t>(side) + 1, {} });
    for (Index j = 0; j < n; ++j)
    {
      for (Index i = 0; i < n; ++i)
      {
        std::array<Index, 4> corners{};
        for (Index k = 0; k < 4; ++k)
        {
          std::array<Index, 3> p{};
          p[axis] = isHigh ? n : 0;
          p[u] = i + (k == 1 || k == 2 ? 1 : 0);
          p[v] = j + (k >= 2 ? 1 : 0);
          corners[isHigh ? k : 3 - k] = node(p); // outwards on both sides
        }
        mesh.elements.insert(mesh.elements.end(), corners.begin(), corners.end());
        mesh.patchOf.push_back(side);
      }
    }
  }
  mesh.featureEdges.assign(mesh.elementCount(), 0);
  const auto isExtreme = [&](const Vector3& p, int k) { return p[k] == 0 || p[k] == 1; };
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      const Vector3& p = mesh.nodes[mesh.corner(e, i)];
      const Vector3& q = mesh.nodes[mesh.corner(e, i + 1)];
      int shared = 0; // extreme coordinates that the ends share: two on an edge of the cube
      for (int k = 0; k < 3; ++k)
      {
        shared += isExtreme(p, k) && p[k] == q[k] ? 1 : 0;
      }
      mesh.featureEdges[e] =
        static_cast<std::uint8_t>(mesh.featureEdges[e] | (shared == 2 ? 1U << i : 0U));
    }
  }
  return mesh;
}

/// `rings` rows of elements round a circle: node (i, j) is i + around j, at the radius 1 + j.
inline ElementMesh annulus(Index around, Index rings)
{
  constexpr double kTurn = 6.283185307179586;
  ElementMesh mesh;
  for (Index j = 0; j <= rings; ++j)
  {
    for (Index i = 0; i < around; ++i)
    {
      const double angle = kTurn * i / around;
      mesh.nodes.push_back((1. + j) * Vector3(std::cos(angle), std::sin(angle), 0));
    }
  }
  for (Index j = 0; j < rings; ++j)
  {
    for (Index i = 0; i < around; ++i)
    {
      const Index next = (i + 1) % around;
      for (const Index node :
        { j * around + i, (j + 1) * around + i, (j + 1) * around + next, j * around + next })
      {
        mesh.elements.push_back(node);
      }
    }
  }
  mesh.patches.push_back({ 1, {} });
  mesh.featureEdges.assign(mesh.elementCount(), 0);
  return mesh;
}

/// Middles of edges, and with 9 nodes centres.
inline ElementMesh secondOrder(const ElementMesh& mesh, int nodes)
{
  ElementMesh result = mesh;
  result.nodesPerElement = nodes;
  result.elements.clear();
  std::map<std::pair<Index, Index>, Index> middles;
  const auto add = [&result](const Vector3& p)
  {
    result.nodes.push_back(p);
    return static_cast<Index>(result.nodes.size() - 1);
  };
  for (std::size_t e = 0; e < mesh.elementCount(); ++e)
  {
    result.elements.insert(result.elements.end(), mesh.element(e), mesh.element(e) + 4);
    Vector3 centre = Vector3::Zero();
    for (std::size_t i = 0; i < 4; ++i)
    {
      const std::pair<Index, Index> edge = std::minmax(mesh.corner(e, i), mesh.corner(e, i + 1));
      const Vector3 middle = (mesh.nodes[edge.first] + mesh.nodes[edge.second]) / 2;
      if (middles.count(edge) == 0)
      {
        middles[edge] = add(middle);
      }
      result.elements.push_back(middles[edge]);
      centre += middle / 4;
    }
    if (nodes == 9)
    {
      result.elements.push_back(add(centre));
    }
  }
  return result;
}

} // namespace quadrille::testing

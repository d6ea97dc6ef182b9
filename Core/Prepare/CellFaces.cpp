// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/CellFaces.h"

#include "Base/Progress.h"

#include <algorithm>
#include <vector>

namespace quadrille
{

namespace
{

/// Faces of voxels have 9 edges, with both diagonals of each; marching cubes between labels, whose points are the
/// middles of the cells' edges, have 27.
constexpr std::size_t kMostVectors = 32;
/// So many edges are the same on average. A designed body of few planes has few vectors, too, each of a few edges.
constexpr std::size_t kLeastUses = 16;
/// Vectors are the same when they differ by less than this part of their length: far above what rounding to single
/// precision leaves, far below what the cells of a mesh that is no grid differ by.
constexpr double kSame = 1e-3;

bool isSame(const Vector3& a, const Vector3& b)
{
  const double most = kSame * kSame * a.squaredNorm();
  return (a - b).squaredNorm() < most || (a + b).squaredNorm() < most;
}

} // namespace

bool isMadeOfCells(const Mesh& mesh)
{
  std::vector<Vector3> vectors;
  std::size_t edges = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (!mesh.isBoundary(h) && mesh.twin[h] < h)
    {
      continue;
    }
    ++edges;
    const Vector3 edge = mesh.edgeVector(h);
    const auto known = std::find_if(vectors.begin(), vectors.end(),
      [&edge](const Vector3& vector) { return isSame(edge, vector); });
    if (known != vectors.end())
    {
      continue;
    }
    if (vectors.size() == kMostVectors)
    {
      return false;
    }
    vectors.push_back(edge);
  }
  return edges > kLeastUses * vectors.size();
}

} // namespace quadrille

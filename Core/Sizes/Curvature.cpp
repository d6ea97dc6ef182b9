// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizes/Curvature.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Mesh/Topology.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_set>

namespace quadrille
{
namespace
{

using Cell = std::array<std::int32_t, 3>;

Vector3 areaVector(const Mesh& mesh, Index f)
{
  return 0.5 * mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1));
}

std::vector<Cell> cellsOf(const Mesh& mesh, double side, int threads)
{
  std::vector<Cell> cells(mesh.faceCount());
  parallelForEach<Index>(cells.size(), kHeavyChunk, threads,
    [&](Index f)
    {
      const Vector3 p = mesh.middleOfFace(f) / side;
      for (int i = 0; i < 3; ++i)
      {
        cells[f][static_cast<std::size_t>(i)] =
          static_cast<std::int32_t>(std::clamp(std::floor(p[i]), -2147483647.0, 2147483647.0));
      }
    });
  return cells;
}

Grouped<> facesOfPatches(const std::vector<Index>& patchOf, std::size_t patches)
{
  return { patches,
    [&](const auto& visit)
    {
      for (Index f = 0; f < patchOf.size(); ++f)
      {
        visit(patchOf[f], f);
      }
    } };
}

SurfacePatch measurePatch(const Mesh& mesh, const Index* begin, const Index* end)
{
  SurfacePatch patch;
  Vector3 sum = Vector3::Zero();
  for (const Index* f = begin; f != end; ++f)
  {
    const Vector3 area = areaVector(mesh, *f);
    patch.area += area.norm();
    patch.centre += area.norm() * mesh.middleOfFace(*f);
    sum += area;
  }
  patch.centre = patch.area > 0 ? Vector3(patch.centre / patch.area) : mesh.middleOfFace(*begin);
  patch.normal = sum.norm() > 0 ? Vector3(sum.normalized()) : Vector3(Vector3::Zero());
  double nearest = kInfinity;
  for (const Index* f = begin; f != end; ++f)
  {
    const double distance = (mesh.middleOfFace(*f) - patch.centre).squaredNorm();
    if (distance < nearest)
    {
      nearest = distance;
      patch.face = *f;
    }
  }
  return patch;
}

void findNeighbours(const Mesh& mesh, const Grouped<>& faces, SurfacePatches& result, int threads)
{
  std::vector<std::vector<Index>> neighbours(result.patches.size());
  parallelForEach<Index>(result.patches.size(), kHeavyChunk, threads,
    [&](Index p)
    {
      std::vector<Index>& mine = neighbours[p];
      for (const Index* f = faces.begin(p); f != faces.end(p); ++f)
      {
        for (Index h = 3 * *f; h < 3 * *f + 3; ++h)
        {
          const Index other = mesh.isConstrained(h) ? p : result.patchOf[Mesh::face(mesh.twin[h])];
          if (other != p)
          {
            mine.push_back(other);
          }
        }
      }
      sortUnique(mine);
    });
  result.first.assign(1, 0);
  for (const std::vector<Index>& mine : neighbours)
  {
    append(result.neighbours, mine);
    result.first.push_back(static_cast<Index>(result.neighbours.size()));
  }
}

/// Sums over the faces of a patch.
struct Bend
{
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero(); ///< bend times length, along the edges
  Vector3 turn = Vector3::Zero();                   ///< of the tangents of curves
  double length = 0;                                ///< of curves
};

/// Half of what each edge of the face bends; the other half is that of the face across.
Eigen::Matrix3d bendOf(const Mesh& mesh, Index f)
{
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  const Vector3 a = areaVector(mesh, f);
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    if (mesh.isConstrained(h))
    {
      continue;
    }
    const Vector3 b = areaVector(mesh, Mesh::face(mesh.twin[h]));
    const Vector3 axis = a.cross(b);
    const Vector3 edge = mesh.edgeVector(h);
    const double length = edge.norm();
    if (length > 0)
    {
      const double angle = std::atan2(axis.norm(), a.dot(b));
      sum += (axis.dot(edge) < 0 ? -0.5 : 0.5) * angle / length * edge * edge.transpose();
    }
  }
  return sum;
}

/// What the features and boundaries of a mesh turn at their vertices.
class CurveTurns
{
public:
  explicit CurveTurns(const Mesh& mesh)
    : mesh_(mesh), edges_(edgesAtVertices(mesh, constrainedEdges(mesh)))
  {
  }

  /// Adds the turn at the vertex that half-edge h, which is constrained, leaves.
  void addTurn(Index h, Bend& bend) const
  {
    const Index v = mesh_.origin[h];
    if (edges_.size(v) != 2)
    {
      return;
    }
    const auto away = [&](Index edge) -> Vector3
    { return mesh_.position[mesh_.otherEnd(edge, v)] - mesh_.position[v]; };
    const Vector3 a = away(edges_.begin(v)[0]), b = away(edges_.begin(v)[1]);
    // A corner is an end of edges whatever their length is.
    if (a.norm() > 0 && b.norm() > 0 && std::atan2(a.cross(b).norm(), -a.dot(b)) < kCornerAngle)
    {
      bend.turn += a.normalized() + b.normalized();
      bend.length += (a.norm() + b.norm()) / 2;
    }
  }

private:
  const Mesh& mesh_;
  Grouped<> edges_; ///< constrained ones at each vertex
};

std::vector<Bend> bendsOf(const Mesh& mesh, const SurfacePatches& patches, int threads)
{
  const Grouped<> faces = facesOfPatches(patches.patchOf, patches.patches.size());
  const CurveTurns turns(mesh);
  std::vector<Bend> bends(patches.patches.size());
  parallelForEach<Index>(bends.size(), kHeavyChunk, threads,
    [&](Index p)
    {
      for (const Index* f = faces.begin(p); f != faces.end(p); ++f)
      {
        bends[p].tensor += bendOf(mesh, *f);
        for (Index h = 3 * *f; h < 3 * *f + 3; ++h)
        {
          if (mesh.isConstrained(h))
          {
            turns.addTurn(h, bends[p]);
          }
        }
      }
    });
  return bends;
}

/// The tensor has its eigenvalues along the edges that bend, that is across the principal directions.
PatchCurvature curvatureOf(const Bend& bend, double area, const Vector3& normal)
{
  PatchCurvature result;
  result.curve = bend.length > 0 ? bend.turn.norm() / bend.length : 0;
  if (!(area > 0) || normal.isZero(0))
  {
    return result;
  }
  const Vector3 x = normal.unitOrthogonal();
  const Vector3 y = normal.cross(x);
  Eigen::Matrix<double, 3, 2> plane;
  plane << x, y;
  const Eigen::Matrix2d flat = plane.transpose() * bend.tensor * plane / area;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(flat);
  const int most = std::abs(solver.eigenvalues()[1]) >= std::abs(solver.eigenvalues()[0]) ? 1 : 0;
  result.largest = solver.eigenvalues()[most];
  result.smallest = solver.eigenvalues()[1 - most];
  result.direction = result.largest != 0 ? Vector3(plane * solver.eigenvectors().col(1 - most))
                                         : Vector3(Vector3::Zero());
  return result;
}

} // namespace

double PatchCurvature::anisotropy() const
{
  const double sum = std::abs(largest) + std::abs(smallest);
  return sum > 0 ? std::abs(largest - smallest) / sum : 0;
}

void SurfacePatches::gather(Index p, double radius, std::vector<Index>& near) const
{
  near.assign(1, p);
  for (std::size_t i = 0; i < near.size(); ++i)
  {
    for (Index k = first[near[i]]; k < first[near[i] + 1]; ++k)
    {
      const Index q = neighbours[k];
      if ((patches[q].centre - patches[p].centre).norm() <= radius && !contains(near, q))
      {
        near.push_back(q);
      }
    }
  }
}

SurfacePatches findPatches(const Mesh& mesh, double cell, int threads)
{
  refuseIf(!(cell > 0) || !std::isfinite(cell),
    "patches of a surface: the side of a cell must be positive and finite.");
  const std::vector<Cell> cells = cellsOf(mesh, cell, threads);
  DisjointSets sets = joinedFaces(mesh, threads,
    [&](Index h)
    { return !mesh.isFeature(h) && cells[Mesh::face(h)] == cells[Mesh::face(mesh.twin[h])]; });
  SurfacePatches result;
  Index count = 0;
  result.patchOf = numberSets(sets, mesh.faceCount(), count);
  result.patches.resize(count);
  const Grouped<> faces = facesOfPatches(result.patchOf, count);
  parallelForEach<Index>(count, kHeavyChunk, threads,
    [&](Index p) { result.patches[p] = measurePatch(mesh, faces.begin(p), faces.end(p)); });
  findNeighbours(mesh, faces, result, threads);
  return result;
}

std::vector<PatchCurvature> patchCurvatures(
  const Mesh& mesh, const SurfacePatches& patches, double radius, int threads)
{
  const std::vector<Bend> bends = bendsOf(mesh, patches, threads);
  std::vector<PatchCurvature> result(bends.size());
  parallelFor(result.size(), kHeavyChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<Index> near;
      for (std::size_t p = begin; p < end; ++p)
      {
        patches.gather(static_cast<Index>(p), radius, near);
        Bend sum;
        double area = 0;
        Vector3 normal = Vector3::Zero();
        for (const Index q : near)
        {
          sum.tensor += bends[q].tensor;
          sum.turn += bends[q].turn;
          sum.length += bends[q].length;
          area += patches.patches[q].area;
          normal += patches.patches[q].area * patches.patches[q].normal;
        }
        result[p] = curvatureOf(
          sum, area, normal.norm() > 0 ? Vector3(normal.normalized()) : Vector3(Vector3::Zero()));
      }
    });
  return result;
}

PatchCurvature curvatureRound(const Mesh& mesh, Index face, double radius)
{
  std::vector<Index> near{ face };
  std::unordered_set<Index> isNear{ face };
  const Vector3 middle = mesh.middleOfFace(face);
  Bend sum;
  double area = 0;
  Vector3 normal = Vector3::Zero();
  for (std::size_t i = 0; i < near.size(); ++i)
  {
    const Vector3 own = areaVector(mesh, near[i]);
    sum.tensor += bendOf(mesh, near[i]);
    area += own.norm();
    normal += own;
    for (Index h = 3 * near[i]; h < 3 * near[i] + 3; ++h)
    {
      const Index next = mesh.isConstrained(h) ? face : Mesh::face(mesh.twin[h]);
      if ((mesh.middleOfFace(next) - middle).norm() <= radius && isNear.insert(next).second)
      {
        near.push_back(next);
      }
    }
  }
  return curvatureOf(
    sum, area, normal.norm() > 0 ? Vector3(normal.normalized()) : Vector3(Vector3::Zero()));
}

} // namespace quadrille

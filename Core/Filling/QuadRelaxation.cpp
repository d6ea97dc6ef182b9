// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/QuadRelaxation.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Quads/QuadMesh.h"
#include "Quads/QuadShape.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{

namespace
{

/// Moves may make quads worse than they are down to this shape only; points with a worse one look for a better place
/// than the mean of their neighbours.
constexpr double kSoundQuad = 0.6;
/// So many directions, and steps as shares of the mean length of their edges.
constexpr int kSearchDirections = 8;
constexpr std::array<double, 3> kSteps{ 0.4, 0.15, 0.05 };

class QuadRelaxation
{
public:
  QuadRelaxation(FaceQuads& mesh, const FaceGround& ground)
    : mesh_(mesh), ground_(ground), cornersAt_(halfEdgesAtPoints(mesh.quads, mesh.points.size()))
  {
  }

  void sweep()
  {
    for (Index v = mesh_.pinCount; v < mesh_.points.size(); ++v)
    {
      if (cornersAt_.size(v) == 0)
      {
        continue;
      }
      moveToMean(v);
      if (worstShapeAt(v) < kSoundQuad)
      {
        moveToBest(v);
      }
    }
  }

private:
  double worstShapeAt(Index v) const
  {
    double worst = 1;
    for (const Index* c = cornersAt_.begin(v); c != cornersAt_.end(v); ++c)
    {
      worst = std::min(worst, shapeOfQuad(mesh_, mesh_.quads[*c / 4]));
    }
    return worst;
  }

  /// Whether none of the quads at the point has a worse shape.
  bool isWorstAtLeast(Index v, double least) const
  {
    return std::all_of(cornersAt_.begin(v), cornersAt_.end(v),
      [&](Index c) { return shapeOfQuad(mesh_, mesh_.quads[c / 4]) >= least; });
  }

  /// With the point there, wherever the face is.
  bool isWorstAtLeastWith(Index v, const Vector3& place, double least)
  {
    const Vector3 before = std::exchange(mesh_.points[v], place);
    const bool isSo = isWorstAtLeast(v, least);
    mesh_.points[v] = before;
    return isSo;
  }

  /// Each neighbour inside counts twice, once for each quad.
  Vector3 meanOfNeighbours(Index v) const
  {
    Vector3 sum = Vector3::Zero();
    for (const Index* c = cornersAt_.begin(v); c != cornersAt_.end(v); ++c)
    {
      const std::array<Index, 4>& quad = mesh_.quads[*c / 4];
      sum += mesh_.points[quad[(*c + 1) % 4]] + mesh_.points[quad[(*c + 3) % 4]];
    }
    return sum / (2.0 * cornersAt_.size(v));
  }

  double meanEdge(Index v) const
  {
    double sum = 0;
    for (const Index* c = cornersAt_.begin(v); c != cornersAt_.end(v); ++c)
    {
      sum += (mesh_.points[mesh_.quads[*c / 4][(*c + 1) % 4]] - mesh_.points[v]).norm();
    }
    return sum / cornersAt_.size(v);
  }

  /// Whether the worst shape at the point is at least so good there; if not, it stays.
  bool tryMove(Index v, const Vector3& to, double least)
  {
    const auto spot = ground_.at(to, mesh_.normals[v], mesh_.points[v]);
    if (!spot)
    {
      return false;
    }
    const Vector3 place = mesh_.points[v], normal = mesh_.normals[v];
    mesh_.points[v] = spot->point;
    mesh_.normals[v] = spot->normal;
    if (isWorstAtLeast(v, least))
    {
      return true;
    }
    mesh_.points[v] = place;
    mesh_.normals[v] = normal;
    return false;
  }

  void moveToMean(Index v)
  {
    const Vector3 place = mesh_.points[v], mean = meanOfNeighbours(v);
    if ((mean - place).norm() < kLeastMove * meanEdge(v))
    {
      return;
    }
    const double least = std::min(kSoundQuad, worstShapeAt(v));
    if (!tryMove(v, mean, least))
    {
      tryMove(v, (place + mean) / 2, least);
    }
  }

  void moveToBest(Index v)
  {
    const double edge = meanEdge(v);
    double least = worstShapeAt(v) + kRoundingOfSingle;
    for (const double step : kSteps)
    {
      const Vector3 place = mesh_.points[v];
      const Vector3 u = mesh_.normals[v].unitOrthogonal(), w = mesh_.normals[v].cross(u);
      for (int i = 0; i < kSearchDirections; ++i)
      {
        const double angle = 2 * kPi * i / kSearchDirections;
        const Vector3 to = place + step * edge * (std::cos(angle) * u + std::sin(angle) * w);
        // Few are better, and the place below is found for these only.
        if (isWorstAtLeastWith(v, to, least) && tryMove(v, to, least))
        {
          least = worstShapeAt(v) + kRoundingOfSingle;
        }
      }
    }
  }

  FaceQuads& mesh_;
  const FaceGround& ground_;
  Grouped<> cornersAt_; ///< per point: 4q + i for corner i of quad q
};

} // namespace

double shapeOfQuad(const FaceQuads& mesh, const std::array<Index, 4>& quad)
{
  Vector3 normal = Vector3::Zero();
  for (const Index v : quad)
  {
    normal += mesh.normals[v];
  }
  return quadShape(cornersOf(mesh.points, quad), normal);
}

void relaxQuads(FaceQuads& mesh, const FaceGround& ground, int sweeps)
{
  QuadRelaxation relaxation(mesh, ground);
  for (int i = 0; i < sweeps; ++i)
  {
    relaxation.sweep();
  }
}

} // namespace quadrille

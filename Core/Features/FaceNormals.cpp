// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Features/FaceNormals.h"

#include "Mesh/PointSets.h"

#include <array>

namespace quadrille
{
namespace
{

/// The same over the precision of the coordinates, where that is worse.
constexpr double kReliableSteps = 16;

constexpr int kMostSliversInARow = 16;

/// Half-edges of a face, longest first.
std::array<Index, 3> byLength(const Mesh& mesh, Index f)
{
  std::array<Index, 3> edges{ 3 * f, 3 * f + 1, 3 * f + 2 };
  std::stable_sort(edges.begin(), edges.end(),
    [&mesh](Index a, Index b)
    { return mesh.edgeVector(a).squaredNorm() > mesh.edgeVector(b).squaredNorm(); });
  return edges;
}

} // namespace

FaceNormals::FaceNormals(const Mesh& mesh, double precision, int threads) : mesh_(mesh)
{
  const PointBox box = boxOfPoints(mesh.position, threads);
  height_ = std::max(kRoundingOfSingle * (box.high - box.low).norm(), kReliableSteps * precision);
}

/// The face whose normal stands for that of a sliver f: beyond the longest edges of slivers, and never back.
Index FaceNormals::beyondSlivers(Index f) const
{
  Index previous = kInvalidIndex;
  Index current = f;
  for (int step = 0; step < kMostSliversInARow && !ownOf(current).isReliable; ++step)
  {
    const std::array<Index, 3> edges = byLength(mesh_, current);
    const auto leadsOn = [&](Index h)
    { return !mesh_.isBoundary(h) && Mesh::face(mesh_.twin[h]) != previous; };
    const auto way = std::find_if(edges.begin(), edges.end(), leadsOn);
    if (way == edges.end())
    {
      break;
    }
    previous = current;
    current = Mesh::face(mesh_.twin[*way]);
  }
  return current;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/CellSteps.h"

#include "Base/Progress.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace quadrille
{

namespace
{

/// Edges that differ by less than 45 degrees in direction run along each other.
const double kParallel = std::sqrt(0.5);

struct Bend
{
  Index halfEdge;
  Vector3 middle;
  Vector3 direction; ///< unit
  bool isConcave;
};

std::vector<Bend> bendsOf(const Mesh& mesh)
{
  std::vector<Bend> bends;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (mesh.isBoundary(h) || mesh.twin[h] < h || !mesh.isFeature(h) ||
      (mesh.flags[h] & kRequestedFeature) != 0)
    {
      continue;
    }
    const Vector3& from = mesh.position[mesh.origin[h]];
    const Vector3& across = mesh.position[mesh.origin[Mesh::previous(mesh.twin[h])]];
    const Vector3 edge = mesh.edgeVector(h);
    bends.push_back({ h, from + edge / 2, edge.normalized(),
      mesh.doubleAreaNormal(Mesh::face(h)).dot(across - from) > 0 });
  }
  return bends;
}

/// Bends by the cubes of a grid that their middles lie in.
class BendGrid
{
public:
  BendGrid(const std::vector<Bend>& bends, double width) : bends_(bends), width_(width)
  {
    for (std::size_t i = 0; i < bends.size(); ++i)
    {
      pollNowAndThen(i);
      cubes_[cubeOf(bends[i].middle)].push_back(i);
    }
  }

  /// Whether one that fits with `bend` to a step is nearer than the width of a cube.
  bool hasOther(const Bend& bend) const
  {
    const Cube cube = cubeOf(bend.middle);
    for (int i = 0; i < 27; ++i)
    {
      const auto found =
        cubes_.find({ cube[0] + i % 3 - 1, cube[1] + i / 3 % 3 - 1, cube[2] + i / 9 - 1 });
      if (found != cubes_.end() &&
        std::any_of(found->second.begin(), found->second.end(),
          [&](std::size_t other) { return isStep(bend, bends_[other]); }))
      {
        return true;
      }
    }
    return false;
  }

private:
  using Cube = std::array<std::int64_t, 3>;

  Cube cubeOf(const Vector3& place) const
  {
    return { std::llround(place[0] / width_), std::llround(place[1] / width_),
      std::llround(place[2] / width_) };
  }

  bool isStep(const Bend& a, const Bend& b) const
  {
    return a.isConcave != b.isConcave && std::abs(a.direction.dot(b.direction)) > kParallel &&
      (a.middle - b.middle).squaredNorm() < width_ * width_;
  }

  const std::vector<Bend>& bends_;
  double width_;
  std::map<Cube, std::vector<std::size_t>> cubes_;
};

} // namespace

std::vector<Index> stepsBelow(const Mesh& mesh, double height)
{
  const std::vector<Bend> bends = bendsOf(mesh);
  const BendGrid grid(bends, height);
  std::vector<Index> steps;
  for (const Bend& bend : bends)
  {
    pollNowAndThen(bend.halfEdge);
    if (grid.hasOther(bend))
    {
      steps.push_back(bend.halfEdge);
    }
  }
  return 2 * steps.size() > bends.size() ? steps : std::vector<Index>{};
}

} // namespace quadrille

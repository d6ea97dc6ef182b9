// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/PatchLevels.h"

#include "Base/TryCount.h"
#include "Transfer/CollapseCosts.h"
#include "Transfer/LevelMesh.h"
#include "Transfer/LevelPlaces.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <tuple>

namespace quadrille
{
namespace
{

/// Inner vertices that the levels have at most, the coarsest one first.
constexpr std::array<std::size_t, 4> kInnerVertices{ 24, 96, 384, 1536 };
/// References flatter than this (2 area / longest edge squared) are replaced by equilateral ones.
constexpr double kFlattestTriangle = 0.1;
/// Work of a collapse, in triangles.
constexpr std::size_t kWorkOfCollapse = 100;

/// Takes vertices of a patch away, and puts them back from the first level on that has a map.
class PatchLevels
{
public:
  PatchLevels(const Mesh& mesh, const std::vector<Index>& patch,
    const std::vector<PatchStar>& stars, const std::vector<int>& turns, double scale,
    const std::vector<FixedVec2>& uv)
    : mesh_(mesh, patch, stars, turns, uv), places_(mesh_, scale)
  {
  }

  PatchLevelsResult run(const PatchSolver& solver);
  void write(std::vector<FixedVec2>& uv) const;

private:
  void coarsen();
  std::vector<std::size_t> levels() const;
  bool solve(const PatchSolver& solver);

  LevelMesh mesh_;
  LevelPlaces places_;
  std::optional<std::size_t>
    placed_; ///< of the vertices that may move, when those that go last were left
  std::size_t work_ = 0;
};

/// Down to the coarsest level, vertices with the shortest edges first.
void PatchLevels::coarsen()
{
  const CollapseCosts costs(mesh_);
  std::set<std::tuple<bool, double, Index>> queue; // whether it goes last, length, vertex
  std::vector<double> known(mesh_.vertexCount(), -1);
  const auto forget = [&](Index v)
  {
    if (known[v] >= 0)
    {
      queue.erase({ mesh_.vertex(v).goesLast, known[v], v });
      known[v] = -1;
    }
  };
  const auto update = [&](Index v)
  {
    forget(v);
    if (mesh_.vertex(v).freedom != PatchFreedom::Fixed && mesh_.vertex(v).corner != kInvalidIndex)
    {
      known[v] = mesh_.shortestEdge(v);
      queue.insert({ mesh_.vertex(v).goesLast, known[v], v });
    }
  };
  for (Index v = 0; v < mesh_.vertexCount(); ++v)
  {
    update(v);
  }
  while (mesh_.inner() > kInnerVertices.front() && !queue.empty())
  {
    const Index v = std::get<2>(*queue.begin());
    forget(v); // until something round it changes
    if (mesh_.vertex(v).goesLast && !placed_)
    {
      placed_ = mesh_.inner();
    }
    if (const auto best = costs.best(v))
    {
      const std::vector<Index> ring = mesh_.neighbours(v);
      mesh_.collapse(best->second);
      work_ += kWorkOfCollapse;
      for (const Index w : ring)
      {
        update(w);
      }
    }
  }
}

/// Asks for a map of the level as it is. True where it is valid; then the vertices have their places of it.
bool PatchLevels::solve(const PatchSolver& solver)
{
  std::vector<Index> faces, numberOf(mesh_.faceCount(), kInvalidIndex);
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    if (!mesh_.isGone(f))
    {
      numberOf[f] = static_cast<Index>(faces.size());
      faces.push_back(f);
    }
  }
  Mesh mesh;
  std::vector<int> turns;
  std::vector<Index> vertexOf(mesh_.vertexCount(), kInvalidIndex), patch;
  std::vector<FixedVec2> uv;
  for (const Index f : faces)
  {
    if (f < mesh_.patchFaces())
    {
      patch.push_back(numberOf[f]);
    }
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const Index v = mesh_.origin(h);
      if (vertexOf[v] == kInvalidIndex)
      {
        vertexOf[v] = mesh.vertexCount();
        mesh.position.push_back(mesh_.vertex(v).position);
        turns.push_back(mesh_.vertex(v).turns);
      }
      mesh.origin.push_back(vertexOf[v]);
      mesh.twin.push_back(mesh_.twin(h) == kInvalidIndex
          ? mesh_.twin(h)
          : 3 * numberOf[Mesh::face(mesh_.twin(h))] + mesh_.twin(h) % 3);
      mesh.flags.push_back(mesh_.isConstrained(h) ? kFeatureEdge : 0);
      uv.push_back(mesh_.image(h));
    }
  }
  if (!solver(mesh, patch, turns, uv))
  {
    return false;
  }
  for (const Index f : patch)
  {
    for (Index k = 0; k < 3; ++k)
    {
      const Index c = 3 * faces[f] + k;
      const Index v = mesh_.origin(c);
      if (mesh_.vertex(v).freedom != PatchFreedom::Fixed)
      {
        mesh_.setPlace(v, mesh_.toOwn(c, uv[3 * f + k]));
      }
    }
  }
  return true;
}

/// The level of the vertices that go last, and the coarser ones; then finer ones.
std::vector<std::size_t> PatchLevels::levels() const
{
  std::vector<std::size_t> sizes(kInnerVertices.begin(), kInnerVertices.end());
  if (placed_)
  {
    sizes.push_back(*placed_);
    std::sort(sizes.begin(), sizes.end());
  }
  return sizes;
}

PatchLevelsResult PatchLevels::run(const PatchSolver& solver)
{
  PatchLevelsResult result;
  const std::size_t before = mesh_.inner();
  coarsen();
  bool isOther = false;
  for (const std::size_t most : levels())
  {
    while (mesh_.hasCollapses() && mesh_.inner() < most)
    {
      mesh_.undo();
    }
    if (mesh_.inner() == before)
    {
      break; // tried as a whole before
    }
    countTry(Try::LevelOfPatch, isOther ? 1 : 0);
    if (!solve(solver))
    {
      isOther = true;
      continue;
    }
    result.valid = true;
    while (mesh_.hasCollapses() && result.valid)
    {
      result.valid = places_.putBack(mesh_.undo());
    }
    countTryLed(Try::LevelOfPatch, isOther && result.valid ? 1 : 0);
    break;
  }
  result.work = work_ + places_.work();
  return result;
}

void PatchLevels::write(std::vector<FixedVec2>& uv) const
{
  for (Index f = 0; f < mesh_.patchFaces(); ++f)
  {
    for (Index k = 0; k < 3; ++k)
    {
      uv[3 * mesh_.fineFace(f) + k] = mesh_.image(3 * f + k);
    }
  }
}

} // namespace

Eigen::Matrix2d inverseOfTriangle(const Vector3& ab, const Vector3& ac)
{
  const double longest = std::max({ ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm() });
  const double doubled = ab.cross(ac).norm();
  Eigen::Matrix2d reference;
  if (doubled > kFlattestTriangle * longest)
  {
    const double length = ab.norm();
    reference << length, ab.dot(ac) / length, 0, doubled / length;
  }
  else
  {
    // A tenth of the longest edge keeps the weight of a sliver small without letting it vanish.
    const double side = 0.1 * std::sqrt(std::max(longest, 1e-12));
    reference << side, 0.5 * side, 0, 0.8660254037844386 * side;
  }
  return reference.inverse();
}

PatchLevelsResult solveByLevels(const Mesh& mesh, const std::vector<Index>& patch,
  const std::vector<PatchStar>& stars, const std::vector<int>& turns, double scale,
  const PatchSolver& solver, std::vector<FixedVec2>& uv)
{
  PatchLevels levels(mesh, patch, stars, turns, scale, uv);
  const PatchLevelsResult result = levels.run(solver);
  if (result.valid)
  {
    levels.write(uv);
  }
  return result;
}

} // namespace quadrille

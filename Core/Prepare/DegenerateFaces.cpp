// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/DegenerateFaces.h"

#include "Base/Parallel.h"
#include "Mesh/SurfaceEdit.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace quadrille
{

namespace
{

constexpr std::size_t kDegenerateChunk = 65536;

/// An edge this much shorter than the longest one is collapsed; a longer one means a cap.
constexpr double kNeedleEdge = 1e-9;

struct Sliver
{
  double longest; ///< squared
  Index face;

  bool operator<(const Sliver& other) const
  {
    return longest != other.longest ? longest < other.longest : face > other.face;
  }
};

double squaredLength(const Mesh& mesh, Index h)
{
  return mesh.edgeVector(h).squaredNorm();
}

Index longestEdge(const Mesh& mesh, Index f)
{
  const auto shorter = [&mesh](Index a, Index b)
  { return squaredLength(mesh, a) < squaredLength(mesh, b); };
  return std::max({ 3 * f, 3 * f + 1, 3 * f + 2 }, shorter);
}

Index shortestEdge(const Mesh& mesh, Index f)
{
  const auto shorter = [&mesh](Index a, Index b)
  { return squaredLength(mesh, a) < squaredLength(mesh, b); };
  return std::min({ 3 * f, 3 * f + 1, 3 * f + 2 }, shorter);
}

class SliverRemover
{
public:
  explicit SliverRemover(PreparedSurface& surface) : surface_(surface), mesh_(surface.mesh) {}

  void push(Index f)
  {
    if (mesh_.origin[3 * f] != kInvalidIndex && isDegenerate(mesh_, f))
    {
      queue_.push({ squaredLength(mesh_, longestEdge(mesh_, f)), f });
    }
  }

  void run()
  {
    // Flips of the longest edge make the longest slivers shorter, but rounding might let a row of them
    // go in circles.
    std::size_t budget = 100 + 20 * queue_.size();
    while (!queue_.empty())
    {
      const Index f = queue_.top().face;
      queue_.pop();
      if (mesh_.origin[3 * f] != kInvalidIndex && isDegenerate(mesh_, f))
      {
        budget > 0 ? resolve(f) : removeFace(surface_, f);
        budget -= budget > 0 ? 1 : 0;
      }
    }
  }

private:
  void resolve(Index f)
  {
    const Index shortest = shortestEdge(mesh_, f);
    const Index longest = longestEdge(mesh_, f);
    const bool needle =
      squaredLength(mesh_, shortest) <= kNeedleEdge * kNeedleEdge * squaredLength(mesh_, longest);
    if (needle && mayCollapse(mesh_, shortest))
    {
      collapse(shortest);
    }
    else if (mesh_.isBoundary(longest))
    {
      removeFace(surface_, f); // its other two edges are where the boundary was
    }
    else if (mayFlip(mesh_, longest))
    {
      const Index g = Mesh::face(mesh_.twin[longest]);
      flipSliver(surface_, longest);
      push(f);
      push(g);
    }
    else if (mayCollapse(mesh_, shortest))
    {
      collapse(shortest);
    }
    else
    {
      removeFace(surface_, f);
    }
  }

  void collapse(Index h)
  {
    std::vector<Index> faces;
    forEachInFan(mesh_, h, [&](Index g) { faces.push_back(Mesh::face(g)); });
    collapseEdge(surface_, h);
    for (const Index f : faces)
    {
      push(f);
    }
  }

  PreparedSurface& surface_;
  Mesh& mesh_;
  std::priority_queue<Sliver> queue_;
};

std::vector<Index> findDegenerate(const Mesh& mesh, int threads)
{
  return parallelSelect(
    mesh.faceCount(), kDegenerateChunk, threads, [&](Index f) { return isDegenerate(mesh, f); });
}

} // namespace

bool isDegenerate(const Mesh& mesh, Index f)
{
  const Vector3& a = mesh.position[mesh.origin[3 * f]];
  const Vector3& b = mesh.position[mesh.origin[3 * f + 1]];
  const Vector3& c = mesh.position[mesh.origin[3 * f + 2]];
  const double longest =
    std::max({ (b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm() });
  const double magnitude =
    std::max({ a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff() });
  // Coordinates are known to half an ulp, so heights to about this.
  const double height = 4 * std::numeric_limits<double>::epsilon() * magnitude;
  return (b - a).cross(c - a).squaredNorm() <= height * height * longest;
}

std::size_t removeDegenerateFaces(PreparedSurface& surface, int threads)
{
  const std::vector<Index> faces = findDegenerate(surface.mesh, threads);
  SliverRemover remover(surface);
  for (const Index f : faces)
  {
    remover.push(f);
  }
  remover.run();
  return faces.size();
}

} // namespace quadrille

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

/// See flipCaps.
constexpr double kCapHeight = 1e-3;
constexpr double kCapHeightOfBox = 1e-4;
/// Cosine of the angle by which a flip may turn the face beyond the edge: there, too, the vertex is as good as on it.
constexpr double kSamePlane = 0.995;

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
      squaredLength(mesh_, shortest) <= kRounding * kRounding * squaredLength(mesh_, longest);
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

/// Height over the longest edge, per its length.
double flatness(const Vector3& a, const Vector3& b, const Vector3& c)
{
  const double longest =
    std::max({ (b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm() });
  return longest > 0 ? (b - a).cross(c - a).norm() / longest : 0;
}

class CapFlipper
{
public:
  explicit CapFlipper(PreparedSurface& surface)
    : surface_(surface), mesh_(surface.mesh),
      highest_(kCapHeightOfBox * surface.boundingBoxDiagonal)
  {
  }

  bool isCap(Index f) const
  {
    const auto [a, b, c] = mesh_.cornersOfFace(f);
    if (!(flatness(a, b, c) < kCapHeight))
    {
      return false; // nearly all
    }
    const Index longest = longestEdge(mesh_, f);
    const Vector3 edge = mesh_.edgeVector(longest);
    const Vector3 beyond = mesh_.edgeVector(Mesh::next(longest));
    const double length = edge.norm();
    const double along = length > 0 ? -edge.dot(beyond) / length : 0; // from the end back
    const double height = length > 0 ? edge.cross(beyond).norm() / length : 0;
    const double least = kCapHeight * length;
    // Near its ends it is a needle.
    return height < std::min(least, highest_) && along > least && along < length - least;
  }

  void push(Index f)
  {
    if (isCap(f))
    {
      queue_.push({ squaredLength(mesh_, longestEdge(mesh_, f)), f });
    }
  }

  std::size_t run()
  {
    std::size_t flips = 0;
    while (!queue_.empty())
    {
      const Index f = queue_.top().face;
      queue_.pop();
      const Index h = longestEdge(mesh_, f);
      if (isCap(f) && isBetterFlipped(h))
      {
        const Index g = Mesh::face(mesh_.twin[h]);
        flipSliver(surface_, h);
        ++flips;
        push(f);
        push(g);
      }
    }
    return flips;
  }

private:
  static bool keepsPlane(const Vector3& made, const Vector3& before)
  {
    return made.dot(before) > kSamePlane * made.norm() * before.norm();
  }

  /// The flattest face is less flat afterwards, so this ends, and the face beyond the edge stays in its plane.
  bool isBetterFlipped(Index h) const
  {
    if (!mayFlip(mesh_, h))
    {
      return false;
    }
    const Index g = mesh_.twin[h];
    const auto at = [&](Index e) -> const Vector3& { return mesh_.position[mesh_.origin[e]]; };
    const Vector3 &a = at(h), &b = at(g), &c = at(Mesh::previous(h)), &d = at(Mesh::previous(g));
    const Vector3 normal = mesh_.doubleAreaNormal(Mesh::face(g));
    return std::min(flatness(a, d, c), flatness(b, c, d)) >
      std::min(flatness(a, b, c), flatness(b, a, d)) &&
      keepsPlane((d - a).cross(c - a), normal) && keepsPlane((c - b).cross(d - b), normal);
  }

  PreparedSurface& surface_;
  Mesh& mesh_;
  double highest_;
  std::priority_queue<Sliver> queue_;
};

std::vector<Index> findDegenerate(const Mesh& mesh, int threads)
{
  return parallelSelect(
    mesh.faceCount(), kLightChunk, threads, [&](Index f) { return isDegenerate(mesh, f); });
}

} // namespace

bool isDegenerate(const Mesh& mesh, Index f)
{
  const auto [a, b, c] = mesh.cornersOfFace(f);
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

std::size_t flipCaps(PreparedSurface& surface, int threads)
{
  CapFlipper flipper(surface);
  for (const Index f : parallelSelect(surface.mesh.faceCount(), kLightChunk, threads,
         [&](Index face) { return flipper.isCap(face); }))
  {
    flipper.push(f);
  }
  return flipper.run();
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/HoleFilling.h"

#include "Quads/QuadShape.h"
#include "Quads/QuadTopology.h"

#include <algorithm>
#include <optional>
#include <set>

namespace quadrille
{
namespace
{

constexpr std::size_t kLongestLoop = 20;
constexpr double kInverted = 10; ///< cost of a quad that is not convex; a good one costs 0

using Edge = std::pair<Index, Index>;

/// Cuts one polygon into quads by dynamic programming over its chords, as one triangulates a
/// polygon optimally; a sub-polygon from corner i to corner j with j - i odd is closed by the chord
/// (i, j).
class PolygonCut
{
public:
  PolygonCut(
    const std::vector<Vector3>& points, std::vector<Index> polygon, const std::set<Edge>& edges)
    : points_(points), polygon_(std::move(polygon)), edges_(edges), size_(polygon_.size()),
      cost_(size_ * size_, 0), cut_(size_ * size_, { 0, 0 })
  {
    normal_ = Vector3::Zero();
    for (std::size_t i = 0; i < size_; ++i)
    {
      normal_ += points_[polygon_[i]].cross(points_[polygon_[(i + 1) % size_]]);
    }
  }

  /// The quads in corner ids of the points; none when every cut would repeat an edge or a point.
  std::optional<std::vector<std::array<Index, 4>>> run()
  {
    for (std::size_t length = 3; length < size_; length += 2)
    {
      for (std::size_t i = 0; i + length < size_; ++i)
      {
        solve(i, i + length);
      }
    }
    if (cost_[size_ - 1] == kInfinity)
    {
      return std::nullopt;
    }
    std::vector<std::array<Index, 4>> quads;
    collect(0, size_ - 1, quads);
    return quads;
  }

private:
  double& cost(std::size_t i, std::size_t j) { return cost_[i * size_ + j]; }

  /// A chord must not repeat an edge; the sides of the polygon are edges already.
  bool isChordFree(std::size_t i, std::size_t j) const
  {
    if (j == i + 1 || (i == 0 && j == size_ - 1))
    {
      return true;
    }
    const Index a = polygon_[i];
    const Index b = polygon_[j];
    return a != b && edges_.count({ std::min(a, b), std::max(a, b) }) == 0;
  }

  double quadCost(const std::array<std::size_t, 4>& corners) const
  {
    std::array<Vector3, 4> p;
    for (std::size_t a = 0; a < 4; ++a)
    {
      p[a] = points_[polygon_[corners[a]]];
      for (std::size_t b = 0; b < a; ++b)
      {
        if (polygon_[corners[a]] == polygon_[corners[b]])
        {
          return kInfinity;
        }
      }
    }
    const double shape = scaledJacobian(p);
    const bool inverted = (p[2] - p[0]).cross(p[3] - p[1]).dot(normal_) < 0;
    return shape > 0 && !inverted ? 1 - shape : kInverted;
  }

  void solve(std::size_t i, std::size_t j)
  {
    double best = kInfinity;
    for (std::size_t k = i + 1; k < j && isChordFree(i, j); k += 2)
    {
      for (std::size_t l = k + 1; l < j; l += 2)
      {
        const double parts = cost(i, k) + cost(k, l) + cost(l, j);
        const double whole = parts == kInfinity ? parts : parts + quadCost({ i, k, l, j });
        if (whole < best)
        {
          best = whole;
          cut_[i * size_ + j] = { k, l };
        }
      }
    }
    cost(i, j) = best;
  }

  void collect(std::size_t i, std::size_t j, std::vector<std::array<Index, 4>>& quads) const
  {
    if (j == i + 1)
    {
      return;
    }
    const auto [k, l] = cut_[i * size_ + j];
    quads.push_back({ polygon_[i], polygon_[k], polygon_[l], polygon_[j] });
    collect(i, k, quads);
    collect(k, l, quads);
    collect(l, j, quads);
  }

  const std::vector<Vector3>& points_;
  std::vector<Index> polygon_;
  const std::set<Edge>& edges_;
  std::size_t size_;
  std::vector<double> cost_; ///< 0 for sides
  std::vector<std::pair<std::size_t, std::size_t>> cut_;
  Vector3 normal_; ///< area vector: which way is out
};

/// Cuts a loop at the points it visits twice, where two holes touch.
std::vector<std::vector<Index>> simpleLoops(const QuadMesh& quads, const std::vector<Index>& loop)
{
  std::vector<std::vector<Index>> loops;
  std::vector<Index> path;
  for (const Index h : loop)
  {
    const Index p = quads.origin(h);
    const auto earlier = std::find(path.begin(), path.end(), p);
    if (earlier != path.end())
    {
      loops.emplace_back(earlier, path.end());
      path.erase(earlier, path.end());
    }
    path.push_back(p);
  }
  loops.push_back(path);
  return loops;
}

/// Is this the rim of a hole to close? boundaryLines: the edges on the input's boundary.
bool isHole(const std::vector<Index>& loop, const std::set<Edge>& boundaryLines)
{
  if (loop.size() < 4 || loop.size() > kLongestLoop || loop.size() % 2 != 0)
  {
    return false;
  }
  for (std::size_t i = 0; i < loop.size(); ++i)
  {
    const auto [a, b] = std::minmax(loop[i], loop[(i + 1) % loop.size()]);
    if (boundaryLines.count({ a, b }) != 0)
    {
      return false;
    }
  }
  return true;
}

/// The rims of all holes, each so that the quads that close it are to the left.
std::vector<std::vector<Index>> findHoles(const QuadMesh& quads)
{
  std::set<Edge> boundaryLines;
  for (const QuadLine& line : quads.lines)
  {
    if (line.boundary)
    {
      boundaryLines.emplace(std::min(line.a, line.b), std::max(line.a, line.b));
    }
  }
  std::vector<std::vector<Index>> polygons;
  for (const std::vector<Index>& loop :
    boundaryLoops(analyzeQuads(quads.quads, quads.points.size())))
  {
    if (loop.size() > 10 * kLongestLoop)
    {
      continue; // a boundary of the input, or a hole far beyond what a fold leaves
    }
    for (const std::vector<Index>& simple : simpleLoops(quads, loop))
    {
      if (isHole(simple, boundaryLines))
      {
        polygons.emplace_back(simple.rbegin(), simple.rend());
      }
    }
  }
  return polygons;
}

/// All edges that end at one of the points of the holes.
std::set<Edge> edgesAt(const QuadMesh& quads, const std::vector<std::vector<Index>>& polygons)
{
  std::vector<std::uint8_t> wanted(quads.points.size(), 0);
  for (const std::vector<Index>& polygon : polygons)
  {
    for (const Index p : polygon)
    {
      wanted[p] = 1;
    }
  }
  std::set<Edge> edges;
  for (const std::array<Index, 4>& q : quads.quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      const Index a = q[i];
      const Index b = q[(i + 1) % 4];
      if (wanted[a] && wanted[b])
      {
        edges.emplace(std::min(a, b), std::max(a, b));
      }
    }
  }
  return edges;
}

} // namespace

std::size_t fillHoles(QuadMesh& quads)
{
  const std::vector<std::vector<Index>> polygons = findHoles(quads);
  std::set<Edge> edges = edgesAt(quads, polygons);
  std::size_t filled = 0;
  for (const std::vector<Index>& polygon : polygons)
  {
    const auto added = PolygonCut(quads.points, polygon, edges).run();
    if (!added)
    {
      continue;
    }
    ++filled;
    for (const std::array<Index, 4>& q : *added)
    {
      quads.quads.push_back(q);
      quads.quadSourceFace.push_back(quads.sourceFace[q[0]]);
      quads.quadSourceWeights.push_back({}); // no square of the map
      for (std::size_t i = 0; i < 4; ++i)
      {
        edges.emplace(std::min(q[i], q[(i + 1) % 4]), std::max(q[i], q[(i + 1) % 4]));
      }
    }
  }
  return filled;
}

} // namespace quadrille

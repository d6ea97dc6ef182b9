// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/QuadCoverage.h"

#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Extraction/ExactMap.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace quadrille
{
namespace
{

/// Up to seven corners: a triangle cut by four lines.
struct Polygon
{
  std::array<Vector2, 8> corners;
  std::size_t size = 0;

  void add(const Vector2& p) { corners[size++] = p; }
};

/// The part with sign * (coordinate - bound) <= 0.
Polygon cut(const Polygon& polygon, int axis, double bound, double sign)
{
  Polygon result;
  for (std::size_t i = 0; i < polygon.size; ++i)
  {
    const Vector2& a = polygon.corners[i];
    const Vector2& b = polygon.corners[(i + 1) % polygon.size];
    const double outA = sign * (a[axis] - bound);
    const double outB = sign * (b[axis] - bound);
    if (outA <= 0)
    {
      result.add(a);
    }
    if ((outA < 0 && outB > 0) || (outA > 0 && outB < 0))
    {
      Vector2 p = a + outA / (outA - outB) * (b - a);
      p[axis] = bound;
      result.add(p);
    }
  }
  return result;
}

double areaOf(const Polygon& polygon)
{
  double twice = 0;
  for (std::size_t i = 2; i < polygon.size; ++i)
  {
    const Vector2 p = polygon.corners[i - 1] - polygon.corners[0];
    const Vector2 q = polygon.corners[i] - polygon.corners[0];
    twice += p.x() * q.y() - p.y() * q.x();
  }
  return twice / 2;
}

/// Area inside the unit square of a triangle of this orientation (1 or -1); 0 for another one.
double areaInSquare(const std::array<Vector2, 3>& triangle, int orientation)
{
  Polygon polygon;
  for (const Vector2& p : triangle)
  {
    polygon.add(p);
  }
  for (const int axis : { 0, 1 })
  {
    polygon = cut(cut(polygon, axis, 0, -1), axis, 1, 1);
  }
  return std::max(0.0, orientation * areaOf(polygon));
}

/// Does the segment have a point strictly inside the unit square?
bool entersSquare(const Vector2& a, const Vector2& b)
{
  double begin = 0;
  double end = 1;
  for (int axis = 0; axis < 2; ++axis)
  {
    const double from = a[axis];
    const double step = b[axis] - from;
    if (step == 0)
    {
      if (!(from > 0 && from < 1))
      {
        return false;
      }
      continue;
    }
    const double low = -from / step;
    const double high = (1 - from) / step;
    begin = std::max(begin, std::min(low, high));
    end = std::min(end, std::max(low, high));
  }
  return begin < end;
}

class Coverer
{
public:
  Coverer(const Mesh& mesh, const std::vector<FixedVec2>& uv, const QuadMesh& quads)
    : map_{ mesh, uv }, quads_(quads)
  {
  }

  void cover(std::size_t q, std::vector<FaceShare>& shares)
  {
    const std::size_t begin = shares.size();
    const Index start = quads_.quadSourceFace[q];
    if (quads_.quadSourceWeights[q] != std::array<double, 3>{})
    {
      search(start, lowerCorner(q), shares);
    }
    double sum = 0;
    for (std::size_t i = begin; i < shares.size(); ++i)
    {
      sum += shares[i].weight;
    }
    if (!(sum > 0))
    {
      shares.resize(begin);
      shares.push_back({ start, 1 });
      return;
    }
    for (std::size_t i = begin; i < shares.size(); ++i)
    {
      shares[i].weight /= sum;
    }
  }

private:
  struct Visit
  {
    Index face;
    Transition toFirst; ///< from the chart of face to that of the first face
  };

  /// With the rotation to the first chart: beside a vertex of valence 2 a face can lie under a quad in two places.
  static std::uint64_t keyOf(Index face, int rotation)
  {
    return 4 * std::uint64_t{ face } + static_cast<std::uint64_t>(rotation);
  }

  /// Of the quad's square, in the chart of the face under its centre: the centre is half an integer, so rounding in
  /// the weights does not matter.
  FixedVec2 lowerCorner(std::size_t q) const
  {
    Vector2 centre = Vector2::Zero();
    for (Index i = 0; i < 3; ++i)
    {
      centre +=
        quads_.quadSourceWeights[q][i] * toDouble(map_.at(3 * quads_.quadSourceFace[q] + i));
    }
    return { static_cast<std::int64_t>(std::floor(centre.x())) * kOne,
      static_cast<std::int64_t>(std::floor(centre.y())) * kOne };
  }

  void search(Index start, FixedVec2 corner, std::vector<FaceShare>& shares)
  {
    const int orientation = map_.orientationOf(start);
    seen_.clear();
    stack_.assign({ { start, {} } });
    seen_.insert(keyOf(start, 0));
    while (!stack_.empty())
    {
      const Visit here = stack_.back();
      stack_.pop_back();
      std::array<Vector2, 3> p;
      for (Index i = 0; i < 3; ++i)
      {
        p[i] = toDouble(here.toFirst.apply(map_.at(3 * here.face + i)) - corner);
      }
      const double area = areaInSquare(p, orientation);
      if (area > 0 || here.face == start)
      {
        shares.push_back({ here.face, area });
      }
      for (Index i = 0; i < 3; ++i)
      {
        visitAcross(3 * here.face + i, entersSquare(p[i], p[(i + 1) % 3]), here.toFirst);
      }
    }
  }

  void visitAcross(Index h, bool enters, const Transition& toFirst)
  {
    Transition t;
    if (!enters || map_.mesh.isConstrained(h) || !map_.transition(h, t))
    {
      return;
    }
    const Visit next{ Mesh::face(map_.mesh.twin[h]), toFirst.after(t.inverse()) };
    if (seen_.insert(keyOf(next.face, next.toFirst.rotation)).second)
    {
      stack_.push_back(next);
    }
  }

  ExactMap map_;
  const QuadMesh& quads_;
  std::unordered_set<std::uint64_t> seen_; ///< faces that were met, see keyOf
  std::vector<Visit> stack_;
};

void checkSizes(const Mesh& mesh, const std::vector<FixedVec2>& uv, const QuadMesh& quads)
{
  refuseIf(uv.size() != mesh.origin.size() || quads.quadSourceFace.size() != quads.quads.size() ||
      quads.quadSourceWeights.size() != quads.quads.size(),
    "coverage of quads: ", uv.size(), " uv for ", mesh.origin.size(),
    " corners, or quads without their sources");
}

} // namespace

QuadCoverage coverQuads(
  const Mesh& mesh, const std::vector<FixedVec2>& uv, const QuadMesh& quads, int threads)
{
  checkSizes(mesh, uv, quads);
  const std::size_t count = quads.quads.size();
  QuadCoverage coverage;
  coverage.first.assign(count + 1, 0);
  using Shares = std::vector<FaceShare>;
  std::vector<Shares> parts = parallelParts<Shares>(count, kHeavyChunk, threads,
    [&](std::size_t begin, std::size_t end, Shares& part)
    {
      Coverer coverer(mesh, uv, quads);
      for (std::size_t q = begin; q < end; ++q)
      {
        coverer.cover(q, part);
        coverage.first[q + 1] = part.size(); // within the part
      }
    });
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    const std::size_t before = coverage.shares.size();
    for (std::size_t q = i * kHeavyChunk; q < std::min(count, (i + 1) * kHeavyChunk); ++q)
    {
      coverage.first[q + 1] += before;
    }
    coverage.shares.insert(coverage.shares.end(), parts[i].begin(), parts[i].end());
    std::vector<FaceShare>().swap(parts[i]);
  }
  return coverage;
}

} // namespace quadrille

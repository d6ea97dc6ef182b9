// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What VertexRemoval finds in the place of a star: its planar map, the triangulation of least cost of its ring, and
/// what that does to the shape of the surface.
#include "Hierarchy/VertexRemoval.h"

#include "Base/Angles.h"
#include "Base/TryCount.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace quadrille
{

namespace
{

/// Cost of a face with three constrained vertices where it is allowed at all.
constexpr double kConstrainedFaceCost = 50;

/// Arc tangent of y / x for y >= 0, in [0, pi], to 3e-10 (interpolation at Chebyshev's nodes). Costs need many
/// angles, and the same ones on every machine.
double angleOf(double y, double x)
{
  const double across = std::abs(x);
  const bool steep = y > across;
  const double most = steep ? y : across;
  const double t = most > 0 ? (steep ? across : y) / most : 0;
  const double u = t * t;
  const double u2 = u * u;
  const double u4 = u2 * u2;
  const double low = (0.9999999995535374 - 0.3333332248891393 * u) +
    u2 * (0.1999955810038755 - 0.14278576024727196 * u);
  const double middle = (0.11050771273870649 - 0.0878504327081528 * u) +
    u2 * (0.066852814828332 - 0.04392841011552016 * u);
  const double high = (0.021912945231385744 - 0.007030669119558297 * u) + u2 * 0.00105760735724206;
  const double arc = t * (low + u4 * (middle + u4 * high));
  const double first = steep ? 0.5 * kPi - arc : arc;
  return x < 0 ? kPi - first : first;
}

double quality(double doubledArea, double squaredEdges)
{
  return squaredEdges > 0 ? kEquilateral * doubledArea / squaredEdges : 0;
}

/// |ab|^2 + |ac|^2 + |ac - ab|^2
template <typename Vector>
double sumOfSquares(const Vector& ab, const Vector& ac)
{
  return 2 * (ab.squaredNorm() + ac.squaredNorm() - ab.dot(ac));
}

} // namespace

bool VertexRemoval::measureStar()
{
  sideNormal_ = { Vector3::Zero(), Vector3::Zero() };
  starArea_ = 0;
  starQuality_ = 1;
  constrainedFaces_ = false;
  for (int i = 0; i < ringSize_; ++i)
  {
    if (!(length_[index(i)] > 0))
    {
      return false;
    }
  }
  for (int i = 0; i < faces_; ++i)
  {
    const int j = nextRing(i);
    const Vector3& p = spoke_[index(i)];
    const Vector3& q = spoke_[index(j)];
    const Vector3 n = p.cross(q);
    const double doubled = n.norm();
    const double dot = p.dot(q);
    const double shape = quality(doubled, 2 * (length_[index(i)] + length_[index(j)] - dot));
    starQuality_ = std::min(starQuality_, shape);
    doubled_[index(i)] = doubled;
    starArea_ += 0.5 * doubled;
    angle_[index(i)] = angleOf(doubled, dot);
    sideNormal_[onCurve_ && i >= curveEnd_ ? 1 : 0] += n;
    normal_[index(i)] = shape > kSliverQuality ? Vector3(n / doubled) : Vector3(Vector3::Zero());
    if (anyConstrained_)
    {
      const auto free = [&](int k)
      { return mesh_.curves.kind[ring_[index(k)]] == VertexKind::Free; };
      constrainedEdge_[index(i)] = mesh_.isConstrained(Mesh::next(slot_[index(i)])) ? 1 : 0;
      constrainedFaces_ = constrainedFaces_ || (onCurve_ && !free(i) && !free(j));
    }
  }
  for (Vector3& n : sideNormal_)
  {
    const double length = n.norm();
    n = length > 0 ? Vector3(n / length) : Vector3(Vector3::Zero());
  }
  for (int i = 0; i < ringSize_; ++i)
  {
    length_[index(i)] = std::sqrt(length_[index(i)]);
  }
  return true;
}

bool VertexRemoval::mapToPlane()
{
  if (boundary_)
  {
    return placeSide(0, faces_, kPi);
  }
  if (onCurve_)
  {
    return placeSide(0, curveEnd_, kPi) && placeSide(curveEnd_, faces_, kPi);
  }
  return placeSide(0, faces_, 2 * kPi);
}

bool VertexRemoval::placeSide(int first, int last, double total)
{
  double sum = 0;
  for (int i = first; i < last; ++i)
  {
    sum += angle_[index(i)];
  }
  if (!(sum > 0))
  {
    return false;
  }
  const double scale = total / sum;
  // The second side of a curve begins at pi, where the first one ended.
  double direction = first == 0 ? 0.0 : kPi;
  for (int i = first; i < last; ++i)
  {
    const double step = scale * angle_[index(i)];
    if (step > 0.995 * kPi || !(step > 1e-6))
    {
      return false;
    }
    if (i > first)
    {
      planar_[index(i)] = length_[index(i)] * Vector2(std::cos(direction), std::sin(direction));
    }
    else
    {
      planar_[index(i)] = { first == 0 ? length_[index(i)] : -length_[index(i)], 0.0 };
    }
    direction += step;
  }
  if (boundary_)
  {
    planar_[index(last)] = { -length_[index(last)], 0.0 };
  }
  return true;
}

void VertexRemoval::forbid(int x, int y)
{
  forbidden_[index(x)] |= std::uint64_t{ 1 } << y;
  forbidden_[index(y)] |= std::uint64_t{ 1 } << x;
}

void VertexRemoval::forbidChords()
{
  // A chord between two curves leaves a map no room between them, so no new one may arise. Those that
  // the input has may only move along with the curve: ring vertices of a curve vertex that lie on another curve are
  // the ends of chords that go.
  for (int x = 0; x < ringSize_; ++x)
  {
    if (mesh_.curves.kind[ring_[index(x)]] == VertexKind::Free)
    {
      continue;
    }
    for (int y = x + 1; y < ringSize_; ++y)
    {
      const bool xOnOwn = onCurve_ && (x == 0 || x == curveEnd_);
      const bool yOnOwn = onCurve_ && y == curveEnd_;
      if (mesh_.curves.kind[ring_[index(y)]] == VertexKind::Free || (xOnOwn && yOnOwn) ||
        isRingEdge(x, y) || isRingEdge(y, x))
      {
        continue;
      }
      const bool moves = xOnOwn != yOnOwn;
      if (!moves || mesh_.curves.onSameCurve(ring_[index(x)], ring_[index(y)]))
      {
        forbid(x, y);
      }
    }
  }
}

/// Least cosine between a face of the star, slivers aside, and its side's mean.
double VertexRemoval::worstDeviation() const
{
  double worst = 1;
  for (int i = 0; i < faces_; ++i)
  {
    const Vector3& n = normal_[index(i)];
    const double dot = n.dot(sideNormal_[onCurve_ && i >= curveEnd_ ? 1 : 0]);
    worst = n.isZero(0) ? worst : std::min(worst, dot);
  }
  return worst;
}

bool VertexRemoval::triangulate(const RemovalGuards& guards)
{
  leastDot_ = std::min(guards.minimumNormalDot, guards.allowOldFolds ? worstDeviation() : 1.0);
  std::fill(forbidden_.begin(), forbidden_.begin() + ringSize_, std::uint64_t{ 0 });
  leastPlanar_ = std::clamp(0.3 * starQuality_, 1e-6, kSliverQuality) / kEquilateral;
  mostHarmonic_ = 1 / std::clamp(0.95 * starQuality_, 1e-6, guards.minimumQuality);
  if (anyConstrained_)
  {
    forbidChords();
  }
  std::array<int, kMaximumRing + 1> polygon;
  for (int i = 0; i <= ringSize_; ++i)
  {
    polygon[index(i)] = i == ringSize_ ? 0 : i;
  }
  // Diagonals that the mesh has already are looked up only when the triangulation wants them.
  for (int attempt = 0; attempt < 4; ++attempt)
  {
    if (attempt > 0)
    {
      countTry(Try::OtherDiagonals);
    }
    triangleCount_ = 0;
    if (splits())
    {
      if (!triangulatePolygon(polygon.data(), curveEnd_ + 1) ||
        !triangulatePolygon(polygon.data() + curveEnd_, ringSize_ - curveEnd_ + 1))
      {
        return false;
      }
    }
    else if (!triangulatePolygon(polygon.data(), ringSize_))
    {
      return false;
    }
    if (!forbidExistingDiagonals())
    {
      if (attempt > 0)
      {
        countTryLed(Try::OtherDiagonals);
      }
      return true;
    }
    metExistingDiagonal_ = true;
  }
  return false;
}

bool VertexRemoval::triangulatePolygon(const int* polygon, int count)
{
  const auto ringAt = [&](int i) { return polygon[index(i)]; };
  for (int i = 0; i + 1 < count; ++i)
  {
    best_[index(ringAt(i))][index(ringAt(i + 1))] = 0;
  }
  for (int gap = 2; gap < count; ++gap)
  {
    for (int i = 0; i + gap < count; ++i)
    {
      const int j = i + gap;
      const int a = ringAt(i);
      const int c = ringAt(j);
      double& best = best_[index(a)][index(c)];
      best = kInfinity;
      if (gap < count - 1 && isForbidden(a, c))
      {
        continue;
      }
      for (int k = i + 1; k < j; ++k)
      {
        const int b = ringAt(k);
        const double below = best_[index(a)][index(b)] + best_[index(b)][index(c)];
        // No triangle has a harmonic index below that of an equilateral one.
        if (!(below + 1 - kRounding < best))
        {
          continue;
        }
        const double cost = below + triangleCost(a, b, c);
        if (cost < best)
        {
          best = cost;
          split_[index(a)][index(c)] = static_cast<std::uint8_t>(k);
        }
      }
    }
  }
  if (best_[index(ringAt(0))][index(ringAt(count - 1))] == kInfinity)
  {
    return false;
  }
  collectTriangles(polygon, 0, count - 1);
  return true;
}

void VertexRemoval::collectTriangles(const int* polygon, int i, int j)
{
  if (j - i < 2)
  {
    return;
  }
  const int k = split_[index(polygon[index(i)])][index(polygon[index(j)])];
  collectTriangles(polygon, i, k);
  collectTriangles(polygon, k, j);
  triangles_[index(triangleCount_++)] = { static_cast<std::uint8_t>(polygon[index(i)]),
    static_cast<std::uint8_t>(polygon[index(k)]), static_cast<std::uint8_t>(polygon[index(j)]) };
}

double VertexRemoval::triangleCost(int a, int b, int c) const
{
  const Vector2 ab2 = planar_[index(b)] - planar_[index(a)];
  const Vector2 ac2 = planar_[index(c)] - planar_[index(a)];
  if (!(parallelogram(ab2, ac2) > leastPlanar_ * sumOfSquares(ab2, ac2)))
  {
    return kInfinity;
  }
  const Vector3 ab = spoke_[index(b)] - spoke_[index(a)];
  const Vector3 ac = spoke_[index(c)] - spoke_[index(a)];
  const Vector3 n = ab.cross(ac);
  const double doubled = n.norm();
  const double harmonic = sumOfSquares(ab, ac) / (kEquilateral * doubled); // 1 / quality
  if (!(harmonic <= mostHarmonic_))
  {
    return kInfinity;
  }
  // A sliver stands in the place of another sliver; its normal says nothing.
  if (harmonic * kSliverQuality < 1 && !normalFits(a, b, c, n, leastDot_ * doubled))
  {
    return kInfinity;
  }
  return harmonic + (anyConstrained_ ? constraintCost(a, b, c) : 0);
}

bool VertexRemoval::normalFits(int a, int b, int c, const Vector3& n, double least) const
{
  // Second side of a curve: its ring positions run from curveEnd_ on (0 closes it).
  const int side = onCurve_ && !boundary_ && b > curveEnd_ ? 1 : 0;
  if (n.dot(sideNormal_[index(side)]) < least)
  {
    return false;
  }
  const auto fits = [&](int face)
  {
    // The zero normal of an old sliver excuses any deviation.
    return face < 0 || n.dot(normal_[index(face)]) >= least || normal_[index(face)].isZero(0);
  };
  return fits(starFace(a, b)) && fits(starFace(b, c)) && fits(starFace(c, a));
}

double VertexRemoval::constraintCost(int a, int b, int c) const
{
  const auto constrained = [&](int x, int y)
  {
    const int face = starFace(x, y);
    if (face >= 0)
    {
      return constrainedEdge_[index(face)] != 0;
    }
    return onCurve_ && ((x == 0 && y == curveEnd_) || (x == curveEnd_ && y == 0));
  };
  if (int{ constrained(a, b) } + int{ constrained(b, c) } + int{ constrained(c, a) } > 1)
  {
    return kInfinity;
  }
  const auto free = [&](int x) { return mesh_.curves.kind[ring_[index(x)]] == VertexKind::Free; };
  if (free(a) || free(b) || free(c))
  {
    return 0;
  }
  return constrainedFaces_ ? kConstrainedFaceCost : kInfinity;
}

bool VertexRemoval::forbidExistingDiagonals()
{
  bool found = false;
  for (int t = 0; t < triangleCount_; ++t)
  {
    const Triangle& triangle = triangles_[index(t)];
    // A diagonal belongs to two triangles; its edge a - c is seen from the one that it closes.
    const int a = triangle.a;
    const int c = triangle.c;
    const bool curveEdge = onCurve_ && std::min(a, c) == 0 && std::max(a, c) == curveEnd_;
    if (!curveEdge && !isRingEdge(a, c) && !isRingEdge(c, a) &&
      mesh_.areJoined(ring_[index(a)], ring_[index(c)]))
    {
      forbid(a, c);
      found = true;
    }
  }
  return found;
}

void VertexRemoval::measureChange(Change& change) const
{
  // Faces after curveEnd_ lie on the second side of a curve. The angles of a face sum to pi, so only two of them
  // need an arc tangent.
  const bool sides = onCurve_ && !boundary_;
  std::fill(
    change.defect.begin(), change.defect.begin() + ringSize_, std::array<double, 2>{ 0, 0 });
  std::array<double, 2> own{};
  for (int i = 0; i < faces_; ++i)
  {
    const std::size_t p = index(i);
    const std::size_t q = index(nextRing(i));
    const std::size_t side = sides && i >= curveEnd_ ? 1 : 0;
    const double atP = angleOf(doubled_[p], length_[p] * length_[p] - spoke_[p].dot(spoke_[q]));
    own[side] += angle_[p];
    change.defect[p][side] += atP;
    change.defect[q][side] += kPi - angle_[p] - atP;
  }
  change.worstQuality = 1;
  for (int t = 0; t < triangleCount_; ++t)
  {
    const Triangle& triangle = triangles_[index(t)];
    const std::size_t side =
      sides && std::max({ triangle.a, triangle.b, triangle.c }) > curveEnd_ ? 1 : 0;
    const Vector3 ab = spoke_[triangle.b] - spoke_[triangle.a];
    const Vector3 ac = spoke_[triangle.c] - spoke_[triangle.a];
    const double doubled = ab.cross(ac).norm();
    const double dot = ab.dot(ac);
    const double atA = angleOf(doubled, dot);
    const double atB = angleOf(doubled, ab.squaredNorm() - dot);
    change.defect[triangle.a][side] -= atA;
    change.defect[triangle.b][side] -= atB;
    change.defect[triangle.c][side] -= kPi - atA - atB;
    change.worstQuality = std::min(change.worstQuality, quality(doubled, sumOfSquares(ab, ac)));
  }
  change.ownDefect = onCurve_ ? std::abs(kPi - own[0]) + (boundary_ ? 0.0 : std::abs(kPi - own[1]))
                              : std::abs(2 * kPi - own[0]);
  change.starArea = starArea_;
}

} // namespace quadrille

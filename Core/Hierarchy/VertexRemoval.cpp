// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
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

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A face flatter than this has no reliable normal.
constexpr double kSliverQuality = 0.02;
/// Less than the harmonic index of any triangle, which is 1 for an equilateral one.
constexpr double kLeastHarmonic = 0.999;
/// Cost of a face with three constrained vertices where it is allowed at all.
constexpr double kConstrainedFaceCost = 50;

double cross(const Vector2& a, const Vector2& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

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

/// Doubled area times this over the sum of squared edges is 1 for an equilateral triangle: 2 sqrt(3).
constexpr double kEquilateral = 3.4641016151377544;

double quality(double doubledArea, double squaredEdges)
{
  return squaredEdges > 0 ? kEquilateral * doubledArea / squaredEdges : 0;
}

/// A weight as the log has it, in units of 2^-32.
std::uint32_t fixedWeight(double weight)
{
  return static_cast<std::uint32_t>(std::lround(std::max(0.0, weight) * 4294967296.0));
}

/// |ab|^2 + |ac|^2 + |ac - ab|^2
template <typename Vector>
double sumOfSquares(const Vector& ab, const Vector& ac)
{
  return 2 * (ab.squaredNorm() + ac.squaredNorm() - ab.dot(ac));
}

} // namespace

bool VertexRemoval::gather(Index v)
{
  vertex_ = v;
  // Ends and junctions of curves stay [Hoppe 1996].
  if (mesh_.curves.kind[v] == VertexKind::Protected || mesh_.valence[v] > kMaximumRing - 1)
  {
    return false;
  }
  onCurve_ = mesh_.curves.kind[v] == VertexKind::Curve;
  border_ = !onCurve_ && !mesh_.border.empty() && mesh_.border[v] != 0;
  const Index first = mesh_.outgoing[v];
  boundary_ = mesh_.isBoundary(first);
  anyConstrained_ = false;
  faces_ = 0;
  int firstCurve = -1;
  const Vector3 center = mesh_.position[v];
  const auto add = [&](Index vertex)
  {
    const std::size_t i = index(ringSize_++);
    ring_[i] = vertex;
    spoke_[i] = mesh_.position[vertex] - center;
    length_[i] = spoke_[i].squaredNorm();
    anyConstrained_ = anyConstrained_ || mesh_.curves.kind[vertex] != VertexKind::Free;
  };
  ringSize_ = 0;
  Index h = first;
  do
  {
    slot_[index(faces_)] = h;
    if ((onCurve_ && mesh_.isConstrained(h)) || (border_ && mesh_.isRegionBorder(h)))
    {
      (firstCurve < 0 ? firstCurve : curveEnd_) = faces_;
    }
    add(mesh_.target(h));
    const Index incoming = Mesh::previous(h);
    h = mesh_.twin[incoming];
    ++faces_;
    if (h == kInvalidIndex)
    {
      add(mesh_.origin[incoming]);
      curveEnd_ = faces_;
    }
  } while (h != kInvalidIndex && h != first);
  if (splits())
  {
    rotateToCurve(firstCurve);
  }
  return faces_ >= (boundary_ ? 2 : 3);
}

void VertexRemoval::rotateToCurve(int first)
{
  std::rotate(slot_.begin(), slot_.begin() + first, slot_.begin() + faces_);
  std::rotate(ring_.begin(), ring_.begin() + first, ring_.begin() + faces_);
  std::rotate(spoke_.begin(), spoke_.begin() + first, spoke_.begin() + faces_);
  std::rotate(length_.begin(), length_.begin() + first, length_.begin() + faces_);
  curveEnd_ -= first;
}

double VertexRemoval::shortestEdge() const
{
  double shortest = kInfinity; // of squares: gather() has not taken roots yet
  if (onCurve_)
  {
    shortest = std::min(length_[0], length_[index(curveEnd_)]);
  }
  else
  {
    shortest = *std::min_element(length_.begin(), length_.begin() + ringSize_);
  }
  return std::sqrt(shortest);
}

bool VertexRemoval::plan(const RemovalGuards& guards)
{
  return surroundingsFit(guards) && triangulateStar(guards) && valencesFit(guards) && locate();
}

bool VertexRemoval::surroundingsFit(const RemovalGuards& guards) const
{
  // The neighbours on the curve may be joined by an edge already: that of another curve, which the curve's two edges
  // would become one with [Hoppe 1996], or the outer edge of a side that is a single face.
  if ((onCurve_ || border_) &&
    (!curveStaysClose(guards) || !loopStaysLong() ||
      mesh_.hasEdge(ring_[0], ring_[index(curveEnd_)])))
  {
    return false;
  }
  return ringSize_ != 3 || boundary_ || !closesTetrahedron();
}

bool VertexRemoval::planStar(const RemovalGuards& guards)
{
  return triangulateStar(guards) && locate();
}

bool VertexRemoval::triangulateStar(const RemovalGuards& guards)
{
  metExistingDiagonal_ = false;
  for (int i = 0; i < ringSize_; ++i)
  {
    for (int j = i + 1; j < ringSize_; ++j)
    {
      if (ring_[index(i)] == ring_[index(j)])
      {
        return false;
      }
    }
  }
  if (!measureStar() || !mapToPlane() || !triangulate(guards))
  {
    return false;
  }
  countDiagonals();
  return true;
}

void VertexRemoval::addStarKey(
  std::vector<std::uint32_t>& words, const std::vector<Index>* names) const
{
  // Kinds and curves of vertices never change, so the ring implies them; but two vertices can be joined by a
  // constrained edge now and by a chord later.
  std::uint64_t constrained = 0;
  for (int i = 0; anyConstrained_ && i < faces_; ++i)
  {
    const bool edge = mesh_.isConstrained(Mesh::next(slot_[index(i)]));
    constrained |= std::uint64_t{ edge ? 1U : 0U } << i;
  }
  const auto nameOf = [names](Index v) { return names == nullptr ? v : (*names)[v]; };
  words.push_back(nameOf(vertex_));
  words.push_back(static_cast<std::uint32_t>(ringSize_) | (boundary_ ? 1U << 8 : 0U) |
    (border_ ? 1U << 9 : 0U) |
    (onCurve_ || border_ ? static_cast<std::uint32_t>(curveEnd_) << 16 : 0U));
  words.push_back(static_cast<std::uint32_t>(constrained));
  words.push_back(static_cast<std::uint32_t>(constrained >> 32));
  for (int i = 0; i < ringSize_; ++i)
  {
    words.push_back(nameOf(ring_[index(i)]));
  }
}

double VertexRemoval::sizeChange() const
{
  const auto logOf = [&](std::size_t i) { return std::log(mesh_.sizeOf(ring_[weightRing_[i]])); };
  constexpr double kWeightUnit = 1.0 / 4294967296.0;
  const double first = logOf(0);
  return std::abs(std::log(mesh_.sizeOf(vertex_)) - first -
    kWeightUnit * weight_[0] * (logOf(1) - first) - kWeightUnit * weight_[1] * (logOf(2) - first));
}

void VertexRemoval::savePlan(std::vector<std::uint32_t>& words) const
{
  const auto pack = [](std::uint32_t a, std::uint32_t b, std::uint32_t c)
  { return a | b << 8 | c << 16; };
  words.push_back(pack(weightRing_[0], weightRing_[1], weightRing_[2]));
  words.push_back(weight_[0]);
  words.push_back(weight_[1]);
  for (int t = 0; t < triangleCount_; ++t)
  {
    const Triangle& triangle = triangles_[index(t)];
    words.push_back(pack(triangle.a, triangle.b, triangle.c));
  }
}

bool VertexRemoval::loadPlan(const std::uint32_t* words)
{
  const auto unpack = [](std::uint32_t word, int i)
  { return static_cast<std::uint8_t>(word >> (8 * i)); };
  weightRing_ = { unpack(words[0], 0), unpack(words[0], 1), unpack(words[0], 2) };
  weight_ = { words[1], words[2] };
  triangleCount_ = ringSize_ - 2;
  for (int t = 0; t < triangleCount_; ++t)
  {
    const std::uint32_t word = words[3 + t];
    triangles_[index(t)] = { unpack(word, 0), unpack(word, 1), unpack(word, 2) };
  }
  countDiagonals();
  return !forbidExistingDiagonals();
}

bool VertexRemoval::curveStaysClose(const RemovalGuards& guards) const
{
  const Vector3& a = spoke_[0];
  const Vector3 ab = spoke_[index(curveEnd_)] - a;
  const double squared = ab.squaredNorm();
  if (!(squared > 0))
  {
    return false;
  }
  const double t = std::clamp(-a.dot(ab) / squared, 0.0, 1.0);
  const double distance = (a + t * ab).norm();
  if (border_)
  {
    return distance <= guards.regionTolerance * mesh_.sizeOf(vertex_);
  }
  return distance + mesh_.curveError[vertex_] <= guards.curveTolerance * mesh_.sizeOf(vertex_);
}

bool VertexRemoval::loopStaysLong() const
{
  // The curve ... p - r0 - v - r1 - q ...: with p == q the loop would fall to three edges.
  const Index r0 = ring_[0];
  const Index r1 = ring_[index(curveEnd_)];
  const Index p = mesh_.nextOnCurve(r0, vertex_, border_);
  return p == kInvalidIndex || p != mesh_.nextOnCurve(r1, vertex_, border_);
}

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
  leastPlanar_ = std::clamp(0.3 * starQuality_, 1e-6, kMinimumPlanarQuality) / kEquilateral;
  mostHarmonic_ = 1 / std::clamp(0.95 * starQuality_, 1e-6, guards.minimumQuality);
  if (anyConstrained_)
  {
    forbidChords();
  }
  std::array<int, kN + 1> polygon;
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
      if (!triangulatePolygon(polygon.data(), curveEnd_ + 1, guards) ||
        !triangulatePolygon(polygon.data() + curveEnd_, ringSize_ - curveEnd_ + 1, guards))
      {
        return false;
      }
    }
    else if (!triangulatePolygon(polygon.data(), ringSize_, guards))
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

bool VertexRemoval::triangulatePolygon(const int* polygon, int count, const RemovalGuards& guards)
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
        if (!(below + kLeastHarmonic < best))
        {
          continue;
        }
        const double cost = below + triangleCost(a, b, c, guards);
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

double VertexRemoval::triangleCost(int a, int b, int c, const RemovalGuards& guards) const
{
  const Vector2 ab2 = planar_[index(b)] - planar_[index(a)];
  const Vector2 ac2 = planar_[index(c)] - planar_[index(a)];
  if (!(cross(ab2, ac2) > leastPlanar_ * sumOfSquares(ab2, ac2)))
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
  return harmonic + (anyConstrained_ ? constraintCost(a, b, c, guards) : 0);
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

double VertexRemoval::constraintCost(int a, int b, int c, const RemovalGuards& guards) const
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
  return guards.allowConstrainedFaces || constrainedFaces_ ? kConstrainedFaceCost : kInfinity;
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
    const bool curveEdge =
      (onCurve_ || border_) && std::min(a, c) == 0 && std::max(a, c) == curveEnd_;
    if (!curveEdge && !isRingEdge(a, c) && !isRingEdge(c, a) &&
      mesh_.areJoined(ring_[index(a)], ring_[index(c)]))
    {
      forbid(a, c);
      found = true;
    }
  }
  return found;
}

bool VertexRemoval::closesTetrahedron() const
{
  const auto outer = [&](int i)
  {
    const Index g = mesh_.twin[Mesh::next(slot_[index(i)])];
    return g == kInvalidIndex ? kInvalidIndex : g / 3;
  };
  const Index a = outer(0);
  const Index b = outer(1);
  const Index c = outer(2);
  return (a != kInvalidIndex && (a == b || a == c)) || (b != kInvalidIndex && b == c);
}

bool VertexRemoval::valencesFit(const RemovalGuards& guards) const
{
  for (int i = 0; i < ringSize_; ++i)
  {
    const int before = mesh_.valence[ring_[index(i)]];
    const int after = newValence(i);
    const bool free = mesh_.curves.kind[ring_[index(i)]] == VertexKind::Free;
    if ((free && after < guards.minimumValence && after < before) || after < 2 ||
      (after > guards.maximumValence && after > before))
    {
      return false;
    }
  }
  return true;
}

bool VertexRemoval::locate()
{
  if (onCurve_)
  {
    const double total = length_[0] + length_[index(curveEnd_)];
    const bool nearFirst = length_[0] <= length_[index(curveEnd_)];
    const int near = nearFirst ? 0 : curveEnd_;
    const int far = nearFirst ? curveEnd_ : 0;
    weightRing_ = { static_cast<std::uint8_t>(near), static_cast<std::uint8_t>(far),
      static_cast<std::uint8_t>(near) };
    weight_ = { fixedWeight(length_[index(near)] / total), 0 };
    return true;
  }
  double bestInside = -kInfinity;
  std::array<double, 3> bestWeights{};
  Triangle home;
  for (int t = 0; t < triangleCount_; ++t)
  {
    const Triangle& triangle = triangles_[index(t)];
    const Vector2& a = planar_[triangle.a];
    const Vector2& b = planar_[triangle.b];
    const Vector2& c = planar_[triangle.c];
    const std::array<double, 3> w{ cross(b, c), cross(c, a), cross(a, b) };
    const double area = w[0] + w[1] + w[2];
    const double inside = *std::min_element(w.begin(), w.end()) / area;
    if (inside > bestInside)
    {
      bestInside = inside;
      bestWeights = { w[0] / area, w[1] / area, w[2] / area };
      home = triangle;
    }
  }
  if (bestInside < -1e-6)
  {
    return false;
  }
  // The heaviest vertex becomes the base, so that the stored weights stay below one.
  const std::array<std::uint8_t, 3> corner{ home.a, home.b, home.c };
  const std::size_t base = static_cast<std::size_t>(
    std::max_element(bestWeights.begin(), bestWeights.end()) - bestWeights.begin());
  const std::size_t second = (base + 1) % 3;
  const std::size_t third = (base + 2) % 3;
  weightRing_ = { corner[base], corner[second], corner[third] };
  weight_ = { fixedWeight(bestWeights[second]), fixedWeight(bestWeights[third]) };
  return true;
}

void VertexRemoval::countDiagonals()
{
  std::fill(diagonals_.begin(), diagonals_.begin() + ringSize_, std::uint8_t{ 0 });
  for (int t = 0; t < triangleCount_; ++t)
  {
    ++diagonals_[triangles_[index(t)].a];
    ++diagonals_[triangles_[index(t)].b];
    ++diagonals_[triangles_[index(t)].c];
  }
  for (int i = 0; i < ringSize_; ++i)
  {
    --diagonals_[index(i)];
  }
}

int VertexRemoval::newValence(int i) const
{
  // The spoke goes; at the ends of an open star the new boundary edge takes its place.
  const bool end = boundary_ && (i == 0 || i == ringSize_ - 1);
  return mesh_.valence[ring_[index(i)]] + diagonals_[index(i)] - 1 + (end ? 1 : 0);
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

int VertexRemoval::bestTarget() const
{
  // Every diagonal that ends at the target saves one flip. A vertex of a curve goes along it [Hoppe 1996].
  if (onCurve_ || border_)
  {
    return diagonals_[index(curveEnd_)] > diagonals_[0] ? curveEnd_ : 0;
  }
  return static_cast<int>(
    std::max_element(diagonals_.begin(), diagonals_.begin() + ringSize_) - diagonals_.begin());
}

CollapseRecord VertexRemoval::makeRecord(int target) const
{
  CollapseRecord record;
  record.faces = faces_;
  record.onCurve = onCurve_;
  record.vertex = vertex_;
  if (boundary_)
  {
    record.kind = target == 0 ? CollapseKind::BoundaryFirst : CollapseKind::BoundaryLast;
  }
  const int shift = boundary_ ? 0 : target;
  for (int i = 0; i < faces_; ++i)
  {
    record.slot[index(i)] = slot_[index((i + shift) % faces_)];
  }
  for (std::size_t i = 0; i < 3; ++i)
  {
    record.ring[i] = static_cast<std::uint8_t>((weightRing_[i] + ringSize_ - shift) % ringSize_);
  }
  for (std::size_t i = 0; i < 2; ++i)
  {
    record.weight[i] = weight_[i];
  }
  return record;
}

void VertexRemoval::apply(RecordWriter& log)
{
  const int target = bestTarget();
  const CollapseRecord record = makeRecord(target);
  for (int i = 0; i < ringSize_; ++i)
  {
    mesh_.valence[ring_[index(i)]] = static_cast<std::uint16_t>(newValence(i));
  }
  if (onCurve_)
  {
    const Vector3 ab = spoke_[index(curveEnd_)] - spoke_[0];
    const double t = std::clamp(-spoke_[0].dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    const float error = mesh_.curveError[vertex_] + static_cast<float>((spoke_[0] + t * ab).norm());
    for (const Index end : { ring_[0], ring_[index(curveEnd_)] })
    {
      mesh_.curveError[end] = std::max(mesh_.curveError[end], error);
    }
  }
  log.collapse(record);
  mesh_.collapse(record);
  mesh_.outgoing[vertex_] = kInvalidIndex;

  const auto fromTarget = [&](int i) { return index((i + ringSize_ - target) % ringSize_); };
  flips_.begin(record.slot.data() + record.firstSurvivor(),
    record.lastSurvivor() - record.firstSurvivor() + 1);
  for (int t = 0; t < triangleCount_; ++t)
  {
    const Triangle& triangle = triangles_[index(t)];
    flips_.add(fromTarget(triangle.a), fromTarget(triangle.b), fromTarget(triangle.c));
  }
  flips_.carryOut(mesh_, ringSize_, log);
  for (int i = record.firstSurvivor(); i <= record.lastSurvivor(); ++i)
  {
    mesh_.refreshOutgoing(record.slot[index(i)] / 3);
  }
}

} // namespace quadrille

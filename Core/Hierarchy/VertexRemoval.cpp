// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/VertexRemoval.h"

#include "Base/Angles.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace quadrille
{

namespace
{

/// A weight as the log has it, in units of 2^-32.
std::uint32_t fixedWeight(double weight)
{
  return static_cast<std::uint32_t>(std::lround(std::max(0.0, weight) * 4294967296.0));
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
    if (onCurve_ && mesh_.isConstrained(h))
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
  if (onCurve_ &&
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
    (onCurve_ ? static_cast<std::uint32_t>(curveEnd_) << 16 : 0U));
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
  return distance + mesh_.curveError[vertex_] <= guards.curveTolerance * mesh_.sizeOf(vertex_);
}

bool VertexRemoval::loopStaysLong() const
{
  // The curve ... p - r0 - v - r1 - q ...: with p == q the loop would fall to three edges.
  const Index r0 = ring_[0];
  const Index r1 = ring_[index(curveEnd_)];
  const Index p = mesh_.nextOnCurve(r0, vertex_);
  return p == kInvalidIndex || p != mesh_.nextOnCurve(r1, vertex_);
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
    const std::array<double, 3> w{ parallelogram(b, c), parallelogram(c, a), parallelogram(a, b) };
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

int VertexRemoval::bestTarget() const
{
  // Every diagonal that ends at the target saves one flip. A vertex of a curve goes along it [Hoppe 1996].
  if (onCurve_)
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

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/CarriedPlaces.h"

#include "Base/LargeArray.h"
#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Transfer/PlaneReplay.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadrille
{
namespace
{

/// A point of a plane, in single precision: coordinates are those of one triangle of the level, and what is fine
/// against it still has three digits where a million triangles lie on it.
struct FlatPoint
{
  float x = 0, y = 0;

  friend FlatPoint operator+(FlatPoint a, FlatPoint b) { return { a.x + b.x, a.y + b.y }; }
  friend FlatPoint operator-(FlatPoint a, FlatPoint b) { return { a.x - b.x, a.y - b.y }; }
  /// As complex numbers: the first one rotates where it has length 1.
  friend FlatPoint operator*(FlatPoint a, FlatPoint b)
  {
    return { a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x };
  }
};

float planeCross(FlatPoint a, FlatPoint b)
{
  return a.x * b.y - a.y * b.x;
}

Complex wide(FlatPoint p)
{
  return { p.x, p.y };
}

FlatPoint flat(Complex p)
{
  return { static_cast<float>(p.real()), static_cast<float>(p.imag()) };
}

FlatPoint conjugate(FlatPoint p)
{
  return { p.x, -p.y };
}

/// As the one of complex numbers.
FlatPoint flatRotation(FlatPoint a, FlatPoint b)
{
  const FlatPoint rotation = b * conjugate(a);
  const float length = std::sqrt(rotation.x * rotation.x + rotation.y * rotation.y);
  return length > 0 ? FlatPoint{ rotation.x / length, rotation.y / length } : FlatPoint{ 1, 0 };
}

/// Charts that are planes of faces of the level. A star has so few faces that products of rotations keep their length.
struct FlatCharts
{
  using Point = FlatPoint;
  using Rotation = FlatPoint;

  static Rotation none() { return { 1, 0 }; }
  static Rotation between(Point from, Point to) { return flatRotation(from, to); }
  static Rotation after(Rotation second, Rotation first) { return second * first; }
  static Point rotate(Rotation r, Point p) { return r * p; }
  static Point rotateBack(Rotation r, Point p) { return conjugate(r) * p; }
  static Point scaled(Point difference, std::uint32_t weight)
  {
    const float w = std::ldexp(static_cast<float>(weight), -32);
    return { w * difference.x, w * difference.y };
  }
};

/// A triangle that a point may go to.
struct PlaneTriangle
{
  Index slot = kInvalidIndex; ///< of the first corner
  std::array<FlatPoint, 3> corner{};

  /// Barycentric coordinates of p, in the order of the corners; not finite for a triangle without area.
  std::array<double, 3> weightsOf(FlatPoint p) const
  {
    const double area = planeCross(corner[1] - corner[0], corner[2] - corner[0]);
    const double second = double{ planeCross(p - corner[0], corner[2] - corner[0]) } / area;
    const double third = double{ planeCross(corner[1] - corner[0], p - corner[0]) } / area;
    return { 1 - second - third, second, third };
  }
  /// The least of them: below 0 outside. Triangles without area hold nothing, nor do inverted ones.
  double depthOf(FlatPoint p) const
  {
    if (!(planeCross(corner[1] - corner[0], corner[2] - corner[0]) > 0))
    {
      return -kInfinity;
    }
    const std::array<double, 3> weights = weightsOf(p);
    return std::min({ weights[0], weights[1], weights[2] });
  }
};

/// The triangle that holds p, or that it is least far outside of; null where none has an area.
const PlaneTriangle* triangleOf(const std::vector<PlaneTriangle>& triangles, FlatPoint p)
{
  const PlaneTriangle* best = nullptr;
  double depth = -kInfinity;
  for (const PlaneTriangle& triangle : triangles)
  {
    const double ofThis = triangle.depthOf(p);
    if (ofThis > depth)
    {
      depth = ofThis;
      best = &triangle;
    }
  }
  return best;
}

using Ring = std::array<FlatPoint, kMaximumRing + 1>;

/// The triangles of the star of a record's vertex at p, in its ring.
void layOutStar(const CollapseRecord& record, const Ring& ring, FlatPoint p,
  std::vector<PlaneTriangle>& triangles)
{
  // Of an interior star the end of the ring is its beginning, the target.
  const auto count = static_cast<std::size_t>(record.ringSize());
  triangles.clear();
  for (std::size_t i = 0; i < static_cast<std::size_t>(record.faces); ++i)
  {
    triangles.push_back({ record.slot[i], { p, ring[i], ring[(i + 1) % count] } });
  }
}

/// p, or where that would invert the star a point in its kernel, if there is one.
FlatPoint intoStar(const CollapseRecord& record, const Ring& ring, FlatPoint p)
{
  const auto count = static_cast<std::size_t>(record.ringSize());
  bool isPositive = true;
  for (std::size_t i = 0; i < static_cast<std::size_t>(record.faces); ++i)
  {
    isPositive = isPositive && planeCross(ring[i] - p, ring[(i + 1) % count] - p) > 0;
  }
  if (isPositive)
  {
    return p;
  }
  std::array<Complex, kMaximumRing + 1> wideRing;
  std::transform(
    ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(count), wideRing.begin(), wide);
  return flat(intoKernel(wideRing.data(), record, wide(p)));
}

/// Places of all faces: lists through one array, so that blocks of a round, which share no face, may change theirs side
/// by side.
class PlaceLists
{
public:
  PlaceLists(Index faces, std::size_t places) : first_(faces, kInvalidIndex), next_(places) {}

  void put(Index face, Index place)
  {
    next_[place] = first_[face];
    first_[face] = place;
  }
  Index first(Index face) const { return first_[face]; }
  Index next(Index place) const { return next_[place]; }
  /// Takes all places out of the face; returns the first one.
  Index takeAll(Index face)
  {
    const Index first = first_[face];
    first_[face] = kInvalidIndex;
    return first;
  }

private:
  std::vector<Index> first_, next_;
};

/// What all blocks work on.
struct Carried
{
  std::vector<FlatPoint>
    corner; ///< #H of the finest mesh, in charts that are planes of the level's faces
  std::vector<FlatPoint> at; ///< of each place, in the chart of its face
  PlaceLists lists;
};

class BlockCarrier
{
public:
  explicit BlockCarrier(Carried& carried) : carried_(carried), star_(carried.corner) {}

  void run(const BlockRecords& records)
  {
    readBackwards(
      records, record_, [this](Index h, Index g) { unflip(h, g); }, [this] { uncollapse(); });
  }

private:
  /// A place on its way.
  struct Moving
  {
    Index place;
    FlatPoint at; ///< in the common chart
  };

  std::vector<FlatPoint>& corner() { return carried_.corner; }

  /// Takes the places of a face; toCommon: from its chart.
  template <typename ToCommon>
  void take(Index face, const ToCommon& toCommon)
  {
    Index place = carried_.lists.takeAll(face);
    while (place != kInvalidIndex)
    {
      const Index next = carried_.lists.next(place);
      moving_.push_back({ place, toCommon(carried_.at[place]) });
      place = next;
    }
  }

  /// Puts what moves into the triangle that holds it; toFace(i, p): into the chart of the i-th triangle's face.
  template <typename ToFace>
  void putAll(const ToFace& toFace)
  {
    for (const Moving& moving : moving_)
    {
      const PlaneTriangle* const held = triangleOf(triangles_, moving.at);
      const PlaneTriangle* const best = held != nullptr ? held : triangles_.data();
      carried_.at[moving.place] =
        toFace(static_cast<std::size_t>(best - triangles_.data()), moving.at);
      carried_.lists.put(best->slot / 3, moving.place);
    }
    moving_.clear();
  }

  /// The places of both faces in the chart of h's face. See the figure in DecimationLog.h.
  void unflip(Index h, Index g)
  {
    const Index nextH = Mesh::next(h);
    const Index nextG = Mesh::next(g);
    const Index f = Mesh::face(h), other = Mesh::face(g);
    const bool isEmpty =
      carried_.lists.first(f) == kInvalidIndex && carried_.lists.first(other) == kInvalidIndex;
    const FlatPoint dInF = corner()[nextH];
    const FlatPoint dInG = corner()[Mesh::previous(g)];
    const FlatPoint rotation =
      flatRotation(corner()[nextG] - dInG, corner()[Mesh::previous(h)] - dInF);
    if (!isEmpty)
    {
      take(f, [](FlatPoint p) { return p; });
      take(other, [&](FlatPoint p) { return dInF + rotation * (p - dInG); });
    }
    const FlatPoint bInF = dInF + rotation * (corner()[g] - dInG);
    star_.unflip(h, g);
    if (isEmpty)
    {
      return;
    }
    const FlatPoint a = corner()[h], c = corner()[Mesh::previous(h)];
    triangles_ = { { h, { a, bInF, c } }, { g, { bInF, a, dInF } } };
    putAll([&](std::size_t i, FlatPoint p)
      { return i == 0 ? p : dInG + conjugate(rotation) * (p - dInF); });
  }

  void uncollapse()
  {
    const FlatPoint unfolded = star_.unfold(record_);
    const FlatPoint p = intoStar(record_, star_.ring(), unfolded);
    const int first = record_.firstSurvivor();
    const int last = record_.lastSurvivor();
    std::array<FlatPoint, kMaximumRing> base; // where the vertex of the collapse is in the charts
    for (int i = first; i <= last; ++i)
    {
      const FlatPoint from = corner()[slot(i)];
      const FlatPoint rotation = star_.rotation(i);
      base[static_cast<std::size_t>(i)] = from;
      take(slot(i) / 3, [&](FlatPoint q) { return rotation * (q - from); });
    }
    if (!moving_.empty())
    {
      layOutStar(record_, star_.ring(), p, triangles_);
    }
    star_.write(record_, p);
    if (moving_.empty())
    {
      return;
    }
    putAll(
      [&](std::size_t i, FlatPoint q)
      {
        // Faces that come back have the chart of their neighbour.
        const int chart = std::clamp(static_cast<int>(i), first, last);
        return base[static_cast<std::size_t>(chart)] + conjugate(star_.rotation(chart)) * q;
      });
  }

  Index slot(int i) const { return record_.slot[static_cast<std::size_t>(i)]; }

  Carried& carried_;
  StarReplay<FlatCharts> star_;
  CollapseRecord record_;
  std::vector<Moving> moving_;
  std::vector<PlaneTriangle> triangles_;
};

/// Weights below it are rounding of single precision: the place is on the edge, or at the corner.
constexpr double kOnEdgeOfSingle = 1e-5;

/// None below 0, sum 1.
std::array<double, 3> insideWeights(std::array<double, 3> weights)
{
  double sum = 0;
  for (double& weight : weights)
  {
    weight = weight > kOnEdgeOfSingle ? weight : 0; // also where it is no number
    sum += weight;
  }
  if (!(sum > 0) || !(sum <= std::numeric_limits<double>::max()))
  {
    return { 1.0 / 3, 1.0 / 3, 1.0 / 3 };
  }
  for (double& weight : weights)
  {
    weight /= sum;
  }
  return weights;
}

void check(const Level& level, const DecimationLog& log, std::size_t rounds,
  const std::vector<SurfacePoint>& places)
{
  const bool isOfLog = rounds <= log.rounds.size() &&
    level.fineFace.size() == level.mesh.faceCount() &&
    std::all_of(
      level.fineFace.begin(), level.fineFace.end(), [&](Index f) { return f < log.fineFaces; });
  refuseIf(!isOfLog, "A level of ", level.mesh.faceCount(), " faces after ", rounds,
    " rounds is not one of the decimation log, of ", log.rounds.size(), " rounds for ",
    log.fineFaces, " faces.");
  for (const SurfacePoint& place : places)
  {
    refuseIf(place.face >= level.mesh.faceCount(), "A place is on face ", place.face,
      ", but the level has ", level.mesh.faceCount(), " faces.");
  }
}

} // namespace

std::vector<SurfacePoint> carryPlaces(const Level& level, const DecimationLog& log,
  std::size_t rounds, const std::vector<SurfacePoint>& places, int threads,
  const ProgressCallback& progress)
{
  check(level, log, rounds, places);
  Carried carried{ {}, std::vector<FlatPoint>(places.size()),
    PlaceLists(log.fineFaces, places.size()) };
  growLarge(carried.corner, 3 * std::size_t{ log.fineFaces });
  for (Index f = 0; f < level.mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const std::array<Complex, 3> corners = layOut(level.mesh, f);
    std::transform(
      corners.begin(), corners.end(), &carried.corner[3 * std::size_t{ level.fineFace[f] }], flat);
  }
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    pollNowAndThen(i);
    const Index face = level.fineFace[places[i].face];
    for (std::size_t k = 0; k < 3; ++k)
    {
      const FlatPoint corner = carried.corner[3 * std::size_t{ face } + k];
      const auto weight = static_cast<float>(places[i].weights[k]);
      carried.at[i] = carried.at[i] + FlatPoint{ weight * corner.x, weight * corner.y };
    }
    carried.lists.put(face, static_cast<Index>(i));
  }
  for (std::size_t round = rounds; round-- > 0;)
  {
    report(progress, static_cast<double>(rounds - round) / static_cast<double>(rounds + 1),
      "carrying points to the surface");
    const DecimationLog::Round& blocks = log.rounds[round];
    parallelForEach(blocks.blockCount, 1, threads,
      [&](std::size_t block) { BlockCarrier(carried).run(log.blocks[blocks.firstBlock + block]); });
  }
  std::vector<SurfacePoint> result(places.size());
  for (Index f = 0; f < log.fineFaces; ++f)
  {
    pollNowAndThen(f);
    for (Index i = carried.lists.first(f); i != kInvalidIndex; i = carried.lists.next(i))
    {
      const FlatPoint* const p = &carried.corner[3 * std::size_t{ f }];
      result[i] = { f,
        insideWeights(PlaneTriangle{ 3 * f, { p[0], p[1], p[2] } }.weightsOf(carried.at[i])) };
    }
  }
  return result;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pieces/CarriedPlaces.h"

#include "Base/Error.h"
#include "Base/LargeArray.h"
#include "Base/Parallel.h"
#include "Transfer/PlaneReplay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

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

FlatPoint conjugate(FlatPoint p)
{
  return { p.x, -p.y };
}

float flatCross(FlatPoint a, FlatPoint b)
{
  return a.x * b.y - a.y * b.x;
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

/// A triangle of a star or of two faces at an edge.
struct Candidate
{
  Index face = kInvalidIndex;
  std::array<FlatPoint, 3> corner{};

  /// Barycentric coordinates of p, in the order of the corners; not finite for a triangle without area.
  std::array<double, 3> weightsOf(FlatPoint p) const
  {
    const double area = flatCross(corner[1] - corner[0], corner[2] - corner[0]);
    const double second = double{ flatCross(p - corner[0], corner[2] - corner[0]) } / area;
    const double third = double{ flatCross(corner[1] - corner[0], p - corner[0]) } / area;
    return { 1 - second - third, second, third };
  }
  /// The least of them: below 0 outside. Triangles without area hold nothing, nor do inverted ones.
  double depthOf(FlatPoint p) const
  {
    if (!(flatCross(corner[1] - corner[0], corner[2] - corner[0]) > 0))
    {
      return -std::numeric_limits<double>::infinity();
    }
    const std::array<double, 3> weights = weightsOf(p);
    return std::min({ weights[0], weights[1], weights[2] });
  }
};

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
    for (std::size_t end = records.size(); end > 0;)
    {
      const std::uint8_t* const at = records.data() + end;
      if (at[-1] == 0)
      {
        unflip(loadLittleEndian(at - 9), loadLittleEndian(at - 5));
        end -= kFlipBytes;
        continue;
      }
      readCollapse(at, record_);
      end -= collapseBytes(record_.faces);
      uncollapse();
    }
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

  /// Puts what moves into the candidate that holds it; toFace(i, p): into the chart of the i-th candidate's face.
  template <typename ToFace>
  void putAll(const ToFace& toFace)
  {
    for (const Moving& moving : moving_)
    {
      std::size_t best = 0;
      double depth = -std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < candidates_.size(); ++i)
      {
        const double ofThis = candidates_[i].depthOf(moving.at);
        if (ofThis > depth)
        {
          depth = ofThis;
          best = i;
        }
      }
      carried_.at[moving.place] = toFace(best, moving.at);
      carried_.lists.put(candidates_[best].face, moving.place);
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
    candidates_ = { { f, { a, bInF, c } }, { other, { bInF, a, dInF } } };
    putAll([&](std::size_t i, FlatPoint p)
      { return i == 0 ? p : dInG + conjugate(rotation) * (p - dInF); });
  }

  void uncollapse()
  {
    const FlatPoint p = intoStar(star_.unfold(record_));
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
      makeStar(p);
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

  /// p, or where that would invert the star a point in its kernel, if there is one.
  FlatPoint intoStar(FlatPoint p) const
  {
    const auto& ring = star_.ring();
    const auto count = static_cast<std::size_t>(record_.ringSize());
    bool isPositive = true;
    for (std::size_t i = 0; i < static_cast<std::size_t>(record_.faces); ++i)
    {
      isPositive = isPositive && flatCross(ring[i] - p, ring[(i + 1) % count] - p) > 0;
    }
    if (isPositive)
    {
      return p;
    }
    std::array<Complex, kMaximumRing + 1> wide;
    std::transform(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(count), wide.begin(),
      [](FlatPoint q) { return Complex(q.x, q.y); });
    const Complex moved = intoKernel(wide.data(), record_, Complex(p.x, p.y));
    return { static_cast<float>(moved.real()), static_cast<float>(moved.imag()) };
  }

  /// The star of the vertex at p, in the chart of the ring.
  void makeStar(FlatPoint p)
  {
    const auto& ring = star_.ring();
    const auto count = static_cast<std::size_t>(record_.ringSize());
    candidates_.clear();
    for (int i = 0; i < record_.faces; ++i)
    {
      const auto at = static_cast<std::size_t>(i);
      candidates_.push_back({ slot(i) / 3, { p, ring[at], ring[(at + 1) % count] } });
    }
  }

  Index slot(int i) const { return record_.slot[static_cast<std::size_t>(i)]; }

  Carried& carried_;
  StarReplay<FlatCharts> star_;
  CollapseRecord record_;
  std::vector<Moving> moving_;
  std::vector<Candidate> candidates_;
};

/// Weights below it are rounding of single precision: the place is on the edge, or at the corner.
constexpr double kOnEdgeOfSingle = 1e-5;

/// None below 0, sum 1.
std::array<double, 3> inside(std::array<double, 3> weights)
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
  const std::vector<FacePlace>& places)
{
  const bool isOfLog = rounds <= log.rounds.size() &&
    level.fineFace.size() == level.mesh.faceCount() &&
    std::all_of(
      level.fineFace.begin(), level.fineFace.end(), [&](Index f) { return f < log.fineFaces; });
  if (!isOfLog)
  {
    throw InvalidInput("A level of " + std::to_string(level.mesh.faceCount()) + " faces after " +
      std::to_string(rounds) + " rounds is not one of the decimation log, of " +
      std::to_string(log.rounds.size()) + " rounds for " + std::to_string(log.fineFaces) +
      " faces.");
  }
  for (const FacePlace& place : places)
  {
    if (place.face >= level.mesh.faceCount())
    {
      throw InvalidInput("A place is on face " + std::to_string(place.face) +
        ", but the level has " + std::to_string(level.mesh.faceCount()) + " faces.");
    }
  }
}

} // namespace

std::vector<FacePlace> carryPlaces(const Level& level, const DecimationLog& log, std::size_t rounds,
  const std::vector<FacePlace>& places, int threads, const ProgressCallback& progress)
{
  check(level, log, rounds, places);
  Carried carried{ {}, std::vector<FlatPoint>(places.size()),
    PlaceLists(log.fineFaces, places.size()) };
  growLarge(carried.corner, 3 * std::size_t{ log.fineFaces });
  for (Index f = 0; f < level.mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const std::array<Complex, 3> corners = layOut(level.mesh, f);
    std::transform(corners.begin(), corners.end(),
      &carried.corner[3 * std::size_t{ level.fineFace[f] }],
      [](Complex p) {
        return FlatPoint{ static_cast<float>(p.real()), static_cast<float>(p.imag()) };
      });
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
    parallelFor(blocks.blockCount, 1, threads,
      [&](std::size_t block, std::size_t)
      { BlockCarrier(carried).run(log.blocks[blocks.firstBlock + block]); });
  }
  std::vector<FacePlace> result(places.size());
  for (Index f = 0; f < log.fineFaces; ++f)
  {
    pollNowAndThen(f);
    for (Index i = carried.lists.first(f); i != kInvalidIndex; i = carried.lists.next(i))
    {
      const FlatPoint* const p = &carried.corner[3 * std::size_t{ f }];
      result[i] = { f, inside(Candidate{ f, { p[0], p[1], p[2] } }.weightsOf(carried.at[i])) };
    }
  }
  return result;
}

} // namespace quadrille

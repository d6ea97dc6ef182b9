// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/SymmetrySearch.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace quadrille
{

namespace
{

constexpr std::size_t kFewSamples = 500;   ///< for all candidates
constexpr std::size_t kLastSamples = 4000; ///< for the result
constexpr std::size_t kRefined = 6;        ///< candidates
constexpr int kMostSteps = 30;
constexpr std::size_t kMostPoints = 20000; ///< of the surface, for the maximum
/// Steps go on while they make the deviation less by this share, or it is rounding.
constexpr double kStillBetter = 1e-3;
constexpr double kMostTilt = 0.3; ///< of the direction, radians a step

/// Triangles, about, that stand for the surface until the last samples.
constexpr std::size_t kFewTriangles = 50000;
constexpr std::size_t kDirections = 100; ///< all round
constexpr int kBetween = 36;             ///< normals between two axes, over half a turn

using Places = std::vector<NearestTriangle::Place>;
/// Two unit vectors normal to a direction and to each other.
using Tangents = std::array<Vector3, 2>;

/// What of a surface says where its symmetries are.
struct SurfaceMoments
{
  Vector3 centre = Vector3::Zero();                   ///< of area
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< of inertia, columns, the longest first
  double size = 0;                                    ///< diagonal of the box
};

/// Half the cross product of two edges.
Vector3 areaVectorOf(const TriangleList& list, std::size_t t)
{
  const std::array<Index, 3>& c = list.corners[t];
  return (list.points[c[1]] - list.points[c[0]]).cross(list.points[c[2]] - list.points[c[0]]) / 2;
}

/// Exact moments of the triangles.
SurfaceMoments measureMoments(const TriangleList& list)
{
  SurfaceMoments moments;
  double total = 0;
  Vector3 first = Vector3::Zero();
  Vector3 low = list.points[list.corners[0][0]];
  Vector3 high = low;
  for (std::size_t t = 0; t < list.corners.size(); ++t)
  {
    const double area = areaVectorOf(list, t).norm();
    total += area;
    for (const Index corner : list.corners[t])
    {
      first += area / 3 * list.points[corner];
      low = low.cwiseMin(list.points[corner]);
      high = high.cwiseMax(list.points[corner]);
    }
  }
  moments.centre = first / total;
  moments.size = (high - low).norm();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::size_t t = 0; t < list.corners.size(); ++t)
  {
    Vector3 sum = Vector3::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const Index corner : list.corners[t])
    {
      const Vector3 p = list.points[corner] - moments.centre;
      sum += p;
      squares += p * p.transpose();
    }
    second += areaVectorOf(list, t).norm() / 12 * (squares + sum * sum.transpose());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second / total);
  moments.axes = solver.eigenvectors().rowwise().reverse(); // ascending before
  return moments;
}

/// At equal steps of the area, in order of the triangles; places in triangles by the sequence R2 [Roberts 2018].
std::vector<Vector3> sampleByArea(const TriangleList& list, std::size_t count)
{
  double total = 0;
  for (std::size_t t = 0; t < list.corners.size(); ++t)
  {
    total += areaVectorOf(list, t).norm();
  }
  std::vector<Vector3> samples;
  samples.reserve(count);
  double area = 0;
  double a = 0.5, b = 0.5;
  for (std::size_t t = 0; t < list.corners.size(); ++t)
  {
    area += areaVectorOf(list, t).norm();
    while (samples.size() < count &&
      area > (static_cast<double>(samples.size()) + 0.5) / static_cast<double>(count) * total)
    {
      a = std::fmod(a + 0.7548776662466927, 1);
      b = std::fmod(b + 0.5698402909980532, 1);
      const bool isBeyond = a + b > 1;
      const double v = isBeyond ? 1 - a : a;
      const double w = isBeyond ? 1 - b : b;
      const std::array<Index, 3>& c = list.corners[t];
      samples.push_back(
        (1 - v - w) * list.points[c[0]] + v * list.points[c[1]] + w * list.points[c[2]]);
    }
  }
  return samples;
}

/// Every so manyth triangle, so that about 50,000 stand for the surface.
TriangleList thinnedOut(const TriangleList& list)
{
  const std::size_t stride = 1 + list.corners.size() / kFewTriangles;
  TriangleList few;
  few.points = list.points;
  for (std::size_t t = 0; t < list.corners.size(); t += stride)
  {
    few.corners.push_back(list.corners[t]);
  }
  return few;
}

/// Root of the mean square of the distances.
double rmsOf(const Places& places)
{
  double sum = 0;
  for (const NearestTriangle::Place& place : places)
  {
    sum += place.distance * place.distance;
  }
  return std::sqrt(sum / static_cast<double>(places.size()));
}

/// And their median.
double medianOf(const Places& places)
{
  std::vector<double> distances;
  distances.reserve(places.size());
  for (const NearestTriangle::Place& place : places)
  {
    distances.push_back(place.distance);
  }
  return middleOf(distances);
}

/// Unit vectors: the axes, others between two of them, as where two moments are equal any could be the one asked for,
/// and some all round.
std::vector<Vector3> candidateDirections(const SurfaceMoments& moments)
{
  std::vector<Vector3> directions;
  const auto add = [&](const Vector3& direction) { directions.push_back(direction.normalized()); };
  for (int i = 0; i < 3; ++i)
  {
    add(moments.axes.col(i));
  }
  for (int i = 0; i < 3; ++i)
  {
    for (int k = 1; k < kBetween; ++k)
    {
      const double angle = k * kPi / kBetween;
      add(std::cos(angle) * moments.axes.col(i) + std::sin(angle) * moments.axes.col((i + 1) % 3));
    }
  }
  for (std::size_t k = 0; k < kDirections; ++k)
  {
    // Half a sphere, by the golden angle.
    const double z = (static_cast<double>(k) + 0.5) / kDirections;
    const double angle = static_cast<double>(k) * kPi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    add(moments.axes * Vector3(r * std::cos(angle), r * std::sin(angle), z));
  }
  return directions;
}

/// Of the two directions of a line the one whose first component that is not small is positive.
Vector3 withSign(const Vector3& normal)
{
  for (int i = 0; i < 3; ++i)
  {
    if (std::abs(normal[i]) > 1e-3)
    {
      return normal[i] > 0 ? normal : Vector3(-normal);
    }
  }
  return normal;
}

/// Where the images of the samples lie beside the surface.
Places nearestImages(const NearestTriangle& surface, const Isometry& isometry,
  const std::vector<Vector3>& samples, int threads)
{
  Places places(samples.size());
  parallelForEach(samples.size(), kHeavyChunk, threads,
    [&](std::size_t i) { places[i] = *surface.at(isometry.image(samples[i])); });
  return places;
}

/// Change of a plane: of the normal along its two tangents, and of the offset over the size.
///
///   image(p) = p - 2 h n,  h = n . (p - origin)
///   d image = -2 ((dn . (p - origin)) n + h dn) + 2 d(offset) n
struct PlaneChange
{
  using Vector = Eigen::Matrix<double, 3, 1>;

  static Vector row(const Isometry& plane, const Tangents& along, const Vector3& p,
    const Vector3& across, double size)
  {
    const Vector3 arm = p - plane.origin;
    const double height = plane.plane().height(p);
    const auto turned = [&](const Vector3& dn)
    { return -2 * across.dot(dn.dot(arm) * plane.direction + height * dn); };
    return Vector(
      turned(along[0]) / size, turned(along[1]) / size, 2 * across.dot(plane.direction));
  }

  static Vector3 shift(const Isometry& plane, const Tangents&, const Vector& change, double size)
  {
    return change[2] * size * plane.direction;
  }
  static Vector3 tilt(const Isometry&, const Vector3& turn) { return turn; }
};

/// Change of an axis: turn w of the direction about two tangents, and shift d along them over the size.
///
///   image(p) = o + R (p - o)
///   d image = w x (R (p - o)) - R (w x (p - o)) + d - R d
struct AxisChange
{
  using Vector = Eigen::Matrix<double, 4, 1>;

  static Vector row(const Isometry& axis, const Tangents& along, const Vector3& p,
    const Vector3& across, double size)
  {
    const Vector3 arm = p - axis.origin;
    const Vector3 turnedArm = axis.imageOf(arm);
    const auto tilted = [&](const Vector3& w)
    { return across.dot(w.cross(turnedArm) - axis.imageOf(w.cross(arm))) / size; };
    const auto shifted = [&](const Vector3& d) { return across.dot(d - axis.imageOf(d)); };
    return Vector(tilted(along[0]), tilted(along[1]), shifted(along[0]), shifted(along[1]));
  }

  static Vector3 shift(const Isometry&, const Tangents& along, const Vector& change, double size)
  {
    return size * (change[2] * along[0] + change[3] * along[1]);
  }
  static Vector3 tilt(const Isometry& axis, const Vector3& turn)
  {
    return turn.cross(axis.direction);
  }
};

struct Candidate
{
  Isometry isometry;
  double rms = 0;
};

template <class Change>
class Refinement
{
public:
  /// size: of the surface.
  Refinement(
    const NearestTriangle& surface, const std::vector<Vector3>& samples, double size, int threads)
    : surface_(surface), samples_(samples), size_(size), threads_(threads)
  {
  }

  /// The best one on the way.
  Candidate run(Isometry isometry) const
  {
    Candidate best;
    int stalled = 0;
    for (int i = 0; i <= kMostSteps; ++i)
    {
      const Places places = nearestImages(surface_, isometry, samples_, threads_);
      const double rms = rmsOf(places);
      const bool isBetter = i == 0 || rms < (1 - kStillBetter) * best.rms;
      stalled = isBetter ? 0 : stalled + 1;
      if (i == 0 || rms < best.rms)
      {
        best = { isometry, rms };
      }
      if (stalled > 2)
      {
        break;
      }
      const Vector change = step(isometry, places);
      isometry = moved(isometry, change);
      if (!(change.norm() > 1e-15))
      {
        break;
      }
    }
    return best;
  }

private:
  using Vector = typename Change::Vector;
  using Matrix = Eigen::Matrix<double, Vector::RowsAtCompileTime, Vector::RowsAtCompileTime>;

  static Tangents tangents(const Isometry& isometry)
  {
    const Vector3 u = isometry.direction.unitOrthogonal();
    return { u, isometry.direction.cross(u) };
  }

  Vector step(const Isometry& isometry, const Places& places) const
  {
    const Tangents along = tangents(isometry);
    const double scale = std::max(3 * medianOf(places), kRounding * size_);
    Matrix a = Matrix::Zero();
    Vector b = Vector::Zero();
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      const Vector3& p = samples_[i];
      const Vector3 across = areaVectorOf(surface_.triangles(), places[i].triangle).normalized();
      const Vector row = Change::row(isometry, along, p, across, size_);
      const double residual = across.dot(isometry.image(p) - places[i].point) / size_;
      const double ratio = places[i].distance / scale;
      const double weight = 1 / (1 + ratio * ratio);
      a += weight * row * row.transpose();
      b -= weight * residual * row;
    }
    // A sphere, or a body of revolution, leaves some of it free.
    Eigen::CompleteOrthogonalDecomposition<Matrix> solver;
    solver.setThreshold(kRounding);
    solver.compute(a);
    return solver.solve(b);
  }

  Isometry moved(const Isometry& isometry, const Vector& change) const
  {
    const Tangents along = tangents(isometry);
    const Vector3 turn = change[0] * along[0] + change[1] * along[1];
    const double shorter = turn.norm() > kMostTilt ? kMostTilt / turn.norm() : 1;
    Isometry next = isometry;
    next.origin = isometry.origin + Change::shift(isometry, along, change, size_);
    next.direction = (isometry.direction + shorter * Change::tilt(isometry, turn)).normalized();
    return next;
  }

  const NearestTriangle& surface_;
  const std::vector<Vector3>& samples_;
  double size_;
  int threads_;
};

/// In their order, but those that are better by more than kRounding come first.
void sortByRms(std::vector<Candidate>& candidates, double size)
{
  const double unit = kRounding * size;
  std::stable_sort(candidates.begin(), candidates.end(),
    [unit](const Candidate& a, const Candidate& b)
    { return std::floor(a.rms / unit) < std::floor(b.rms / unit); });
}

template <class Change>
Isometry findBy(const NearestTriangle& surface, Isometry isometry, int threads)
{
  const TriangleList& list = surface.triangles();
  const SurfaceMoments moments = measureMoments(list);
  const NearestTriangle few(thinnedOut(list));
  std::vector<Vector3> samples = sampleByArea(list, kFewSamples);
  std::vector<Candidate> candidates;
  isometry.origin = moments.centre;
  for (const Vector3& direction : candidateDirections(moments))
  {
    isometry.direction = direction;
    candidates.push_back({ isometry, rmsOf(nearestImages(few, isometry, samples, threads)) });
  }
  sortByRms(candidates, moments.size);
  candidates.resize(std::min(candidates.size(), kRefined));
  for (Candidate& candidate : candidates)
  {
    candidate = Refinement<Change>(few, samples, moments.size, threads).run(candidate.isometry);
    candidate.rms = rmsOf(nearestImages(surface, candidate.isometry, samples, threads));
  }
  sortByRms(candidates, moments.size);
  samples = sampleByArea(list, kLastSamples);
  isometry = Refinement<Change>(surface, samples, moments.size, threads)
               .run(candidates.front().isometry)
               .isometry;
  isometry.direction = withSign(isometry.direction);
  isometry.origin = isometry.foot(moments.centre);
  return isometry;
}

} // namespace

ImageDeviation imageDeviation(const NearestTriangle& surface, const Isometry& isometry, int threads)
{
  const TriangleList& list = surface.triangles();
  std::vector<Vector3> samples = sampleByArea(list, kLastSamples);
  const std::size_t byArea = samples.size();
  const std::size_t stride = 1 + list.points.size() / kMostPoints;
  for (std::size_t i = 0; i < list.points.size(); i += stride)
  {
    samples.push_back(list.points[i]);
  }
  Places places = nearestImages(surface, isometry, samples, threads);
  ImageDeviation deviation;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    if (places[i].distance > deviation.maximum)
    {
      deviation.maximum = places[i].distance;
      deviation.place = samples[i];
    }
  }
  places.resize(byArea);
  deviation.rms = rmsOf(places);
  return deviation;
}

Isometry findIsometry(const NearestTriangle& surface, const Isometry& kind, int threads)
{
  return kind.isReflection ? findBy<PlaneChange>(surface, kind, threads)
                           : findBy<AxisChange>(surface, kind, threads);
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/MirrorSearch.h"

#include "Base/Angles.h"
#include "Base/Parallel.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadrille
{

namespace
{

using Matrix3 = Eigen::Matrix3d;

constexpr std::size_t kFirstSamples = 200;  ///< for all candidates
constexpr std::size_t kMiddleSamples = 500; ///< for the best of them
constexpr std::size_t kLastSamples = 4000;  ///< for the result
constexpr std::size_t kRefined = 6;         ///< candidates
constexpr int kFewSteps = 8, kMostSteps = 30;
constexpr std::size_t kMostPoints = 20000; ///< of the surface, for the maximum
/// Steps go on while they make the deviation less by this share, or it is rounding.
constexpr double kStillBetter = 1e-3;
/// Triangles, about, that stand for the surface until the last samples.
constexpr std::size_t kFewTriangles = 50000;
constexpr std::size_t kMirrorChunk = 64;
constexpr std::size_t kDirections = 100; ///< all round
constexpr int kBetween = 36;             ///< normals between two axes, over half a turn
/// Deviations that differ by less than this, over the size of the surface, are equal.
constexpr double kEqual = 1e-9;

struct Sample
{
  Vector3 point;
  Vector3 normal; ///< unit
};

struct Sampling
{
  std::vector<Sample> samples; ///< each of the same area
  Vector3 centre = Vector3::Zero();
  Matrix3 axes = Matrix3::Identity(); ///< columns, the longest first
  double size = 0;                    ///< diagonal of the box
};

Vector3 faceAreaVector(const TriangleList& list, std::size_t t)
{
  const std::array<Index, 3>& c = list.corners[t];
  return (list.points[c[1]] - list.points[c[0]]).cross(list.points[c[2]] - list.points[c[0]]) / 2;
}

/// At equal steps of the area, in order of the triangles; places in triangles by the sequence R2 [Roberts 2018].
std::vector<Sample> sample(const TriangleList& list, std::size_t count)
{
  double total = 0;
  for (std::size_t t = 0; t < list.corners.size(); ++t)
  {
    total += faceAreaVector(list, t).norm();
  }
  std::vector<Sample> samples;
  samples.reserve(count);
  double area = 0;
  double a = 0.5, b = 0.5;
  for (std::size_t t = 0; t < list.corners.size(); ++t)
  {
    const Vector3 across = faceAreaVector(list, t);
    area += across.norm();
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
        { (1 - v - w) * list.points[c[0]] + v * list.points[c[1]] + w * list.points[c[2]],
          across.normalized() });
    }
  }
  return samples;
}

/// Exact moments of the triangles.
void measureMoments(const TriangleList& list, Sampling& sampling)
{
  double total = 0;
  Vector3 first = Vector3::Zero();
  Vector3 low = list.points[list.corners[0][0]];
  Vector3 high = low;
  for (std::size_t t = 0; t < list.corners.size(); ++t)
  {
    const double area = faceAreaVector(list, t).norm();
    total += area;
    for (const Index corner : list.corners[t])
    {
      first += area / 3 * list.points[corner];
      low = low.cwiseMin(list.points[corner]);
      high = high.cwiseMax(list.points[corner]);
    }
  }
  sampling.centre = first / total;
  sampling.size = (high - low).norm();
  Matrix3 second = Matrix3::Zero();
  for (std::size_t t = 0; t < list.corners.size(); ++t)
  {
    Vector3 sum = Vector3::Zero();
    Matrix3 squares = Matrix3::Zero();
    for (const Index corner : list.corners[t])
    {
      const Vector3 p = list.points[corner] - sampling.centre;
      sum += p;
      squares += p * p.transpose();
    }
    second += faceAreaVector(list, t).norm() / 12 * (squares + sum * sum.transpose());
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(second / total);
  sampling.axes = solver.eigenvectors().rowwise().reverse(); // ascending before
}

Sampling sampleSurface(const TriangleList& list, std::size_t count)
{
  Sampling sampling;
  measureMoments(list, sampling);
  sampling.samples = sample(list, count);
  return sampling;
}

/// Where the images of the samples lie beside the surface.
std::vector<NearestTriangle::Place> nearestImages(const NearestTriangle& surface,
  const MirrorPlane& plane, const std::vector<Sample>& samples, int threads)
{
  std::vector<NearestTriangle::Place> places(samples.size());
  parallelFor(samples.size(), kMirrorChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        places[i] = *surface.at(plane.image(samples[i].point));
      }
    });
  return places;
}

double rmsOf(const std::vector<NearestTriangle::Place>& places)
{
  double sum = 0;
  for (const NearestTriangle::Place& place : places)
  {
    sum += place.distance * place.distance;
  }
  return std::sqrt(sum / static_cast<double>(places.size()));
}

double medianOf(const std::vector<NearestTriangle::Place>& places)
{
  std::vector<double> distances;
  distances.reserve(places.size());
  for (const NearestTriangle::Place& place : places)
  {
    distances.push_back(place.distance);
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

/// Every so manyth triangle.
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

struct Candidate
{
  MirrorPlane plane;
  double rms = 0;
};

/// Two unit vectors normal to n and to each other.
std::array<Vector3, 2> tangents(const Vector3& n)
{
  const Vector3 u = n.unitOrthogonal();
  return { u, n.cross(u) };
}

class Refinement
{
public:
  Refinement(const NearestTriangle& surface, const Sampling& sampling, int threads)
    : surface_(surface), sampling_(sampling), threads_(threads)
  {
  }

  /// The best plane on the way.
  Candidate run(MirrorPlane plane, int steps) const
  {
    Candidate best;
    int stalled = 0;
    for (int i = 0; i <= steps; ++i)
    {
      const auto places = nearestImages(surface_, plane, sampling_.samples, threads_);
      const double rms = rmsOf(places);
      const bool isBetter = i == 0 || rms < (1 - kStillBetter) * best.rms;
      stalled = isBetter ? 0 : stalled + 1;
      if (i == 0 || rms < best.rms)
      {
        best = { plane, rms };
      }
      if (stalled > 2)
      {
        break;
      }
      const Vector3 change = step(plane, places);
      plane = moved(plane, change);
      if (!(change.norm() > 1e-15))
      {
        break;
      }
    }
    return best;
  }

private:
  /// Change of the normal along its two tangents, and of the offset over the size.
  ///
  ///   image(p) = p - 2 h n,  h = n . (p - origin)
  ///   d image = -2 ((dn . (p - origin)) n + h dn) + 2 d(offset) n
  Vector3 step(const MirrorPlane& plane, const std::vector<NearestTriangle::Place>& places) const
  {
    const auto [u, v] = tangents(plane.normal);
    const double scale = std::max(3 * medianOf(places), kEqual * sampling_.size);
    Matrix3 a = Matrix3::Zero();
    Vector3 b = Vector3::Zero();
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      const Vector3& p = sampling_.samples[i].point;
      const Vector3 across = faceAreaVector(surface_.triangles(), places[i].triangle).normalized();
      const Vector3 arm = p - plane.origin;
      const double height = plane.height(p);
      const auto turned = [&](const Vector3& dn)
      { return -2 * across.dot(dn.dot(arm) * plane.normal + height * dn); };
      const Vector3 row(
        turned(u) / sampling_.size, turned(v) / sampling_.size, 2 * across.dot(plane.normal));
      const double residual = across.dot(plane.image(p) - places[i].point) / sampling_.size;
      const double ratio = places[i].distance / scale;
      const double weight = 1 / (1 + ratio * ratio);
      a += weight * row * row.transpose();
      b -= weight * residual * row;
    }
    // A sphere, or a body of revolution, leaves some of it free.
    Eigen::CompleteOrthogonalDecomposition<Matrix3> solver;
    solver.setThreshold(1e-9);
    solver.compute(a);
    return solver.solve(b);
  }

  MirrorPlane moved(const MirrorPlane& plane, const Vector3& change) const
  {
    const auto [u, v] = tangents(plane.normal);
    const Vector3 turn = change[0] * u + change[1] * v;
    const double most = 0.3; // radians a step
    const double shorter = turn.norm() > most ? most / turn.norm() : 1;
    MirrorPlane next;
    next.origin = plane.origin + change[2] * sampling_.size * plane.normal;
    next.normal = (plane.normal + shorter * turn).normalized();
    return next;
  }

  const NearestTriangle& surface_;
  const Sampling& sampling_;
  int threads_;
};

std::vector<MirrorPlane> candidatePlanes(const Sampling& sampling)
{
  std::vector<MirrorPlane> planes;
  const auto add = [&](const Vector3& normal) {
    planes.push_back({ sampling.centre, normal.normalized() });
  };
  for (int i = 0; i < 3; ++i)
  {
    add(sampling.axes.col(i));
  }
  for (int i = 0; i < 3; ++i)
  {
    for (int k = 1; k < kBetween; ++k)
    {
      const double angle = k * kPi / kBetween;
      add(
        std::cos(angle) * sampling.axes.col(i) + std::sin(angle) * sampling.axes.col((i + 1) % 3));
    }
  }
  for (std::size_t k = 0; k < kDirections; ++k)
  {
    // Half a sphere, by the golden angle.
    const double z = (static_cast<double>(k) + 0.5) / kDirections;
    const double angle = static_cast<double>(k) * kPi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    add(sampling.axes * Vector3(r * std::cos(angle), r * std::sin(angle), z));
  }
  return planes;
}

/// In their order, but those that are better by more than kEqual come first.
void sortByRms(std::vector<Candidate>& candidates, double size)
{
  const double unit = kEqual * size;
  std::stable_sort(candidates.begin(), candidates.end(),
    [unit](const Candidate& a, const Candidate& b)
    { return std::floor(a.rms / unit) < std::floor(b.rms / unit); });
}

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

} // namespace

MirrorDeviation mirrorDeviation(
  const NearestTriangle& surface, const MirrorPlane& plane, int threads)
{
  const TriangleList& list = surface.triangles();
  std::vector<Sample> samples = sample(list, kLastSamples);
  const std::size_t byArea = samples.size();
  const std::size_t stride = 1 + list.points.size() / kMostPoints;
  for (std::size_t i = 0; i < list.points.size(); i += stride)
  {
    samples.push_back({ list.points[i], Vector3::Zero() });
  }
  std::vector<NearestTriangle::Place> places = nearestImages(surface, plane, samples, threads);
  MirrorDeviation deviation;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    if (places[i].distance > deviation.maximum)
    {
      deviation.maximum = places[i].distance;
      deviation.place = samples[i].point;
    }
  }
  places.resize(byArea);
  deviation.rms = rmsOf(places);
  return deviation;
}

MirrorPlane findMirrorPlane(const NearestTriangle& surface, int threads)
{
  Sampling sampling = sampleSurface(surface.triangles(), kFirstSamples);
  const NearestTriangle few(thinnedOut(surface.triangles()));
  std::vector<Candidate> candidates;
  for (const MirrorPlane& plane : candidatePlanes(sampling))
  {
    candidates.push_back({ plane, rmsOf(nearestImages(few, plane, sampling.samples, threads)) });
  }
  sortByRms(candidates, sampling.size);
  candidates.resize(std::min(candidates.size(), kRefined));
  sampling.samples = sample(surface.triangles(), kMiddleSamples);
  for (Candidate& candidate : candidates)
  {
    candidate = Refinement(few, sampling, threads).run(candidate.plane, kFewSteps);
    candidate.rms = rmsOf(nearestImages(surface, candidate.plane, sampling.samples, threads));
  }
  sortByRms(candidates, sampling.size);
  sampling.samples = sample(surface.triangles(), kLastSamples);
  MirrorPlane plane =
    Refinement(surface, sampling, threads).run(candidates.front().plane, kMostSteps).plane;
  plane.origin = plane.foot(sampling.centre);
  plane.normal = withSign(plane.normal);
  return plane;
}

} // namespace quadrille

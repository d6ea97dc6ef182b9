// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/MirrorSearch.h"

#include "Base/Parallel.h"
#include "Symmetry/SurfaceSamples.h"

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
constexpr int kFewSteps = 8, kMostPlaneSteps = 30;
constexpr std::size_t kMostPoints = 20000; ///< of the surface, for the maximum
/// Steps go on while they make the deviation less by this share, or it is rounding.
constexpr double kStillBetter = 1e-3;
constexpr std::size_t kMirrorChunk = 64;
/// Deviations that differ by less than this, over the size of the surface, are equal.
constexpr double kEqual = 1e-9;

/// Where the images of the samples lie beside the surface.
std::vector<NearestTriangle::Place> nearestImages(const NearestTriangle& surface,
  const MirrorPlane& plane, const std::vector<SurfaceSample>& samples, int threads)
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
  Refinement(const NearestTriangle& surface, const SurfaceSampling& sampling, int threads)
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
      const Vector3 across = areaVectorOf(surface_.triangles(), places[i].triangle).normalized();
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
  const SurfaceSampling& sampling_;
  int threads_;
};

/// In their order, but those that are better by more than kEqual come first.
void sortByRms(std::vector<Candidate>& candidates, double size)
{
  const double unit = kEqual * size;
  std::stable_sort(candidates.begin(), candidates.end(),
    [unit](const Candidate& a, const Candidate& b)
    { return std::floor(a.rms / unit) < std::floor(b.rms / unit); });
}

} // namespace

MirrorDeviation mirrorDeviation(
  const NearestTriangle& surface, const MirrorPlane& plane, int threads)
{
  const TriangleList& list = surface.triangles();
  std::vector<SurfaceSample> samples = sampleByArea(list, kLastSamples);
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
  SurfaceSampling sampling = sampleSurface(surface.triangles(), kFirstSamples);
  const NearestTriangle few(thinnedOut(surface.triangles()));
  std::vector<Candidate> candidates;
  for (const Vector3& normal : candidateDirections(sampling))
  {
    const MirrorPlane plane{ sampling.centre, normal };
    candidates.push_back({ plane, rmsOf(nearestImages(few, plane, sampling.samples, threads)) });
  }
  sortByRms(candidates, sampling.size);
  candidates.resize(std::min(candidates.size(), kRefined));
  sampling.samples = sampleByArea(surface.triangles(), kMiddleSamples);
  for (Candidate& candidate : candidates)
  {
    candidate = Refinement(few, sampling, threads).run(candidate.plane, kFewSteps);
    candidate.rms = rmsOf(nearestImages(surface, candidate.plane, sampling.samples, threads));
  }
  sortByRms(candidates, sampling.size);
  sampling.samples = sampleByArea(surface.triangles(), kLastSamples);
  MirrorPlane plane =
    Refinement(surface, sampling, threads).run(candidates.front().plane, kMostPlaneSteps).plane;
  plane.origin = plane.foot(sampling.centre);
  plane.normal = withSign(plane.normal);
  return plane;
}

} // namespace quadrille

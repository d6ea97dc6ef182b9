// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/RotationSearch.h"

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

using Matrix4 = Eigen::Matrix4d;
using Vector4 = Eigen::Vector4d;

constexpr std::size_t kFirstTurned = 200;         ///< samples for all candidates
constexpr std::size_t kMiddleTurned = 500;        ///< for the best of them
constexpr std::size_t kLastTurned = 4000;         ///< for the result
constexpr std::size_t kRefinedAxes = 6;           ///< candidates
constexpr int kFewTurns = 8, kMostAxisTurns = 30; ///< steps of a refinement
constexpr std::size_t kMostTurnedPoints = 20000;  ///< of the surface, for the maximum
constexpr double kBetterAxis =
  1e-3; ///< steps go on while they make the deviation less by this share
constexpr std::size_t kTurnChunk = 64;
/// Deviations that differ by less than this, over the size of the surface, are equal.
constexpr double kEqualAxes = 1e-9;

using TurnedPlaces = std::vector<NearestTriangle::Place>;

/// Where the samples lie beside the surface when they are turned by a step.
TurnedPlaces nearestTurned(const NearestTriangle& surface, const RotationAxis& axis, int order,
  const std::vector<SurfaceSample>& samples, int threads)
{
  TurnedPlaces places(samples.size());
  parallelFor(samples.size(), kTurnChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        places[i] = *surface.at(axis.image(samples[i].point, 1, order));
      }
    });
  return places;
}

struct AxisCandidate
{
  RotationAxis axis;
  double rms = 0;
};

class AxisRefinement
{
public:
  AxisRefinement(
    const NearestTriangle& surface, const SurfaceSampling& sampling, int order, int threads)
    : surface_(surface), sampling_(sampling), order_(order), threads_(threads)
  {
  }

  /// The best axis on the way.
  AxisCandidate run(RotationAxis axis, int steps) const
  {
    AxisCandidate best;
    int stalled = 0;
    for (int i = 0; i <= steps; ++i)
    {
      const TurnedPlaces places =
        nearestTurned(surface_, axis, order_, sampling_.samples, threads_);
      const double rms = rmsOf(places);
      const bool isBetter = i == 0 || rms < (1 - kBetterAxis) * best.rms;
      stalled = isBetter ? 0 : stalled + 1;
      if (i == 0 || rms < best.rms)
      {
        best = { axis, rms };
      }
      if (stalled > 2)
      {
        break;
      }
      const Vector4 change = step(axis, places);
      axis = moved(axis, change);
      if (!(change.norm() > 1e-15))
      {
        break;
      }
    }
    return best;
  }

private:
  /// Turn w of the direction about two tangents, and shift d along them over the size.
  ///
  ///   image(p) = o + R (p - o)
  ///   d image = w x (R (p - o)) - R (w x (p - o)) + d - R d
  Vector4 step(const RotationAxis& axis, const TurnedPlaces& places) const
  {
    const Vector3 u = axis.direction.unitOrthogonal();
    const Vector3 v = axis.direction.cross(u);
    const double scale = std::max(3 * medianOf(places), kEqualAxes * sampling_.size);
    Matrix4 a = Matrix4::Zero();
    Vector4 b = Vector4::Zero();
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      const Vector3 arm = sampling_.samples[i].point - axis.origin;
      const Vector3 turnedArm = axis.imageOf(arm, 1, order_);
      const Vector3 image = axis.origin + turnedArm;
      const Vector3 across = areaVectorOf(surface_.triangles(), places[i].triangle).normalized();
      const auto tilted = [&](const Vector3& w) {
        return across.dot(w.cross(turnedArm) - axis.imageOf(w.cross(arm), 1, order_)) /
          sampling_.size;
      };
      const auto shifted = [&](const Vector3& d)
      { return across.dot(d - axis.imageOf(d, 1, order_)); };
      const Vector4 row(tilted(u), tilted(v), shifted(u), shifted(v));
      const double residual = across.dot(image - places[i].point) / sampling_.size;
      const double ratio = places[i].distance / scale;
      const double weight = 1 / (1 + ratio * ratio);
      a += weight * row * row.transpose();
      b -= weight * residual * row;
    }
    // A sphere, or a body of revolution, leaves some of it free.
    Eigen::CompleteOrthogonalDecomposition<Matrix4> solver;
    solver.setThreshold(1e-9);
    solver.compute(a);
    return solver.solve(b);
  }

  RotationAxis moved(const RotationAxis& axis, const Vector4& change) const
  {
    const Vector3 u = axis.direction.unitOrthogonal();
    const Vector3 v = axis.direction.cross(u);
    const Vector3 tilt = change[0] * u + change[1] * v;
    constexpr double kMostTilt = 0.3; // radians a step
    const double shorter = tilt.norm() > kMostTilt ? kMostTilt / tilt.norm() : 1;
    RotationAxis next;
    next.origin = axis.origin + sampling_.size * (change[2] * u + change[3] * v);
    next.direction = (axis.direction + shorter * tilt.cross(axis.direction)).normalized();
    return next;
  }

  const NearestTriangle& surface_;
  const SurfaceSampling& sampling_;
  int order_;
  int threads_;
};

/// In their order, but those that are better by more than kEqualAxes come first.
void sortAxes(std::vector<AxisCandidate>& candidates, double size)
{
  const double unit = kEqualAxes * size;
  std::stable_sort(candidates.begin(), candidates.end(),
    [unit](const AxisCandidate& a, const AxisCandidate& b)
    { return std::floor(a.rms / unit) < std::floor(b.rms / unit); });
}

} // namespace

MirrorDeviation rotationDeviation(
  const NearestTriangle& surface, const RotationAxis& axis, int order, int threads)
{
  const TriangleList& list = surface.triangles();
  std::vector<SurfaceSample> samples = sampleByArea(list, kLastTurned);
  const std::size_t byArea = samples.size();
  const std::size_t stride = 1 + list.points.size() / kMostTurnedPoints;
  for (std::size_t i = 0; i < list.points.size(); i += stride)
  {
    samples.push_back({ list.points[i], Vector3::Zero() });
  }
  TurnedPlaces places = nearestTurned(surface, axis, order, samples, threads);
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

RotationAxis findRotationAxis(const NearestTriangle& surface, int order, int threads)
{
  SurfaceSampling sampling = sampleSurface(surface.triangles(), kFirstTurned);
  const NearestTriangle few(thinnedOut(surface.triangles()));
  std::vector<AxisCandidate> candidates;
  for (const Vector3& direction : candidateDirections(sampling))
  {
    const RotationAxis axis{ sampling.centre, direction };
    candidates.push_back(
      { axis, rmsOf(nearestTurned(few, axis, order, sampling.samples, threads)) });
  }
  sortAxes(candidates, sampling.size);
  candidates.resize(std::min(candidates.size(), kRefinedAxes));
  sampling.samples = sampleByArea(surface.triangles(), kMiddleTurned);
  for (AxisCandidate& candidate : candidates)
  {
    candidate = AxisRefinement(few, sampling, order, threads).run(candidate.axis, kFewTurns);
    candidate.rms = rmsOf(nearestTurned(surface, candidate.axis, order, sampling.samples, threads));
  }
  sortAxes(candidates, sampling.size);
  sampling.samples = sampleByArea(surface.triangles(), kLastTurned);
  RotationAxis axis = AxisRefinement(surface, sampling, order, threads)
                        .run(candidates.front().axis, kMostAxisTurns)
                        .axis;
  axis.direction = withSign(axis.direction);
  axis.origin = axis.foot(sampling.centre);
  return axis;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/SurfaceSamples.h"

#include "Base/Angles.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace quadrille
{

namespace
{

/// Triangles, about, that stand for the surface until the last samples.
constexpr std::size_t kFewTriangles = 50000;
constexpr std::size_t kDirections = 100; ///< all round
constexpr int kBetween = 36;             ///< normals between two axes, over half a turn

/// Exact moments of the triangles.
void measureMoments(const TriangleList& list, SurfaceSampling& sampling)
{
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
  sampling.centre = first / total;
  sampling.size = (high - low).norm();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::size_t t = 0; t < list.corners.size(); ++t)
  {
    Vector3 sum = Vector3::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const Index corner : list.corners[t])
    {
      const Vector3 p = list.points[corner] - sampling.centre;
      sum += p;
      squares += p * p.transpose();
    }
    second += areaVectorOf(list, t).norm() / 12 * (squares + sum * sum.transpose());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second / total);
  sampling.axes = solver.eigenvectors().rowwise().reverse(); // ascending before
}

} // namespace

Vector3 areaVectorOf(const TriangleList& list, std::size_t t)
{
  const std::array<Index, 3>& c = list.corners[t];
  return (list.points[c[1]] - list.points[c[0]]).cross(list.points[c[2]] - list.points[c[0]]) / 2;
}

std::vector<SurfaceSample> sampleByArea(const TriangleList& list, std::size_t count)
{
  double total = 0;
  for (std::size_t t = 0; t < list.corners.size(); ++t)
  {
    total += areaVectorOf(list, t).norm();
  }
  std::vector<SurfaceSample> samples;
  samples.reserve(count);
  double area = 0;
  double a = 0.5, b = 0.5;
  for (std::size_t t = 0; t < list.corners.size(); ++t)
  {
    const Vector3 across = areaVectorOf(list, t);
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

SurfaceSampling sampleSurface(const TriangleList& list, std::size_t count)
{
  SurfaceSampling sampling;
  measureMoments(list, sampling);
  sampling.samples = sampleByArea(list, count);
  return sampling;
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

std::vector<Vector3> candidateDirections(const SurfaceSampling& sampling)
{
  std::vector<Vector3> directions;
  const auto add = [&](const Vector3& direction) { directions.push_back(direction.normalized()); };
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
  return directions;
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

} // namespace quadrille

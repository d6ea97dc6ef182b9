// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/PatchProblems.h"

#include "Base/Angles.h"
#include "Base/ChartRotation.h"
#include "GridMap/MapShape.h"
#include "Transfer/PatchRotations.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace quadrille
{
namespace
{

/// What weighs most is no nearer than this, squared and over the largest distance of the patch.
constexpr double kNearest = 1e-4;
/// References flatter than this (2 area / longest edge squared) are replaced by equilateral ones.
constexpr double kFlattestTriangle = 0.1;

} // namespace

UntangleProblem PatchProblems::make(const std::vector<double>& rotations) const
{
  // A point per corner, relative to its face's first corner: only differences inside a face matter.
  UntangleProblem problem;
  const int points = 3 * static_cast<int>(patch_.faces().size());
  const double scale = referenceScale();
  problem.offset = Eigen::VectorXd::Zero(2 * points);
  std::vector<Eigen::Triplet<double>> entries;
  const auto pointOf = [&](Index corner)
  {
    const auto face = std::lower_bound(patch_.faces().begin(), patch_.faces().end(), corner / 3);
    return 3 * static_cast<int>(face - patch_.faces().begin()) + static_cast<int>(corner % 3);
  };
  for (std::size_t i = 0; i < patch_.faces().size(); ++i)
  {
    const Index f = patch_.faces()[i];
    const Index point = static_cast<Index>(3 * i);
    problem.triangles.push_back({ point, point + 1, point + 2 });
    problem.inverseReference.push_back(inverseReference(f, scale));
    if (!rotations.empty())
    {
      problem.inverseReference.back() *= Eigen::Rotation2Dd(-rotations[i]).toRotationMatrix();
    }
    problem.weight.push_back(0.5 / std::abs(problem.inverseReference.back().determinant()));
    for (Index k = 0; k < 3; ++k)
    {
      problem.offset.segment<2>(2 * (point + k)) = toDouble(uv_[3 * f + k] - uv_[3 * f]);
    }
  }
  for (const PatchVertex& vertex : patch_.vertices())
  {
    for (std::size_t i = 0; i < vertex.fanCount && vertex.freedom != PatchFreedom::Fixed; ++i)
    {
      const PatchCorner& c = patch_.fans()[vertex.firstFan + i];
      const int row = 2 * pointOf(c.corner);
      int column = vertex.firstUnknown;
      for (const bool alongU : { true, false })
      {
        if (vertex.freedom == (alongU ? PatchFreedom::AlongV : PatchFreedom::AlongU))
        {
          continue;
        }
        const CornerAxis axis = cornerAxis(alongU ? 0 : 1, c.rotation);
        entries.emplace_back(row + axis.coordinate, column++, axis.sign);
      }
    }
  }
  problem.basis.resize(2 * points, patch_.unknowns());
  problem.basis.setFromTriplets(entries.begin(), entries.end());
  return problem;
}

double PatchProblems::referenceScale() const
{
  // So that the references have as much area as the image: the area of the image does not change, as its
  // border stays.
  double area = 0;
  double image = 0;
  for (const Index f : patch_.faces())
  {
    area += mesh_.faceArea(f);
    const Vector2 a = toDouble(uv_[3 * f + 1] - uv_[3 * f]);
    const Vector2 b = toDouble(uv_[3 * f + 2] - uv_[3 * f]);
    image += 0.5 * parallelogram(a, b);
  }
  return area > 0 && image > 0 ? std::sqrt(image / area) : 1.0;
}

/// Of the triangle laid out in the plane; where it is too flat for that, of an equilateral one.
Eigen::Matrix2d PatchProblems::inverseReference(Index f, double scale) const
{
  const Vector3 ab = scale * mesh_.edgeVector(3 * f);
  const Vector3 ac = -scale * mesh_.edgeVector(3 * f + 2);
  const double longest = std::max({ ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm() });
  const double doubled = ab.cross(ac).norm();
  Eigen::Matrix2d reference;
  if (doubled > kFlattestTriangle * longest)
  {
    const double length = ab.norm();
    reference << length, ab.dot(ac) / length, 0, doubled / length;
  }
  else
  {
    // A tenth of the longest edge keeps the weight of a sliver small without letting it vanish.
    const double side = 0.1 * std::sqrt(std::max(longest, 1e-12));
    reference << side, 0.5 * side, 0, 0.8660254037844386 * side;
  }
  return reference.inverse();
}

std::vector<double> PatchProblems::nearnessToFixed() const
{
  std::vector<Vector3> fixed;
  for (const PatchVertex& vertex : patch_.vertices())
  {
    const auto begin = patch_.fans().begin() + static_cast<std::ptrdiff_t>(vertex.firstFan);
    const bool inside = std::all_of(begin, begin + static_cast<std::ptrdiff_t>(vertex.fanCount),
      [&](const PatchCorner& c) { return patch_.inPatch()[Mesh::face(c.corner)] != 0; });
    if (vertex.freedom == PatchFreedom::Fixed && inside)
    {
      fixed.push_back(mesh_.position[mesh_.origin[begin->corner]]);
    }
  }
  std::vector<double> nearness(patch_.faces().size(), 1);
  if (fixed.empty())
  {
    return nearness;
  }
  double farthest = 0;
  for (std::size_t i = 0; i < patch_.faces().size(); ++i)
  {
    const Vector3 middle = mesh_.middleOfFace(patch_.faces()[i]);
    double squared = kInfinity;
    for (const Vector3& p : fixed)
    {
      squared = std::min(squared, (middle - p).squaredNorm());
    }
    nearness[i] = squared;
    farthest = std::max(farthest, squared);
  }
  for (double& squared : nearness)
  {
    squared = farthest > 0 ? 1 / std::max(squared / farthest, kNearest) : 1;
  }
  return nearness;
}

void PatchProblems::guardCurves(const std::vector<double>& rotations,
  const std::vector<double>& nearness, UntangleProblem& problem) const
{
  const double scale = referenceScale();
  std::vector<Index> fixed;
  for (const PatchVertex& vertex : patch_.vertices())
  {
    if (vertex.freedom == PatchFreedom::Fixed)
    {
      fixed.push_back(mesh_.origin[patch_.fans()[vertex.firstFan].corner]);
    }
  }
  std::sort(fixed.begin(), fixed.end());
  std::vector<GuardedEdge> edges;
  std::vector<double> factors;
  for (std::size_t i = 0; i < patch_.faces().size(); ++i)
  {
    for (Index k = 0; k < 3; ++k)
    {
      const Index h = 3 * patch_.faces()[i] + k;
      const double length = scale * mesh_.edgeVector(h).norm();
      const bool stays = std::binary_search(fixed.begin(), fixed.end(), mesh_.origin[h]) &&
        std::binary_search(fixed.begin(), fixed.end(), mesh_.target(h));
      if (!mesh_.isConstrained(h) || stays || !(length > 0))
      {
        continue;
      }
      const double direction = rotations[i] + directionOf(mesh_, h);
      const int axis = static_cast<int>(std::lround(direction / kRightAngle));
      edges.push_back(
        { static_cast<Index>(3 * i + k), static_cast<Index>(3 * i + (k + 1) % 3), axis, length });
      factors.push_back(nearness[i]);
    }
  }
  const std::size_t before = problem.weight.size();
  guardEdges(problem, edges);
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    problem.weight[before + i] *= factors[i];
  }
}

} // namespace quadrille

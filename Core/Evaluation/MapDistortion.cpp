// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/MapDistortion.h"

#include "Base/Error.h"
#include "Base/Progress.h"
#include "GridMap/MapShape.h"
#include "Mesh/Sizing.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

double mappedArea(const std::vector<FixedVec2>& uv, Index f)
{
  const Vector2 a = toDouble(uv[3 * f + 1] - uv[3 * f]);
  const Vector2 b = toDouble(uv[3 * f + 2] - uv[3 * f]);
  return (a.x() * b.y() - a.y() * b.x()) / 2;
}

/// The value below which this part of the weight lies; entries ascend.
double quantile(const std::vector<std::pair<double, double>>& entries, double part, double total)
{
  double below = 0;
  for (const auto& [value, weight] : entries)
  {
    below += weight;
    if (below >= part * total)
    {
      return value;
    }
  }
  return entries.empty() ? 0 : entries.back().first;
}

} // namespace

MapDistortion measureDistortion(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  if (uv.size() != mesh.origin.size())
  {
    throw InvalidInput("distortion: the map has not the size of the mesh");
  }
  double area = 0, mapped = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    area += sizedArea(mesh, f);
    mapped += mappedArea(uv, f);
  }
  const double unit = area > 0 && mapped > 0 ? std::sqrt(area / mapped) : 1;
  MapDistortion result;
  std::vector<std::pair<double, double>> energies; // and weights
  double total = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const double weight = sizedArea(mesh, f);
    if (!(weight > 0) || !(mappedArea(uv, f) > 0))
    {
      ++result.left;
      continue;
    }
    Eigen::Matrix2d edges;
    edges << toDouble(uv[3 * f + 1] - uv[3 * f]), toDouble(uv[3 * f + 2] - uv[3 * f]);
    const Eigen::Matrix2d j = unit * edges * flattenFace(mesh, f).inverse();
    const double d = j.determinant();
    const double squared = j.squaredNorm();
    energies.emplace_back(squared * (1 + 1 / (d * d)) / 4, weight);
    result.mean += weight * energies.back().first;
    result.angle += weight * squared / (2 * d);
    result.size += weight * std::abs(std::log2(d));
    total += weight;
  }
  if (total > 0)
  {
    result.mean /= total;
    result.angle /= total;
    result.size /= total;
  }
  std::sort(energies.begin(), energies.end());
  result.median = quantile(energies, 0.5, total);
  result.p90 = quantile(energies, 0.9, total);
  result.p99 = quantile(energies, 0.99, total);
  return result;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/MapDistortion.h"

#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Evaluation/Distribution.h"
#include "GridMap/MapShape.h"
#include "Mesh/Sizing.h"

#include <Eigen/LU>

#include <cmath>
#include <vector>

namespace quadrille
{
MapDistortion measureDistortion(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  refuseIf(uv.size() != mesh.origin.size(), "distortion: the map has not the size of the mesh");
  double area = 0, mapped = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    area += sizedArea(mesh, f);
    mapped += mappedArea(uv, f);
  }
  const double unit = area > 0 && mapped > 0 ? std::sqrt(area / mapped) : 1;
  MapDistortion result;
  std::vector<double> energies, weights;
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
    const Eigen::Matrix2d j = unit * mappedEdges(uv, f) * flattenFace(mesh, f).inverse();
    const double d = j.determinant();
    const double squared = j.squaredNorm();
    energies.push_back(squared * (1 + 1 / (d * d)) / 4);
    weights.push_back(weight);
    result.mean += weight * energies.back();
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
  const WeightedDistribution distribution(energies, weights);
  result.median = distribution.quantile(0.5);
  result.p90 = distribution.quantile(0.9);
  result.p99 = distribution.quantile(0.99);
  return result;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/QuadQuality.h"

#include "Quads/QuadShape.h"
#include "Quads/QuadTopology.h"

#include <cmath>

namespace quadrille
{
namespace
{

using Quads = std::vector<std::array<Index, 4>>;

Statistics summarize(const std::vector<double>& values)
{
  Statistics result;
  if (values.empty())
  {
    return result;
  }
  const double count = static_cast<double>(values.size());
  double sum = 0;
  for (const double x : values)
  {
    sum += x;
  }
  result.mean = sum / count;
  double squares = 0;
  for (const double x : values)
  {
    squares += (x - result.mean) * (x - result.mean);
  }
  result.deviation = std::sqrt(squares / count);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  result.minimum = *low;
  result.maximum = *high;
  return result;
}

void countValences(const QuadTopology& topology, QuadQuality& quality)
{
  for (std::size_t p = 0; p < topology.valence.size(); ++p)
  {
    const int valence = topology.valence[p];
    if (valence == 0 || topology.onBoundary[p] != 0)
    {
      continue;
    }
    ++quality.interiorValences[valence];
    quality.irregularVertices += valence != 4 ? 1 : 0;
  }
}

void measureShapes(const std::vector<Vector3>& points, const Quads& quads, QuadQuality& quality)
{
  std::vector<double> jacobians, areas;
  for (const std::array<Index, 4>& q : quads)
  {
    const std::array<Vector3, 4> p{ points[q[0]], points[q[1]], points[q[2]], points[q[3]] };
    jacobians.push_back(scaledJacobian(p));
    quality.nonPositiveJacobians += jacobians.back() <= 0 ? 1 : 0;
    const Vector3 n0 = (p[1] - p[0]).cross(p[2] - p[0]);
    const Vector3 n1 = (p[2] - p[0]).cross(p[3] - p[0]);
    areas.push_back((n0.norm() + n1.norm()) / 2);
  }
  quality.scaledJacobian = summarize(jacobians);
  quality.area = summarize(areas);
}

void measureEdges(const std::vector<Vector3>& points, const Quads& quads,
  const QuadTopology& topology, QuadQuality& quality)
{
  std::vector<double> lengths;
  for (std::size_t h = 0; h < topology.twin.size(); ++h)
  {
    if (topology.twin[h] == kInvalidIndex || h < topology.twin[h])
    {
      const Index a = quads[h / 4][h % 4];
      const Index b = quads[h / 4][(h + 1) % 4];
      lengths.push_back((points[a] - points[b]).norm());
    }
  }
  quality.edgeLength = summarize(lengths);
}

} // namespace

QuadQuality evaluateQuads(const std::vector<Vector3>& points, const Quads& quads)
{
  const QuadTopology topology = analyzeQuads(quads, points.size());
  QuadQuality quality;
  quality.quads = quads.size();
  quality.vertices = points.size() - topology.isolatedPoints;
  quality.edges = topology.edges;
  quality.components = topology.components;
  quality.boundaryLoops = topology.boundaryLoops;
  quality.eulerCharacteristic = topology.eulerCharacteristic;
  quality.manifold = topology.manifold();
  quality.closed = topology.closed();
  countValences(topology, quality);
  measureShapes(points, quads, quality);
  measureEdges(points, quads, topology, quality);
  return quality;
}

} // namespace quadrille

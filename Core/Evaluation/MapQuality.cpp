// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/MapQuality.h"

#include "Base/Angles.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Evaluation/Distribution.h"
#include "GridMap/MapCheck.h"
#include "GridMap/MapShape.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadrille
{
namespace
{

/// The edges at corner 0 of the face in its plane, over its sizes, as columns.
Eigen::Matrix2d flatEdges(const Mesh& mesh, Index f)
{
  const SizedTriangle triangle = sizedTriangle(mesh, f);
  Eigen::Matrix2d edges;
  edges << triangle.width, triangle.apex.x(), 0, triangle.apex.y();
  return edges;
}

/// j: the gradient of g, with a determinant other than 0.
FaceMapQuality qualityOf(const Eigen::Matrix2d& j, double edgeLength)
{
  const double det = j.determinant();
  // Of a 2 by 2 matrix: the squared singular values are the roots of x^2 - |j|^2 x + det^2.
  const double half = j.squaredNorm() / 2;
  const double root = std::sqrt(std::max(0.0, (half - std::abs(det)) * (half + std::abs(det))));
  FaceMapQuality quality;
  quality.sizing = det / (edgeLength * edgeLength);
  quality.anisotropy = (half + root) / std::abs(det);
  quality.shear = std::atan2(det, std::abs(j.col(0).dot(j.col(1))));
  return quality;
}

std::vector<double> evenBins(double first, double last)
{
  std::vector<double> edges;
  for (int i = 0; i <= kQualityBins; ++i)
  {
    edges.push_back(first + (last - first) * i / kQualityBins);
  }
  return edges;
}

} // namespace

MapQuality measureMapQuality(const Mesh& mesh, const std::vector<FixedVec2>& uv, double edgeLength)
{
  refuseIf(uv.size() != mesh.origin.size(), "map quality: the map has not the size of the mesh");
  if (!(edgeLength > 0) || !std::isfinite(edgeLength))
  {
    throw InvalidInput("map quality: the edge length has to be positive and finite");
  }
  MapQuality result;
  result.faces.resize(mesh.faceCount());
  result.areas.assign(mesh.faceCount(), 0.0);
  std::vector<double> sizing, anisotropy, shear, weights;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const Eigen::Matrix2d flat = flatEdges(mesh, f);
    const Eigen::Matrix2d mapped = mappedEdges(uv, f);
    const Eigen::Matrix2d j = flat * mapped.inverse();
    if (!(flat.determinant() > 0) || mapped.determinant() == 0 || !(j.determinant() != 0) ||
      !j.allFinite())
    {
      ++result.degenerate;
      continue;
    }
    result.faces[f] = qualityOf(j, edgeLength);
    result.areas[f] = sizedArea(mesh, f);
    if (result.faces[f].sizing < 0)
    {
      ++result.inverted;
      continue;
    }
    sizing.push_back(result.faces[f].sizing);
    anisotropy.push_back(result.faces[f].anisotropy);
    shear.push_back(result.faces[f].shear);
    weights.push_back(result.areas[f]);
  }
  result.sizing = WeightedDistribution(sizing, weights);
  result.anisotropy = WeightedDistribution(anisotropy, weights);
  result.shear = WeightedDistribution(shear, weights);
  return result;
}

std::vector<int> turnsOfMap(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  refuseIf(uv.size() != mesh.origin.size(), "turns of a map: the map has not the size of the mesh");
  std::vector<int> turns(mesh.vertexCount(), 0);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    pollNowAndThen(f);
    const FixedVec2* p = &uv[3 * std::size_t{ f }];
    const int sign = orientation(p[0], p[1], p[2]);
    const std::array<std::int8_t, 3> entered = quadrantsEnteredByAll(p, sign);
    for (std::size_t i = 0; i < 3; ++i)
    {
      turns[mesh.origin[3 * f + i]] += entered[i];
    }
  }
  const std::vector<int> regular = regularTurns(mesh);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    turns[v] = regular[v] == 4 ? turns[v] : regular[v];
  }
  return turns;
}

std::vector<double> sizingBins()
{
  std::vector<double> edges = evenBins(-2, 2);
  for (double& edge : edges)
  {
    edge = std::exp2(edge);
  }
  return edges;
}

std::vector<double> anisotropyBins()
{
  return evenBins(1, 4.6);
}

std::vector<double> shearBins()
{
  return evenBins(0, kPi / 2);
}

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

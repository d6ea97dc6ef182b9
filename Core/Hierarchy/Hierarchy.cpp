// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/Hierarchy.h"

#include "Hierarchy/BudgetDecimation.h"
#include "Hierarchy/DecimationMesh.h"
#include "Hierarchy/LogBuilder.h"
#include "Hierarchy/UniformDecimation.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace quadrille
{

namespace
{

/// How far a curve of a coarser level may lie from the input's, in s: a tenth of a quad is not seen in the
/// quads, while a circle of radius s still gets an edge per 0.9 s.
constexpr double kCurveTolerance = 0.1;
/// Distance on both sides over which the turn at a corner is measured, in s.
constexpr double kCornerScale = 0.25;
/// A component is thinned out as if s were at most sqrt(area / this), so that one that is smaller than a few quads
/// still has about 60 vertices to carry a cross field.
constexpr double kSmallComponent = 26;

void checkOptions(const Mesh& fine, const HierarchyOptions& options)
{
  if (!(options.targetEdgeLength > 0) || !std::isfinite(options.targetEdgeLength))
  {
    throw InvalidInput(
      "The target edge length of a decimation must be positive and finite, but is " +
      std::to_string(options.targetEdgeLength) + ".");
  }
  for (const Index v : options.keepVertices)
  {
    if (v >= fine.vertexCount())
    {
      throw InvalidInput("Vertex " + std::to_string(v) + " is to be kept, but the mesh has only " +
        std::to_string(fine.vertexCount()) + " vertices.");
    }
  }
}

/// The lowest vertex of each vertex's component, by merging along all edges.
std::vector<Index> componentRoots(const Mesh& fine)
{
  std::vector<Index> parent(fine.vertexCount());
  std::iota(parent.begin(), parent.end(), Index{ 0 });
  const auto root = [&](Index v)
  {
    while (parent[v] != v)
    {
      parent[v] = parent[parent[v]];
      v = parent[v];
    }
    return v;
  };
  for (Index h = 0; h < fine.halfEdgeCount(); ++h)
  {
    const Index a = root(fine.origin[h]);
    const Index b = root(fine.target(h));
    parent[std::max(a, b)] = std::min(a, b);
  }
  for (Index v = 0; v < fine.vertexCount(); ++v)
  {
    parent[v] = parent[parent[v]]; // the parent is lower, so its own root is final already
  }
  return parent;
}

/// Factor on s per vertex; empty when no component is small against s.
std::vector<float> componentScales(const Mesh& fine, double edgeLength)
{
  const std::vector<Index> component = componentRoots(fine);
  std::vector<float> scales(fine.vertexCount(), 0.0F);
  std::vector<double> area(fine.vertexCount(), 0.0); // at the roots
  for (Index f = 0; f < fine.faceCount(); ++f)
  {
    area[component[fine.origin[3 * f]]] +=
      0.5 * fine.edgeVector(3 * f).cross(fine.edgeVector(3 * f + 1)).norm();
  }
  bool anySmall = false;
  for (Index v = 0; v < fine.vertexCount(); ++v)
  {
    const double scale = std::sqrt(area[component[v]] / kSmallComponent) / edgeLength;
    scales[v] = static_cast<float>(std::min(1.0, scale));
    anySmall = anySmall || scale < 1;
  }
  return anySmall ? scales : std::vector<float>();
}

/// The share [begin, end] of the whole progress.
ProgressCallback part(const ProgressCallback& progress, double begin, double end)
{
  if (!progress)
  {
    return {};
  }
  return [&progress, begin, end](double fraction, const std::string& text)
  { return progress(begin + (end - begin) * fraction, text); };
}

double secondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

Hierarchy buildHierarchy(const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options)
{
  checkOptions(fine, options);
  const double s = options.targetEdgeLength;
  Hierarchy result;
  LogBuilder log;

  const auto start1 = std::chrono::steady_clock::now();
  DecimationMesh mesh(fine, traceFeatureCurves(fine, kCornerScale * s));
  BudgetOptions budget;
  if (options.cost == DecimationCost::GaussianMemory)
  {
    budget.inputDefect = angleDefects(mesh);
  }
  UniformOptions uniform;
  uniform.edgeLength = 0.5 * s;
  uniform.scale = componentScales(fine, s);
  uniform.curveTolerance = kCurveTolerance * s;
  uniform.keepVertices = options.keepVertices;
  uniform.threads = options.threads;
  uniform.progress = part(options.progress, 0.0, 0.6);
  decimateUniformly(mesh, uniform, log);
  log.endIntermediate();
  result.intermediate = mesh.extract();
  result.secondsPhase1 = secondsSince(start1);

  const auto start2 = std::chrono::steady_clock::now();
  budget.vertices = options.coarseVertices;
  budget.cost = options.cost;
  budget.keepVertices = options.keepVertices;
  budget.curveTolerance = kCurveTolerance * s;
  budget.threads = options.threads;
  budget.progress = part(options.progress, 0.6, 1.0);
  result.notice = decimateToBudget(mesh, budget, log);
  result.coarse = mesh.extract();
  result.log = log.finish();
  result.log.fineHash = fineHash;
  result.log.fineFaces = fine.faceCount();
  result.secondsPhase2 = secondsSince(start2);
  return result;
}

} // namespace quadrille

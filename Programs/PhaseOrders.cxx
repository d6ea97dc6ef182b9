// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "PhaseOrders.h"

#include "Base/Parallel.h"
#include "Convert/PolyData.h"
#include "Features/FeatureFilter.h"
#include "MeshFiles.h"
#include "Prepare/Prepare.h"
#include "Prepare/Refine.h"

#include <vtkPolyData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace quadrille
{

namespace
{

struct Order
{
  const char* name;
  DecimationOrder order;
};
constexpr std::array<Order, 3> kOrders = { { { "sweeps", DecimationOrder::Sweeps },
  { "heap", DecimationOrder::Heap }, { "stochastic", DecimationOrder::Stochastic } } };

/// How even a level is. Lengths in s.
struct Evenness
{
  double shortPercent = 0;          ///< edges below s/2
  std::array<double, 3> quantile{}; ///< 5, 50 and 95 percent of the edges are shorter
  double deviation = 0;             ///< standard deviation of the lengths over their mean
  double meanQuality = 0;           ///< of the triangles, 4 sqrt(3) area / (sum of squared edges)
};

Evenness measure(const Mesh& mesh, double edgeLength)
{
  std::vector<double> length;
  Evenness evenness;
  double sum = 0;
  double squares = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isBoundary(h) || h < mesh.twin[h])
    {
      length.push_back(mesh.edgeVector(h).norm() / edgeLength);
      sum += length.back();
      squares += length.back() * length.back();
      evenness.shortPercent += length.back() < 0.5 ? 1 : 0;
    }
  }
  std::sort(length.begin(), length.end());
  const double count = static_cast<double>(length.size());
  evenness.shortPercent *= 100 / count;
  evenness.quantile = { length[length.size() / 20], length[length.size() / 2],
    length[length.size() * 19 / 20] };
  evenness.deviation =
    std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count))) / (sum / count);
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const Vector3 a = mesh.edgeVector(3 * f);
    const Vector3 b = mesh.edgeVector(3 * f + 1);
    evenness.meanQuality += 2 * std::sqrt(3.0) * a.cross(b).norm() /
      (a.squaredNorm() + b.squaredNorm() + (a + b).squaredNorm());
  }
  evenness.meanQuality /= mesh.faceCount();
  return evenness;
}

} // namespace

PreparedSurface prepareMeshFile(const std::string& path, double quads, double& edgeLength)
{
  const vtkSmartPointer<vtkPolyData> input = readMeshFile(path);
  PreparedSurface surface = prepareSurface(convertSurface(input, "").input, {});
  edgeLength = std::sqrt(surface.area / quads);
  removeUnresolvedFeatures(surface.mesh, edgeLength);
  refineSurface(surface, edgeLength, {});
  return surface;
}

void printOrdersHeader()
{
  std::printf(
    "mesh,repeat,order,threads,seconds,faces,vertices,intermediate_vertices,short_percent,"
    "edge_5,edge_50,edge_95,deviation,quality\n");
}

void printOrders(const std::string& path, const OrderComparison& request)
{
  double edgeLength = 0;
  const PreparedSurface surface = prepareMeshFile(path, request.quads, edgeLength);
  for (long long repeat = 0; repeat < request.repeat; ++repeat)
  {
    for (const Order& order : kOrders)
    {
      HierarchyOptions options;
      options.targetEdgeLength = edgeLength;
      options.order = order.order;
      options.draws = request.draws;
      options.threads = order.order == DecimationOrder::Sweeps ? request.threads : 1;
      const Hierarchy levels = Redecimation(surface.mesh, surface.hash, options).take();
      const Mesh& mesh = levels.intermediate.mesh;
      const Evenness even = measure(mesh, edgeLength);
      std::printf("%s,%lld,%s,%d,%.6f,%u,%u,%u,%.2f,%.3f,%.3f,%.3f,%.3f,%.3f\n",
        std::filesystem::path(path).stem().c_str(), repeat, order.name,
        resolveThreads(options.threads), levels.secondsPhase1, surface.mesh.faceCount(),
        surface.mesh.vertexCount(), mesh.vertexCount(), even.shortPercent, even.quantile[0],
        even.quantile[1], even.quantile[2], even.deviation, even.meanQuality);
      std::fflush(stdout);
    }
  }
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CoarseTimes.h"

#include "GridMap/GridMap.h"
#include "Hierarchy/Hierarchy.h"
#include "PhaseOrders.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <vector>

namespace quadrille
{

namespace
{

/// Field, seamless map, quantization, embedding, sum.
using StageSeconds = std::array<double, 5>;

StageSeconds wallSeconds(const GridMapResult& map)
{
  return { map.secondsField, map.secondsSeamless, map.secondsQuantize, map.secondsEmbed,
    map.secondsField + map.secondsSeamless + map.secondsQuantize + map.secondsEmbed };
}

StageSeconds processorSeconds(const GridMapResult& map)
{
  return { map.processorField, map.processorSeamless, map.processorQuantize, map.processorEmbed,
    map.processorField + map.processorSeamless + map.processorQuantize + map.processorEmbed };
}

StageSeconds medians(const std::vector<StageSeconds>& runs)
{
  StageSeconds result{};
  for (std::size_t i = 0; i < result.size(); ++i)
  {
    std::vector<double> values;
    for (const StageSeconds& run : runs)
    {
      values.push_back(run[i]);
    }
    std::sort(values.begin(), values.end());
    result[i] = (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
  }
  return result;
}

void printRow(const std::string& path, const CoarseTiming& request, const Mesh& mesh,
  const GridMapResult& map, const std::vector<StageSeconds>& runs, const char* clock)
{
  std::printf("%s,%.0f,%u,%u,%d", std::filesystem::path(path).stem().c_str(), request.quads,
    mesh.vertexCount(), mesh.faceCount(), map.status.ok() ? 1 : 0);
  for (const double seconds : medians(runs))
  {
    std::printf(",%.4f", seconds);
  }
  std::printf(",%d,%d,%s\n", map.seamlessSteps, map.embedSteps, clock);
}

} // namespace

void printCoarseHeader()
{
  std::printf("mesh,quads,vertices,faces,ok,field,seamless,quantize,embed,total,seamless_steps,"
              "embed_steps,clock\n");
}

void printCoarse(const std::string& path, const CoarseTiming& request)
{
  double edgeLength = 0;
  const PreparedSurface surface = prepareMeshFile(path, request.quads, edgeLength);
  HierarchyOptions levelOptions;
  levelOptions.targetEdgeLength = edgeLength;
  levelOptions.coarseVertices = request.coarseVertices;
  const Hierarchy levels = buildHierarchy(surface.mesh, surface.hash, levelOptions);
  const Mesh& mesh = levels.coarse.mesh;
  GridMapOptions options;
  options.edgeLength = edgeLength;
  options.targetQuads = request.quads;
  GridMapResult map;
  std::vector<StageSeconds> wall, processor;
  for (long long repeat = 0; repeat < request.repeat; ++repeat)
  {
    map = computeGridMap(mesh, options);
    wall.push_back(wallSeconds(map));
    processor.push_back(processorSeconds(map));
  }
  printRow(path, request, mesh, map, wall, "wall");
  printRow(path, request, mesh, map, processor, "processor");
  std::fflush(stdout);
}

} // namespace quadrille

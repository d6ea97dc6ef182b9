// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "CoarseTimes.h"

#include "GridMap/GridMap.h"
#include "Hierarchy/Hierarchy.h"
#include "PreparedFile.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
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

/// The coarse level with what is asked for on it.
struct CoarseTask
{
  Level level;
  GridMapOptions options;
};

/// Where the edits are: a vertex inside the surface, in the middle of the storage order or after it, that is regular.
Index regularVertex(const Mesh& mesh, const CrossField& field)
{
  const Index count = mesh.vertexCount();
  std::vector<bool> curve(count, false);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isConstrained(h))
    {
      curve[mesh.origin[h]] = curve[mesh.target(h)] = true;
    }
  }
  for (Index i = 0; i < count; ++i)
  {
    const Index v = (count / 2 + i) % count;
    if (!curve[v] && field.turns[v] == 4)
    {
      return v;
    }
  }
  return count / 2;
}

/// Vertices within so many edges of v.
std::vector<bool> ringsRound(const Mesh& mesh, Index v, int rings)
{
  std::vector<bool> inside(mesh.vertexCount(), false);
  inside[v] = true;
  for (int ring = 0; ring < rings; ++ring)
  {
    std::vector<Index> added;
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      if (inside[mesh.origin[h]] != inside[mesh.target(h)])
      {
        added.push_back(inside[mesh.origin[h]] ? mesh.target(h) : mesh.origin[h]);
      }
    }
    for (const Index w : added)
    {
      inside[w] = true;
    }
  }
  return inside;
}

/// A stroke along the field over the faces round v, turned by `turn` radians.
std::vector<Guide> strokeRound(const Mesh& mesh, const CrossField& field, Index v, double turn)
{
  constexpr int kTimedRings = 2;
  const std::vector<bool> inside = ringsRound(mesh, v, kTimedRings);
  std::vector<Guide> guides(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    if (inside[mesh.origin[3 * f]] && inside[mesh.origin[3 * f + 1]] &&
      inside[mesh.origin[3 * f + 2]])
    {
      const Vector3 axis = mesh.edgeVector(3 * f).normalized();
      const Vector3 normal = axis.cross(mesh.edgeVector(3 * f + 1)).normalized();
      const double angle = field.angle[f] + turn;
      guides[f].direction = std::cos(angle) * axis + std::sin(angle) * normal.cross(axis);
      guides[f].weight = 1;
    }
  }
  return guides;
}

struct Edit
{
  const char* name;
  CoarseTask before, after;
};

/// A direction that turns by 20 degrees, a vertex that is to have five edges, and a level with some more vertices.
std::vector<Edit> editsOf(Redecimation& levels, HierarchyOptions levelOptions,
  const CoarseTask& plain, const CrossField& field)
{
  constexpr double kTurn = 0.35;
  const Mesh& mesh = plain.level.mesh;
  const Index v = regularVertex(mesh, field);
  Edit direction{ "direction", plain, plain };
  direction.before.options.guides = strokeRound(mesh, field, v, 0);
  direction.after.options.guides = strokeRound(mesh, field, v, kTurn);
  Edit valence{ "valence", plain, plain };
  valence.after.options.targetValences.assign(mesh.vertexCount(), 0);
  valence.after.options.targetValences[v] = 5;
  Edit level{ "level", plain, plain };
  const Level& middle = levels.hierarchy().intermediate;
  const auto found =
    std::lower_bound(middle.fineVertex.begin(), middle.fineVertex.end(), plain.level.fineVertex[v]);
  const std::vector<bool> kept =
    ringsRound(middle.mesh, static_cast<Index>(found - middle.fineVertex.begin()), 2);
  for (Index w = 0; w < kept.size(); ++w)
  {
    if (kept[w])
    {
      levelOptions.keepVertices.push_back(middle.fineVertex[w]);
    }
  }
  level.after.level = levels.update(levelOptions).coarse;
  return { direction, valence, level };
}

class Timer
{
public:
  Timer(const std::string& path, const CoarseTiming& request) : path_(path), request_(request) {}

  /// Times a task and prints its two rows.
  GridMapResult run(const CoarseTask& task, const char* edit, const PreviousMap* previous)
  {
    GridMapOptions options = task.options;
    options.previous = previous;
    options.vertexIds = task.level.fineVertex;
    GridMapResult map;
    std::vector<StageSeconds> wall, processor;
    for (long long repeat = 0; repeat < request_.repeat; ++repeat)
    {
      map = computeGridMap(task.level.mesh, options);
      wall.push_back(wallSeconds(map));
      processor.push_back(processorSeconds(map));
    }
    const char* start = previous != nullptr ? "warm" : "cold";
    print(task.level.mesh, map, wall, edit, start, "wall");
    print(task.level.mesh, map, processor, edit, start, "processor");
    std::fflush(stdout);
    return map;
  }

private:
  void print(const Mesh& mesh, const GridMapResult& map, const std::vector<StageSeconds>& runs,
    const char* edit, const char* start, const char* clock) const
  {
    std::printf("%s,%.0f,%u,%u,%s,%s,%s,%d", std::filesystem::path(path_).stem().c_str(),
      request_.quads, mesh.vertexCount(), mesh.faceCount(), edit, start, clock,
      map.status.ok() ? 1 : 0);
    for (const double seconds : medians(runs))
    {
      std::printf(",%.4f", seconds);
    }
    std::printf(",%d,%d,%zu,%zu,%zu\n", map.seamlessSteps, map.embedSteps, map.reuse.faces,
      map.reuse.seamless, map.reuse.integers);
  }

  std::string path_;
  CoarseTiming request_;
};

} // namespace

void printCoarseHeader()
{
  std::printf("mesh,quads,vertices,faces,edit,start,clock,ok,field,seamless,quantize,embed,total,"
              "seamless_steps,embed_steps,faces_reused,seamless_reused,integers_reused\n");
}

void printCoarse(const std::string& path, const CoarseTiming& request)
{
  double edgeLength = 0;
  const PreparedSurface surface = prepareMeshFile(path, request.quads, edgeLength);
  HierarchyOptions levelOptions;
  levelOptions.targetEdgeLength = edgeLength;
  levelOptions.coarseVertices = request.coarseVertices;
  Redecimation levels(surface.mesh, surface.hash, levelOptions);
  CoarseTask plain;
  plain.level = levels.update(levelOptions).coarse;
  plain.options.edgeLength = edgeLength;
  plain.options.targetQuads = request.quads;
  plain.options.method = request.method;
  Timer timer(path, request);
  const GridMapResult map = timer.run(plain, "none", nullptr);
  if (!map.status.ok() || request.method != MapMethod::ScaleAware)
  {
    return; // the others always begin anew
  }
  for (const Edit& edit : editsOf(levels, levelOptions, plain, map.field))
  {
    const GridMapResult before = computeGridMap(edit.before.level.mesh, edit.before.options);
    if (!before.status.ok())
    {
      continue;
    }
    const PreviousMap previous =
      previousMap(edit.before.level.mesh, before, edit.before.level.fineVertex);
    timer.run(edit.after, edit.name, nullptr);
    timer.run(edit.after, edit.name, &previous);
  }
}

} // namespace quadrille

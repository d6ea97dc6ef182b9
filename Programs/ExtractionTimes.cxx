// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "ExtractionTimes.h"

#include "Base/Parallel.h"
#include "Convert/PolyData.h"
#include "Extraction/ExactMap.h"
#include "Extraction/Extraction.h"
#include "MeshFiles.h"
#include "Pipeline/Pipeline.h"

#include <vtkPolyData.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace quadrille
{

namespace
{

/// 25 times as many quads at the largest: 10,000 become 250,000.
constexpr int kScales[] = { 1, 2, 5 };

struct MappedMesh
{
  Mesh mesh;
  std::vector<FixedVec2> uv;
};

FixedVec2 midpoint(FixedVec2 a, FixedVec2 b)
{
  return { (a.u + b.u) >> 1, (a.v + b.v) >> 1 };
}

/// Every triangle in four by the midpoints of its edges; those of the map are rounded in the chart of the lower
/// half-edge and carried over the exact transition, so the map stays seamless bit for bit.
///
///            c
///          /   \            face f becomes 4f .. 4f + 3: (a, ab, ca), (b, bc, ab),
///       ca ---- bc          (c, ca, bc) and (ab, bc, ca)
///      /  \    /  \         .
///     a --- ab --- b
MappedMesh subdivided(const MappedMesh& coarse)
{
  const Mesh& mesh = coarse.mesh;
  const ExactMap map{ mesh, coarse.uv };
  MappedMesh fine;
  fine.mesh.position = mesh.position;
  std::vector<Index> middle(mesh.halfEdgeCount());
  std::vector<FixedVec2> middleUv(mesh.halfEdgeCount());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Index g = mesh.twin[h];
    if (g < h)
    {
      continue;
    }
    middle[h] = static_cast<Index>(fine.mesh.position.size());
    middleUv[h] = midpoint(map.at(h), map.at(Mesh::next(h)));
    fine.mesh.position.push_back(
      (mesh.position[mesh.origin[h]] + mesh.position[mesh.target(h)]) / 2);
    if (g != kInvalidIndex)
    {
      Transition t;
      middle[g] = middle[h];
      middleUv[g] =
        map.transition(h, t) ? t.apply(middleUv[h]) : midpoint(map.at(g), map.at(Mesh::next(g)));
    }
  }
  // Half of h at its origin, and at its target.
  const auto lower = [](Index h) { return 12 * (h / 3) + 3 * (h % 3); };
  const auto upper = [&lower](Index h) { return lower(Mesh::next(h)) + 2; };
  const std::size_t count = 4 * mesh.origin.size();
  fine.mesh.origin.resize(count);
  fine.mesh.twin.resize(count);
  fine.mesh.flags.assign(count, 0);
  fine.uv.resize(count);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    const Index p = Mesh::previous(h);
    const Index g = mesh.twin[h];
    const Index corner = lower(h);                // (origin, middle of h, middle of the one before)
    const Index inner = 12 * (h / 3) + 9 + h % 3; // from the middle of h to that of the next one
    fine.mesh.origin.edit()[corner] = mesh.origin[h];
    fine.mesh.origin.edit()[corner + 1] = fine.mesh.origin.edit()[inner] = middle[h];
    fine.mesh.origin.edit()[corner + 2] = middle[p];
    fine.uv[corner] = map.at(h);
    fine.uv[corner + 1] = fine.uv[inner] = middleUv[h];
    fine.uv[corner + 2] = middleUv[p];
    fine.mesh.twin.edit()[corner] = g == kInvalidIndex ? g : upper(g);
    fine.mesh.twin.edit()[upper(h)] = g == kInvalidIndex ? g : lower(g);
    fine.mesh.flags.edit()[corner] = fine.mesh.flags.edit()[upper(h)] = mesh.flags[h];
    const Index across = 12 * (h / 3) + 9 + p % 3; // from the middle of the one before to that of h
    fine.mesh.twin.edit()[corner + 1] = across;
    fine.mesh.twin.edit()[across] = corner + 1;
  }
  return fine;
}

/// A point by where it is and on which place of the surface it lies.
using PlacedPoint = std::tuple<double, double, double, Index, std::array<double, 3>>;

/// The quads by their points, each from its lowest one on, sorted.
std::vector<std::array<Index, 4>> sortedQuads(
  const QuadMesh& quads, std::vector<PlacedPoint>& places)
{
  const auto place = [&quads](std::size_t p) -> PlacedPoint
  {
    const Vector3& x = quads.points[p];
    return { x.x(), x.y(), x.z(), quads.sourceFace[p], quads.sourceWeights[p] };
  };
  places.clear();
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    places.push_back(place(p));
  }
  std::sort(places.begin(), places.end());
  const auto rank = [&](Index p)
  {
    return static_cast<Index>(
      std::lower_bound(places.begin(), places.end(), place(p)) - places.begin());
  };
  std::vector<std::array<Index, 4>> sorted;
  for (std::array<Index, 4> q : quads.quads)
  {
    for (Index& p : q)
    {
      p = rank(p);
    }
    std::rotate(q.begin(), std::min_element(q.begin(), q.end()), q.end());
    sorted.push_back(q);
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// The same points and the same quads, in any order.
bool isSame(const QuadMesh& a, const QuadMesh& b)
{
  std::vector<PlacedPoint> placesA;
  std::vector<PlacedPoint> placesB;
  const auto quadsA = sortedQuads(a, placesA);
  const auto quadsB = sortedQuads(b, placesB);
  return placesA == placesB && quadsA == quadsB;
}

double seconds(clockid_t clock)
{
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

/// One way to extract.
struct Way
{
  ExtractionPath path = ExtractionPath::Fast;
  int threads = 1;

  const char* name() const { return path == ExtractionPath::Fast ? "fast" : "folded"; }
};

/// With one thread and with as many as asked for; the fast path only where it works.
std::vector<Way> waysFor(const MappedMesh& mapped, int threads)
{
  const bool folded = checkMap({ mapped.mesh, mapped.uv }, false, threads).count[kNotPositive] > 0;
  std::vector<Way> ways;
  for (const ExtractionPath path : { ExtractionPath::Fast, ExtractionPath::Folded })
  {
    if (folded && path == ExtractionPath::Fast)
    {
      continue;
    }
    ways.push_back({ path, 1 });
    if (resolveThreads(threads) > 1)
    {
      ways.push_back({ path, resolveThreads(threads) });
    }
  }
  return ways;
}

/// What came of all runs in one way.
struct Outcome
{
  std::vector<double> wall;
  std::vector<double> processor;
  std::size_t quads = 0;
  bool ok = false;
  bool same = false; ///< the points and quads of the first way
};

QuadMesh runOnce(
  const Mesh& mesh, const std::vector<FixedVec2>& uv, const Way& way, Outcome& outcome)
{
  ExtractionOptions options;
  options.path = way.path;
  options.threads = way.threads;
  options.smoothingSteps = 0;
  const double wall = seconds(CLOCK_MONOTONIC);
  const double processor = seconds(CLOCK_PROCESS_CPUTIME_ID);
  ExtractionResult result = extractQuads(mesh, uv, options);
  outcome.processor.push_back(seconds(CLOCK_PROCESS_CPUTIME_ID) - processor);
  outcome.wall.push_back(seconds(CLOCK_MONOTONIC) - wall);
  outcome.quads = result.mesh.quads.size();
  outcome.ok = result.status.ok();
  return std::move(result.mesh);
}

/// Ways alternate, so that a busy machine disturbs all alike.
std::vector<Outcome> runAll(const Mesh& mesh, const std::vector<FixedVec2>& uv,
  const std::vector<Way>& ways, long long repeat)
{
  std::vector<Outcome> outcomes(ways.size());
  QuadMesh first;
  for (long long i = 0; i < repeat; ++i)
  {
    for (std::size_t k = 0; k < ways.size(); ++k)
    {
      QuadMesh quads = runOnce(mesh, uv, ways[k], outcomes[k]);
      if (i > 0)
      {
        continue;
      }
      if (k == 0)
      {
        first = std::move(quads);
        outcomes[k].same = true;
      }
      else
      {
        outcomes[k].same = isSame(first, quads);
      }
    }
  }
  return outcomes;
}

/// The map of a mesh file; none where it gives no quads, which is told.
std::optional<MappedMesh> mapMeshFile(const std::string& path, const ExtractionTiming& request)
{
  const vtkSmartPointer<vtkPolyData> input = readMeshFile(path);
  RemeshOptions options;
  options.quads = static_cast<std::size_t>(request.quads);
  options.threads = request.threads;
  RemeshResult result = remesh(convertSurface(input, "").input, options);
  if (!result.status.ok())
  {
    std::fprintf(stderr, "quadrille-bench: %s: %s\n", path.c_str(), result.status.message.c_str());
    return std::nullopt;
  }
  MappedMesh mapped{ std::move(result.surface.mesh), std::move(result.uv) };
  for (int i = 0; i < request.subdivide; ++i)
  {
    mapped = subdivided(mapped);
  }
  return mapped;
}

} // namespace

void printExtractionHeader()
{
  std::printf("mesh,asked,faces,scale,path,threads,clock,quads,ok,same,seconds\n");
}

bool printExtraction(const std::string& path, const ExtractionTiming& request)
{
  const std::optional<MappedMesh> mapped = mapMeshFile(path, request);
  if (!mapped)
  {
    return false;
  }
  const std::vector<Way> ways = waysFor(*mapped, request.threads);
  bool allGood = true;
  for (const int scale : kScales)
  {
    std::vector<FixedVec2> uv = mapped->uv;
    for (FixedVec2& p : uv)
    {
      p = { p.u * scale, p.v * scale };
    }
    const std::vector<Outcome> outcomes = runAll(mapped->mesh, uv, ways, request.repeat);
    for (std::size_t k = 0; k < ways.size(); ++k)
    {
      const Outcome& outcome = outcomes[k];
      for (const bool wall : { true, false })
      {
        std::printf("%s,%.0f,%u,%d,%s,%d,%s,%zu,%d,%d,%.6f\n",
          std::filesystem::path(path).stem().c_str(), request.quads, mapped->mesh.faceCount(),
          scale, ways[k].name(), ways[k].threads, wall ? "wall" : "processor", outcome.quads,
          outcome.ok ? 1 : 0, outcome.same ? 1 : 0,
          median(wall ? outcome.wall : outcome.processor));
      }
      allGood = allGood && outcome.ok && outcome.same;
    }
    std::fflush(stdout);
  }
  return allGood;
}

} // namespace quadrille

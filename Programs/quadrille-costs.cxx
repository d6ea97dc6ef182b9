// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The costs of phase 2 against each other: what the decimation does to the singularities of the cross field, as CSV on
/// standard output [Ebke et al. 2016, Figure 13].
#include "CrossField/CrossField.h"
#include "Evaluation/SingularityDistance.h"
#include "Hierarchy/Hierarchy.h"
#include "Options.h"
#include "PreparedFile.h"
#include "Transfer/ExpectedTurns.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace
{

using namespace quadrille;

constexpr const char* kIntroduction =
  R"(usage: quadrille-costs MESH... [options]

Computes the cross field of each mesh without decimation and on coarse levels made with every cost, and writes to
standard output, as CSV, the columns
  mesh,field,triangles,valences,distance,percent,seconds_cold,seconds_warm,hit_percent
with a row for each of
  reference, intermediate, E_G,mem, E_G, E_QEM, E_uni
valences: the irregular inner vertices, as valence:number. distance: earth mover's distance of the singularities to
the reference, in quarter turns times target edge lengths; percent: relative to E_G,mem. Seconds of phase 2 from the
intermediate level, with an empty and with a full cache of costs, and how much of a second run the cache knows when
every 50th intermediate vertex has to be kept.

)";

constexpr const char* kClosing = "exit code: 0, or 2 when a mesh cannot be used";

constexpr int kBadInput = 2;
constexpr std::size_t kKeepEvery = 50;

struct Request
{
  double quads = 5000;
  Index coarseVertices = 1000;
  std::size_t referenceFaces = 400000;
};

struct Cost
{
  const char* name;
  DecimationCost cost;
};
constexpr std::array<Cost, 4> kCosts = { { { "\"E_G,mem\"", DecimationCost::GaussianMemory },
  { "E_G", DecimationCost::Gaussian }, { "E_QEM", DecimationCost::Quadric },
  { "E_uni", DecimationCost::Uniform } } };

std::vector<int> turnsOf(const Mesh& mesh, double edgeLength)
{
  CrossFieldOptions options;
  options.targetEdgeLength = edgeLength;
  return computeCrossField(mesh, options).turns;
}

/// The turns of a level's field on the finest mesh.
std::vector<int> turnsOf(const Mesh& fine, const Level& level, double edgeLength)
{
  return expectedTurns(fine, level, turnsOf(level.mesh, edgeLength));
}

std::string valencesText(const Mesh& mesh, const std::vector<int>& turns)
{
  std::string text;
  for (const auto& [valence, count] : singularityHistogram(mesh, turns))
  {
    text += (text.empty() ? "" : " ") + std::to_string(valence) + ":" + std::to_string(count);
  }
  return text;
}

/// Distance in edge lengths; a row about sums that differ would mean nothing.
double distance(const Mesh& mesh, const std::vector<int>& reference, const std::vector<int>& turns,
  double edgeLength)
{
  const SingularityDistance result = singularityDistance(mesh, reference, turns);
  return result.unmatched == 0 ? result.work / edgeLength : std::nan("");
}

struct Timing
{
  double cold = 0;
  double warm = 0;
  double hitPercent = 0;
};

Timing timePhase2(Redecimation& levels, HierarchyOptions options)
{
  Timing timing;
  timing.cold = levels.update(options).secondsPhase2;
  timing.warm = levels.update(options).secondsPhase2;
  const std::vector<Index>& vertices = levels.hierarchy().intermediate.fineVertex;
  for (std::size_t i = 0; i < vertices.size(); i += kKeepEvery)
  {
    options.keepVertices.push_back(vertices[i]);
  }
  const CacheReport cache = levels.update(options).cache;
  timing.hitPercent = 100.0 * static_cast<double>(cache.hits) /
    static_cast<double>(std::max<std::size_t>(cache.lookups, 1));
  return timing;
}

void compare(const std::string& path, const Request& request)
{
  double edgeLength = 0;
  const PreparedSurface surface = prepareMeshFile(path, request.quads, edgeLength);
  const Mesh& fine = surface.mesh;
  HierarchyOptions options;
  options.targetEdgeLength = edgeLength;
  options.coarseVertices = request.coarseVertices;
  Redecimation levels(fine, surface.hash, options);
  const Level& intermediate = levels.hierarchy().intermediate;
  const std::string name = std::filesystem::path(path).stem();

  const std::vector<int> middle = turnsOf(fine, intermediate, edgeLength);
  const bool whole = fine.faceCount() <= request.referenceFaces;
  const std::vector<int> reference = whole ? turnsOf(fine, edgeLength) : middle;
  std::printf("%s,reference,%u,%s,0,,,,\n", name.c_str(),
    whole ? fine.faceCount() : intermediate.mesh.faceCount(),
    valencesText(fine, reference).c_str());
  std::printf("%s,intermediate,%u,%s,%.2f,,,,\n", name.c_str(), intermediate.mesh.faceCount(),
    valencesText(fine, middle).c_str(), distance(fine, reference, middle, edgeLength));
  double hundredPercent = 0;
  for (const Cost& cost : kCosts)
  {
    options.cost = cost.cost;
    const Timing timing = timePhase2(levels, options);
    const Level& coarse = levels.update(options).coarse;
    const std::vector<int> turns = turnsOf(fine, coarse, edgeLength);
    const double far = distance(fine, reference, turns, edgeLength);
    hundredPercent = cost.cost == DecimationCost::GaussianMemory ? far : hundredPercent;
    std::printf("%s,%s,%u,%s,%.2f,%.0f,%.3f,%.3f,%.1f\n", name.c_str(), cost.name,
      coarse.mesh.faceCount(), valencesText(fine, turns).c_str(), far, 100 * far / hundredPercent,
      timing.cold, timing.warm, timing.hitPercent);
    std::fflush(stdout);
  }
}

void addOptions(CommandOptions& options, Request& request)
{
  options.beginGroup("options:");
  options.addCount(
    "quads", "N", { 1, 1000000000 },
    [&request](long long quads) { request.quads = static_cast<double>(quads); },
    "target number of quads (default 5000)");
  options.addCount(
    "coarse-vertices", "N", { 4, 1000000000 },
    [&request](long long count) { request.coarseVertices = static_cast<Index>(count); },
    "budget of the coarse level (default 1000)");
  options.addCount(
    "reference-faces", "N", { 0, 1000000000 },
    [&request](long long count) { request.referenceFaces = static_cast<std::size_t>(count); },
    "meshes with more triangles have the field of the intermediate level as reference (default "
    "400000)");
}

} // namespace

int main(int argc, char* argv[])
{
  try
  {
    Request request;
    CommandOptions options(kIntroduction, kClosing);
    addOptions(options, request);
    if (const std::optional<std::string> text = options.parse(argc, argv))
    {
      std::fputs(text->c_str(), stdout);
      return 0;
    }
    if (options.files().empty())
    {
      throw UsageError("no mesh is given; --help tells more");
    }
    std::printf("mesh,field,triangles,valences,distance,percent,seconds_cold,seconds_warm,"
                "hit_percent\n");
    for (const std::string& mesh : options.files())
    {
      compare(mesh, request);
    }
    return 0;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "quadrille-costs: %s\n", error.what());
    return kBadInput;
  }
}

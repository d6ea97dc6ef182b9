// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Seconds and sizes of the stages, as CSV on standard output. Every run is a process of its own, so that
/// its peak memory is its own; the peak is the same on each row of a run.
#include "Base/Clock.h"
#include "Base/Memory.h"
#include "Base/Parallel.h"
#include "CoarseTimes.h"
#include "ExtractionTimes.h"
#include "FieldCounts.h"
#include "MeshFiles.h"
#include "Options.h"
#include "RemeshRun.h"
#include "ReplayCounts.h"

#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPolyData.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

namespace
{

using namespace quadrille;

constexpr const char* kIntroduction =
  R"(usage: quadrille-bench MESH... [--quads N | --edge-length S] [--threads N] [--repeat N]
       quadrille-bench MESH... --compare replay [--quads N] [--threads N]
       quadrille-bench MESH... --compare field [--quads N] [--threads N]
       quadrille-bench MESH... --compare coarse [--quads N] [--coarse-vertices N] [--repeat N]
       quadrille-bench MESH... --compare extraction [--quads N] [--subdivide N] [--threads N] [--repeat N]

Remeshes each mesh and writes to standard output, as CSV, the columns
  mesh,repeat,threads,stage,seconds,elements_in,elements_out,peak_rss_mb
with the stages
  read, repair, order, connectivity, refine, phase1, phase2, field, seamless, quantize, embed,
  replay, certify, extract, total, cancel, attempts
where refine splits the surface's long edges, certify checks the map on the surface and cancel is the longest time in
which the run could not have been stopped. Stages that were repeated count with all their runs: elements_in and
elements_out of attempts tell how often phase 1 ran and how many maps were carried to the surface.

With --compare replay writes, instead, what the replay of the coarse map did to the triangles of each mesh:
  mesh,quads,faces,coarse_not_positive,inverted_stars,moved_to_kernel,without_kernel,replay_not_positive,
  mended_patches,not_positive,ok
where stars that their vertex inverted are counted, those of them that were mended by moving it into the kernel of its
ring, and those that have none; then triangles that are not positive after the replay and after patches round them were
embedded anew. ok: 1 when quads came of it.

With --compare field computes the cross field of each mesh on all of its refined surface, remeshes it, and writes
  mesh,quads,faces,coarse_vertices,irregular_surface,irregular_coarse,ratio,ok
with the irregular vertices of both fields, the second over the first, and whether quads came of it. At most 500,000
refined faces.

)";

constexpr const char* kCoarse =
  R"(With --compare coarse makes the coarse level of each mesh, then its field and map on one thread, and writes
  mesh,quads,vertices,faces,edit,start,clock,ok,field,seamless,quantize,embed,total,seamless_steps,embed_steps,
  faces_reused,seamless_reused,integers_reused
with medians in seconds of the clock on the wall and of the processor, Newton steps, and what was taken over from the
map before. Edits: none; direction, a stroke over some faces turned by 20 degrees; valence, one vertex that is to have
five edges; level, the vertices of the intermediate level round it kept. Those are made cold and starting warm from the
map before the edit. A level whose first map fails has ok 0 and no edits.
)";

constexpr const char* kExtraction =
  R"(With --compare extraction remeshes each mesh, extracts the quads of the map on its surface, and of the map made 2
and 5 times as large, with one thread and with --threads, by the fast path where the map has no folds and by the one
for folds, without smoothing, and writes
  mesh,asked,faces,scale,path,threads,clock,quads,ok,same,seconds
with medians of the clock on the wall and of the processor. same: 1 when points and quads are those of the first row of
the scale.
)";

constexpr const char* kClosing =
  "exit code: 0 when every run gave quads, else the worst code of the command quadrille";

constexpr std::array<const char*, 17> kStages = { "read", "repair", "order", "connectivity",
  "refine", "phase1", "phase2", "field", "seamless", "quantize", "embed", "replay", "certify",
  "extract", "total", "cancel", "attempts" };

/// Seconds without a chance to stop that are worth a line.
constexpr double kSlowCancel = 0.1;

struct Request
{
  long long quads = 5000;
  double edgeLength = 0; ///< 0: quads
  int threads = 0;
  long long repeat = 1;
  /// "replay": counts of the replay; "field": irregular vertices; "coarse": times of the coarse level; "extraction":
  /// times of the extraction
  std::string compared;
  Index coarseVertices = 1000;
  int subdivide = 0;
  int method = 0; ///< of vtkQuadRemesh::Methods
};

const std::vector<std::string> kComparisons = { "replay", "field", "coarse", "extraction" };

void addOptions(CommandOptions& options, Request& request)
{
  options.beginGroup("options:");
  options.addCount(
    "quads", "N", { 1, 1000000000 }, [&request](long long quads) { request.quads = quads; },
    "target number of quads (default 5000)");
  options.addNumber(
    "edge-length", "S", { 1e-300, 1e300 },
    [&request](double length) { request.edgeLength = length; },
    "target edge length in units of the input");
  options.addCount(
    "threads", "N", { 0, 4096 },
    [&request](long long threads) { request.threads = static_cast<int>(threads); },
    "threads to compute with; 0 means all (default 0)");
  options.addCount(
    "repeat", "N", { 1, 1000000 }, [&request](long long repeat) { request.repeat = repeat; },
    "runs of each mesh (default 1)");
  addMethod(
    options, [&request](int method) { request.method = method; },
    "how the map is made, as the command has it (default scale-aware). Of those that round, "
    "seamless is cut, Poisson "
    "equation and relations, quantize the rounding");
  options.addChoice(
    "compare", "NAME", kComparisons,
    [&request](int name) { request.compared = kComparisons[static_cast<std::size_t>(name)]; },
    "replay, field, coarse or extraction: compares instead, as told here");
}

/// Those that only one comparison has.
void addComparisons(CommandOptions& options, Request& request)
{
  options.beginGroup(kCoarse);
  options.addCount(
    "coarse-vertices", "N", { 4, 1000000000 },
    [&request](long long count) { request.coarseVertices = static_cast<Index>(count); },
    "budget of the coarse level (default 1000)");
  options.beginGroup(kExtraction);
  options.addCount(
    "subdivide", "N", { 0, 3 },
    [&request](long long times) { request.subdivide = static_cast<int>(times); },
    "cut each triangle of the mapped surface into four, N times (default 0)");
}

/// What no option can check for itself.
void checkTogether(const CommandOptions& options, const Request& request)
{
  if (options.files().empty())
  {
    throw UsageError("no mesh is given; --help tells more");
  }
  if (options.given("quads") && options.given("edge-length"))
  {
    throw UsageError("only one of --quads and --edge-length can be given");
  }
  if (request.compared != "coarse" && options.given("coarse-vertices"))
  {
    throw UsageError("--coarse-vertices is for --compare coarse");
  }
  if (request.compared != "extraction" && options.given("subdivide"))
  {
    throw UsageError("--subdivide is for --compare extraction");
  }
  if (!request.compared.empty() && options.given("edge-length"))
  {
    throw UsageError("--compare takes --quads, not --edge-length");
  }
}

std::vector<StageRow> collect(const std::vector<StageRow>& stages)
{
  std::vector<StageRow> rows;
  for (const char* name : kStages)
  {
    StageRow row{ name, 0, 0, 0 };
    bool first = true;
    for (const StageRow& stage : stages)
    {
      if (stage.stage == name)
      {
        row.seconds += stage.seconds;
        row.elementsIn = first ? stage.elementsIn : row.elementsIn;
        row.elementsOut = stage.elementsOut;
        first = false;
      }
    }
    rows.push_back(row);
  }
  return rows;
}

double peakMegabytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024; // Linux counts KiB
}

void printRows(const std::string& mesh, long long repeat, const Request& request,
  const std::vector<StageRow>& rows)
{
  const double peak = peakMegabytes();
  for (const StageRow& row : rows)
  {
    std::printf("%s,%lld,%d,%s,%.6f,%lld,%lld,%.1f\n", std::filesystem::path(mesh).stem().c_str(),
      repeat, resolveThreads(request.threads), row.stage.c_str(), row.seconds, row.elementsIn,
      row.elementsOut, peak);
  }
  std::fflush(stdout);
}

/// One mesh of a comparison.
int compare(const std::string& mesh, const Request& request)
{
  try
  {
    const double quads = static_cast<double>(request.quads);
    if (request.compared == "replay")
    {
      printReplay(mesh, quads, request.threads);
    }
    else if (request.compared == "field")
    {
      printFieldCounts(mesh, quads, request.threads);
    }
    else if (request.compared == "coarse")
    {
      printCoarse(mesh,
        { quads, request.coarseVertices, static_cast<MapMethod>(request.method), request.repeat });
    }
    else
    {
      return printExtraction(mesh, { quads, request.threads, request.subdivide, request.repeat })
        ? kValidQuads
        : kNoValidResult;
    }
    return kValidQuads;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "quadrille-bench: %s\n", error.what());
    return kBadInput;
  }
}

int runOnce(const std::string& mesh, long long repeat, const Request& request)
{
  try
  {
    const double start = secondsNow();
    const vtkSmartPointer<vtkPolyData> input = readMeshFile(mesh, request.threads);
    const double read = secondsNow() - start;
    RemeshRun run;
    run.filter()->SetTargetTypeToNumberOfQuads();
    run.filter()->SetNumberOfQuads(request.quads);
    if (request.edgeLength > 0)
    {
      run.filter()->SetTargetTypeToEdgeLength();
      run.filter()->SetEdgeLength(request.edgeLength);
    }
    run.filter()->SetNumberOfThreads(request.threads);
    run.filter()->SetMethod(request.method);
    run.filter()->SetComputeMappedSurface(request.method == vtkQuadRemesh::METHOD_SEAMLESS);
    const ExitCode code = run.execute(input);
    if (code != kValidQuads)
    {
      std::fprintf(stderr, "quadrille-bench: %s: %s\n", mesh.c_str(), run.error().c_str());
      return code;
    }
    const long long cells = input->GetNumberOfCells();
    std::vector<StageRow> rows = run.stages();
    rows.insert(rows.begin(), { "read", read, cells, cells });
    rows.push_back(
      { "total", secondsNow() - start, cells, run.filter()->GetOutput()->GetNumberOfPolys() });
    vtkFieldData* facts = run.filter()->GetOutput()->GetFieldData();
    rows.push_back(
      { "attempts", 0, static_cast<long long>(facts->GetArray("Decimations")->GetTuple1(0)),
        static_cast<long long>(facts->GetArray("Replays")->GetTuple1(0)) });
    rows.push_back({ "cancel", run.longestGap(), cells, cells });
    printRows(mesh, repeat, request, collect(rows));
    if (run.longestGap() > kSlowCancel)
    {
      std::fprintf(stderr, "quadrille-bench: %s: %.3f s without a chance to stop after '%s'\n",
        mesh.c_str(), run.longestGap(), run.longestGapText().c_str());
    }
    return kValidQuads;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "quadrille-bench: %s\n", error.what());
    return kBadInput;
  }
}

/// A crash of one run is a failure of that run only.
int runInChild(const std::string& mesh, long long repeat, const Request& request)
{
  std::fflush(stdout);
  const pid_t child = ::fork();
  if (child == 0)
  {
    const int code = runOnce(mesh, repeat, request);
    std::fflush(nullptr);
    ::_exit(code);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) < 0 || !WIFEXITED(status))
  {
    std::fprintf(stderr, "quadrille-bench: %s: the run ended abnormally\n", mesh.c_str());
    return kNoValidResult;
  }
  return WEXITSTATUS(status);
}

int compareAll(const std::vector<std::string>& meshes, const Request& request)
{
  request.compared == "replay"     ? printReplayHeader()
    : request.compared == "field"  ? printFieldCountsHeader()
    : request.compared == "coarse" ? printCoarseHeader()
                                   : printExtractionHeader();
  int worst = 0;
  for (const std::string& mesh : meshes)
  {
    worst = std::max(worst, compare(mesh, request));
  }
  return worst;
}

int runAll(const std::vector<std::string>& meshes, const Request& request)
{
  std::printf("mesh,repeat,threads,stage,seconds,elements_in,elements_out,peak_rss_mb\n");
  int worst = 0;
  for (const std::string& mesh : meshes)
  {
    for (long long repeat = 0; repeat < request.repeat; ++repeat)
    {
      worst = std::max(worst, runInChild(mesh, repeat, request));
    }
  }
  return worst;
}

} // namespace

int main(int argc, char* argv[])
{
  keepFreedMemory(); // as the command does
  try
  {
    Request request;
    CommandOptions options(kIntroduction, kClosing);
    addOptions(options, request);
    addComparisons(options, request);
    if (const std::optional<std::string> text = options.parse(argc, argv))
    {
      std::fputs(text->c_str(), stdout);
      return 0;
    }
    checkTogether(options, request);
    return request.compared.empty() ? runAll(options.files(), request)
                                    : compareAll(options.files(), request);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "quadrille-bench: %s\n", error.what());
    return kBadInput;
  }
}

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The command for people without ParaView's window: a mesh file in, a quad mesh out.
#include "Evaluation/QuadQuality.h"
#include "Json.h"
#include "MeshFiles.h"
#include "Options.h"
#include "RemeshRun.h"
#include "Terminal.h"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkObject.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>

#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <new>
#include <sstream>
#include <vector>

namespace
{

using namespace quadrille;

constexpr const char* kHelp =
  R"(usage: quadrille IN.{ply,obj,stl,off,vtp,vtk} OUT.{vtp,obj,ply,vtu,ex2} [options]
       quadrille IN.{ply,obj,stl,off,vtp,vtk} --method seamless --map MAP.vtp [options]

Remeshes a triangle surface with quads only.

size of the quads (at most one):
  --quads N                 target number of quads (default 5000)
  --edge-length S           target edge length in units of the input
  --relative-edge-length R  target edge length over the bounding-box diagonal

  --feature-angle DEG       edges sharper than this become edges of the quads;
                            0 turns the detection off (default 40)
  --coarse-vertices N       vertices of the level where the layout is computed (default 1000); auto: as many as the
                            curvature of the surface needs, from 300 to 4000
  --method NAME             how the map is made: scale-aware (default); mixed-integer and quadcover, which may leave
                            inverted triangles and then fail; seamless, which has no integers and so makes no quads
  --integers NAME           keep-sizes (default): quads of the size asked for; coarsest: as few as a layout of the
                            surface can have; the size then sets only what the coarse level keeps
  --anisotropy-limit R      largest ratio of the two stretches of the map, at least 1, as far as features and irregular
                            vertices let it; quads then differ more in size (default 0: no limit)
  --close-handles R         cut and close handles that are shorter round than R edge lengths of the quads,
                            which need 3 (default 0: none)
  --small-components WORD   what becomes of connected components with less area than the smallest block of quads has:
                            keep (default), as about that many quads, or remove
  --final-quality LEVEL     coarse, intermediate or input: where the map is solved at last, with the same quads;
                            the finer, the less distorted, and the longer it takes (default coarse)
  --distortion-metric WORD  on: coarse triangles count with the shape of the surface that they stand for, so that
                            sizes come out more even (default off)
  --smoothing-steps N       sweeps in which the points move over the surface, where that does not lower the worst
                            scaled Jacobian round them, before quads that are turned over at a corner are mended; 0: they
                            stay where the map has them (default 5)
  --cell-data NAME          what cell arrays of the quads come from: centre (default), the cell under the centre of a
                            quad; area, all cells under it: the average of real numbers, the most frequent label
  --threads N               threads to compute with; 0 means all (default 0)
  --memory-limit MB         refuse to start where more memory is needed by the estimate;
                            0 means what the machine has free (default 0)
  --map MAP.vtp             write the surface with its map, too (cell array IGM: u0 v0 u1 v1 u2 v2, one unit a quad,
                            and texture coordinates); the seamless method writes this only, so leave OUT away there
  --report REPORT.json      what was repaired, sizes, seconds per stage, certificate,
                            asked and actual count, quality
  --maximum-quads N         refuse to make more than this (default 10000000)
  --quiet                   no progress, no notices, no summary; what goes wrong is still told
  --help                    this text

exit code: 0 valid quads (seamless: a valid map); 2 bad input or arguments; 3 no valid result
)";

volatile std::sig_atomic_t stopRequested = 0;

void requestStop(int)
{
  stopRequested = 1;
}

/// VTK's readers end the process where a damaged file makes them ask for too much memory. Catching that is the only way to keep
/// the promise of an exit code.
class ReaderGuard
{
public:
  ReaderGuard()
  {
    std::signal(SIGABRT, giveUp);
    std::signal(SIGSEGV, giveUp);
  }
  ~ReaderGuard()
  {
    std::signal(SIGABRT, SIG_DFL);
    std::signal(SIGSEGV, SIG_DFL);
  }

private:
  static void giveUp(int)
  {
    constexpr char kText[] = "quadrille: the input file is damaged: its reader failed\n";
    // Only what is safe in a signal handler.
    [[maybe_unused]] const ssize_t written = ::write(2, kText, sizeof(kText) - 1);
    ::_exit(kBadInput);
  }
};

vtkSmartPointer<vtkPolyData> readGuarded(const std::string& path)
{
  const ReaderGuard guard;
  return readMeshFile(path);
}

struct Request
{
  std::string input;
  std::string output; ///< empty for a method without quads
  std::string map;    ///< empty: not asked for
  std::string report;
};

Request parseFiles(const CommandLine& line)
{
  const bool seamless = methodOf(line) == vtkQuadRemesh::METHOD_SEAMLESS;
  const std::size_t files = line.positional().size();
  if (seamless && (files != 1 || !line.text("map")))
  {
    throw UsageError("the method seamless makes no quads: give the input file and --map MAP.vtp, "
                     "and no output file");
  }
  if (!seamless && files != 2)
  {
    throw UsageError("an input and an output file are needed; --help tells more");
  }
  const Request request{ line.positional()[0], seamless ? "" : line.positional()[1],
    line.text("map").value_or(""), line.text("report").value_or("") };
  if (!seamless && !canWrite(request.output))
  {
    throw UsageError(request.output + ": unknown extension; known are vtp, obj, ply, vtu and ex2");
  }
  if (!request.map.empty() && extensionOf(request.map) != "vtp")
  {
    throw UsageError(request.map + ": a map needs the extension vtp");
  }
  // Better now than after the computation.
  for (const std::string& file : { request.output, request.map, request.report })
  {
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    if (!file.empty() && ::access(folder.empty() ? "." : folder.c_str(), W_OK) != 0)
    {
      throw UsageError(file + ": the folder is missing or cannot be written to");
    }
    if (!file.empty() && std::filesystem::is_directory(file))
    {
      throw UsageError(file + ": is a folder");
    }
  }
  return request;
}

void setSize(const CommandLine& line, vtkQuadRemesh* filter)
{
  constexpr double kSmallest = 1e-300;
  const auto quads = line.count("quads", 1, 1000000000);
  const auto length = line.number("edge-length", kSmallest, 1e300);
  const auto relative = line.number("relative-edge-length", kSmallest, 10);
  if (quads.has_value() + length.has_value() + relative.has_value() > 1)
  {
    throw UsageError("only one of --quads, --edge-length and --relative-edge-length can be given");
  }
  if (quads)
  {
    filter->SetTargetTypeToNumberOfQuads();
    filter->SetNumberOfQuads(*quads);
  }
  else if (length)
  {
    filter->SetTargetTypeToEdgeLength();
    filter->SetEdgeLength(*length);
  }
  else if (relative)
  {
    filter->SetTargetTypeToRelativeEdgeLength();
    filter->SetRelativeEdgeLength(*relative);
  }
}

int finalQuality(const CommandLine& line)
{
  const std::string level = line.text("final-quality").value_or("coarse");
  const std::array<const char*, 3> levels{ "coarse", "intermediate", "input" };
  const auto found = std::find(levels.begin(), levels.end(), level);
  if (found == levels.end())
  {
    throw UsageError("--final-quality must be coarse, intermediate or input, not " + level);
  }
  return static_cast<int>(found - levels.begin());
}

int cellDataFrom(const CommandLine& line)
{
  const std::string word = line.text("cell-data").value_or("centre");
  if (word != "centre" && word != "area")
  {
    throw UsageError("--cell-data must be centre or area, not " + word);
  }
  return word == "area" ? vtkQuadRemesh::CELL_DATA_FROM_AREA : vtkQuadRemesh::CELL_DATA_FROM_CENTRE;
}

int smallComponents(const CommandLine& line)
{
  const std::string word = line.text("small-components").value_or("keep");
  if (word != "keep" && word != "remove")
  {
    throw UsageError("--small-components must be keep or remove, not " + word);
  }
  return word == "remove" ? vtkQuadRemesh::REMOVE_SMALL_COMPONENTS
                          : vtkQuadRemesh::KEEP_SMALL_COMPONENTS;
}

bool distortionMetric(const CommandLine& line)
{
  const std::string word = line.text("distortion-metric").value_or("off");
  if (word != "on" && word != "off")
  {
    throw UsageError("--distortion-metric must be on or off, not " + word);
  }
  return word == "on";
}

void setOptions(const CommandLine& line, vtkQuadRemesh* filter)
{
  setSize(line, filter);
  filter->SetMethod(methodOf(line));
  filter->SetIntegers(integersOf(line));
  if (const auto angle = line.number("feature-angle", 0, 180))
  {
    filter->SetDetectFeatures(*angle > 0);
    filter->SetFeatureAngle(*angle);
  }
  if (line.text("coarse-vertices") == "auto")
  {
    filter->SetCoarseVerticesToAutomatic();
  }
  else if (const auto vertices = line.count("coarse-vertices", 4, 100000000))
  {
    filter->SetCoarseVertices(static_cast<int>(*vertices));
  }
  filter->SetNumberOfThreads(static_cast<int>(line.count("threads", 0, 4096).value_or(0)));
  filter->SetMemoryLimit(line.number("memory-limit", 0, 1e12).value_or(0));
  filter->SetMaximumNumberOfQuads(line.count("maximum-quads", 1, 500000000).value_or(10000000));
  filter->SetAnisotropyLimit(line.number("anisotropy-limit", 0, 1e6).value_or(0));
  filter->SetCloseHandles(line.number("close-handles", 0, 1e6).value_or(0));
  filter->SetSmallComponents(smallComponents(line));
  filter->SetSmoothingSteps(static_cast<int>(line.count("smoothing-steps", 0, 1000).value_or(5)));
  filter->SetFinalQuality(finalQuality(line));
  filter->SetDistortionMetric(distortionMetric(line));
  filter->SetCellDataFrom(cellDataFrom(line));
  filter->SetComputeMappedSurface(line.text("map").has_value());
}

//------------------------------------------------------------------------------
// The report

double fieldNumber(vtkPolyData* data, const char* name)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  return array && array->GetNumberOfTuples() > 0 ? array->GetTuple1(0) : 0;
}

/// Members from a field array of names and one of values beside it.
void addPairs(Json& json, vtkPolyData* data, const char* namesName, const char* valuesName)
{
  auto* names = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray(namesName));
  vtkDataArray* values = data->GetFieldData()->GetArray(valuesName);
  for (vtkIdType i = 0; names && values && i < names->GetNumberOfValues(); ++i)
  {
    json.add(names->GetValue(i), values->GetTuple1(i));
  }
}

QuadQuality measure(vtkPolyData* data)
{
  std::vector<Vector3> points(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    data->GetPoint(static_cast<vtkIdType>(i), points[i].data());
  }
  std::vector<std::array<Index, 4>> quads;
  auto cells = vtk::TakeSmartPointer(data->GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell())
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    quads.push_back({ static_cast<Index>(ids[0]), static_cast<Index>(ids[1]),
      static_cast<Index>(ids[2]), static_cast<Index>(ids[3]) });
  }
  return evaluateQuads(points, quads);
}

void addQuality(Json& json, vtkPolyData* quads)
{
  const QuadQuality quality = measure(quads);
  json.begin("quality");
  json.add("manifold", quality.manifold);
  json.add("closed", quality.closed);
  json.add("components", static_cast<long long>(quality.components));
  json.add("boundary_loops", static_cast<long long>(quality.boundaryLoops));
  json.add("euler_characteristic", quality.eulerCharacteristic);
  json.add("mean_scaled_jacobian", quality.scaledJacobian.mean);
  json.add("minimum_scaled_jacobian", quality.scaledJacobian.minimum);
  json.add("quads_not_positive", static_cast<long long>(quality.nonPositiveJacobians));
  json.add("mean_edge_length", quality.edgeLength.mean);
  json.add("edge_length_deviation", quality.edgeLength.deviation);
  json.add("irregular_vertices", static_cast<long long>(quality.irregularVertices));
  json.begin("interior_valences");
  for (const auto& [valence, count] : quality.interiorValences)
  {
    json.add(std::to_string(valence), static_cast<long long>(count));
  }
  json.end();
  json.end();
}

void addLines(Json& json, const char* name, const std::string& text)
{
  json.beginList(name);
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
  {
    json.addItem(line);
  }
  json.endList();
}

void addStages(Json& json, RemeshRun& run, double readSeconds)
{
  json.beginList("stages");
  const auto add = [&json](const StageRow& row)
  {
    json.beginItem();
    json.add("stage", row.stage);
    json.add("seconds", row.seconds);
    json.add("elements_in", row.elementsIn);
    json.add("elements_out", row.elementsOut);
    json.end();
  };
  const long long cells = vtkPolyData::SafeDownCast(run.filter()->GetInput())->GetNumberOfCells();
  add({ "read", readSeconds, cells, cells });
  for (const StageRow& row : run.stages())
  {
    add(row);
  }
  json.endList();
}

void addSuccess(Json& json, vtkPolyData* quads)
{
  json.add("estimated_seconds", fieldNumber(quads, "EstimatedSeconds"));
  json.add("estimated_megabytes", fieldNumber(quads, "EstimatedMegabytes"));
  json.add("target_edge_length", fieldNumber(quads, "TargetEdgeLength"));
  json.add("quads_asked", fieldNumber(quads, "TargetQuads"));
  json.add("quads_actual", static_cast<long long>(quads->GetNumberOfPolys()));
  json.begin("repair");
  addPairs(json, quads, "RepairNames", "RepairCounts");
  json.end();
  json.begin("extraction");
  addPairs(json, quads, "ExtractionNames", "ExtractionCounts");
  json.end();
  json.begin("sizes");
  json.add("surface_faces", fieldNumber(quads, "SurfaceFaces"));
  json.add("coarse_vertices", fieldNumber(quads, "CoarseVertices"));
  json.add("quad_points", static_cast<long long>(quads->GetNumberOfPoints()));
  json.end();
  json.begin("certificate");
  json.add("valid", fieldNumber(quads, "CertificateValid") != 0);
  addPairs(json, quads, "CertificateNames", "CertificateValues");
  json.end();
  if (quads->GetFieldData()->GetArray("AnisotropyLimit"))
  {
    json.add("anisotropy_limit", fieldNumber(quads, "AnisotropyLimit"));
    json.add("share_beyond_anisotropy_limit", fieldNumber(quads, "BeyondAnisotropyLimit"));
  }
  if (quads->GetFieldData()->GetArray("DistortionBefore"))
  {
    json.begin("distortion_before");
    addPairs(json, quads, "DistortionNames", "DistortionBefore");
    json.end();
    json.begin("distortion_after");
    addPairs(json, quads, "DistortionNames", "DistortionAfter");
    json.end();
    json.add("optimization_steps", fieldNumber(quads, "OptimizationSteps"));
  }
  addQuality(json, quads);
}

struct Timing
{
  double read = 0;
  double total = 0;
};

std::string makeReport(const Request& request, RemeshRun& run, ExitCode code, const Timing& timing)
{
  vtkPolyData* input = vtkPolyData::SafeDownCast(run.filter()->GetInput());
  Json json;
  json.add("input", request.input);
  json.add("output", request.output);
  json.add("exit_code", static_cast<long long>(code));
  json.add("error", code == kValidQuads ? "" : run.error());
  json.add("input_points", static_cast<long long>(input->GetNumberOfPoints()));
  json.add("input_cells", static_cast<long long>(input->GetNumberOfCells()));
  json.add("seconds_total", timing.total);
  json.add("handles", static_cast<long long>(run.filter()->GetHandles()));
  json.add("unresolved_handles", static_cast<long long>(run.filter()->GetUnresolvedHandles()));
  json.add("shortest_loop_over_edge_length", run.filter()->GetShortestLoopOverEdgeLength());
  json.add("shortest_boundary_over_edge_length", run.filter()->GetShortestBoundaryOverEdgeLength());
  if (code == kValidQuads)
  {
    addSuccess(json, run.filter()->GetOutput());
  }
  addStages(json, run, timing.read);
  addLines(json, "stage_times", run.filter()->GetStageTimesText());
  json.add("certificate_text", run.filter()->GetCertificateText());
  addLines(json, "notices", run.filter()->GetNoticesText());
  return json.text();
}

/// The report of a run that ended before there was a mesh.
std::string makeFailureReport(const Request& request, ExitCode code, const std::string& error)
{
  Json json;
  json.add("input", request.input);
  json.add("output", request.output);
  json.add("exit_code", static_cast<long long>(code));
  json.add("error", error);
  return json.text();
}

//------------------------------------------------------------------------------
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<std::string> linesOf(const std::string& text)
{
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
  {
    lines.push_back(line);
  }
  return lines;
}

/// Thousands are set apart: 1,234,567.
std::string grouped(long long number)
{
  std::string digits = std::to_string(number);
  for (std::ptrdiff_t i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3)
  {
    digits.insert(static_cast<std::size_t>(i), ",");
  }
  return digits;
}

std::string textOf(double number, const char* format)
{
  char text[64];
  std::snprintf(text, sizeof(text), format, number);
  return text;
}

/// A value of the certificate; 0 where it is not told.
double certificateNumber(vtkPolyData* data, const std::string& name)
{
  auto* names = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray("CertificateNames"));
  vtkDataArray* values = data->GetFieldData()->GetArray("CertificateValues");
  for (vtkIdType i = 0; names && values && i < names->GetNumberOfValues(); ++i)
  {
    if (names->GetValue(i) == name)
    {
      return values->GetTuple1(i);
    }
  }
  return 0;
}

/// What the map's certificate means for the result.
std::string mapSentence(vtkPolyData* data)
{
  const auto folds = static_cast<long long>(certificateNumber(data, "not_positive"));
  if (folds > 0)
  {
    return "the map has folds (" + grouped(folds) + " triangles), which the quads bridge";
  }
  return certificateNumber(data, "wrong_turns") > 0 ? "the map has vertices with another valence than the field"
                                                    : "the map has no folds";
}

/// "part.vtp: 3,091 quads (asked for 3,000), 3,110 points, edge length 0.0123, 1.20 s".
std::string quadsSentence(RemeshRun& run, const Request& request, double seconds)
{
  vtkPolyData* quads = run.filter()->GetOutput();
  return request.output + ": " + grouped(quads->GetNumberOfPolys()) + " quads (asked for " +
    grouped(static_cast<long long>(run.filter()->GetTargetQuads())) + "), " +
    grouped(quads->GetNumberOfPoints()) + " points, edge length " +
    textOf(fieldNumber(quads, "TargetEdgeLength"), "%.4g") + ", " + textOf(seconds, "%.2f s");
}

void printSummary(RemeshRun& run, const Request& request, double seconds)
{
  printSentences(linesOf(run.filter()->GetNoticesText()));
  vtkPolyData* mapped = run.filter()->GetMappedSurface();
  std::vector<std::string> results;
  if (!request.output.empty())
  {
    results.push_back(quadsSentence(run, request, seconds));
  }
  if (!request.map.empty())
  {
    results.push_back(request.map + ": " + grouped(mapped->GetNumberOfPolys()) + " triangles with their map" +
      (request.output.empty() ? ", " + textOf(seconds, "%.2f s") : ""));
  }
  results.back() += "; " + mapSentence(request.output.empty() ? mapped : run.filter()->GetOutput());
  for (const std::string& result : results)
  {
    std::fprintf(stderr, "%s\n", result.c_str());
  }
}

/// Notices of a failed run often name its cause.
void printFailure(RemeshRun& run, const Request& request)
{
  printSentences(linesOf(run.filter()->GetNoticesText()));
  const std::string text = "quadrille: " + request.input + ": " + run.error();
  const std::size_t width = terminalWidth();
  std::fprintf(stderr, "%s\n", width > 0 ? wrapText(text, width - 1, 2).c_str() : text.c_str());
}

ExitCode execute(const CommandLine& line, const Request& request)
{
  const Clock::time_point start = Clock::now();
  RemeshRun run;
  setOptions(line, run.filter());
  const vtkSmartPointer<vtkPolyData> input = readGuarded(request.input);
  Timing timing;
  timing.read = secondsSince(start);

  const bool quiet = line.flag("quiet");
  ProgressDisplay progress(quiet);
  run.onProgress(
    [&progress](double fraction, const std::string& text)
    {
      progress.show(fraction, text);
      return stopRequested == 0;
    });
  const ExitCode code = run.execute(input);
  progress.finish();
  timing.total = secondsSince(start);
  if (code == kValidQuads)
  {
    if (!request.output.empty())
    {
      writeMeshFile(run.filter()->GetOutput(), request.output);
    }
    if (!request.map.empty())
    {
      writeMeshFile(run.filter()->GetMappedSurface(), request.map);
    }
    if (!quiet)
    {
      printSummary(run, request, timing.total);
    }
  }
  else
  {
    printFailure(run, request);
  }
  if (!request.report.empty())
  {
    writeTextFile(makeReport(request, run, code, timing), request.report);
  }
  return code;
}

ExitCode runAndReport(const CommandLine& line, const Request& request)
{
  const auto fail = [&request](ExitCode code, const std::string& reason)
  {
    std::fprintf(stderr, "quadrille: %s\n", reason.c_str());
    if (!request.report.empty())
    {
      writeTextFile(makeFailureReport(request, code, reason), request.report);
    }
    return code;
  };
  try
  {
    return execute(line, request);
  }
  catch (const FileError& error)
  {
    return fail(kBadInput, error.what());
  }
  catch (const std::bad_alloc&)
  {
    return fail(kNoValidResult, "out of memory");
  }
}

} // namespace

int main(int argc, char* argv[])
{
  std::signal(SIGINT, requestStop);
  std::signal(SIGTERM, requestStop);
  try
  {
    const CommandLine line(argc, argv,
      { "quads", "edge-length", "relative-edge-length", "feature-angle", "coarse-vertices",
        "threads", "memory-limit", "close-handles", "small-components", "anisotropy-limit", "method", "integers", "map",
        "final-quality", "distortion-metric", "smoothing-steps", "cell-data", "maximum-quads", "report" },
      { "quiet" });
    if (line.help() || argc == 1)
    {
      std::fputs(kHelp, line.help() ? stdout : stderr);
      return line.help() ? kValidQuads : kBadInput;
    }
    return runAndReport(line, parseFiles(line));
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "quadrille: %s\n", error.what());
    return kBadInput;
  }
}

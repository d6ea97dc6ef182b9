// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The command for people without ParaView's window: a mesh file in, a quad mesh out.
#include "Base/Memory.h"
#include "CadRun.h"
#include "ElementRun.h"
#include "MeshFiles.h"
#include "Options.h"
#include "RemeshRun.h"
#include "Report.h"
#include "Terminal.h"
#include "WrapRun.h"

#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkObject.h>
#include <vtkPolyData.h>
#include <vtkQuadMeshWriter.h>
#include <vtkStringArray.h>

#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <new>
#include <optional>
#include <sstream>
#include <vector>

namespace
{

using namespace quadrille;

constexpr const char* kIntroduction =
  R"(usage: quadrille IN.{ply,obj,stl,off,vtp,vtk} OUT.{vtp,vtu,ex2,e,inp,msh,mesh,obj,ply,stl} [options]
       quadrille IN.{step,stp,iges,igs,brep} OUT.{vtp,vtu,ex2,e,inp,msh,mesh,obj,ply,stl} [options]
       quadrille IN.{ply,obj,stl,off,vtp,vtk} --method seamless --map MAP.vtp [options]

Remeshes a triangle surface, or the faces of a CAD file, with quads only.

)";

constexpr const char* kClosing =
  R"(exit code: 0 valid quads (seamless: a valid map); 2 bad input or arguments;
           3 no valid result, or elements that fail --require;
           4 stopped, by a signal or the time limit: the valid quads of the best attempt so far;
           5 valid quads of some connected components, as others have no map (--failed-components))";

volatile std::sig_atomic_t stopRequested = 0;

void requestStop(int)
{
  stopRequested = 1;
}

/// VTK's readers end the process where a damaged file makes them ask for too much memory. Catching that is the only way
/// to keep the promise of an exit code.
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

vtkSmartPointer<vtkPolyData> readGuarded(const std::string& path, int threads)
{
  const ReaderGuard guard;
  return readMeshFile(path, threads);
}

/// What the command line asks for beside the settings of the filter.
struct Request
{
  RunFiles files;
  vtkNew<vtkQuadMeshWriter> writer;
  WrapRequest wrap;
  CadRun cad;
  std::string sizes; ///< by name, a line each
  ElementRun elements;
  bool quiet = false;
};

void addSizes(CommandOptions& options, vtkQuadRemesh* filter, std::string& byName)
{
  constexpr double kSmallestLength = 1e-300;
  options.beginGroup("size of the quads (at most one):");
  options.addCount(
    "quads", "N", { 1, 1000000000 },
    [filter](long long quads)
    {
      filter->SetTargetTypeToNumberOfQuads();
      filter->SetNumberOfQuads(quads);
    },
    "target number of quads (default: as many as the shape needs, 5000 or up to 20000, which a "
    "notice tells)");
  options.addNumber(
    "edge-length", "S", { kSmallestLength, 1e300 },
    [filter](double length)
    {
      filter->SetTargetTypeToEdgeLength();
      filter->SetEdgeLength(length);
    },
    "target edge length in units of the input");
  options.addNumber(
    "relative-edge-length", "R", { kSmallestLength, 10 },
    [filter](double length)
    {
      filter->SetTargetTypeToRelativeEdgeLength();
      filter->SetRelativeEdgeLength(length);
    },
    "target edge length over the bounding-box diagonal");
  options.addNumber(
    "chord-error", "E", { kSmallestLength, 1e300 },
    [filter](double error) { filter->SetChordError(error); },
    "by how much edges of the quads may lie off the surface, in units of the input: they are "
    "shorter where it is curved; with --quads as many quads are distributed so");
  options.addNumber(
    "angle-a-quad", "DEG", { 0.01, 180 }, [filter](double angle) { filter->SetAngleAQuad(angle); },
    "by how much the surface may turn along an edge of the quads, in degrees; else as "
    "--chord-error");
  options.addNumber(
    "gap-quads", "N", { 0, 1000 }, [filter](double quads) { filter->SetGapQuads(quads); },
    "so many edges at least go into the thickness of the solid and into gaps outside (default 0: "
    "sizes do not depend on that)");
  options.addNumber(
    "smallest-size", "R", { 0.001, 1 }, [filter](double size) { filter->SetSmallestSize(size); },
    "the least that these lead to, over the target edge length (default 0.2)");
  options.addNumber(
    "largest-size", "R", { 1, 1000 }, [filter](double size) { filter->SetLargestSize(size); },
    "the most that these leave, over the target edge length (default 1)");
  options.addTexts(
    "size", "NAME=R", [&byName](const std::string& size) { byName += size + "\n"; },
    "edges are R times as long on the faces of this name (cell array PatchNames, or of a CAD "
    "file), "
    "on its CAD edges and vertices; * stands for any letters; may be given several times");
}

/// So many numbers with commas between them; none where it is something else.
template <std::size_t count>
std::optional<std::array<double, count>> numbersIn(const std::string& text)
{
  std::istringstream stream(text);
  std::array<double, count> numbers{};
  bool isRead = true;
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    char comma = ',';
    isRead = isRead && (i == 0 || stream >> comma) && comma == ',' && stream >> numbers[i];
  }
  const bool isAll = isRead && stream.peek() == std::istringstream::traits_type::eof();
  return isAll ? std::optional(numbers) : std::nullopt;
}

/// The order, or the order and six numbers.
void setRotation(vtkQuadRemesh* filter, const std::string& text)
{
  constexpr double kLeastOrder = 2, kMostOrder = 64;
  const auto order = numbersIn<1>(text);
  const auto all = numbersIn<7>(text);
  const double steps = order ? order->front() : all ? all->front() : 0;
  if (!(steps >= kLeastOrder && steps <= kMostOrder && steps == std::floor(steps)))
  {
    throw UsageError("--rotation " + text +
      ": give the order, 2 to 64, for an axis that is found, or with a point of the axis and its "
      "direction as seven numbers, n,x,y,z,dx,dy,dz");
  }
  if (filter->GetSymmetry() != vtkQuadRemesh::SYMMETRY_NONE)
  {
    throw UsageError("quads have one symmetry: give --symmetry or --rotation");
  }
  filter->SetRotationOrder(static_cast<int>(steps));
  if (order)
  {
    filter->SetSymmetryToAxisFound();
    return;
  }
  filter->SetSymmetryToAxis();
  filter->SetSymmetryOrigin(all->data() + 1);
  filter->SetSymmetryNormal(all->data() + 4);
}

/// "found", or six numbers.
void setSymmetry(vtkQuadRemesh* filter, const std::string& text)
{
  if (filter->GetSymmetry() != vtkQuadRemesh::SYMMETRY_NONE)
  {
    throw UsageError("quads have one symmetry: give --symmetry or --rotation");
  }
  if (text == "found")
  {
    filter->SetSymmetryToFound();
    return;
  }
  const auto numbers = numbersIn<6>(text);
  if (!numbers)
  {
    throw UsageError("--symmetry " + text +
      ": give found, or a point of the plane and its normal as six numbers, x,y,z,nx,ny,nz");
  }
  filter->SetSymmetryToPlane();
  filter->SetSymmetryOrigin(numbers->data());
  filter->SetSymmetryNormal(numbers->data() + 3);
}

/// "auto", or a length.
WrapRequest wrapRequestOf(const std::string& text)
{
  if (!canWrap())
  {
    throw UsageError("--wrap needs CGAL, which this build does not have: configure Quadrille with "
                     "QUADRILLE_USE_CGAL=ON");
  }
  WrapRequest request;
  request.isAsked = true;
  request.onlyAfterFailure = text == "auto";
  if (!request.onlyAfterFailure)
  {
    std::istringstream stream(text);
    const bool isRead = static_cast<bool>(stream >> request.alpha);
    if (!isRead || stream.peek() != std::istringstream::traits_type::eof() || !(request.alpha > 0))
    {
      throw UsageError("--wrap " + text +
        ": give auto, or the radius of the ball that wraps, a "
        "length above 0 in units of the input");
    }
  }
  return request;
}

void addShape(CommandOptions& options, vtkQuadRemesh* filter)
{
  options.beginGroup("what the quads are like:");
  options.addNumber(
    "feature-angle", "DEG", { 0, 180 },
    [filter](double angle)
    {
      filter->SetDetectFeatures(angle > 0);
      filter->SetFeatureAngle(angle);
    },
    "edges sharper than this become edges of the quads; 0 turns the detection off (default 40)");
  options.addChoice(
    "feature-criterion", "WORD", { "creases", "angle" },
    [filter](int criterion) { filter->SetFeatureCriterion(criterion); },
    "which edges above the angle are features: creases (default), those of curves that are creases "
    "as a whole, which noise of scans is not, or all by their angle");
  options.addCountOrWord(
    "coarse-vertices", "N", { 4, 100000000 }, "auto",
    [filter](std::optional<long long> vertices)
    {
      if (vertices)
      {
        filter->SetCoarseVertices(static_cast<int>(*vertices));
      }
      else
      {
        filter->SetCoarseVerticesToAutomatic();
      }
    },
    "vertices of the level where the layout is computed (default 1000); auto: as many as the "
    "curvature of the surface "
    "needs, from 300 to 4000");
  options.addText(
    "guide", "NAME",
    [filter](const std::string& name)
    {
      if (name == "curvature")
      {
        filter->CurvatureGuidesOn();
      }
      else
      {
        filter->SetGuideArrayName(name.c_str());
      }
    },
    "where no GuidingDirection is given, quads follow the principal curvature of the surface "
    "(curvature), or the array of three numbers on cells or points of this name");
  options.addNumber(
    "guide-anisotropy", "A", { 0, 0.99 },
    [filter](double least) { filter->SetLeastAnisotropy(least); },
    "with --guide curvature: where |k1 - k2| / (|k1| + |k2|) is above this, over about an edge "
    "length (default 0.3)");
  addMethod(
    options, [filter](int method) { filter->SetMethod(method); },
    "how the map is made: scale-aware (default); mixed-integer and quadcover, which may leave "
    "inverted triangles and "
    "then fail; seamless, which has no integers and so makes no quads");
  options.addChoice(
    "integers", "NAME", { "keep-sizes", "coarsest" },
    [filter](int integers) { filter->SetIntegers(integers); },
    "keep-sizes (default): quads of the size asked for; coarsest: as few as a layout of the "
    "surface can have; the size "
    "then sets only what the coarse level keeps");
  options.addNumber(
    "anisotropy-limit", "R", { 0, 1e6 },
    [filter](double limit) { filter->SetAnisotropyLimit(limit); },
    "largest ratio of the two stretches of the map, at least 1, as far as features and irregular "
    "vertices let it; quads "
    "then differ more in size (default 0: no limit)");
  options.addNumber(
    "smallest-detail", "R", { 0, 1e6 },
    [filter](double length) { filter->SetSmallestDetail(length); },
    "what is smaller than R edge lengths of the quads goes before the first map: handles and holes "
    "(with --small-details automatic), groups, ends and bands of sharp edges, above 1 connected "
    "components; 0: nothing (default 1)");
  options.addChoice(
    "small-details", "WORD", { "automatic", "resolve", "simplify", "keep" },
    [filter](int decision) { filter->SetSmallDetails(decision); },
    "what becomes of handles and holes shorter round than 3 edge lengths of the quads: resolve, "
    "quads are smaller there, simplify, they are closed and filled, keep, as they are, or a "
    "failure; automatic (default): below --smallest-detail simplify, else resolve where that takes "
    "few quads");
  options.addChoice(
    "small-components", "WORD", { "keep", "remove" },
    [filter](int remove)
    {
      filter->SetSmallComponents(
        remove ? vtkQuadRemesh::REMOVE_SMALL_COMPONENTS : vtkQuadRemesh::KEEP_SMALL_COMPONENTS);
    },
    "what becomes of connected components with less area than the smallest block of quads has: "
    "keep (default), as about "
    "that many quads, or remove");
  options.addChoice(
    "failed-components", "WORD", { "leave-out", "fail" },
    [filter](int word) { filter->SetFailedComponents(word); },
    "what becomes of connected components that have no map: leave-out (default), the others have "
    "quads, and the exit code is 5, or fail, nothing is written");
  options.addText(
    "symmetry", "PLANE", [filter](const std::string& text) { setSymmetry(filter, text); },
    "quads that are their own mirror image: found, about the plane about which the surface is "
    "nearest to its image, or "
    "x,y,z,nx,ny,nz, a point of the plane and its normal, which points to the half that is "
    "remeshed");
  options.addChoice(
    "plane-curve", "WORD", { "isoline", "mid-line" },
    [filter](int curve) { filter->SetPlaneCurve(curve); },
    "what quads with a mirror symmetry have in the plane: isoline (default), edges, or mid-line, "
    "quads across it, each its own image");
  options.addText(
    "rotation", "ORDER", [filter](const std::string& text) { setRotation(filter, text); },
    "quads that become themselves when they are turned by one of so many steps of a whole turn, 2 "
    "to 64, round the axis about which the surface is nearest to itself, or n,x,y,z,dx,dy,dz, with "
    "a point of the axis and its direction");
}

void addFinish(CommandOptions& options, vtkQuadRemesh* filter)
{
  options.addChoice(
    "final-quality", "LEVEL", { "coarse", "intermediate", "input" },
    [filter](int level) { filter->SetFinalQuality(level); },
    "coarse, intermediate or input: where the map is solved at last, with the same quads; the "
    "finer, the less distorted, "
    "and the longer it takes (default coarse)");
  options.addChoice(
    "distortion-metric", "WORD", { "on", "off" },
    [filter](int off) { filter->SetDistortionMetric(off == 0); },
    "on: coarse triangles count with the shape of the surface that they stand for, so that sizes "
    "come out more even "
    "(default off)");
  options.addCount(
    "smoothing-steps", "N", { 0, 1000 },
    [filter](long long steps) { filter->SetSmoothingSteps(static_cast<int>(steps)); },
    "sweeps in which the points move over the surface, where that does not lower the worst scaled "
    "Jacobian round them, and those of features and boundaries to the bends of their curve, "
    "before quads that are turned over at a corner are mended; 0: they stay where the map has them "
    "(default 5)");
  options.addChoice(
    "cell-data", "NAME", { "centre", "area" },
    [filter](int area)
    {
      filter->SetCellDataFrom(
        area ? vtkQuadRemesh::CELL_DATA_FROM_AREA : vtkQuadRemesh::CELL_DATA_FROM_CENTRE);
    },
    "what cell arrays of the quads come from: centre (default), the cell under the centre of a "
    "quad; area, all cells "
    "under it: the average of real numbers, the most frequent label");
}

/// What only some formats have.
void addFormats(CommandOptions& options, vtkQuadMeshWriter* writer)
{
  options.beginGroup("the output file:");
  options.addText(
    "patch-array", "NAME",
    [writer](const std::string& name) { writer->SetPatchArrayName(name.c_str()); },
    "sets of elements by the cell array of this name, whole numbers or strings, that the input "
    "has, "
    "or LayoutPatch (default: PatchId, else PatchNames, else LayoutPatch where it has at most 200 "
    "patches)");
  options.addText(
    "element", "TYPE", [writer](const std::string& type) { writer->SetElementType(type.c_str()); },
    "inp: the type of the elements: S4 (default), S4R, CPS4, CPS4R, CPE4, CPE4R; of second order "
    "S8R (default), S8, CPS8, CPS8R, CPE8, CPE8R, S9R5");
  options.addChoice(
    "inp-dialect", "WORD", { "calculix", "abaqus" },
    [writer](int dialect) { writer->SetDialect(dialect); },
    "inp: calculix (default) or abaqus: how sides of shells are named, and axes of elements given");
  options.addText(
    "material", "NAME", [writer](const std::string& name) { writer->SetMaterial(name.c_str()); },
    "inp: the material that sections name, where elements have a thickness or an axis (default "
    "MATERIAL)");
  options.addChoice(
    "msh-version", "V", { "4.1", "2.2" }, [writer](int version) { writer->SetMshVersion(version); },
    "msh: the version of Gmsh's format (default 4.1)");
  options.addFlag(
    "file-details", [writer] { writer->FileDetailsOn(); },
    "vtu, ply: also what many programs stop at: in vtu arrays of texts, as the names of patches "
    "and "
    "the notices of the run; in ply the patches of faces");
}

void addRun(CommandOptions& options, vtkQuadRemesh* filter, Request& request)
{
  options.beginGroup("the run:");
  options.addText(
    "wrap", "WORD", [&request](const std::string& text) { request.wrap = wrapRequestOf(text); },
    "auto: where the input itself cannot be remeshed, a closed wrap of it is (alpha: a hundredth "
    "of the diagonal), and the points of the quads are put back onto the input where they belong "
    "to it; a length: so from the start, with this alpha. Gaps narrower than alpha are closed, "
    "sharp edges rounded");
  options.addCount(
    "threads", "N", { 0, 4096 },
    [filter](long long threads) { filter->SetNumberOfThreads(static_cast<int>(threads)); },
    "threads to compute with; 0 means all (default 0)");
  options.addChoice(
    "pieces", "WORD", { "automatic", "always", "never" },
    [filter](int pieces) { filter->SetPieces(pieces); },
    "whether the surface is cut into pieces of about a million triangles, each thinned out by "
    "itself before the quads are made, which takes less time and a third of the memory: automatic "
    "(default), from 4000000 triangles on, where a quad has at least 66 of them and nothing needs "
    "the whole surface, as guides, a symmetry or --map do, and from 1000000 on, or with other "
    "constraints, thinned out in one piece; always; never");
  options.addNumber(
    "memory-limit", "MB", { 0, 1e12 },
    [filter](double megabytes) { filter->SetMemoryLimit(megabytes); },
    "refuse to start where more memory is needed by the estimate; 0 means what the machine has "
    "free (default 0)");
  options.addCount(
    "maximum-quads", "N", { 1, 500000000 },
    [filter](long long quads) { filter->SetMaximumNumberOfQuads(quads); },
    "refuse to make more than this (default 10000000)");
  options.addText(
    "map", "MAP.vtp", [&request](const std::string& path) { request.files.map = path; },
    "write the surface with its map, too (cell array IGM: u0 v0 u1 v1 u2 v2, one unit a quad, and "
    "texture coordinates); "
    "the seamless method writes this only, so leave OUT away there");
  options.addText(
    "report", "REPORT.json", [&request](const std::string& path) { request.files.report = path; },
    "what was repaired, sizes, seconds per stage, certificate, asked and actual count, quality");
  options.addFlag(
    "quiet", [&request] { request.quiet = true; },
    "no progress, no notices, no summary; what goes wrong is still told");
}

/// Better now than after the computation.
void requireWritable(const RunFiles& files)
{
  for (const std::string& file : { files.output, files.map, files.report })
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
}

/// What no option can check for itself.
void checkTogether(const CommandOptions& options, vtkQuadRemesh* filter, RunFiles& files)
{
  if (options.given("quads") + options.given("edge-length") +
      options.given("relative-edge-length") >
    1)
  {
    throw UsageError("only one of --quads, --edge-length and --relative-edge-length can be given");
  }
  const bool seamless = filter->GetMethod() == vtkQuadRemesh::METHOD_SEAMLESS;
  const std::size_t count = options.files().size();
  if (seamless && (count != 1 || !options.given("map")))
  {
    throw UsageError("the method seamless makes no quads: give the input file and --map MAP.vtp, "
                     "and no output file");
  }
  if (!seamless && count != 2)
  {
    throw UsageError("an input and an output file are needed; --help tells more");
  }
  files.input = options.files()[0];
  files.output = seamless ? "" : options.files()[1];
  if (options.given("wrap") && options.given("map"))
  {
    throw UsageError("--map writes the surface with its map, which with --wrap would be the wrap: "
                     "give one of them only");
  }
  if (!seamless && !canWrite(files.output))
  {
    throw UsageError(files.output + ": unknown extension; known are " + writtenExtensions());
  }
  if (options.given("map") && extensionOf(files.map) != "vtp")
  {
    throw UsageError(files.map + ": a map needs the extension vtp");
  }
  requireWritable(files);
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
  auto* names =
    vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray("CertificateNames"));
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
  return certificateNumber(data, "wrong_turns") > 0
    ? "the map has vertices with another valence than the field"
    : "the map has no folds";
}

/// "part.vtp: 3,091 quads (asked for 3,000), 3,110 points, edge length 0.0123, 1.20 s".
std::string quadsSentence(RemeshRun& run, const RunFiles& files, double seconds)
{
  vtkPolyData* quads = run.filter()->GetOutput();
  return files.output + ": " + grouped(quads->GetNumberOfPolys()) + " quads (asked for " +
    grouped(static_cast<long long>(run.filter()->GetTargetQuads())) + "), " +
    grouped(quads->GetNumberOfPoints()) + " points, edge length " +
    textOf(fieldNumber(quads, "TargetEdgeLength"), "%.4g") + ", " + textOf(seconds, "%.2f s");
}

void printSummary(RemeshRun& run, const RunFiles& files, double seconds)
{
  printSentences(linesOf(run.notices()));
  vtkPolyData* mapped = run.filter()->GetMappedSurface();
  std::vector<std::string> results;
  if (!files.output.empty())
  {
    results.push_back(quadsSentence(run, files, seconds));
  }
  if (!files.map.empty())
  {
    results.push_back(files.map + ": " + grouped(mapped->GetNumberOfPolys()) +
      " triangles with their map" + (files.output.empty() ? ", " + textOf(seconds, "%.2f s") : ""));
  }
  results.back() += "; " + mapSentence(files.output.empty() ? mapped : run.filter()->GetOutput());
  for (const std::string& result : results)
  {
    std::fprintf(stderr, "%s\n", result.c_str());
  }
}

/// Notices of a failed run often name its cause.
void printFailure(RemeshRun& run, const RunFiles& files)
{
  printSentences(linesOf(run.notices()));
  const std::string text = "quadrille: " + files.input + ": " + run.error();
  const std::size_t width = terminalWidth();
  std::fprintf(stderr, "%s\n", width > 0 ? wrapText(text, width - 1, 2).c_str() : text.c_str());
}

ExitCode execute(RemeshRun& run, Request& request)
{
  const Clock::time_point start = Clock::now();
  const RunFiles& files = request.files;
  const bool isCad = CadRun::isCad(files.input);
  const vtkSmartPointer<vtkPolyData> read = isCad
    ? request.cad.read(run, files.input)
    : readGuarded(files.input, run.filter()->GetNumberOfThreads());
  const vtkSmartPointer<vtkPolyData> input =
    request.sizes.empty() ? read : withNamedSizes(read, files.input, request.sizes);
  RunTimes times;
  times.read = secondsSince(start);

  ProgressDisplay progress(request.quiet);
  run.onProgress(
    [&progress](double fraction, const std::string& text)
    {
      progress.show(fraction, text);
      return stopRequested == 0;
    });
  ExitCode code =
    request.wrap.isAsked ? executeWrapped(run, input, request.wrap) : run.execute(input);
  vtkSmartPointer<vtkDataSet> result = run.filter()->GetOutput();
  if (hasQuads(code) && request.elements.isAsked())
  {
    result = request.elements.execute(run, input);
    code = result ? code : kNoValidResult;
  }
  if (isCad && hasQuads(code))
  {
    result = request.cad.project(run, result);
    code = result ? code : kNoValidResult;
  }
  progress.finish();
  times.total = secondsSince(start);
  if (hasQuads(code))
  {
    if (!files.output.empty())
    {
      const std::string notices = writeMeshFile(result, files.output, request.writer);
      run.addNotice(notices.substr(0, notices.find_last_not_of('\n') + 1));
    }
    if (!files.map.empty())
    {
      writeMeshFile(run.filter()->GetMappedSurface(), files.map);
    }
    if (!request.quiet)
    {
      printSummary(run, files, times.total);
    }
    else if (code == kPartialQuads)
    {
      std::fprintf(stderr, "quadrille: %s: %s\n", files.input.c_str(), run.filter()->GetVerdict());
    }
  }
  else
  {
    printFailure(run, files);
  }
  if (!files.report.empty())
  {
    writeTextFile(makeReport(files, run, request.elements, code, times), files.report);
  }
  if (!request.elements.isGood())
  {
    // The summary has it already.
    const std::string reason = request.quiet
      ? request.elements.failure()
      : "elements fail --require, see above; the mesh was written";
    std::fprintf(stderr, "quadrille: %s: %s\n", files.output.c_str(), reason.c_str());
    return kNoValidResult;
  }
  return code;
}

ExitCode runAndReport(RemeshRun& run, Request& request)
{
  const auto fail = [&request](ExitCode code, const std::string& reason)
  {
    std::fprintf(stderr, "quadrille: %s\n", reason.c_str());
    if (!request.files.report.empty())
    {
      writeTextFile(makeFailureReport(request.files, code, reason), request.files.report);
    }
    return code;
  };
  try
  {
    return execute(run, request);
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

ExitCode runCommand(int argc, char* argv[])
{
  RemeshRun run;
  Request request;
  CommandOptions options(kIntroduction, kClosing);
  addSizes(options, run.filter(), request.sizes);
  addShape(options, run.filter());
  addFinish(options, run.filter());
  request.cad.addOptions(options);
  addFormats(options, request.writer);
  request.elements.addOptions(options);
  addRun(options, run.filter(), request);
  if (const std::optional<std::string> text = options.parse(argc, argv))
  {
    std::fputs(text->c_str(), stdout);
    return kValidQuads;
  }
  if (argc == 1)
  {
    std::fputs(options.help().c_str(), stderr);
    return kBadInput;
  }
  checkTogether(options, run.filter(), request.files);
  request.cad.check(options, request.files.input);
  request.elements.check(options, request.files.output);
  request.wrap.detectsFeatures = options.given("feature-angle");
  run.filter()->SetComputeMappedSurface(options.given("map"));
  request.elements.prepare(run, request.wrap.isAsked, options.given("cell-data"));
  return runAndReport(run, request);
}

} // namespace

int main(int argc, char* argv[])
{
  quadrille::keepFreedMemory();
  std::signal(SIGINT, requestStop);
  std::signal(SIGTERM, requestStop);
  try
  {
    return runCommand(argc, argv);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "quadrille: %s\n", error.what());
    return kBadInput;
  }
}

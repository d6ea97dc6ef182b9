// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/FinalQuality.h"

#include "Base/Error.h"
#include "Base/Parallel.h"
#include "Base/TryCount.h"
#include "Extraction/Extraction.h"
#include "Pipeline/Attempt.h"
#include "Quads/QuadShape.h"
#include "Requests/Guides.h"
#include "Transfer/PatchMender.h"
#include "Transfer/Transfer.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace quadrille
{
namespace
{

/// How often quads that the re-solve has inverted get the carried map back.
constexpr int kMaximumHolds = 3;

bool noWorse(const Certificate& a, const Certificate& b)
{
  return a.notPositive <= b.notPositive && a.wrongTurns <= b.wrongTurns &&
    a.seamResiduals <= b.seamResiduals && a.offAxes <= b.offAxes &&
    a.offIsolines <= b.offIsolines && a.offIntegers <= b.offIntegers &&
    a.fractionalTransitions <= b.fractionalTransitions;
}

/// One guide a face, or nothing where there is none at all.
std::vector<Guide> guidesOf(const PreparedSurface& surface, int threads)
{
  std::vector<Guide> guides;
  const SurfaceGuides found = surfaceGuides(surface, threads);
  if (!found.faces.empty())
  {
    guides.resize(surface.mesh.faceCount());
    for (const FaceGuide& guide : found.faces)
    {
      guides[guide.face] = guide.guide;
    }
  }
  return guides;
}

/// Values of the surface's vertices at those of a level.
template <typename T>
std::vector<T> onLevel(const Level& level, const std::vector<T>& values)
{
  std::vector<T> result;
  result.reserve(level.fineVertex.size());
  for (const Index v : level.fineVertex)
  {
    result.push_back(values[v]);
  }
  return result;
}

std::string keptText(const std::string& why)
{
  return "final quality: the map of the coarse level was kept, as " + why;
}

std::string comparison(const char* what, double before, double after)
{
  char text[128];
  std::snprintf(text, sizeof(text), "%s would have gone from %.4g to %.4g", what, before, after);
  return keptText(text);
}

/// The quads of a map that are inverted at a corner.
struct InvertedQuads
{
  bool valid = false; ///< whether the map has quads at all
  std::vector<Vector3> centres;
};

InvertedQuads invertedQuadsOf(const PreparedSurface& surface, const std::vector<FixedVec2>& uv,
  const FinalQualityOptions& options)
{
  ExtractionOptions extraction;
  extraction.maximumNumberOfQuads = options.maximumNumberOfQuads;
  extraction.smoothingSteps = options.smoothingSteps;
  extraction.fixedVertices = heldIndexVertices(surface);
  extraction.threads = options.threads;
  const ExtractionResult quads = extractQuads(surface.mesh, uv, extraction);
  InvertedQuads result;
  result.valid = quads.status.ok();
  for (const Index q : invertedQuads(quads.mesh.points, quads.mesh.quads))
  {
    const std::array<Vector3, 4> p = cornersOf(quads.mesh.points, quads.mesh.quads[q]);
    result.centres.push_back((p[0] + p[1] + p[2] + p[3]) / 4);
  }
  return result;
}

/// The vertices near these places keep what the carried map gives them. fixed: #V flags.
void fixNear(const Mesh& mesh, const std::vector<Vector3>& places, double radius,
  std::vector<std::uint8_t>& fixed)
{
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    pollNowAndThen(v, kHeavyChunk);
    fixed[v] = fixed[v] != 0 || isNear(mesh.position[v], places, radius) ? 1 : 0;
  }
}

RelaxOptions relaxOptions(const FinalQualityOptions& options)
{
  RelaxOptions relax;
  relax.maximumBytes = options.maximumBytes;
  relax.threads = options.threads;
  relax.progress = options.progress;
  return relax;
}

/// uv: the carried map, before.
RelaxResult solveOnInput(const PreparedSurface& surface, const std::vector<std::uint8_t>& fixed,
  const FinalQualityOptions& options, std::vector<FixedVec2>& uv)
{
  RelaxOptions relax = relaxOptions(options);
  relax.guides = guidesOf(surface, options.threads);
  return relaxMap(surface.mesh, fixed, relax, uv);
}

RelaxResult solveOnIntermediate(const Mesh& mesh, const std::vector<int>& turns,
  const std::vector<std::uint8_t>& fixed, const CoarseMap& coarse,
  const FinalQualityOptions& options, std::vector<FixedVec2>& uv)
{
  const Level& level = coarse.hierarchy->intermediate;
  const DecimationLog& log = coarse.hierarchy->log;
  TransferOptions transfer;
  transfer.threads = options.threads;
  std::vector<FixedVec2> levelUv = transferToLevel(
    coarse.hierarchy->coarse, level, log.intermediateRounds, log, *coarse.uv, transfer);
  mendPatches(level.mesh, levelUv, onLevel(level, turns), options.threads, {});
  RelaxOptions relax = relaxOptions(options);
  relax.guides = level.guides;
  RelaxResult result = relaxMap(level.mesh, onLevel(level, fixed), relax, levelUv);
  if (result.status.ok())
  {
    uv = transferFromLevel(mesh, level, log.intermediateRounds, log, levelUv, turns, transfer).uv;
    // The replay has put vertices into kernels once more, where their triangles are thin.
    RelaxOptions local = relaxOptions(options);
    local.maximumSteps = 0;
    relaxMap(mesh, fixed, local, uv);
  }
  return result;
}

/// Why the map that was solved again does not count; empty where it may.
std::string whyWorse(const Certificate& certificate, const MapDistortion& after,
  const Certificate& carried, const MapDistortion& before)
{
  if (!noWorse(certificate, carried))
  {
    return keptText("the certificate would have become worse: " + certificate.text());
  }
  return after.mean < before.mean ? "" : comparison("the distortion", before.mean, after.mean);
}

} // namespace

FinalQualityReport improveMap(const PreparedSurface& surface, const std::vector<int>& turns,
  const std::vector<std::uint8_t>& integerVertex, const CoarseMap& coarse,
  const FinalQualityOptions& options, SurfaceMap& map)
{
  FinalQualityReport report;
  report.level = options.level;
  if (options.level == FinalQuality::Coarse)
  {
    return report;
  }
  report.before = report.after = measureDistortion(surface.mesh, map.uv);
  report.elements = options.level == FinalQuality::Input
    ? surface.mesh.faceCount()
    : coarse.hierarchy->intermediate.mesh.faceCount();
  const bool isOnInput = options.level == FinalQuality::Input;
  // A seamless map without integers has no quads.
  const bool hasQuads = map.certificate.fractionalTransitions == 0;
  const auto inverted = [&](const std::vector<FixedVec2>& uv)
  { return hasQuads ? invertedQuadsOf(surface, uv, options) : InvertedQuads{}; };
  const InvertedQuads before = inverted(map.uv);
  std::vector<std::uint8_t> fixed = integerVertex;
  double radius = options.edgeLength; // twice as far each time
  for (int hold = 0;; ++hold)
  {
    std::vector<FixedVec2> uv = isOnInput ? map.uv : std::vector<FixedVec2>{};
    const RelaxResult relaxed = isOnInput
      ? solveOnInput(surface, fixed, options, uv)
      : solveOnIntermediate(surface.mesh, turns, fixed, coarse, options, uv);
    report.steps += relaxed.steps;
    if (!relaxed.status.ok())
    {
      report.notice = keptText(relaxed.status.message);
      return report;
    }
    const Certificate certificate =
      certify(surface.mesh, uv, turns, integerVertex, options.threads);
    const MapDistortion after = measureDistortion(surface.mesh, uv);
    report.notice = whyWorse(certificate, after, map.certificate, report.before);
    if (!report.notice.empty())
    {
      return report;
    }
    const InvertedQuads made = inverted(uv);
    if (made.valid >= before.valid && made.centres.size() <= before.centres.size())
    {
      report.improved = true;
      countTryLed(Try::CarriedMapHeld, hold > 0 ? 1 : 0);
      report.after = after;
      map = { std::move(uv), certificate };
      return report;
    }
    if (made.valid < before.valid || hold == kMaximumHolds)
    {
      report.notice = comparison("the number of quads that are turned over",
        static_cast<double>(before.centres.size()), static_cast<double>(made.centres.size()));
      return report;
    }
    // Large quads on creases and in pockets that are narrower than they are.
    fixNear(surface.mesh, made.centres, radius, fixed);
    radius *= 2;
    ++report.holds;
    countTry(Try::CarriedMapHeld);
  }
}

} // namespace quadrille

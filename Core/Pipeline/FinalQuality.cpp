// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/FinalQuality.h"

#include "Base/Error.h"
#include "Base/TryCount.h"
#include "Extraction/Extraction.h"
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
/// Within so many edge lengths of such a quad; twice as far each time.
constexpr double kFirstHold = 1;

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

std::string comparison(const char* what, double before, double after)
{
  char text[128];
  std::snprintf(text, sizeof(text), "%s would have gone from %.4g to %.4g", what, before, after);
  return std::string("final quality: the map of the coarse level was kept, as ") + text;
}

/// The quads of a map that are inverted at a corner.
struct InvertedQuads
{
  bool valid = false; ///< whether the map has quads at all
  std::vector<Vector3> centres;
};

class Improvement
{
public:
  Improvement(const PreparedSurface& surface, const std::vector<int>& turns,
    const std::vector<std::uint8_t>& integerVertex, const CoarseMap& coarse,
    const FinalQualityOptions& options, const SurfaceMap& carried)
    : surface_(surface), turns_(turns), fixed_(integerVertex), coarse_(coarse), options_(options),
      carried_(carried)
  {
  }

  /// The map with the vertices fixed that are; not ok where it would take too much.
  RelaxResult solve(std::vector<FixedVec2>& uv) const
  {
    return options_.level == FinalQuality::Input ? solveOnInput(uv) : solveOnIntermediate(uv);
  }

  InvertedQuads invertedQuadsOf(const std::vector<FixedVec2>& uv) const
  {
    if (carried_.certificate.fractionalTransitions > 0)
    {
      return {}; // a seamless map without integers has none
    }
    ExtractionOptions extraction;
    extraction.maximumNumberOfQuads = options_.maximumNumberOfQuads;
    extraction.smoothingSteps = options_.smoothingSteps;
    extraction.fixedVertices = indexVertices(surface_);
    extraction.threads = options_.threads;
    const ExtractionResult quads = extractQuads(surface_.mesh, uv, extraction);
    InvertedQuads result;
    result.valid = quads.status.ok();
    for (const Index q : invertedQuads(quads.mesh.points, quads.mesh.quads))
    {
      const std::array<Vector3, 4> p = cornersOf(quads.mesh.points, quads.mesh.quads[q]);
      result.centres.push_back((p[0] + p[1] + p[2] + p[3]) / 4);
    }
    return result;
  }

  /// The vertices near these places keep what the carried map gives them.
  void fixNear(const std::vector<Vector3>& places, double radius)
  {
    for (Index v = 0; v < surface_.mesh.vertexCount(); ++v)
    {
      pollNowAndThen(v, 1024);
      const auto isNear = [&](const Vector3& p)
      { return (surface_.mesh.position[v] - p).squaredNorm() < radius * radius; };
      if (fixed_[v] == 0 && std::any_of(places.begin(), places.end(), isNear))
      {
        fixed_[v] = 1;
      }
    }
  }

private:
  RelaxOptions relaxOptions() const
  {
    RelaxOptions relax;
    relax.maximumBytes = options_.maximumBytes;
    relax.threads = options_.threads;
    relax.progress = options_.progress;
    return relax;
  }

  RelaxResult solveOnInput(std::vector<FixedVec2>& uv) const
  {
    uv = carried_.uv;
    RelaxOptions relax = relaxOptions();
    relax.guides = guidesOf(surface_, options_.threads);
    return relaxMap(surface_.mesh, fixed_, relax, uv);
  }

  RelaxResult solveOnIntermediate(std::vector<FixedVec2>& uv) const
  {
    const Level& level = coarse_.hierarchy->intermediate;
    const DecimationLog& log = coarse_.hierarchy->log;
    TransferOptions transfer;
    transfer.threads = options_.threads;
    std::vector<FixedVec2> levelUv = transferToLevel(
      coarse_.hierarchy->coarse, level, log.intermediateRounds, log, *coarse_.uv, transfer);
    mendPatches(level.mesh, levelUv, onLevel(level, turns_), options_.threads, {});
    RelaxOptions relax = relaxOptions();
    relax.guides = level.guides;
    RelaxResult result = relaxMap(level.mesh, onLevel(level, fixed_), relax, levelUv);
    if (result.status.ok())
    {
      uv = transferFromLevel(
        surface_.mesh, level, log.intermediateRounds, log, levelUv, turns_, transfer)
             .uv;
      // The replay has put vertices into kernels once more, where their triangles are thin.
      RelaxOptions local = relaxOptions();
      local.maximumSteps = 0;
      relaxMap(surface_.mesh, fixed_, local, uv);
    }
    return result;
  }

  const PreparedSurface& surface_;
  const std::vector<int>& turns_;
  std::vector<std::uint8_t> fixed_; ///< #V flags
  const CoarseMap& coarse_;
  const FinalQualityOptions& options_;
  const SurfaceMap& carried_;
};

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
  Improvement improvement(surface, turns, integerVertex, coarse, options, map);
  const InvertedQuads before = improvement.invertedQuadsOf(map.uv);
  double radius = kFirstHold * options.edgeLength;
  for (int hold = 0;; ++hold)
  {
    std::vector<FixedVec2> uv;
    const RelaxResult relaxed = improvement.solve(uv);
    report.steps += relaxed.steps;
    if (!relaxed.status.ok())
    {
      report.notice =
        "final quality: the map of the coarse level was kept, as " + relaxed.status.message;
      return report;
    }
    const Certificate certificate =
      certify(surface.mesh, uv, turns, integerVertex, options.threads);
    const MapDistortion after = measureDistortion(surface.mesh, uv);
    if (!noWorse(certificate, map.certificate))
    {
      report.notice =
        "final quality: the map of the coarse level was kept, as the certificate would "
        "have become worse: " +
        certificate.text();
      return report;
    }
    if (!(after.mean < report.before.mean))
    {
      report.notice = comparison("the distortion", report.before.mean, after.mean);
      return report;
    }
    const InvertedQuads inverted = improvement.invertedQuadsOf(uv);
    if (inverted.valid >= before.valid && inverted.centres.size() <= before.centres.size())
    {
      report.improved = true;
      countTryLed(Try::CarriedMapHeld, hold > 0 ? 1 : 0);
      report.after = after;
      map = { std::move(uv), certificate };
      return report;
    }
    if (inverted.valid < before.valid || hold == kMaximumHolds)
    {
      report.notice = comparison("the number of quads that are turned over",
        static_cast<double>(before.centres.size()), static_cast<double>(inverted.centres.size()));
      return report;
    }
    // Large quads on creases and in pockets that are narrower than they are.
    improvement.fixNear(inverted.centres, radius);
    radius *= 2;
    ++report.holds;
    countTry(Try::CarriedMapHeld);
  }
}

} // namespace quadrille

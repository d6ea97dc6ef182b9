// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/RunFields.h"

#include <algorithm>
#include <iterator>

namespace quadrille
{

namespace
{

using Texts = std::vector<std::string>;
using Counts = std::vector<std::size_t>;
using Numbers = std::vector<double>;

template <class Value, class Of>
std::vector<Value> columnOf(const std::vector<StageRecord>& stages, const Of& of)
{
  std::vector<Value> values;
  std::transform(stages.begin(), stages.end(), std::back_inserter(values), of);
  return values;
}

RunFields namedFields(const char* namesField, const char* countsField,
  const std::vector<std::pair<std::string, std::size_t>>& namedCounts)
{
  Texts names;
  Counts counts;
  for (const auto& [name, count] : namedCounts)
  {
    names.push_back(name);
    counts.push_back(count);
  }
  return { { namesField, names }, { countsField, counts } };
}

RunFields smallPartFields(const SmallParts& parts, double edgeLength)
{
  const auto coordinates = [](const Vector3& p) { return Numbers{ p.x(), p.y(), p.z() }; };
  return { { "Handles", Counts{ parts.handles } },
    { "UnresolvedHandles", Counts{ parts.unresolvedHandles } },
    { "ShortestLoopOverEdgeLength", Numbers{ parts.shortestLoop / edgeLength } },
    { "ShortestLoopPlace", coordinates(parts.place) },
    { "ShortestBoundaryOverEdgeLength", Numbers{ parts.boundary.shortest / edgeLength } },
    { "ShortestBoundaryPlace", coordinates(parts.boundary.place) } };
}

RunFields attemptFields(const std::vector<std::string>& attempts)
{
  Texts names;
  Counts counts;
  for (std::size_t i = 1; i < attempts.size(); ++i)
  {
    const std::string& step = attempts[i];
    if (std::find(names.begin(), names.end(), step) == names.end())
    {
      names.push_back(step);
      counts.push_back(
        static_cast<std::size_t>(std::count(attempts.begin(), attempts.end(), step)));
    }
  }
  return { { "Attempts", Counts{ attempts.size() } }, { "RecoveryNames", names },
    { "RecoveryCounts", counts } };
}

RunFields tryFields(const TryCounts& tries)
{
  Texts names;
  Counts taken, led;
  for (std::size_t i = 0; i < kTries; ++i)
  {
    if (tries.taken[i] > 0)
    {
      const TryRow& row = tryTable()[i];
      names.push_back(std::string(row.room) + ": " + row.name);
      taken.push_back(tries.taken[i]);
      led.push_back(tries.led[i]);
    }
  }
  return { { "TryNames", names }, { "TriesTaken", taken }, { "TriesLed", led } };
}

RunFields finalQualityFields(const FinalQualityReport& report)
{
  if (report.level == FinalQuality::Coarse)
  {
    return {};
  }
  const auto values = [](const MapDistortion& d) {
    return Numbers{ d.mean, d.median, d.p90, d.p99, d.angle, d.size, static_cast<double>(d.left) };
  };
  return { { "DistortionNames", Texts{ "mean", "median", "p90", "p99", "angle", "size", "left" } },
    { "DistortionBefore", values(report.before) }, { "DistortionAfter", values(report.after) },
    { "OptimizationSteps", Counts{ static_cast<std::size_t>(report.steps) } } };
}

void addAll(RunFields& fields, RunFields more)
{
  std::move(more.begin(), more.end(), std::back_inserter(fields));
}

} // namespace

std::vector<std::pair<std::string, std::size_t>> repairCounts(const RepairReport& r)
{
  return { { "triangulated_polygons", r.triangulatedPolygons }, { "merged_points", r.mergedPoints },
    { "degenerate_faces", r.degenerateFaces }, { "flipped_caps", r.flippedCaps },
    { "duplicate_faces", r.duplicateFaces }, { "isolated_points", r.isolatedPoints },
    { "non_manifold_edges", r.nonManifoldEdges },
    { "non_manifold_vertices", r.nonManifoldVertices }, { "reoriented_faces", r.reorientedFaces },
    { "removed_components", r.removedComponents }, { "refined_faces", r.refinedFaces },
    { "closed_handles", r.closedHandles }, { "filled_holes", r.filledHoles } };
}

RunFields stageFields(const std::vector<StageRecord>& stages)
{
  return { { "StageNames",
             columnOf<std::string>(stages, [](const StageRecord& s) { return s.stage; }) },
    { "StageSeconds", columnOf<double>(stages, [](const StageRecord& s) { return s.seconds; }) },
    { "StageElementsIn",
      columnOf<std::size_t>(stages, [](const StageRecord& s) { return s.elementsIn; }) },
    { "StageElementsOut",
      columnOf<std::size_t>(stages, [](const StageRecord& s) { return s.elementsOut; }) } };
}

RunFields certificateFields(const Certificate& c, bool isOfAll)
{
  return { { "Certificate", Texts{ c.text() } },
    { "CertificateValid", Counts{ c.valid() && isOfAll ? 1U : 0U } },
    { "CertificateNames",
      Texts{ "triangles", "not_positive", "wrong_turns", "seam_residuals", "off_axes",
        "off_isolines", "off_integers", "fractional_transitions", "minimum_determinant", "area" } },
    { "CertificateValues",
      Numbers{ static_cast<double>(c.triangles), static_cast<double>(c.notPositive),
        static_cast<double>(c.wrongTurns), static_cast<double>(c.seamResiduals),
        static_cast<double>(c.offAxes), static_cast<double>(c.offIsolines),
        static_cast<double>(c.offIntegers), static_cast<double>(c.fractionalTransitions),
        c.minimumDeterminant, c.area } } };
}

RunFields repairFields(const RepairReport& repair)
{
  return namedFields("RepairNames", "RepairCounts", repairCounts(repair));
}

RunFields extractionFields(const ExtractionCounts& counts)
{
  return namedFields("ExtractionNames", "ExtractionCounts", namedCounts(counts));
}

RunFields methodFields(MapMethod method)
{
  return { { "Method", Texts{ nameOf(method) } } };
}

RunFields anisotropyFields(double limit, double beyond)
{
  if (!(limit > 0))
  {
    return {};
  }
  return { { "AnisotropyLimit", Numbers{ limit } },
    { "BeyondAnisotropyLimit", Numbers{ beyond } } };
}

RunFields runFields(const RemeshResult& result)
{
  RunFields fields = stageFields(result.stages);
  addAll(fields, { { "ReusedStages", result.reused } });
  addAll(fields, certificateFields(result.certificate, result.failed.components == 0));
  addAll(fields, repairFields(result.surface.repair));
  addAll(fields, extractionFields(result.extraction));
  addAll(fields,
    { { "EstimatedSeconds", Numbers{ result.estimate.seconds } },
      { "EstimatedMegabytes", Numbers{ 1e-6 * result.estimate.bytes } },
      { "TargetEdgeLength", Numbers{ result.targetEdgeLength } },
      { "TargetQuads", Counts{ result.targetQuads } },
      { "ActualQuads", Counts{ result.quads.quads.size() } },
      { "CoarseVertices", Counts{ result.coarse.mesh.vertexCount() } },
      { "Decimations", Counts{ static_cast<std::size_t>(result.decimations) } },
      { "Replays", Counts{ static_cast<std::size_t>(result.replays) } },
      { "SurfaceFaces", Counts{ result.surface.mesh.faceCount() } } });
  addAll(fields, smallPartFields(result.smallParts, result.targetEdgeLength));
  addAll(fields, attemptFields(result.attempts));
  addAll(fields, tryFields(result.tries));
  if (result.failed.components > 0)
  {
    addAll(fields, { { "ComponentsWithoutQuads", Counts{ result.failed.components } } });
  }
  if (!result.stopped.empty())
  {
    addAll(fields, { { "Stopped", Texts{ result.stopped } } });
  }
  addAll(fields, finalQualityFields(result.finalQuality));
  return fields;
}

} // namespace quadrille

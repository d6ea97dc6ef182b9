// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/JoinedRuns.h"

#include "Base/Lists.h"
#include "Mesh/ContentHash.h"
#include "Quads/QuadTopology.h"

#include <algorithm>
#include <iomanip>
#include <iterator>
#include <map>
#include <numeric>
#include <sstream>
#include <utility>

namespace quadrille
{
namespace
{

Index shifted(Index id, Index shift)
{
  return id == kInvalidIndex ? id : id + shift;
}

void appendShifted(const std::vector<Index>& part, Index shift, std::vector<Index>& all)
{
  std::transform(part.begin(), part.end(), std::back_inserter(all),
    [&](Index id) { return shifted(id, shift); });
}

void appendNew(const std::vector<std::string>& part, std::vector<std::string>& all)
{
  for (const std::string& text : part)
  {
    if (!contains(all, text))
    {
      all.push_back(text);
    }
  }
}

void addCertificate(const Certificate& part, Index faces, Certificate& all)
{
  all.minimumDeterminant = all.triangles == 0
    ? part.minimumDeterminant
    : std::min(all.minimumDeterminant, part.minimumDeterminant);
  all.triangles += part.triangles;
  all.withoutMap += part.withoutMap;
  all.notPositive += part.notPositive;
  all.wrongTurns += part.wrongTurns;
  all.seamResiduals += part.seamResiduals;
  all.offAxes += part.offAxes;
  all.offIsolines += part.offIsolines;
  all.offIntegers += part.offIntegers;
  all.fractionalTransitions += part.fractionalTransitions;
  all.area += part.area;
  appendShifted(part.worstFaces, faces, all.worstFaces);
  all.worstFaces.resize(std::min(all.worstFaces.size(), kWorstFaces));
}

void addLevel(Level part, Index vertices, Index faces, Level& all)
{
  if (!all.guides.empty() || !part.guides.empty())
  {
    all.guides.resize(all.mesh.faceCount());
    part.guides.resize(part.mesh.faceCount());
    append(all.guides, part.guides);
  }
  appendMesh(part.mesh, all.mesh);
  appendShifted(part.fineVertex, vertices, all.fineVertex);
  appendShifted(part.fineFace, faces, all.fineFace);
}

void addTransfer(const TransferResult& part, Index vertices, TransferResult& all)
{
  all.invertedStars += part.invertedStars;
  all.movedToKernel += part.movedToKernel;
  all.withoutKernel += part.withoutKernel;
  all.replayNotPositive += part.replayNotPositive;
  all.mendedPatches += part.mendedPatches;
  all.notPositive += part.notPositive;
  appendShifted(part.defectVertices, vertices, all.defectVertices);
}

void addQuadMesh(const QuadMesh& part, Index faces, QuadMesh& all)
{
  const auto points = static_cast<Index>(all.points.size());
  append(all.points, part.points);
  for (const std::array<Index, 4>& quad : part.quads)
  {
    all.quads.push_back({ quad[0] + points, quad[1] + points, quad[2] + points, quad[3] + points });
  }
  appendShifted(part.sourceFace, faces, all.sourceFace);
  append(all.sourceWeights, part.sourceWeights);
  appendShifted(part.quadSourceFace, faces, all.quadSourceFace);
  append(all.quadSourceWeights, part.quadSourceWeights);
  if (!part.polygonOffsets.empty())
  {
    const auto corners = static_cast<Index>(all.polygonPoints.size());
    all.polygonOffsets.resize(std::max<std::size_t>(all.polygonOffsets.size(), 1), 0);
    all.polygonOffsets.pop_back(); // where the part begins
    appendShifted(part.polygonOffsets, corners, all.polygonOffsets);
    appendShifted(part.polygonPoints, points, all.polygonPoints);
    appendShifted(part.polygonSourceFace, faces, all.polygonSourceFace);
  }
  append(all.valence, part.valence);
  append(all.onBoundary, part.onBoundary);
  for (QuadLine line : part.lines)
  {
    line.a += points;
    line.b += points;
    line.halfEdge = shifted(line.halfEdge, 3 * faces);
    all.lines.push_back(line);
  }
}

void addExtraction(const ExtractionCounts& part, ExtractionCounts& all)
{
  all.openPorts += part.openPorts;
  all.zeroSides += part.zeroSides;
  all.mergedVertices += part.mergedVertices;
  all.zippedSides += part.zippedSides;
  all.cancelledQuads += part.cancelledQuads;
  all.droppedFaces += part.droppedFaces;
  all.filledHoles += part.filledHoles;
}

/// Each edge once; on the boundary where all of its lines are.
void joinLines(QuadMesh& quads)
{
  std::map<std::pair<Index, Index>, std::size_t> known;
  std::vector<QuadLine> lines;
  for (const QuadLine& line : quads.lines)
  {
    const auto [at, isNew] = known.emplace(std::minmax(line.a, line.b), lines.size());
    if (isNew)
    {
      lines.push_back(line);
    }
    else
    {
      lines[at->second].boundary = lines[at->second].boundary && line.boundary;
    }
  }
  quads.lines = std::move(lines);
}

/// Means over the parts by the quads that they have, and the largest of what nearly all lies below.
void addDistortion(const MapDistortion& part, double quads, double quadsBefore, MapDistortion& all)
{
  const auto mean = [&](double& value, double other)
  { value = (value * quadsBefore + other * quads) / (quadsBefore + quads); };
  mean(all.mean, part.mean);
  mean(all.median, part.median);
  mean(all.angle, part.angle);
  mean(all.size, part.size);
  all.p90 = std::max(all.p90, part.p90);
  all.p99 = std::max(all.p99, part.p99);
  all.left += part.left;
}

void addFinalQuality(
  const FinalQualityReport& part, double quads, double quadsBefore, FinalQualityReport& all)
{
  all.level = part.level;
  all.improved = part.improved && (quadsBefore == 0 || all.improved);
  if (part.level != FinalQuality::Coarse)
  {
    addDistortion(part.before, quads, quadsBefore, all.before);
    addDistortion(part.after, quads, quadsBefore, all.after);
  }
  all.steps += part.steps;
  all.holds += part.holds;
  all.elements += part.elements;
  all.notice += all.notice == part.notice ? "" : (all.notice.empty() ? "" : "; ") + part.notice;
}

/// The shorter of two loops, where 0 is none.
void addShortest(double part, const Vector3& partPlace, double& all, Vector3& place)
{
  if (part > 0 && (all == 0 || part < all))
  {
    all = part;
    place = partPlace;
  }
}

void addSmallParts(const SmallParts& part, SmallParts& all)
{
  all.handles += part.handles;
  all.unresolvedHandles += part.unresolvedHandles;
  all.complete = all.complete && part.complete;
  addShortest(part.shortestLoop, part.place, all.shortestLoop, all.place);
  all.boundary.loops += part.boundary.loops;
  all.boundary.shortLoops += part.boundary.shortLoops;
  addShortest(
    part.boundary.shortest, part.boundary.place, all.boundary.shortest, all.boundary.place);
}

void addLog(const RemeshResult& part, RemeshResult& all)
{
  addPart(part.stages, all.stages);
  appendNew(part.reused, all.reused);
  append(all.attempts, part.attempts);
  all.tries.add(part.tries);
  all.work += part.work;
  all.decimations += part.decimations;
  all.replays += part.replays;
}

} // namespace

JoinedRuns::JoinedRuns(const SizedSurface& whole)
  : components_(whole.surface->components), targetQuads_(static_cast<long long>(whole.targetQuads)),
    surface_(withoutElements(*whole.surface))
{
  joined_.curves.resize(whole.surface->curves.size());
}

void JoinedRuns::add(const SizedPart& part, RemeshResult made)
{
  addLog(made, joined_);
  appendNew(made.notices, joined_.notices);
  joined_.stopped += joined_.stopped.empty() ? made.stopped : "";
  targetQuads_ += static_cast<long long>(made.targetQuads);
  targetQuads_ -= static_cast<long long>(part.sized.targetQuads);
  joined_.mapKey = KeyMaker(joined_.mapKey).add(made.mapKey).key();
  append(joined_.givenUpFeatures, made.givenUpFeatures);
  append(joined_.withoutMap, made.withoutMap);
  addSmallParts(made.smallParts, joined_.smallParts);
  addFailed(part, made.failed);
  for (std::size_t i = 0; i < part.curves.size(); ++i)
  {
    joined_.curves[part.curves[i]] = std::move(made.curves[i]);
  }
  addMap(made);
  addQuads(made);
  appendSurface(*part.sized.surface, surface_);
}

void JoinedRuns::leaveOut(const SizedPart& part, const RemeshResult& made)
{
  const PreparedSurface& surface = *part.sized.surface;
  addLog(made, joined_);
  targetQuads_ -= static_cast<long long>(part.sized.targetQuads);
  surface_.unusedValences += surface.valenceRequests.size();
  tellUnmet(
    surface.curves, part.curves, "its connected component has no quads: " + made.status.message);
  FailedParts failed;
  failed.components = surface.components;
  failed.share = 1;
  failed.polygons = surface.sourcePolygon;
  failed.places = made.failed.places;
  failed.why = made.status.message;
  addFailed(part, failed);
}

void JoinedRuns::addFilled(const CutFaces& cut, FilledPart filled)
{
  const PreparedSurface& surface = cut.faces;
  const Index faces = surface_.mesh.faceCount();
  QuadMesh& all = joined_.quads;
  const auto before = static_cast<Index>(all.points.size());
  const auto shared = static_cast<Index>(filled.points.size());
  joined_.mapKey = KeyMaker(joined_.mapKey).add(surface.hash).key();
  joined_.uv.resize(joined_.uv.size() + surface.mesh.halfEdgeCount());
  joined_.turns.resize(joined_.turns.size() + surface.mesh.vertexCount());
  joined_.certificate.withoutMap += surface.mesh.faceCount();
  surface_.unusedValences += surface.valenceRequests.size();
  tellUnmet(surface.curves, cut.curves,
    "it passes through a face between sharp edges that has no map; ask for more quads");
  append(joined_.withoutMap, cut.inside);
  addQuadMesh(filled.quads, faces, all);
  // Points of the rest stand for those that lie on them.
  std::vector<Index> stands(all.points.size());
  std::iota(stands.begin(), stands.end(), Index{ 0 });
  for (Index i = 0; i < shared; ++i)
  {
    const Index p = filled.points[i];
    stands[before + i] = p;
    all.points[p] = filled.quads.points[i];
    all.sourceFace[p] = filled.quads.sourceFace[i] + faces;
    all.sourceWeights[p] = filled.quads.sourceWeights[i];
  }
  for (const auto& [p, one] : filled.same)
  {
    stands[p] = one;
  }
  std::vector<std::uint8_t> isKept(stands.size(), 0);
  for (Index p = 0; p < stands.size(); ++p)
  {
    isKept[p] = stands[p] == p ? 1 : 0;
  }
  const std::vector<Index> newId = keepPoints(all, isKept);
  for (std::array<Index, 4>& quad : all.quads)
  {
    for (Index& p : quad)
    {
      p = newId[stands[p]];
    }
  }
  for (QuadLine& line : all.lines)
  {
    line.a = newId[stands[line.a]];
    line.b = newId[stands[line.b]];
  }
  joinLines(all);
  setValences(all);
  PreparedSurface added = surface;
  added.components = 0; // those of the rest
  added.valenceRequests.clear();
  added.sectorRequests.clear();
  appendSurface(added, surface_);
}

/// curves: of a part; ids: of the whole.
void JoinedRuns::tellUnmet(
  const std::vector<CurveRequest>& curves, const std::vector<Index>& ids, const std::string& why)
{
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    CurveOutcome& curve = joined_.curves[ids[i]];
    curve.why = why;
    curve.start = curves[i].points.front();
    curve.end = curves[i].points.back();
    curve.ends = curves[i].ends;
  }
}

/// failed: of the part.
void JoinedRuns::addFailed(const SizedPart& part, const FailedParts& failed)
{
  FailedParts& all = joined_.failed;
  all.components += failed.components;
  all.ofComponents = all.components > 0 ? components_ : 0;
  all.share += part.share * failed.share;
  append(all.places, failed.places);
  append(all.polygons, failed.polygons);
  sortUnique(all.polygons);
  all.why = all.why.empty() ? failed.why : all.why;
}

void JoinedRuns::addMap(RunMap& made)
{
  const Index vertices = surface_.mesh.vertexCount(), faces = surface_.mesh.faceCount();
  addCertificate(
    made.coarseCertificate, joined_.coarse.mesh.faceCount(), joined_.coarseCertificate);
  addLevel(std::move(made.coarse), vertices, faces, joined_.coarse);
  append(joined_.coarseUv, made.coarseUv);
  append(joined_.coarseTurns, made.coarseTurns);
  for (SectorRequest& request : made.onFeatures)
  {
    request.vertex += vertices;
    joined_.onFeatures.push_back(std::move(request));
  }
  append(joined_.uv, made.uv);
  append(joined_.turns, made.turns);
  addCertificate(made.certificate, faces, joined_.certificate);
  addTransfer(made.transfer, vertices, joined_.transfer);
}

void JoinedRuns::addQuads(const RunQuads& made)
{
  const auto before = static_cast<double>(joined_.quads.quads.size());
  const auto added = static_cast<double>(made.quads.quads.size());
  addFinalQuality(made.finalQuality, added, before, joined_.finalQuality);
  addExtraction(made.extraction, joined_.extraction);
  addQuadMesh(made.quads, surface_.mesh.faceCount(), joined_.quads);
}

PreparedSurface JoinedRuns::take(RemeshResult& result, int threads)
{
  takeLog(result);
  static_cast<RunMap&>(result) = std::move(static_cast<RunMap&>(joined_));
  static_cast<RunQuads&>(result) = std::move(static_cast<RunQuads&>(joined_));
  result.status = {};
  result.failed = std::move(joined_.failed);
  result.stopped = std::move(joined_.stopped);
  result.mapKey = joined_.mapKey;
  result.targetQuads = static_cast<std::size_t>(std::max(1LL, targetQuads_));
  result.smallParts = joined_.smallParts;
  append(result.givenUpFeatures, joined_.givenUpFeatures);
  appendNew(joined_.notices, result.notices);
  surface_.hash = contentHash(surface_.mesh, threads);
  return std::move(surface_);
}

void JoinedRuns::takeLog(RemeshResult& result)
{
  addLog(joined_, result);
  eraseIf(result.reused,
    [&](const std::string& name)
    {
      return std::any_of(result.stages.begin(), result.stages.end(),
        [&](const StageRecord& record) { return record.stage == name; });
    });
}

std::string FailedParts::text() const
{
  if (components == 0)
  {
    return {};
  }
  return why + "; " + countText() +
    (components == 1 ? ", has no quads and was left out" : ", have no quads and were left out");
}

std::string FailedParts::lostText(std::size_t without) const
{
  return components <= without
    ? std::string()
    : "with it " + countText() + (components == 1 ? ", has no quads: " : ", have no quads: ") + why;
}

std::string FailedParts::countText() const
{
  std::ostringstream text;
  text << components << " of " << ofComponents << " connected components, with "
       << std::setprecision(3) << 100 * share << " % of the area";
  return text.str();
}

} // namespace quadrille

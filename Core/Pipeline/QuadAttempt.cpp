// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Attempt.h"
#include "Requests/Guides.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Pipeline/Estimate.h"
#include "Pipeline/Notices.h"
#include "Quads/QuadShape.h"
#include "Quads/SurfaceShape.h"
#include "Requests/DrawnLines.h"
#include "Transfer/Transfer.h"

#include <algorithm>
#include <utility>

namespace quadrille
{
namespace
{

/// A fold within so many edge lengths is why a quad is inverted.
constexpr double kFoldRadius = 2;

FinalQualityOptions finalQualityOptions(const RunContext& run)
{
  FinalQualityOptions options;
  options.level = run.options.finalQuality;
  options.edgeLength = run.edgeLength;
  options.maximumNumberOfQuads = run.options.maximumNumberOfQuads;
  options.smoothingSteps = run.options.smoothingSteps;
  options.maximumBytes = run.options.memoryLimit.value_or(freeMemory());
  options.threads = run.options.threads;
  options.progress = subProgress(run.options.progress, 0.9, 0.95, "Optimizing: ");
  return options;
}

/// Why the map is not solved again, though that was asked for; empty where it can be. The levels are made for it where
/// they are needed.
std::string hindrance(
  RunContext& run, const PlannedSurface& surface, const Plan& plan, const MapAttempt& map)
{
  if (run.options.method != MapMethod::ScaleAware && !map.certificate.valid())
  {
    return std::string("that by the method '") + nameOf(run.options.method) +
      "' is no integer-grid map to begin with";
  }
  const bool isThere = run.options.finalQuality != FinalQuality::Intermediate ||
    isMapOf(map, run.levels.make(surface, levelOptions(run, plan)));
  return isThere ? "" : "its decimation is not there any more";
}

/// On request: the same integers, solved again on a finer level.
void improve(RunContext& run, const PlannedSurface& surface, const Plan& plan, MapAttempt& map,
  QuadAttempt& made)
{
  if (run.options.finalQuality == FinalQuality::Coarse)
  {
    return;
  }
  const double start = secondsNow();
  const std::string why = hindrance(run, surface, plan, map);
  if (!why.empty())
  {
    made.notices.push_back("final quality: the map of the coarse level was kept, as " + why);
    return;
  }
  const bool byLevels = run.options.finalQuality == FinalQuality::Intermediate;
  const Mesh& mesh = surface->mesh;
  SurfaceMap improved{ std::move(map.uv), map.certificate };
  const CoarseMap coarse{ byLevels ? &run.levels.hierarchy() : nullptr, &map.coarseUv };
  made.finalQuality =
    improveMap(*surface, map.turns, map.integerVertex, coarse, finalQualityOptions(run), improved);
  map.uv = std::move(improved.uv);
  if (made.finalQuality.improved)
  {
    map.certificate = improved.certificate;
    made.uv = PackedMap(mesh, map.uv);
    made.certificate = improved.certificate;
  }
  tell({ made.finalQuality.notice }, made.notices);
  made.stages.add("optimize", secondsNow() - start, made.finalQuality.elements, mesh.faceCount());
}

/// Where the map on the surface is not valid everywhere, what was asked for may be lost: that is told.
std::string missedValencesText(const PreparedSurface& surface, const QuadMesh& quads)
{
  const std::vector<Index> vertices = heldIndexVertices(surface);
  std::vector<int> valence(vertices.empty() ? 0 : surface.mesh.vertexCount(), 0);
  for (Index p = 0; p < quads.points.size() && !valence.empty(); ++p)
  {
    if (const std::optional<Index> corner = meshCorner(quads, p))
    {
      // On a boundary of k quads there are k + 1 edges; as if the quads went on, it would be k + 2.
      valence[surface.mesh.origin[*corner]] = quads.valence[p] + (quads.onBoundary[p] != 0 ? 1 : 0);
    }
  }
  const auto missed = elementsWhere(surface.valenceRequests,
    [&](const ValenceRequest& request)
    {
      return request.valence != kRegularValence && !request.mayDrift &&
        valence[request.vertex] != request.valence;
    });
  if (missed.empty())
  {
    return {};
  }
  return std::to_string(missed.size()) +
    " points did not get the valence that was asked for, where the map has folds; one is point " +
    std::to_string(missed.front().point) + " at " +
    placeText(surface.mesh.position[missed.front().vertex]) +
    ": ask for smaller quads, or for fewer irregular vertices there";
}

/// For a failure of the extraction: whether the map is to blame.
std::string certificateText(const Certificate& certificate)
{
  const std::string defects = defectsText(certificate);
  return defects.empty() ? " (the map is valid)" : " (map on the input surface: " + defects + ")";
}

Status failureOf(const Status& extraction, MapMethod method, const Certificate& certificate)
{
  if (extraction.code == StatusCode::TooLarge)
  {
    return extraction; // whatever the map is
  }
  return { extraction.code,
    "ask for more quads, more coarse vertices, or a larger feature angle: " +
      (isRounded(method) ? std::string("no valid quad mesh from the map by '") + nameOf(method) +
            "', which may have folds (the scale aware method has none): "
                         : std::string("no valid quad mesh: ")) +
      extraction.message + certificateText(certificate) };
}

void countInverted(const RunContext& run, const MapAttempt& map, QuadAttempt& made)
{
  const std::vector<Vector3> folds = positionsOf(run.surface->mesh, map.transfer.defectVertices);
  const std::vector<Index> inverted = invertedQuads(made.quads.points, made.quads.quads);
  made.invertedQuads = inverted.size();
  made.invertedAtFolds = std::any_of(inverted.begin(), inverted.end(),
    [&](Index q)
    {
      const std::array<Vector3, 4> corners = cornersOf(made.quads.points, made.quads.quads[q]);
      return std::any_of(corners.begin(), corners.end(),
        [&](const Vector3& p) { return isNear(p, folds, kFoldRadius * run.edgeLength); });
    });
}

/// Triangles under the points where more than two quads have an edge, or a quad has a point twice.
std::vector<Index> facesWithoutSurface(const QuadMesh& quads)
{
  std::vector<std::pair<Index, Index>> edges;
  for (const std::array<Index, 4>& quad : quads.quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      edges.emplace_back(std::minmax(quad[i], quad[(i + 1) % 4]));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Index> faces;
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    const auto& [a, b] = edges[i];
    if (a == b || (i + 2 < edges.size() && edges[i] == edges[i + 2]))
    {
      faces.push_back(quads.sourceFace[a]);
      faces.push_back(quads.sourceFace[b]);
    }
  }
  sortUnique(faces);
  return faces;
}

/// certificate: of the map that the quads are made of. Returns how many quads there are, also where they are not valid.
std::size_t extract(const RunContext& run, const Mesh& mesh, const std::vector<FixedVec2>& uv,
  ExtractionOptions options, const Certificate& certificate, QuadAttempt& made)
{
  options.maximumNumberOfQuads = run.options.maximumNumberOfQuads;
  options.threads = run.options.threads;
  ExtractionResult extracted = extractQuads(mesh, uv, options);
  if (!extracted.status.ok())
  {
    made.status = failureOf(extracted.status, run.options.method, certificate);
    made.failedFaces = facesWithoutSurface(extracted.mesh);
    return extracted.mesh.quads.size();
  }
  made.extraction = extracted;
  made.quads = std::move(extracted.mesh);
  return made.quads.quads.size();
}

/// What connections and cycles have become in the quads, edge by edge.
std::vector<std::vector<Index>> edgesOfCurves(
  const PreparedSurface& surface, const std::vector<CurveOutcome>& outcomes, const QuadMesh& quads)
{
  std::vector<std::uint8_t> isOnMet(surface.mesh.halfEdgeCount(), 0);
  for (std::size_t i = 0; i < outcomes.size(); ++i)
  {
    if (outcomes[i].met)
    {
      const EdgesOfLine line = edgesOfLine(surface.mesh, surface.curves[i]);
      std::transform(line.edges.begin(), line.edges.end(), isOnMet.begin(), isOnMet.begin(),
        [](std::uint8_t a, std::uint8_t b) { return a | b; });
    }
  }
  std::vector<std::vector<Index>> edges;
  for (const QuadLine& line : quads.lines)
  {
    // Those of filled faces know no half-edge.
    if (line.halfEdge != kInvalidIndex && isOnMet[line.halfEdge] != 0)
    {
      edges.push_back({ line.a, line.b });
    }
  }
  return edges;
}

} // namespace

ExtractionOptions extractionOptions(
  const PreparedSurface& surface, const RunMap& map, const RemeshOptions& run)
{
  ExtractionOptions options;
  options.smoothingSteps = run.smoothingSteps;
  options.maximumNumberOfQuads = run.maximumNumberOfQuads;
  options.threads = run.threads;
  options.fixedVertices = heldIndexVertices(surface);
  if (!map.curves.empty())
  {
    options.keptChains = [&surface, &map](const QuadMesh& quads)
    { return edgesOfCurves(surface, map.curves, quads); };
  }
  return options;
}

namespace
{

void extractOnSurface(
  const RunContext& run, const PlannedSurface& surface, const MapAttempt& map, QuadAttempt& made)
{
  if (run.options.method == MapMethod::Seamless)
  {
    made.notices.push_back("the method 'seamless' has no integers, so there are no quads: the "
                           "map on the surface is the result");
    return;
  }
  const double start = secondsNow();
  const Mesh& mesh = surface->mesh;
  const std::shared_ptr<const SurfaceShape> shape = findOrMake<SurfaceShape>(
    run.store, surface.keyWithoutSizes, [&] { return shapeOf(mesh, run.options.threads); },
    [](const SurfaceShape&) { return sizeof(SurfaceShape); });
  ExtractionOptions options = extractionOptions(*surface, map, run.options);
  options.guides = map.guides;
  // Of the coarsest ones each is a patch of a layout, whatever its shape.
  options.replacesBad = !run.options.coarsestIntegers && !run.hasBeside;
  options.mapIsCertified = map.certificate.valid();
  options.shape = shape.get();
  options.progress = subProgress(run.options.progress, 0.9, 1.0, "Extracting: ");
  const std::size_t quads = extract(run, mesh, map.uv, options, map.certificate, made);
  made.stages.add("extract", secondsNow() - start, mesh.faceCount(), quads);
  if (made.status.ok())
  {
    tell(
      { mapNotice(mesh, map.certificate), missedValencesText(*surface, made.quads) }, made.notices);
    countInverted(run, map, made);
  }
}

/// From the store; null where it has none that this run may take.
std::shared_ptr<const QuadAttempt> findQuads(RunContext& run, ResultKey key, MapAttempt& map)
{
  const auto found = findIn<QuadAttempt>(run.store, key);
  if (!found || found->quads.quads.size() > run.options.maximumNumberOfQuads)
  {
    return nullptr;
  }
  if (found->uv)
  {
    map.uv.clear();
    map.packed = *found->uv;
    map.certificate = *found->certificate;
  }
  return asReused(*found, {});
}

} // namespace

std::size_t QuadAttempt::bytes() const
{
  return bytesOf(quads.points) + bytesOf(quads.quads) + bytesOf(quads.sourceFace) +
    bytesOf(quads.sourceWeights) + (uv ? uv->bytes() : 0);
}

std::shared_ptr<const QuadAttempt> makeQuads(
  RunContext& run, const PlannedSurface& surface, const Plan& plan, MapAttempt& map)
{
  const ResultKey key =
    KeyMaker(map.key).add(run.options.smoothingSteps, run.options.finalQuality).key();
  if (auto known = findQuads(run, key, map))
  {
    run.levels.letGo();
    return known;
  }
  if (run.options.finalQuality != FinalQuality::Intermediate)
  {
    run.levels.letGo(); // before the map takes their memory
  }
  map.unpack(surface->mesh);
  const TryScope tries;
  auto made = std::make_shared<QuadAttempt>();
  improve(run, surface, plan, map, *made);
  run.levels.letGo();
  extractOnSurface(run, surface, map, *made);
  made->tries = tries.counts();
  // What a limit of this run has kept from being made is not remembered.
  const bool limited = made->status.code == StatusCode::TooLarge ||
    (run.options.finalQuality != FinalQuality::Coarse && !made->finalQuality.improved);
  if (run.store != nullptr && !limited)
  {
    const std::size_t bytes = made->bytes();
    run.store->put(key, std::make_shared<QuadAttempt>(*made), bytes);
  }
  return made;
}

std::shared_ptr<const QuadAttempt> makePreview(
  RunContext& run, const PlannedSurface& surface, const Plan& plan, const MapAttempt& map)
{
  auto made = std::make_shared<QuadAttempt>();
  const Hierarchy& levels = run.levels.make(surface, levelOptions(run, plan));
  const double start = secondsNow();
  const Mesh& mesh = levels.intermediate.mesh;
  TransferOptions transfer;
  transfer.spare = &run.spare;
  transfer.threads = run.options.threads;
  const std::vector<FixedVec2> uv = transferToLevel(map.coarse, levels.intermediate,
    levels.log.intermediateRounds, levels.log, map.coarseUv, transfer);
  ExtractionOptions options;
  options.smoothingSteps = 0;
  const std::size_t quads = extract(run, mesh, uv, options, map.coarseCertificate, *made);
  made->stages.add("preview", secondsNow() - start, mesh.faceCount(), quads);
  run.levels.letGo();
  return made;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Attempt.h"
#include "GridMap/FieldUntangling.h"

#include "Base/Lists.h"
#include "Base/WorkCount.h"
#include "GridMap/PreviousMap.h"
#include "Pipeline/CoarsestMap.h"
#include "Pipeline/GuidedMap.h"
#include "Pipeline/Notices.h"
#include "Pipeline/RequestKeys.h"
#include "Requests/Guides.h"
#include "Requests/HeldVertices.h"
#include "Requests/StraightRequests.h"
#include "Transfer/ExpectedTurns.h"
#include "Transfer/SurfaceStretch.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

namespace quadrille
{
namespace
{

/// Of what a map has to share with an earlier one for a warm start.
ResultKey warmKey(const RunContext& run, const PlannedSurface& surface, const Plan& plan)
{
  return KeyMaker(surface.key)
    .add(run.edgeLength, plan.quads, run.options.anisotropyLimit, run.options.distortionMetric)
    .key();
}

GridMapOptions mapOptions(const RunContext& run, const PlannedSurface& surface,
  const Hierarchy& levels, const Plan& plan, MapAttempt& made)
{
  const Level& coarse = levels.coarse;
  GridMapOptions options;
  options.method = run.options.method;
  options.edgeLength = run.edgeLength;
  options.targetQuads = plan.quads;
  options.anisotropyLimit = run.options.anisotropyLimit;
  options.guides = coarse.guides;
  options.targetValences = levelValences(*surface, coarse.mesh, coarse.fineVertex);
  options.sectorTurns = levelSectors(*surface, coarse.mesh, coarse.fineVertex);
  options.sizes = sizeWish(surface);
  options.curves = surface->curves;
  options.seams = surface->seams;
  options.progress = subProgress(run.options.progress, 0.45, 0.8, "Mapping: ");
  if (run.options.distortionMetric) // on request
  {
    const double start = secondsNow();
    options.stretch = measureStretch(levels.intermediate, coarse, levels.log);
    made.stages.add("metric", secondsNow() - start, levels.intermediate.mesh.faceCount(),
      coarse.mesh.faceCount());
  }
  return options;
}

GridMapResult computeMap(RunContext& run, const PlannedSurface& surface, const Hierarchy& levels,
  const Plan& plan, MapAttempt& made)
{
  const Level& coarse = levels.coarse;
  // Half of the quads at a straight part will lie outside.
  const bool isOutset = !surface->straight.empty();
  OutsetMesh outset;
  if (isOutset)
  {
    outset = withOutset(coarse.mesh, surface->straight, run.edgeLength / 2);
  }
  const Mesh& mesh = isOutset ? outset.mesh : coarse.mesh;
  GridMapOptions options = mapOptions(run, surface, levels, plan, made);
  options.straight = std::move(outset.requests);
  if (run.options.coarsestIntegers)
  {
    return computeCoarsestMap(mesh, options);
  }
  const bool remembers = run.store != nullptr && run.options.method == MapMethod::ScaleAware;
  const ResultKey key = warmKey(run, surface, plan);
  const std::shared_ptr<PreviousMap> previous =
    remembers && run.options.warmStart ? run.store->find<PreviousMap>(key) : nullptr;
  if (previous)
  {
    options.previous = previous.get();
    options.vertexIds = coarse.fineVertex;
  }
  GridMapResult map = computeGridMap(mesh, options);
  const std::array<std::pair<std::size_t, const char*>, 2> reuses{
    { { map.reuse.seamless, "seamless" }, { map.reuse.integers, "quantize" } }
  };
  for (const auto& [components, stage] : reuses)
  {
    if (components > 0)
    {
      made.started.emplace_back(stage);
    }
  }
  if (remembers && map.status.ok())
  {
    auto next = std::make_shared<PreviousMap>(previousMap(mesh, map, coarse.fineVertex));
    const std::size_t bytes = next->bytes();
    run.store->put(key, std::move(next), bytes);
  }
  return map;
}

FailedFaces onFinest(const FailedFaces& failed, const Level& coarse)
{
  const std::vector<Index>& fineFace = coarse.fineFace;
  FailedFaces finest;
  for (const Index f : failed.faces)
  {
    if (f < fineFace.size()) // others are of the outset
    {
      finest.faces.push_back(fineFace[f]);
    }
  }
  for (const auto& [one, other] : failed.either)
  {
    if (std::max(one, other) < fineFace.size())
    {
      finest.either.push_back({ fineFace[one], fineFace[other] });
    }
  }
  return finest;
}

/// What is left of a map on the coarse level.
void recordCoarse(const Hierarchy& levels, GridMapResult& map, MapAttempt& made)
{
  const std::size_t coarse = levels.coarse.mesh.faceCount();
  made.stages.add("field", map.secondsField, coarse, coarse);
  made.stages.add("seamless", map.secondsSeamless, coarse, coarse);
  made.stages.add("quantize", map.secondsQuantize, coarse, coarse);
  made.stages.add("embed", map.secondsEmbed, coarse, coarse);
  tell({ levels.notice, refinementNotice(map.refinement) }, made.notices);
  made.curves = std::move(map.curves);
  made.coarse = levels.coarse;
  made.coarseUv = std::move(map.uv);
  if (!map.field.turns.empty()) // there is none where the level is too large for one
  {
    made.coarseTurns = map.field.turns;
    made.coarseInteger = integerVertices(made.coarse.mesh, map.field);
    made.onFeatures = sectorsOf(
      made.coarse.mesh, map.field.sectorTurns, made.coarseInteger, made.coarse.fineVertex);
  }
  made.coarseCertificate = map.certificate;
  made.hopeless = map.status.code == StatusCode::TooLarge ||
    (map.status.code == StatusCode::Infeasible && map.failedAt.empty());
  if (!map.status.ok())
  {
    made.status = map.status;
    made.failedPlaces = positionsOf(levels.coarse.mesh, map.failedAt);
    made.failedAt = onFinest(map.failedAt, levels.coarse);
    made.failedFaces = onFinest(map.failedFaces, levels.coarse);
    made.failedIn = onFinest(map.failedIn.empty() ? map.failedAt : map.failedIn, levels.coarse);
  }
}

/// Fills transfer, uv and certificate. False where nothing was carried.
bool carry(
  RunContext& run, const Mesh& mesh, const Hierarchy& levels, bool alongGuides, MapAttempt& made)
{
  double start = secondsNow();
  TransferOptions options;
  options.spare = &run.spare;
  options.threads = run.options.threads;
  options.progress = subProgress(run.options.progress, 0.8, 0.9, "Mapping back: ");
  std::optional<TransferResult> carried = alongGuides
    ? transferAlongGuides(mesh, levels, made.coarseUv, made.turns, made.integerVertex, options)
    : transferMap(mesh, made.coarse, levels.log, made.coarseUv, options);
  if (!carried)
  {
    return false;
  }
  made.transfer = std::move(*carried);
  made.uv = std::move(made.transfer.uv);
  made.transfer.uv.clear();
  made.guides = alongGuides ? guidesRoundRegions(mesh, levels.intermediate, run.edgeLength)
                            : std::vector<FaceGuide>();
  made.stages.add("replay", secondsNow() - start, made.coarse.mesh.faceCount(), mesh.faceCount());
  start = secondsNow();
  made.certificate = certify(mesh, made.uv, made.turns, made.integerVertex, run.options.threads);
  made.stages.add("certify", secondsNow() - start, mesh.faceCount(), mesh.faceCount());
  return true;
}

/// What carrying a map makes.
struct CarriedParts
{
  std::vector<FixedVec2> uv;
  TransferResult transfer;
  Certificate certificate;
  std::vector<FaceGuide> guides;

  void swapWith(MapAttempt& made)
  {
    std::swap(uv, made.uv);
    std::swap(transfer, made.transfer);
    std::swap(certificate, made.certificate);
    std::swap(guides, made.guides);
  }
};

/// The map along guides has defects: without them, if it has fewer so.
void tryWithoutGuides(RunContext& run, const Mesh& mesh, const Hierarchy& levels, MapAttempt& made)
{
  const std::size_t defects = made.defects();
  CarriedParts along;
  along.swapWith(made);
  carry(run, mesh, levels, false, made);
  const bool isBetter = made.defects() < defects;
  if (!isBetter)
  {
    along.swapWith(made);
  }
  countTry(Try::WithoutGuides);
  countTryLed(Try::WithoutGuides, isBetter ? 1 : 0);
}

void tellOfRounding(MapMethod method, MapAttempt& made)
{
  if (isRounded(method))
  {
    const Certificate& coarse = made.coarseCertificate;
    const Certificate& fine = made.certificate;
    std::ostringstream text;
    text << "the method '" << nameOf(method) << "' gives no guarantee: " << coarse.notPositive
         << " of " << coarse.triangles << " triangles of the coarse map and " << fine.notPositive
         << " of " << fine.triangles << " of the map on the surface are inverted or degenerate";
    made.notices.push_back(text.str());
  }
}

/// A map that was interrupted is that of another run with the same allowance only.
ResultKey interruptedKey(ResultKey key, std::size_t allowance)
{
  return KeyMaker(key).add(allowance).key();
}

void interrupt(const Hierarchy& levels, std::size_t allowance, MapAttempt& made)
{
  made.key = interruptedKey(made.key, allowance);
  made.isInterrupted = true;
  made.hopeless = true; // more freedom would take longer
  made.work = allowance;
  made.coarse = levels.coarse;
  made.status = { StatusCode::NotConverged,
    "ask for smaller quads, a larger feature angle or fewer coarse vertices: the map of the "
    "coarse level was not done within the work that a surface of this size is worth" };
}

} // namespace

std::size_t MapAttempt::defects() const
{
  return certificate.notPositive + certificate.wrongTurns + certificate.seamResiduals;
}

void MapAttempt::pack(const Mesh& surface)
{
  if (!uv.empty())
  {
    packed = PackedMap(surface, uv);
    std::vector<FixedVec2>().swap(uv);
  }
}

void MapAttempt::unpack(const Mesh& surface)
{
  if (uv.empty() && packed.bytes() > 0)
  {
    uv = packed.unpack(surface);
    packed = {};
  }
}

std::size_t MapAttempt::bytes() const
{
  return bytesOf(coarse.mesh.position) + bytesOf(coarse.mesh.origin) + bytesOf(coarse.mesh.twin) +
    bytesOf(coarseUv) + bytesOf(uv) + packed.bytes() + bytesOf(turns) + bytesOf(integerVertex) +
    bytesOf(guides);
}

RunContext makeRun(const SizedSurface& sized, const RemeshOptions& options, ResultStore* store)
{
  RunContext run{ options, sized.edgeLength, sized.targetQuads,
    withoutPlan(sized.surface, sized.key), store, Levels(store) };
  run.hasBeside = sized.hasBeside;
  if (options.progress)
  {
    run.options.progress = [tried = run.tried, asked = options.progress](
                             double fraction, const std::string& text)
    { return asked(fraction, (tried->empty() ? "" : *tried + ": ") + text); };
  }
  return run;
}

HierarchyOptions levelOptions(const RunContext& run, const Plan& plan)
{
  HierarchyOptions options;
  options.targetEdgeLength = plan.levels.edgeLength * run.edgeLength;
  options.coarseVertices = plan.levels.coarseVertices;
  options.cost = run.options.decimationCost;
  options.guides = surfaceGuides(*run.surface, run.options.threads).faces;
  options.keepVertices = plan.levels.keptVertices;
  options.isExact = run.surface->facets.isDesigned;
  options.isConnected = run.surface->components == 1;
  options.threads = run.options.threads;
  options.progress = subProgress(run.options.progress, 0.15, 0.45, "Decimating: ");
  return options;
}

ResultKey mapKey(const RunContext& run, const PlannedSurface& surface, const Plan& plan)
{
  const RemeshOptions& options = run.options;
  return KeyMaker(surface.key)
    .add(run.edgeLength, plan.levels.keptVertices, plan.levels.coarseVertices,
      plan.levels.edgeLength, plan.quads, options.method, options.decimationCost,
      options.coarsestIntegers, options.distortionMetric, options.warmStart,
      options.anisotropyLimit, requestsKey(*surface))
    .key();
}

std::shared_ptr<MapAttempt> findMap(const RunContext& run, ResultKey key, std::size_t allowance)
{
  if (run.store == nullptr)
  {
    return nullptr;
  }
  auto found = run.store->find<MapAttempt>(key);
  if (!found || found->work > allowance)
  {
    found = run.store->find<MapAttempt>(interruptedKey(key, allowance));
  }
  return found ? asReused(*found, { "phase1", "phase2" }) : nullptr;
}

bool isMapOf(const MapAttempt& map, const Hierarchy& levels)
{
  return levels.coarse.fineVertex == map.coarse.fineVertex;
}

std::shared_ptr<MapAttempt> makeCoarseMap(RunContext& run, const PlannedSurface& surface,
  const Hierarchy& levels, const Plan& plan, ResultKey key, std::size_t allowance)
{
  auto made = std::make_shared<MapAttempt>();
  made->key = key;
  made->stages.add(run.levels.stages());
  if (!made->stages.has("phase2"))
  {
    made->reused.emplace_back("phase2");
  }
  const double start = secondsNow();
  try
  {
    const WorkScope scope(allowance);
    GridMapResult map = computeMap(run, surface, levels, plan, *made);
    made->work = scope.done();
    recordCoarse(levels, map, *made);
  }
  catch (const WorkSpent& spent)
  {
    interrupt(levels, allowance, *made);
    if (const auto* inFaces = dynamic_cast<const SpentInFaces*>(&spent))
    {
      made->failedFaces = onFinest(inFaces->faces, levels.coarse);
    }
    const std::size_t faces = levels.coarse.mesh.faceCount();
    made->stages.add("interrupted", secondsNow() - start, faces, faces);
  }
  return made;
}

void carryToSurface(
  RunContext& run, const PlannedSurface& surface, const Hierarchy& levels, MapAttempt& made)
{
  const WorkScope scope;
  const Mesh& mesh = surface->mesh;
  made.turns = expectedTurns(mesh, made.coarse, made.coarseTurns);
  made.integerVertex.assign(mesh.vertexCount(), 0);
  for (Index v = 0; v < made.coarseInteger.size(); ++v)
  {
    made.integerVertex[made.coarse.fineVertex[v]] = made.coarseInteger[v];
  }
  const bool isScaleAware = run.options.method == MapMethod::ScaleAware;
  if (!isScaleAware || !carry(run, mesh, levels, true, made))
  {
    carry(run, mesh, levels, false, made);
  }
  else if (!made.certificate.valid())
  {
    tryWithoutGuides(run, mesh, levels, made);
  }
  made.isCarried = true;
  made.workOfCarrying = scope.done();
  tellOfRounding(run.options.method, made);
}

void keepMap(const RunContext& run, const Mesh& surface, MapAttempt& map)
{
  if (run.store == nullptr)
  {
    return;
  }
  std::vector<FixedVec2> uv = std::move(map.uv);
  map.uv = {};
  if (!uv.empty())
  {
    map.packed = PackedMap(surface, uv);
  }
  auto kept = std::make_shared<MapAttempt>(map);
  map.packed = {};
  map.uv = std::move(uv);
  const std::size_t bytes = kept->bytes();
  run.store->put(map.key, std::move(kept), bytes);
}

std::vector<Vector3> positionsOf(const Mesh& mesh, const std::vector<Index>& vertices)
{
  std::vector<Vector3> points;
  points.reserve(vertices.size());
  for (const Index v : vertices)
  {
    points.push_back(mesh.position[v]);
  }
  return points;
}

std::vector<Index> failedVertices(const Attempt& attempt, const Mesh& surface)
{
  if (!attempt.quads)
  {
    return attempt.map->failedIn;
  }
  std::vector<Index> vertices;
  for (const Index f : attempt.quads->failedFaces)
  {
    vertices.push_back(surface.origin[3 * f]);
  }
  sortUnique(vertices);
  return vertices;
}

bool isNear(const Vector3& p, const std::vector<Vector3>& places, double radius)
{
  return std::any_of(places.begin(), places.end(),
    [&](const Vector3& place) { return (p - place).squaredNorm() < radius * radius; });
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Attempt.h"

#include "Base/WorkCount.h"
#include "GridMap/PreviousMap.h"
#include "Pipeline/CoarsestMap.h"
#include "Pipeline/GuidedMap.h"
#include "Pipeline/Notices.h"
#include "Quads/QuadTopology.h"
#include "Requests/Guides.h"
#include "Requests/HeldVertices.h"
#include "Requests/StraightRequests.h"
#include "Transfer/ExpectedTurns.h"
#include "Transfer/PatchMender.h"
#include "Transfer/SurfaceStretch.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace quadrille
{
namespace
{

/// Of all that a map depends on.
ResultKey mapKey(const RunContext& run, const Plan& plan)
{
  const RemeshOptions& options = run.options;
  KeyMaker key(run.surface.key());
  key.add(run.edgeLength).add(plan.levelsKey());
  key.add(static_cast<std::uint64_t>(options.method))
    .add(static_cast<std::uint64_t>(options.decimationCost))
    .add(std::uint64_t{ options.coarsestIntegers ? 1U : 0U })
    .add(std::uint64_t{ options.distortionMetric ? 1U : 0U })
    .add(std::uint64_t{ options.warmStart ? 1U : 0U })
    .add(options.anisotropyLimit);
  addRequests(*run.surface, key);
  return key.key();
}

/// Of what a map has to share with an earlier one for a warm start.
ResultKey warmKey(const RunContext& run, const Plan& plan)
{
  return KeyMaker(run.surface.key())
    .add(run.edgeLength)
    .add(plan.quads)
    .add(run.options.anisotropyLimit)
    .add(std::uint64_t{ run.options.distortionMetric ? 1U : 0U })
    .key();
}

GridMapOptions mapOptions(RunContext& run, const Plan& plan, MapAttempt& made)
{
  const Hierarchy& levels = run.levels.hierarchy();
  GridMapOptions options;
  options.method = run.options.method;
  options.edgeLength = run.edgeLength;
  options.targetQuads = plan.quads;
  options.anisotropyLimit = run.options.anisotropyLimit;
  options.guides = levels.coarse.guides;
  options.targetValences =
    levelValences(*run.surface, levels.coarse.mesh, levels.coarse.fineVertex);
  options.sectorTurns = levelSectors(*run.surface, levels.coarse.mesh, levels.coarse.fineVertex);
  options.curves = run.surface->curves;
  options.seams = run.surface->seams;
  options.progress = subProgress(run.options.progress, 0.45, 0.8, "Mapping: ");
  if (run.options.distortionMetric) // on request
  {
    const double start = secondsNow();
    options.stretch = measureStretch(levels.intermediate, levels.coarse, levels.log).stretch;
    made.stages.add("metric", secondsNow() - start, levels.intermediate.mesh.faceCount(),
      levels.coarse.mesh.faceCount());
  }
  return options;
}

GridMapResult computeMap(RunContext& run, const Plan& plan, MapAttempt& made)
{
  const Level& coarse = run.levels.hierarchy().coarse;
  // Half of the quads at a straight part will lie outside.
  const bool isOutset = !run.surface->straight.empty();
  OutsetMesh outset;
  if (isOutset)
  {
    outset = withOutset(coarse.mesh, run.surface->straight, run.edgeLength / 2);
  }
  const Mesh& mesh = isOutset ? outset.mesh : coarse.mesh;
  GridMapOptions options = mapOptions(run, plan, made);
  options.straight = std::move(outset.requests);
  if (run.options.coarsestIntegers)
  {
    return computeCoarsestMap(mesh, options);
  }
  const bool remembers = run.store != nullptr && run.options.method == MapMethod::ScaleAware;
  const std::shared_ptr<PreviousMap> previous =
    remembers && run.options.warmStart ? run.store->find<PreviousMap>(warmKey(run, plan)) : nullptr;
  if (previous)
  {
    options.previous = previous.get();
    options.vertexIds = coarse.fineVertex;
  }
  GridMapResult map = computeGridMap(mesh, options);
  const auto reuseIf = [&](std::size_t components, const char* stage)
  {
    if (components > 0)
    {
      made.started.emplace_back(stage);
    }
  };
  reuseIf(map.reuse.seamless, "seamless");
  reuseIf(map.reuse.integers, "quantize");
  reuseIf(map.reuse.embedded, "embed");
  if (remembers && map.status.ok())
  {
    auto next = std::make_shared<PreviousMap>(previousMap(mesh, map, coarse.fineVertex));
    const std::size_t bytes = next->bytes();
    run.store->put(warmKey(run, plan), std::move(next), bytes);
  }
  return map;
}

/// What is left of a map on the coarse level.
void recordCoarse(
  const RunContext& run, const Hierarchy& levels, GridMapResult& map, MapAttempt& made)
{
  const std::size_t coarse = levels.coarse.mesh.faceCount();
  made.stages.add("field", map.secondsField, coarse, coarse);
  made.stages.add("seamless", map.secondsSeamless, coarse, coarse);
  made.stages.add("quantize", map.secondsQuantize, coarse, coarse);
  made.stages.add("embed", map.secondsEmbed, coarse, coarse);
  for (const std::string& notice : { levels.notice, refinementNotice(map.refinement) })
  {
    if (!notice.empty())
    {
      made.notices.push_back(notice);
    }
  }
  made.curves = map.curves;
  for (const Index v : map.curveOffenders)
  {
    made.curveOffenders.push_back(levels.coarse.fineVertex[v]);
  }
  made.coarse = levels.coarse;
  made.coarseUv = std::move(map.uv);
  const bool hasField =
    !map.field.turns.empty(); // there is none where the level is too large for one
  if (hasField)
  {
    made.coarseTurns = map.field.turns;
    made.coarseInteger = integerVertices(made.coarse.mesh, map.field);
    made.onFeatures = sectorsOf(
      made.coarse.mesh, map.field.sectorTurns, made.coarseInteger, made.coarse.fineVertex);
  }
  made.coarseCertificate = map.certificate;
  // Where features are held, more freedom is what helps, see Session.
  const bool isHeld = run.surface->regularOnFeatures && !map.status.ok();
  made.hopeless = isHeld || map.status.code == StatusCode::TooLarge ||
    (map.status.code == StatusCode::Infeasible && map.offenders.empty());
  if (!map.status.ok())
  {
    made.status = { map.status.code, "no valid map of the coarse mesh: " + map.status.message };
    made.collapsed = map.collapsedFaces > 0;
    made.coarseTroubles = positionsOf(levels.coarse.mesh, map.offenders);
    for (const Index v : map.offenders)
    {
      made.coarseOffenders.push_back(levels.coarse.fineVertex[v]);
    }
  }
}

/// Fills transfer, uv and certificate. False where nothing was carried.
bool carry(RunContext& run, bool alongGuides, MapAttempt& made)
{
  const Mesh& mesh = run.surface->mesh;
  const Hierarchy& levels = run.levels.hierarchy();
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
  made.stages.add("replay", secondsNow() - start, made.coarse.mesh.faceCount(), mesh.faceCount());
  start = secondsNow();
  made.certificate = certify(mesh, made.uv, made.turns, made.integerVertex, run.options.threads);
  made.stages.add("certify", secondsNow() - start, mesh.faceCount(), mesh.faceCount());
  return true;
}

/// A few places that the transfer could not mend, with the vertices of the level between.
void mendFewPlaces(RunContext& run, MapAttempt& made)
{
  const Mesh& mesh = run.surface->mesh;
  const double start = secondsNow();
  const MendResult mended =
    mendPatchesByLevels(mesh, made.uv, made.turns, run.levels.hierarchy().intermediate.fineVertex,
      run.options.threads, subProgress(run.options.progress, 0.8, 0.9, "Mapping back: "));
  made.transfer.mendedPatches += mended.patches;
  made.transfer.notPositive = mended.notPositive;
  std::vector<Index>& offenders = made.transfer.offenders;
  offenders.clear();
  for (const Index f : mended.defects)
  {
    offenders.insert(offenders.end(), &mesh.origin[3 * f], &mesh.origin[3 * f] + 3);
  }
  std::sort(offenders.begin(), offenders.end());
  offenders.erase(std::unique(offenders.begin(), offenders.end()), offenders.end());
  made.certificate = certify(mesh, made.uv, made.turns, made.integerVertex, run.options.threads);
  made.stages.add("replay", secondsNow() - start, made.coarse.mesh.faceCount(), mesh.faceCount());
}

void carryToSurface(RunContext& run, MapAttempt& made)
{
  const Mesh& mesh = run.surface->mesh;
  made.turns = expectedTurns(mesh, made.coarse, made.coarseTurns);
  made.integerVertex.assign(mesh.vertexCount(), 0);
  for (Index v = 0; v < made.coarseInteger.size(); ++v)
  {
    made.integerVertex[made.coarse.fineVertex[v]] = made.coarseInteger[v];
  }
  const bool guided = run.options.method == MapMethod::ScaleAware && carry(run, true, made);
  if (!guided || !made.certificate.valid())
  {
    carry(run, false, made);
    if (guided)
    {
      countTry(Try::WithoutGuides);
      countTryLed(Try::WithoutGuides, made.certificate.valid() ? 1 : 0);
    }
  }
  if (run.options.method == MapMethod::ScaleAware && !made.transfer.offenders.empty())
  {
    mendFewPlaces(run, made);
  }
  made.isCarried = true;
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

void keepMap(RunContext& run, MapAttempt& map)
{
  if (run.store == nullptr)
  {
    return;
  }
  std::vector<FixedVec2> uv = std::move(map.uv);
  map.uv = {};
  if (!uv.empty())
  {
    map.packed = PackedMap(run.surface->mesh, uv);
  }
  auto kept = std::make_shared<MapAttempt>(map);
  map.packed = {};
  map.uv = std::move(uv);
  const std::size_t bytes = kept->bytes();
  run.store->put(map.key, std::move(kept), bytes);
}

/// Names of what an attempt from the store has not computed.
std::shared_ptr<MapAttempt> asReused(const MapAttempt& found)
{
  auto map = std::make_shared<MapAttempt>(found);
  map->reused = { "phase1", "phase2" };
  for (const StageRecord& record : found.stages.all())
  {
    map->reused.push_back(record.stage);
  }
  map->started.clear();
  map->stages = {};
  return map;
}

/// A map that was interrupted is that of another run with the same allowance only.
ResultKey interruptedKey(ResultKey key, std::size_t allowance)
{
  return KeyMaker(key).add(std::uint64_t{ allowance }).key();
}

void interrupt(const Hierarchy& levels, std::size_t allowance, MapAttempt& made)
{
  made.key = interruptedKey(made.key, allowance);
  made.isInterrupted = true;
  made.hopeless = true; // more freedom would take longer
  made.work = allowance;
  made.coarse = levels.coarse;
  made.status = { StatusCode::NotConverged,
    "the map of the coarse mesh was not done within the work that a surface of this size is "
    "worth; ask for smaller quads, for fewer features (a larger feature angle, or none) or for "
    "fewer coarse vertices" };
}

std::shared_ptr<MapAttempt> makeCoarseMap(
  RunContext& run, const Plan& plan, ResultKey key, std::size_t allowance)
{
  auto made = std::make_shared<MapAttempt>();
  made->key = key;
  const Hierarchy& levels = run.levels.make(levelOptions(run, plan));
  made->stages.add(run.levels.stages());
  if (!made->stages.has("phase2"))
  {
    made->reused.emplace_back("phase2");
  }
  const double start = secondsNow();
  try
  {
    const WorkScope scope(allowance);
    GridMapResult map = computeMap(run, plan, *made);
    made->work = scope.done();
    recordCoarse(run, levels, map, *made);
  }
  catch (const WorkSpent&)
  {
    interrupt(levels, allowance, *made);
    const std::size_t faces = levels.coarse.mesh.faceCount();
    made->stages.add("interrupted", secondsNow() - start, faces, faces);
  }
  return made;
}

/// From the store, as a run without one would make it.
std::shared_ptr<MapAttempt> findMap(const RunContext& run, ResultKey key, std::size_t allowance)
{
  if (run.store == nullptr)
  {
    return nullptr;
  }
  const auto found = run.store->find<MapAttempt>(key);
  return found && found->work <= allowance
    ? found
    : run.store->find<MapAttempt>(interruptedKey(key, allowance));
}

/// Whether the levels are those of the map; they are made where they are not there.
bool hasLevelsOf(RunContext& run, const Plan& plan, const MapAttempt& map)
{
  run.levels.make(levelOptions(run, plan));
  return run.levels.hierarchy().coarse.fineVertex == map.coarse.fineVertex;
}

} // namespace

void addRequests(const PreparedSurface& surface, KeyMaker& key)
{
  for (const PolygonGuide& guide : surface.polygonGuides)
  {
    key.add(std::uint64_t{ guide.polygon }).add(double{ guide.weight });
    for (int i = 0; i < 3; ++i)
    {
      key.add(guide.direction[i]);
    }
  }
  for (const StrokeFace& guided : surface.strokeFaces)
  {
    key.add(std::uint64_t{ guided.face }).add(double{ guided.weight });
    for (int i = 0; i < 3; ++i)
    {
      key.add(guided.direction[i]);
    }
  }
  for (const ValenceRequest& request : surface.valenceRequests)
  {
    key.add(std::uint64_t{ request.vertex })
      .add(static_cast<std::uint64_t>(static_cast<std::int64_t>(request.valence)));
  }
  if (surface.regularElsewhere)
  {
    key.add(std::uint64_t{ 1 });
  }
  if (surface.regularOnFeatures)
  {
    key.add(std::uint64_t{ 2 }).add(std::uint64_t{ surface.sectorRequests.size() });
    for (const SectorRequest& request : surface.sectorRequests)
    {
      key.add(std::uint64_t{ request.vertex }).add(std::uint64_t{ request.sectors.size() });
      for (const HeldSector& sector : request.sectors)
      {
        key.add(sector.middle[0]).add(sector.middle[1]).add(sector.middle[2]);
        key.add(static_cast<std::uint64_t>(sector.turns));
      }
    }
  }
  for (const SeamRequest& seam : surface.seams)
  {
    key.add(std::uint64_t{ 4 });
    for (const Vector3& p : { seam.from, seam.to, seam.imageFrom, seam.imageTo })
    {
      key.add(p[0]).add(p[1]).add(p[2]);
    }
  }
  for (const StraightRequest& part : surface.straight)
  {
    key.add(std::uint64_t{ 5 });
    for (const Vector3& p : { part.from, part.via, part.to, part.outward })
    {
      key.add(p[0]).add(p[1]).add(p[2]);
    }
  }
  for (const CurveRequest& curve : surface.curves)
  {
    key.add(static_cast<std::uint64_t>(curve.kind) + 2).add(std::uint64_t{ curve.points.size() });
    for (const Vector3& p : curve.points)
    {
      key.add(p[0]).add(p[1]).add(p[2]);
    }
  }
}

std::size_t MapAttempt::defects() const
{
  return certificate.notPositive + certificate.wrongTurns + certificate.seamResiduals;
}

std::size_t MapAttempt::unmetCurves() const
{
  return static_cast<std::size_t>(std::count_if(
    curves.begin(), curves.end(), [](const CurveOutcome& curve) { return !curve.met; }));
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
    bytesOf(coarseUv) + bytesOf(uv) + packed.bytes() + bytesOf(turns) + bytesOf(integerVertex);
}

HierarchyOptions levelOptions(const RunContext& run, const Plan& plan)
{
  HierarchyOptions options;
  options.targetEdgeLength = plan.levels.edgeLength * run.edgeLength;
  options.coarseVertices = plan.levels.coarseVertices;
  options.cost = run.options.decimationCost;
  options.guides = surfaceGuides(*run.surface, run.options.threads).faces;
  options.keepVertices = plan.levels.keptVertices;
  options.isConnected = run.surface->components == 1;
  options.threads = run.options.threads;
  options.progress = subProgress(run.options.progress, 0.15, 0.45, "Decimating: ");
  return options;
}

std::shared_ptr<MapAttempt> makeMap(RunContext& run, const Plan& plan, std::size_t allowance)
{
  const TryScope tries;
  run.surface.apply(plan);
  const ResultKey key = mapKey(run, plan);
  const auto found = findMap(run, key, allowance);
  std::shared_ptr<MapAttempt> made =
    found ? asReused(*found) : makeCoarseMap(run, plan, key, allowance);
  const bool isDone = !made->status.ok() || made->isCarried || run.options.preview;
  if (!isDone && hasLevelsOf(run, plan, *made))
  {
    carryToSurface(run, *made);
    tellOfRounding(run.options.method, *made);
  }
  else if (!isDone)
  {
    // Levels that were made again may be others than those that a preview has left a map of.
    made = makeCoarseMap(run, plan, key, allowance);
    if (made->status.ok())
    {
      carryToSurface(run, *made);
      tellOfRounding(run.options.method, *made);
    }
  }
  made->tries.add(tries.counts());
  if (!found || made->isCarried != found->isCarried)
  {
    keepMap(run, *made);
  }
  return made;
}

std::optional<GridTroubles> gridTroubles(const RunContext& run, const MapAttempt& map)
{
  if (map.coarseUv.empty() || !map.coarseCertificate.valid())
  {
    return std::nullopt;
  }
  ExtractionOptions options;
  options.maximumNumberOfQuads = run.options.maximumNumberOfQuads;
  options.smoothingSteps = 0;
  options.threads = run.options.threads;
  const ExtractionResult coarse = extractQuads(map.coarse.mesh, map.coarseUv, options);
  if (coarse.status.ok() || coarse.status.code == StatusCode::TooLarge)
  {
    return std::nullopt;
  }
  const QuadTopology topology = analyzeQuads(coarse.mesh.quads, coarse.mesh.points.size());
  GridTroubles troubles;
  troubles.defects = coarse.droppedFaces + topology.nonManifoldEdges +
    topology.nonManifoldVertices + topology.degenerateQuads;
  for (const Index p : topology.offendingPoints)
  {
    troubles.places.push_back(coarse.mesh.points[p]);
  }
  return troubles;
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

bool isNear(const Vector3& p, const std::vector<Vector3>& places, double radius)
{
  return std::any_of(places.begin(), places.end(),
    [&](const Vector3& place) { return (p - place).squaredNorm() < radius * radius; });
}

} // namespace quadrille

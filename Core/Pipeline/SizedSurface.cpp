// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SizedSurface.h"

#include "Base/Clock.h"
#include "Base/Lists.h"
#include "Base/Memory.h"
#include "Base/Progress.h"
#include "Features/CreaseCurves.h"
#include "Features/FeatureFilter.h"
#include "Features/Fillets.h"
#include "Mesh/ContentHash.h"
#include "Mesh/Sizing.h"
#include "Pipeline/DrawnOnSurface.h"
#include "Pipeline/Notices.h"
#include "Pipeline/PlannedSurface.h"
#include "Pipeline/QuadsOfShape.h"
#include "Prepare/Frame.h"
#include "Prepare/Prepare.h"
#include "Prepare/Refine.h"
#include "Prepare/RepairText.h"
#include "Requests/DrawnLines.h"
#include "Requests/Guides.h"
#include "Requests/HeldVertices.h"
#include "Sizes/CurvatureGuides.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

/// A prepared surface in the store, without requests.
struct StoredPrepared
{
  PreparedSurface surface;
  double sizedArea = 0;
  std::vector<std::string> notices; ///< on what is drawn on it
};

/// A sized one. The number of quads is that of the limited sizes, where an edge length was asked for.
struct StoredSized : SizeReport
{
  PreparedSurface surface;
};

ResultKey preparedKey(ResultKey inputHash, const RemeshOptions& options)
{
  return KeyMaker(inputHash).add(options.featureAngle.value_or(0)).key();
}

/// surface: prepared.
ResultKey sizedKey(ResultKey prepared, const PreparedSurface& surface, const RemeshOptions& options,
  const SizedSurface& sized)
{
  // Of details only components are taken out before the surface is sized.
  const bool mayDrop = maySimplify(options) && surface.components > 1;
  KeyMaker key(prepared);
  key.add(sized.edgeLength, judgesCreases(options), options.smallestDetail,
    options.removeSmallComponents, mayDrop, mayDrop ? sized.targetQuads : 0);
  if (options.sizes.any())
  {
    const AdaptiveSizes& sizes = options.sizes;
    key.add(sizes.chordError.value_or(0), sizes.turn.value_or(0), sizes.gapQuads, sizes.smallest,
      sizes.largest, options.quads.has_value());
  }
  return key.key();
}

/// Repaired, in order and with features. What only placeHeld needs is left of the input.
PreparedSurface prepareInput(SurfaceInput& input, const RemeshOptions& options,
  const ProgressCallback& progress, StageRecords& stages)
{
  PrepareOptions prepareOptions;
  prepareOptions.featureAngle = options.featureAngle;
  prepareOptions.threads = options.threads;
  prepareOptions.progress = progress;
  const std::size_t polygons = input.polygonOffsets.empty() ? 0 : input.polygonOffsets.size() - 1;
  SurfaceInput later;
  later.held = input.held;
  later.drawn = input.drawn;
  later.sizingOrders = input.sizingOrders;
  PreparedSurface surface = prepareSurface(std::move(input), prepareOptions);
  input = std::move(later);
  releaseFreedMemory();
  for (const auto& [name, seconds] : surface.seconds)
  {
    stages.add(name, seconds, polygons, surface.mesh.faceCount());
  }
  return surface;
}

/// On the features as they are to stay, unlike the other requests.
void placeHeld(const SurfaceInput& input, PreparedSurface& surface)
{
  surface.sectorRequests = placeHeldVertices(input, surface);
}

bool refuseTooMany(const RemeshOptions& options, SizedSurface& sized)
{
  if (sized.targetQuads <= options.maximumNumberOfQuads)
  {
    return false;
  }
  sized.status = { StatusCode::TooLarge,
    "ask for fewer quads, or raise the limit (Maximum Number Of Quads, --maximum-quads): about " +
      std::to_string(sized.targetQuads) + " quads would be made, more than the limit of " +
      std::to_string(options.maximumNumberOfQuads) };
  return true;
}

/// surface: prepared, without requests; sized afterwards, with them. False where the store does not have it.
bool recallSized(const SurfaceInput& input, const RemeshOptions& options, ResultStore& store,
  PreparedSurface& surface, SizedSurface& sized)
{
  const auto found = store.find<StoredSized>(sized.key);
  if (!found || (!options.quads && found->targetQuads > options.maximumNumberOfQuads))
  {
    return false;
  }
  surface = found->surface;
  collectRequests(input, surface, options.threads);
  static_cast<SizeReport&>(sized) = *found;
  sized.targetQuads = options.quads.value_or(found->targetQuads);
  sized.reused.emplace_back("refine");
  refuseTooMany(options, sized);
  return true;
}

/// Triangles that refinement left as they were are shared, and count once.
void keepSized(std::shared_ptr<StoredPrepared> prepared, ResultKey preparedAt,
  const PreparedSurface& surface, ResultStore& store, const SizedSurface& sized)
{
  auto stored = std::make_shared<StoredSized>();
  static_cast<SizeReport&>(*stored) = sized;
  stored->surface = surface;
  stored->surface.setRequests({});
  const std::size_t bytes =
    bytesOf(stored->surface, &prepared->surface) + bytesOf(stored->givenUpFeatures);
  const std::size_t bytesPrepared = bytesOf(prepared->surface);
  store.put(preparedAt, std::move(prepared), bytesPrepared);
  store.put(sized.key, std::move(stored), bytes);
}

/// The edge length stays; where the number of quads was asked for, it is met by the scale of the map.
void limitSizes(PreparedSurface& surface, const RemeshOptions& options, SizedSurface& sized)
{
  const SizingReport limited = limitSizeGrowth(surface.mesh, sized.edgeLength);
  tell({ sizingNotice(surface.mesh, limited) }, sized.notices);
  if (limited.changed > 0 && !options.quads)
  {
    sized.targetQuads = predictedQuads(areaOverSizes(surface), sized.edgeLength);
  }
}

/// What a step has unmarked, where it did; `before` becomes what it has left.
void noteGivenUp(FeatureLoss reason, std::size_t removed, const Mesh& mesh,
  std::vector<std::uint8_t>& before, SizedSurface& sized)
{
  const std::vector<Index> lost = removed > 0 ? lostFeatures(mesh, before) : std::vector<Index>{};
  if (!lost.empty())
  {
    const std::vector<GivenUpCurve> curves = givenUpCurves(mesh, lost, sized.edgeLength, reason);
    sized.givenUpFeatures.insert(sized.givenUpFeatures.end(), curves.begin(), curves.end());
    before = mesh.flags;
  }
}

void filterFeatures(PreparedSurface& surface, const RemeshOptions& options, SizedSurface& sized)
{
  Mesh& mesh = surface.mesh;
  std::vector<std::uint8_t> before = mesh.flags;
  FeatureFilterReport filtered =
    removeUnresolvedFeatures(mesh, options.smallestDetail * sized.edgeLength, options.threads);
  noteGivenUp(FeatureLoss::Unresolved, filtered.removedEdges, mesh, before, sized);
  CreaseReport creases;
  if (judgesCreases(options) && !surface.facets.isDesigned)
  {
    creases = removeFalseCreases(mesh, sized.edgeLength, options.threads, filtered);
    noteGivenUp(FeatureLoss::NoCrease, creases.removedEdges, mesh, before, sized);
  }
  tell({ featureNotice(filtered), creases.text() }, sized.notices);
}

/// Where a designed body is sharp at the scale of the quads, they have an edge, too. Short ends of such lines go as
/// those of sharp edges do.
void followFillets(PreparedSurface& surface, const RemeshOptions& options, SizedSurface& sized)
{
  if (!options.featureAngle || !judgesCreases(options) || !surface.facets.isDesigned)
  {
    return;
  }
  Mesh& mesh = surface.mesh;
  const std::vector<Index> fillets =
    markFillets(mesh, *options.featureAngle, sized.edgeLength, options.threads);
  if (!fillets.empty())
  {
    removeUnresolvedFeatures(mesh, options.smallestDetail * sized.edgeLength, options.threads);
    tell({ filletNotice(mesh, fillets, sized.edgeLength) }, sized.notices);
  }
}

/// Without small components and features that quads cannot resolve, in triangles no larger than quads.
void refine(PreparedSurface& surface, const RemeshOptions& options, SizedSurface& sized)
{
  const double start = secondsNow();
  const std::size_t before = surface.mesh.faceCount();
  tell({ dropSmallComponents(surface, options, sized) }, sized.notices);
  tell({ surface.facets.text() }, sized.notices);
  filterFeatures(surface, options, sized);
  followFillets(surface, options, sized);
  refineSurface(surface, sized.edgeLength, subProgress(options.progress, 0.1, 0.15, "Refining: "),
    options.threads);
  sized.stages.add("refine", secondsNow() - start, before, surface.mesh.faceCount());
  tell({ surface.notice }, sized.notices);
}

/// From the prepared surface with its requests to the sized one.
void sizePreparedSurface(
  PreparedSurface& surface, const RemeshOptions& options, SizedSurface& sized)
{
  if (options.sizes.any())
  {
    tell({ adaptSizes(surface, options, sized) }, sized.notices);
  }
  else
  {
    limitSizes(surface, options, sized);
  }
  if (!refuseTooMany(options, sized))
  {
    refine(surface, options, sized);
  }
}

void setTarget(double sizedArea, double diagonal, const RemeshOptions& options, SizedSurface& sized)
{
  sized.edgeLength = targetEdgeLength(options, sizedArea, diagonal);
  sized.targetQuads = options.quads.value_or(predictedQuads(sizedArea, sized.edgeLength));
}

void guideByCurvature(PreparedSurface& surface, const RemeshOptions& options, SizedSurface& sized)
{
  if (!options.curvatureGuides)
  {
    return;
  }
  const double start = secondsNow();
  const std::size_t guided =
    addCurvatureGuides(surface, sized.edgeLength, *options.curvatureGuides, options.threads);
  sized.stages.add("guides", secondsNow() - start, surface.mesh.faceCount(), guided);
  tell({ std::to_string(guided) + " polygons are guided by the curvature of the surface" },
    sized.notices);
}

/// What does not depend on whether the store had the surface.
SizedSurface finished(
  PreparedSurface surface, const RemeshOptions& options, ResultStore* store, SizedSurface sized)
{
  if (sized.status.ok())
  {
    placeStrokes(surface, sized.edgeLength, options.threads);
    guideByCurvature(surface, options, sized);
    tell(requestNotices(surface, surfaceGuides(surface, options.threads)), sized.notices);
    for (const std::string& sentence : repairSentences(surface.repair))
    {
      tell({ "input: " + sentence }, sized.notices);
    }
  }
  sized.surface = std::make_shared<const PreparedSurface>(std::move(surface));
  if (sized.status.ok())
  {
    countBlocks(sized, options, store);
  }
  return sized;
}

/// Features that are cleared or drawn, on the sized surface: its triangles are no larger than quads, and their parts
/// neither.
void addFeatures(const DrawnRequests& drawn, const RemeshOptions& options, PreparedSurface& surface,
  SizedSurface& sized)
{
  const bool draws = !drawn.features.empty() || hasLines(surface.curves);
  if (!draws && drawn.cleared.empty())
  {
    return;
  }
  const double start = secondsNow();
  const std::size_t before = surface.mesh.faceCount();
  clearDrawn(surface, drawn.cleared, sized.edgeLength, sized.notices);
  drawFeatures(surface, drawn.features, sized.edgeLength, options.threads, sized.notices);
  filterFeatures(surface, options, sized);
  splitEnclosedFaces(surface);
  splitChords(surface);
  surface.hash = contentHash(surface.mesh, options.threads);
  sized.key = KeyMaker(sized.key).add(surface.hash).key();
  sized.stages.add("draw", secondsNow() - start, before, surface.mesh.faceCount());
}

/// Valences at places and at the ends of connections, on the sized surface.
void addValences(const std::vector<ValencePlace>& valences, const RemeshOptions& options,
  PreparedSurface& surface, SizedSurface& sized)
{
  const int threads = options.threads;
  if (drawValences(surface, withEnds(surface, valences, sized.edgeLength, threads),
        sized.edgeLength, threads, sized.notices))
  {
    sized.key = KeyMaker(sized.key).add(surface.hash).key();
  }
}

/// Features, held vertices and valences, on the sized surface.
void addDrawn(const SurfaceInput& input, const RemeshOptions& options, PreparedSurface& surface,
  SizedSurface& sized)
{
  if (sized.status.ok())
  {
    addFeatures(input.drawn, options, surface, sized);
    placeHeld(input, surface);
    addValences(input.drawn.valences, options, surface, sized);
  }
}

/// The prepared surface that a run begins with, and where it is stored; stored: null where it was made.
struct PreparedOfRun
{
  PreparedSurface surface; ///< without requests where it is stored
  double sizedArea = 0;
  ResultKey key = 0;
  std::shared_ptr<StoredPrepared> stored;
};

std::shared_ptr<StoredPrepared> withoutRequests(
  const PreparedOfRun& prepared, const std::vector<std::string>& notices)
{
  auto stored = std::make_shared<StoredPrepared>(
    StoredPrepared{ prepared.surface, prepared.sizedArea, notices });
  stored->surface.setRequests({});
  return stored;
}

PreparedOfRun findOrPrepare(
  SurfaceInput& input, const RemeshOptions& options, const KnownInput& known, SizedSurface& sized)
{
  PreparedOfRun prepared;
  prepared.key = preparedKey(known.inputHash, options);
  prepared.stored = findIn<StoredPrepared>(known.store, prepared.key);
  if (prepared.stored)
  {
    prepared.surface = prepared.stored->surface;
    prepared.sizedArea = prepared.stored->sizedArea;
    sized.reused = { "repair", "order", "connectivity" };
    return prepared;
  }
  prepared.surface = prepareInput(
    input, options, subProgress(options.progress, 0.0, 0.1, "Preparing: "), sized.stages);
  prepared.sizedArea = areaOverSizes(prepared.surface);
  return prepared;
}

/// Sizes that are drawn become those of the prepared surface. How fine that has to be follows from the quads.
void addSizes(const SurfaceInput& input, double edgeLength, const RemeshOptions& options,
  PreparedSurface& surface, SizedSurface& sized)
{
  const double start = secondsNow();
  const std::size_t before = surface.mesh.faceCount();
  drawSizes(surface, input, edgeLength, options.threads, sized.notices);
  sized.stages.add("draw", secondsNow() - start, before, surface.mesh.faceCount());
}

/// The same where the store may have it.
void findOrAddSizes(const SurfaceInput& input, const RemeshOptions& options, ResultStore* store,
  PreparedOfRun& prepared, SizedSurface& sized)
{
  const double edgeLength =
    targetEdgeLength(options, prepared.sizedArea, prepared.surface.boundingBoxDiagonal);
  if (store != nullptr && !prepared.stored)
  {
    const std::shared_ptr<StoredPrepared> plain = withoutRequests(prepared, {});
    const std::size_t bytes = bytesOf(plain->surface);
    store->put(prepared.key, plain, bytes); // for runs that draw something else
  }
  prepared.key = drawnKey(prepared.key, input, edgeLength);
  if (const auto drawn = findIn<StoredPrepared>(store, prepared.key))
  {
    prepared.stored = drawn;
    prepared.surface = drawn->surface;
    prepared.sizedArea = drawn->sizedArea;
    sized.notices = drawn->notices;
    return;
  }
  if (prepared.stored)
  {
    collectRequests(input, prepared.surface, options.threads);
    prepared.stored.reset();
  }
  addSizes(input, edgeLength, options, prepared.surface, sized);
  prepared.sizedArea = areaOverSizes(prepared.surface);
}

} // namespace

bool judgesCreases(const RemeshOptions& options)
{
  return options.featureAngle && options.featureCriterion == FeatureCriterion::Creases;
}

double targetEdgeLength(const RemeshOptions& options, double sizedArea, double boundingBoxDiagonal)
{
  if (options.quads)
  {
    return roundedLength(std::sqrt(sizedArea / static_cast<double>(*options.quads)));
  }
  return options.edgeLength ? *options.edgeLength
                            : roundedLength(options.relativeEdgeLength * boundingBoxDiagonal);
}

std::size_t predictedQuads(double sizedArea, double edgeLength)
{
  const double quads = sizedArea / (edgeLength * edgeLength);
  return static_cast<std::size_t>(std::max(1.0, std::min(quads, 1e15)));
}

bool isPrepared(const KnownInput& known, const RemeshOptions& options)
{
  return findIn<StoredPrepared>(known.store, preparedKey(known.inputHash, options)) != nullptr;
}

SizedSurface sizeSurface(SurfaceInput& input, const RemeshOptions& given, const KnownInput& known)
{
  SizedSurface sized;
  ResultStore* store = known.store;
  PreparedOfRun prepared = findOrPrepare(input, given, known, sized);
  RemeshOptions options = given;
  const std::string ofNumber =
    settleQuads(prepared.surface, prepared.sizedArea, store, prepared.key, options);
  if (!input.drawn.sizes.empty())
  {
    findOrAddSizes(input, options, store, prepared, sized);
  }
  PreparedSurface& surface = prepared.surface;
  setTarget(prepared.sizedArea, surface.boundingBoxDiagonal, options, sized);
  sized.key = sizedKey(prepared.key, surface, options, sized);
  if (!prepared.stored || !recallSized(input, options, *store, surface, sized))
  {
    std::shared_ptr<StoredPrepared> stored = prepared.stored;
    if (stored)
    {
      collectRequests(input, surface, options.threads);
    }
    else if (store != nullptr)
    {
      stored = withoutRequests(prepared, sized.notices);
    }
    sizePreparedSurface(surface, options, sized);
    if (sized.status.ok() && store != nullptr)
    {
      keepSized(std::move(stored), prepared.key, surface, *store, sized);
    }
  }
  addDrawn(input, options, surface, sized);
  input = {};
  tell({ ofNumber }, sized.notices); // not before: what is stored may be of a number that was given
  return finished(std::move(surface), options, store, std::move(sized));
}

PreparedSurface prepareDrawn(SurfaceInput& input, RemeshOptions& options,
  const ProgressCallback& progress, SizedSurface& sized)
{
  PreparedSurface surface = prepareInput(input, options, progress, sized.stages);
  tell({ settleQuads(surface, areaOverSizes(surface), nullptr, 0, options) }, sized.notices);
  const double edgeLength =
    targetEdgeLength(options, areaOverSizes(surface), surface.boundingBoxDiagonal);
  drawFeatures(surface, input.drawn.features, edgeLength, options.threads, sized.notices);
  if (!input.drawn.sizes.empty())
  {
    addSizes(input, edgeLength, options, surface, sized);
  }
  return surface;
}

SizedSurface sizePrepared(PreparedSurface surface, const DrawnRequests& drawn,
  const RemeshOptions& options, SizedSurface sized)
{
  setTarget(areaOverSizes(surface), surface.boundingBoxDiagonal, options, sized);
  sized.key = sizedKey(preparedKey(0, options), surface, options, sized);
  sizePreparedSurface(surface, options, sized);
  if (sized.status.ok())
  {
    if (!drawn.cleared.empty())
    {
      clearDrawn(surface, drawn.cleared, sized.edgeLength, sized.notices);
      surface.hash = contentHash(surface.mesh, options.threads);
    }
    addValences(drawn.valences, options, surface, sized);
  }
  return finished(std::move(surface), options, nullptr, std::move(sized));
}

} // namespace quadrille

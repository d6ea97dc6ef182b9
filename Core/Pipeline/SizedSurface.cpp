// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/SizedSurface.h"

#include "Base/Clock.h"
#include "Base/Memory.h"
#include "Features/CreaseCurves.h"
#include "Features/FeatureFilter.h"
#include "Features/FeatureNetwork.h"
#include "Mesh/ContentHash.h"
#include "Mesh/Sizing.h"
#include "Pipeline/Notices.h"
#include "Pipeline/SmallBlocks.h"
#include "Pipeline/SmallHandles.h"
#include "Pipeline/SurfaceSizes.h"
#include "Prepare/Frame.h"
#include "Prepare/Prepare.h"
#include "Prepare/Refine.h"
#include "Prepare/RepairText.h"
#include "Requests/Guides.h"
#include "Requests/HeldVertices.h"
#include "Requests/InsertPlaces.h"
#include "Sizes/CurvatureGuides.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
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
  std::vector<std::string> drawnNotices; ///< on what is drawn on it
};

/// A sized one. The number of quads is that of the limited sizes, where an edge length was asked for.
struct StoredSized
{
  PreparedSurface surface;
  bool hasRequests = false; ///< moved by what closed handles
  double edgeLength = 0;    ///< s; adaptive sizes change it where a number of quads is asked for
  std::size_t targetQuads = 0;
  std::vector<std::string> notices;
  std::vector<GivenUpCurve> givenUpFeatures;
  std::vector<SmallDetail> details;
};

void addPlace(const Vector3& p, KeyMaker& key)
{
  key.add(p[0]).add(p[1]).add(p[2]);
}

/// Of what is drawn that changes the triangles and sizes of the surface, whatever the size of quads makes of it.
ResultKey drawnKey(const SurfaceInput& input, ResultKey prepared, double edgeLength)
{
  const DrawnRequests& drawn = input.drawn;
  if (drawn.features.empty() && drawn.sizes.empty())
  {
    return prepared;
  }
  KeyMaker key(prepared);
  key.add(edgeLength);
  for (const FeatureRequest& feature : drawn.features)
  {
    key.add(std::uint64_t{ feature.points.size() });
    for (const Vector3& p : feature.points)
    {
      addPlace(p, key);
    }
  }
  for (const SizeRequest& size : drawn.sizes)
  {
    addPlace(size.place, key);
    key.add(size.radius).add(size.factor).add(static_cast<std::uint64_t>(size.order));
  }
  return key.add(input.sizingOrders).key();
}

/// Orders of sizes of points, at the vertices that they became.
std::vector<int> sizingOrdersOf(const std::vector<int>& orders, const PreparedSurface& surface)
{
  std::vector<int> result;
  if (!orders.empty())
  {
    result.assign(surface.mesh.vertexCount(), 0);
    for (Index h = 0; h < surface.mesh.halfEdgeCount(); ++h)
    {
      int& order = result[surface.mesh.origin[h]];
      order = std::max(order, orders[surface.sourcePoints[Mesh::face(h)][h % 3]]);
    }
  }
  return result;
}

/// Of guides, valences and curves, where closed handles move their corners.
ResultKey requestsKey(const SurfaceInput& input)
{
  KeyMaker key;
  for (const ValencePlace& asked : input.drawn.valences)
  {
    addPlace(asked.place, key);
    key.add(static_cast<std::uint64_t>(asked.valence));
  }
  for (const StrokeRequest& stroke : input.drawn.strokes)
  {
    for (const Vector3& p : stroke.points)
    {
      addPlace(p, key);
    }
    key.add(stroke.weight).add(stroke.radius).add(static_cast<std::uint64_t>(stroke.order));
  }
  for (const Vector3& direction : input.guideDirections)
  {
    key.add(direction[0]).add(direction[1]).add(direction[2]);
  }
  for (const CurveRequest& curve : input.curves)
  {
    key.add(static_cast<std::uint64_t>(curve.kind));
    for (const Vector3& p : curve.points)
    {
      key.add(p[0]).add(p[1]).add(p[2]);
    }
  }
  for (const HeldVertex& vertex : input.held)
  {
    key.add(std::uint64_t{ vertex.point }).add(std::uint64_t{ vertex.sectors.size() });
    key.add(vertex.place[0]).add(vertex.place[1]).add(vertex.place[2]);
    for (const HeldSector& sector : vertex.sectors)
    {
      key.add(sector.middle[0]).add(sector.middle[1]).add(sector.middle[2]);
      key.add(static_cast<std::uint64_t>(sector.turns));
    }
  }
  if (input.regularOnFeatures)
  {
    key.add(std::uint64_t{ 2 });
  }
  for (const SeamRequest& seam : input.seams)
  {
    key.add(std::uint64_t{ 4 });
    for (const Vector3& p : { seam.from, seam.to, seam.imageFrom, seam.imageTo })
    {
      key.add(p[0]).add(p[1]).add(p[2]);
    }
  }
  for (const StraightRequest& part : input.straight)
  {
    key.add(std::uint64_t{ 5 });
    for (const Vector3& p : { part.from, part.via, part.to, part.outward })
    {
      key.add(p[0]).add(p[1]).add(p[2]);
    }
  }
  return key.add(input.guideWeights)
    .add(input.targetValences)
    .add(std::uint64_t{ input.regularElsewhere ? 1U : 0U })
    .key();
}

ResultKey preparedKey(ResultKey inputHash, const RemeshOptions& options)
{
  return KeyMaker(inputHash).add(options.featureAngle.value_or(0)).key();
}

class SurfaceSizing
{
public:
  SurfaceSizing(SurfaceInput& input, const RemeshOptions& options, const KnownInput& known)
    : input_(input), options_(options), store_(known.store),
      preparedKey_(preparedKey(known.inputHash, options)), drawnKey_(preparedKey_)
  {
  }

  SizedSurface run()
  {
    prepare();
    drawOn();
    return sizeAll();
  }

  SizedSurface run(PreparedSurface surface, const StageRecords& stages)
  {
    surface_ = std::move(surface);
    made_.stages = stages;
    measure();
    return sizeAll();
  }

private:
  SizedSurface sizeAll()
  {
    made_.edgeLength = targetEdgeLength(options_, sizedArea_, diagonal_);
    made_.targetQuads =
      options_.quads ? *options_.quads : predictedQuads(sizedArea_, made_.edgeLength);
    if (!findSized())
    {
      size();
    }
    if (made_.status.ok())
    {
      insertPlaces();
      placeStrokes(surface_, options_.threads);
      guideByCurvature();
      tellRequests();
    }
    input_ = {};
    made_.surface = std::make_shared<const PreparedSurface>(std::move(surface_));
    if (made_.status.ok())
    {
      countBlocks(made_, options_, store_);
    }
    return std::move(made_);
  }

  void measure()
  {
    sizedArea_ = areaOverSizes(surface_);
    diagonal_ = surface_.boundingBoxDiagonal;
  }

  void tell(const std::string& notice)
  {
    if (!notice.empty())
    {
      made_.notices.push_back(notice);
    }
  }

  void reuse(std::initializer_list<const char*> stages)
  {
    made_.reused.insert(made_.reused.end(), stages.begin(), stages.end());
  }

  void prepare()
  {
    if (store_ != nullptr)
    {
      if ((prepared_ = store_->find<StoredPrepared>(preparedKey_)))
      {
        surface_ = prepared_->surface;
        sizedArea_ = prepared_->sizedArea;
        diagonal_ = surface_.boundingBoxDiagonal;
        reuse({ "repair", "order", "connectivity" });
        return;
      }
    }
    PrepareOptions prepareOptions;
    prepareOptions.featureAngle = options_.featureAngle;
    prepareOptions.threads = options_.threads;
    prepareOptions.progress = subProgress(options_.progress, 0.0, 0.1, "Preparing: ");
    requestsKey_ = options_.closeHandles > 0 ? requestsKey(input_) : 0;
    const std::size_t polygons =
      input_.polygonOffsets.empty() ? 0 : input_.polygonOffsets.size() - 1;
    surface_ = prepareSurface(std::move(input_), prepareOptions);
    SurfaceInput later; // what placeHeld still needs
    later.held = std::move(input_.held);
    later.drawn = std::move(input_.drawn);
    later.sizingOrders = std::move(input_.sizingOrders);
    input_ = std::move(later);
    releaseFreedMemory();
    for (const auto& [name, seconds] : surface_.seconds)
    {
      made_.stages.add(name, seconds, polygons, surface_.mesh.faceCount());
    }
    measure();
  }

  /// Feature curves and sizes, as part of the prepared surface. How fine that has to be follows from the quads.
  void drawOn()
  {
    if (input_.drawn.features.empty() && input_.drawn.sizes.empty())
    {
      return;
    }
    const InsertionOptions insertion{ targetEdgeLength(options_, sizedArea_, diagonal_),
      options_.threads };
    drawnKey_ = drawnKey(input_, preparedKey_, insertion.edgeLength);
    keepPrepared();
    const auto known = store_ != nullptr ? store_->find<StoredPrepared>(drawnKey_) : nullptr;
    if (known)
    {
      prepared_ = known;
      surface_ = known->surface;
      sizedArea_ = known->sizedArea;
      made_.notices.insert(
        made_.notices.end(), known->drawnNotices.begin(), known->drawnNotices.end());
      return;
    }
    const double start = secondsNow();
    if (prepared_)
    {
      requestsKey_ = options_.closeHandles > 0 ? requestsKey(input_) : 0;
      collectRequests(input_, surface_, options_.threads);
      prepared_.reset();
    }
    const std::size_t before = surface_.mesh.faceCount();
    const std::size_t verticesBefore = surface_.mesh.vertexCount();
    surface_.featurePaths =
      insertFeatures(surface_, input_.drawn.features, insertion, drawnNotices_);
    insertSizes(
      surface_, input_.drawn.sizes, sizingOrdersOf(input_.sizingOrders, surface_), insertion);
    surface_.hash = contentHash(surface_.mesh, options_.threads);
    measure();
    tellAdded(surface_.mesh.vertexCount() - verticesBefore, drawnNotices_);
    made_.notices.insert(made_.notices.end(), drawnNotices_.begin(), drawnNotices_.end());
    made_.stages.add("draw", secondsNow() - start, before, surface_.mesh.faceCount());
  }

  static void tellAdded(std::size_t vertices, std::vector<std::string>& notices)
  {
    if (vertices > 0)
    {
      notices.push_back(std::to_string(vertices) +
        " vertices were added to the triangles where constraints lie; the shape stays as it is");
    }
  }

  /// The surface without what is drawn on it, for the next run.
  void keepPrepared()
  {
    if (store_ != nullptr && !prepared_)
    {
      auto prepared = std::make_shared<StoredPrepared>(StoredPrepared{ surface_, sizedArea_, {} });
      prepared->surface.setRequests({});
      const std::size_t bytes = bytesOf(prepared->surface);
      store_->put(preparedKey_, std::move(prepared), bytes);
    }
  }

  /// Valences at places, on the triangles as they are to stay.
  void insertPlaces()
  {
    if (input_.drawn.valences.empty())
    {
      return;
    }
    const Index before = surface_.mesh.faceCount();
    const Index verticesBefore = surface_.mesh.vertexCount();
    const InsertionOptions insertion{ made_.edgeLength, options_.threads };
    const InsertedValences inserted = insertValences(surface_, input_.drawn.valences, insertion);
    made_.notices.insert(made_.notices.end(), inserted.notices.begin(), inserted.notices.end());
    if (inserted.splitConstraint)
    {
      splitChords(surface_);
    }
    if (surface_.mesh.faceCount() != before)
    {
      tellAdded(surface_.mesh.vertexCount() - verticesBefore, made_.notices);
      surface_.hash = contentHash(surface_.mesh, options_.threads);
      made_.key = KeyMaker(made_.key).add(surface_.hash).key();
    }
  }

  bool findSized()
  {
    if (prepared_)
    {
      requestsKey_ = options_.closeHandles > 0 ? requestsKey(input_) : 0;
    }
    // Of details only components are taken out before the surface is sized.
    const bool mayDrop = maySimplify(options_) && surface_.components > 1;
    made_.key = KeyMaker(drawnKey_)
                  .add(made_.edgeLength)
                  .add(std::uint64_t{ judgesCreases(options_) ? 1U : 0U })
                  .add(options_.closeHandles)
                  .add(requestsKey_)
                  .add(std::uint64_t{ options_.removeSmallComponents ? 1U : 0U })
                  .add(std::uint64_t{ mayDrop ? 1U : 0U })
                  .add(std::uint64_t{ mayDrop ? made_.targetQuads : 0 })
                  .key();
    if (options_.sizes.any())
    {
      const AdaptiveSizes& sizes = options_.sizes;
      made_.key = KeyMaker(made_.key)
                    .add(sizes.chordError.value_or(0))
                    .add(sizes.gapQuads)
                    .add(sizes.smallest)
                    .add(sizes.largest)
                    .add(std::uint64_t{ options_.quads ? 1U : 0U })
                    .key();
    }
    const auto found = prepared_ ? store_->find<StoredSized>(made_.key) : nullptr;
    if (!found || (!options_.quads && found->targetQuads > options_.maximumNumberOfQuads))
    {
      return false;
    }
    surface_ = found->surface;
    if (!found->hasRequests)
    {
      collectRequests(input_, surface_, options_.threads);
      placeHeld();
    }
    made_.edgeLength = found->edgeLength;
    made_.targetQuads = options_.quads ? *options_.quads : found->targetQuads;
    made_.notices = found->notices; // those on what is drawn among them
    made_.givenUpFeatures = found->givenUpFeatures;
    made_.details = found->details;
    reuse({ "refine" });
    return !refuseTooMany();
  }

  void size()
  {
    auto prepared = prepared_;
    if (prepared)
    {
      collectRequests(input_, surface_, options_.threads);
    }
    else if (store_ != nullptr)
    {
      prepared =
        std::make_shared<StoredPrepared>(StoredPrepared{ surface_, sizedArea_, drawnNotices_ });
      prepared->surface.setRequests({});
    }
    if (options_.sizes.any())
    {
      tell(adaptSizes(surface_, options_, made_));
    }
    else
    {
      limitSizes();
    }
    if (refuseTooMany())
    {
      return;
    }
    refine();
    placeHeld();
    if (store_ != nullptr)
    {
      keep(prepared);
    }
  }

  /// On the triangles as they are to stay, unlike the other requests.
  void placeHeld() { surface_.sectorRequests = placeHeldVertices(input_, surface_); }

  /// Triangles that refinement left as they were are shared, and count once.
  void keep(const std::shared_ptr<StoredPrepared>& prepared)
  {
    auto sized = std::make_shared<StoredSized>();
    sized->surface = surface_;
    sized->hasRequests = options_.closeHandles > 0;
    sized->targetQuads = made_.targetQuads;
    sized->edgeLength = made_.edgeLength;
    sized->notices = made_.notices;
    sized->givenUpFeatures = made_.givenUpFeatures;
    sized->details = made_.details;
    if (!sized->hasRequests)
    {
      sized->surface.setRequests({});
    }
    store_->put(drawnKey_, prepared, bytesOf(prepared->surface));
    const std::size_t bytes =
      bytesOf(sized->surface, &prepared->surface) + bytesOf(sized->givenUpFeatures);
    store_->put(made_.key, std::move(sized), bytes);
  }

  /// The edge length stays; where the number of quads was asked for, it is met by the scale of the map.
  void limitSizes()
  {
    Mesh& mesh = surface_.mesh;
    const SizingReport limited = limitSizeGrowth(mesh, made_.edgeLength);
    tell(sizingNotice(mesh, limited));
    if (limited.changed > 0 && !options_.quads)
    {
      made_.targetQuads = predictedQuads(areaOverSizes(surface_), made_.edgeLength);
    }
  }

  bool refuseTooMany()
  {
    if (made_.targetQuads <= options_.maximumNumberOfQuads)
    {
      return false;
    }
    made_.status = { StatusCode::TooLarge,
      "about " + std::to_string(made_.targetQuads) +
        " quads would be made, more than the limit of " +
        std::to_string(options_.maximumNumberOfQuads) +
        "; ask for fewer or longer quads, or raise the limit (Maximum Number Of Quads, "
        "--maximum-quads)" };
    return true;
  }

  void refine()
  {
    PreparedSurface& surface = surface_;
    double start = secondsNow();
    const std::size_t before = surface.mesh.faceCount();
    tell(dropSmallComponents(surface, options_, made_));
    tell(surface.facets.text());
    filterFeatures();
    refineSurface(surface, made_.edgeLength,
      subProgress(options_.progress, 0.1, 0.15, "Refining: "), options_.threads);
    made_.stages.add("refine", secondsNow() - start, before, surface.mesh.faceCount());
    tell(surface.notice);
    if (options_.closeHandles > 0)
    {
      start = secondsNow();
      const std::size_t open = surface.mesh.faceCount();
      const ClosedHandles closed = closeSmallHandles(surface, made_.edgeLength, options_);
      tell(closed.notice);
      made_.details.insert(made_.details.end(), closed.details.begin(), closed.details.end());
      made_.decimations += closed.decimations;
      made_.stages.add("close", secondsNow() - start, open, surface.mesh.faceCount());
    }
  }

  void filterFeatures()
  {
    Mesh& mesh = surface_.mesh;
    std::vector<std::uint8_t> before = mesh.flags;
    FeatureFilterReport filtered =
      removeUnresolvedFeatures(mesh, made_.edgeLength, options_.threads);
    noteGivenUp(FeatureLoss::Unresolved, filtered.removedEdges > 0, before);
    CreaseReport creases;
    if (judgesCreases(options_))
    {
      creases = removeFalseCreases(mesh, made_.edgeLength, options_.threads, filtered);
      noteGivenUp(FeatureLoss::NoCrease, creases.removedEdges > 0, before);
    }
    const NetworkReport network = simplifyFeatureNetwork(mesh, made_.edgeLength, filtered);
    noteGivenUp(FeatureLoss::ShortArc, network.removedEdges > 0, before);
    tell(featureNotice(filtered));
    tell(creases.text());
    tell(network.text());
  }

  /// What a step has unmarked, where it did; `before` becomes what it has left.
  void noteGivenUp(FeatureLoss reason, bool any, std::vector<std::uint8_t>& before)
  {
    if (!any)
    {
      return;
    }
    const Mesh& mesh = surface_.mesh;
    const std::vector<Index> lost = lostFeatures(mesh, before);
    if (!lost.empty())
    {
      for (const GivenUpCurve& curve : givenUpCurves(mesh, lost, made_.edgeLength, reason))
      {
        made_.givenUpFeatures.push_back(curve);
      }
      before = mesh.flags;
    }
  }

  void guideByCurvature()
  {
    if (!options_.curvatureGuides)
    {
      return;
    }
    const double start = secondsNow();
    PreparedSurface& surface = surface_;
    const std::size_t guided =
      addCurvatureGuides(surface, made_.edgeLength, *options_.curvatureGuides, options_.threads);
    made_.stages.add("guides", secondsNow() - start, surface.mesh.faceCount(), guided);
    tell(std::to_string(guided) + " polygons are guided by the curvature of the surface");
  }

  void tellRequests()
  {
    const PreparedSurface& surface = surface_;
    for (const std::string& notice :
      requestNotices(surface, surfaceGuides(surface, options_.threads)))
    {
      tell(notice);
    }
    for (const std::string& sentence : repairSentences(surface.repair))
    {
      tell("input: " + sentence);
    }
  }

  SurfaceInput& input_;
  const RemeshOptions& options_;
  ResultStore* store_;
  SizedSurface made_;
  PreparedSurface surface_; ///< until it is made_.surface
  ResultKey preparedKey_;
  ResultKey drawnKey_; ///< of the prepared surface with what is drawn on it
  ResultKey requestsKey_ = 0;
  std::shared_ptr<StoredPrepared> prepared_; ///< found in the store
  double sizedArea_ = 0, diagonal_ = 0;
  std::vector<std::string> drawnNotices_; ///< on features and sizes that are drawn
};

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
  return known.store != nullptr &&
    known.store->find<StoredPrepared>(preparedKey(known.inputHash, options)) != nullptr;
}

SizedSurface sizeSurface(SurfaceInput& input, const RemeshOptions& options, const KnownInput& known)
{
  return SurfaceSizing(input, options, known).run();
}

SizedSurface sizePrepared(
  PreparedSurface surface, const StageRecords& stages, const RemeshOptions& options)
{
  SurfaceInput none;
  return SurfaceSizing(none, options, {}).run(std::move(surface), stages);
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/Pipeline.h"

#include "Base/Memory.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Extraction/QuadShape.h"
#include "Extraction/QuadTopology.h"
#include "GridMap/MapShape.h"
#include "Mesh/CloseHandles.h"
#include "Mesh/ContentHash.h"
#include "Mesh/FeatureFilter.h"
#include "Mesh/Frame.h"
#include "Mesh/RepairText.h"
#include "Mesh/Sizing.h"
#include "Mesh/SmallComponents.h"
#include "Pipeline/CoarsestMap.h"
#include "Pipeline/LeaveFrame.h"
#include "Pipeline/Notices.h"
#include "Transfer/PackedMap.h"
#include "Transfer/SurfaceStretch.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <optional>
#include <queue>
#include <sstream>
#include <utility>

namespace quadrille
{
namespace
{

/// How often the coarse level is rebuilt with more freedom around the offenders of a failed map.
constexpr int kMaximumAttempts = 3;
/// A fold within so many edge lengths is why a quad is turned over.
constexpr double kFoldRadius = 2;
/// From this number of offenders on, an attempt must have halved that of the one before to deserve another.
constexpr std::size_t kManyOffenders = 100;
/// How often the coarse level is rebuilt because the map does not fit the input's triangles.
constexpr int kMaximumTransfers = 3;
/// Work on maps (GridMapResult::work) after which nothing is tried again; about a minute.
constexpr std::size_t kMaximumWork = 24000000;
/// How often the number of quads is doubled where they do not fit round a small handle.
constexpr int kMaximumFinerGrids = 3;
/// Before that, quads are made smaller near the places alone: so often, by this factor, within so many edge lengths.
constexpr int kMaximumShrinks = 4;
/// Where that makes the number of quads grow by more than this factor they may as well be smaller everywhere.
constexpr double kMostGrowth = 1.6;
/// Handles with loops below so many edge lengths are sure to be among the places.
constexpr double kHopelessLoop = 2;
constexpr double kShrink = 0.5;
/// So many quads are made to fit round a loop that is too short for three, if they need not be smaller than this for it.
constexpr double kQuadsOfShrunkLoop = 4;
constexpr double kLeastShrink = 0.1;
constexpr double kShrinkRadius = 1.5;
/// How often features are given up near the places of a failure.
constexpr int kMaximumFeatureDrops = 4;
/// The first time within this part of the edge length, then twice as far each time.
constexpr double kFirstFeatureDrop = 0.5;
/// How often handles are looked for and closed: those whose loops meet others' have to wait.
constexpr int kMaximumClosings = 10;
/// Along the edges of the surface a loop may be so much longer than on the intermediate level, which lies inside of it.
constexpr double kLongerAlongEdges = 2;
/// Bytes that a memory takes for a triangle of the input where the surface is split nowhere, and half as much again while it is filled.
constexpr double kBytesRemembered = 150;
/// Rings of intermediate vertices that are kept around an offender.
constexpr int kFreedomRings = 2;

double now()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

ProgressCallback subProgress(
  const ProgressCallback& progress, double begin, double end, const std::string& prefix)
{
  if (!progress)
  {
    return {};
  }
  return [=](double fraction, const std::string& text)
  { return progress(begin + (end - begin) * std::clamp(fraction, 0.0, 1.0), prefix + text); };
}

void checkOptions(const RemeshOptions& options)
{
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  if (options.coarsestIntegers && options.method != MapMethod::ScaleAware)
  {
    throw InvalidInput("the coarsest integers need the scale aware method");
  }
  if (options.quads && *options.quads < 1)
  {
    throw InvalidInput("the target number of quads must be at least 1");
  }
  if (options.edgeLength && !positive(*options.edgeLength))
  {
    throw InvalidInput("the target edge length must be a positive number");
  }
  if (!options.quads && !options.edgeLength && !positive(options.relativeEdgeLength))
  {
    throw InvalidInput("the relative target edge length must be a positive number");
  }
  if (options.featureAngle && !(*options.featureAngle > 0 && *options.featureAngle <= M_PI))
  {
    throw InvalidInput("the feature angle must be above 0 and at most 180 degrees");
  }
  if (options.memoryLimit && !positive(*options.memoryLimit))
  {
    throw InvalidInput("the memory limit must be a positive number of bytes");
  }
  checkAnisotropyLimit(options.anisotropyLimit);
  if (options.anisotropyLimit > 0 &&
    (options.method == MapMethod::MixedInteger || options.method == MapMethod::QuadCover))
  {
    throw InvalidInput("an anisotropy limit needs the scale aware or the seamless method");
  }
  if (!(options.closeHandles >= 0 && std::isfinite(options.closeHandles)))
  {
    throw InvalidInput("the length of handles to close must be 0 or a positive number");
  }
  if (options.coarseVertices != 0 && options.coarseVertices < 4)
  {
    throw InvalidInput(
      "the coarse level needs at least 4 vertices, or 0 for as many as the curvature needs");
  }
}

/// The run of one remesh() call; each method is one stage and fills its part of the result.
class Run
{
public:
  Run(SurfaceInput input, const RemeshOptions& options, RemeshMemory* memory)
    : input_(std::move(input)), options_(options), poll_(options.progress), memory_(memory)
  {
    options_.progress = poll_.callback();
  }

  RemeshResult execute()
  {
    checkOptions(options_);
    try
    {
      if (fitsIntoMemory())
      {
        run();
      }
      letLevelsGo();
      leave();
    }
    catch (const Cancelled&)
    {
      letLevelsGo();
      leaveNothing();
    }
    return std::move(result_);
  }

private:
  /// What was under work when it was stopped is in the run's own coordinates, or half made.
  void leaveNothing()
  {
    result_.status = { StatusCode::Cancelled, "stopped on request; no quads were made" };
    result_.quads = {};
    result_.surface = {};
    result_.uv.clear();
    result_.turns.clear();
    result_.coarse = {};
    result_.coarseUv.clear();
    result_.coarseTurns.clear();
  }

  void leave()
  {
    result_.frame = frame_;
    if (options_.mergeCharts && result_.status.ok())
    {
      result_.framePositions = result_.surface.mesh.position;
    }
    leaveFrame(result_, frame_, userPoints_);
    if (askedEdgeLength_ && !options_.quads)
    {
      result_.targetEdgeLength = *askedEdgeLength_; // with every bit
    }
  }

  void enter()
  {
    FramedInput framed = enterFrame(std::move(input_), options_.threads);
    input_ = std::move(framed.input);
    frame_ = framed.frame;
    userPoints_ = std::move(framed.points);
    places_.set(frame_.centre, frame_.unit, frame_.sign);
    if (options_.edgeLength)
    {
      askedEdgeLength_ = options_.edgeLength;
      options_.edgeLength = frame_.lengthOf(*options_.edgeLength);
    }
  }

  void run()
  {
    enter();
    prepare();
    chooseEdgeLength();
    limitSizes();
    if (!refuseTooMany())
    {
      refine();
      while (!makeQuads())
      {
      }
      if (bestQuads_)
      {
        restore(std::move(*bestQuads_));
      }
      if (!gridNotice_.empty())
      {
        result_.notices.push_back(gridNotice_);
      }
      tellAnisotropy();
      mergeMapCharts();
      if (!result_.status.ok() && result_.smallParts.unresolvedHandles > 0)
      {
        result_.status.message += "; " + unresolvedText();
      }
      if (!result_.status.ok() && result_.smallParts.boundary.shortLoops > 0)
      {
        result_.status.message += "; " + tinyHolesText();
      }
    }
  }

  /// One attempt; true when it was the last one. Quads that fail for the folds of a method that has such are its
  /// result.
  bool makeQuads()
  {
    const bool mapped = computeMap();
    if (mapped && improve() && extract())
    {
      return isRounded() || !tryForBetterQuads();
    }
    return (mapped && isRounded()) || !mayRepeat() || !(takeFinerGrid() || dropFeatures());
  }

  void tellAnisotropy()
  {
    if (!(options_.anisotropyLimit > 0) || !result_.status.ok())
    {
      return;
    }
    result_.beyondAnisotropyLimit =
      shareBeyondRatio(result_.coarse.mesh, result_.coarseUv, options_.anisotropyLimit);
    tell(anisotropyNotice(result_.beyondAnisotropyLimit, options_.anisotropyLimit));
    if (result_.finalQuality.improved)
    {
      result_.notices.push_back("final quality does not know the anisotropy limit: on the finer "
                                "level more triangles may be beyond it");
    }
  }

  void addStage(const std::string& name, double seconds, std::size_t in, std::size_t out)
  {
    // A stage that had to be repeated is one entry with the time of all its runs.
    for (StageRecord& stage : result_.stages)
    {
      if (stage.stage == name)
      {
        stage = { name, stage.seconds + seconds, in, out };
        return;
      }
    }
    result_.stages.push_back({ name, seconds, in, out });
  }

  void tell(const std::string& notice)
  {
    if (!notice.empty())
    {
      result_.notices.push_back(notice);
    }
  }

  /// In place of what an earlier attempt of this run has told.
  void tellInstead(std::string& before, const std::string& notice)
  {
    std::vector<std::string>& notices = result_.notices;
    notices.erase(std::remove(notices.begin(), notices.end(), before), notices.end());
    before = notice;
    tell(notice);
  }

  /// For a failure of the extraction: whether the map is to blame.
  std::string describeMap() const
  {
    const std::string defects = defectsText(result_.certificate);
    return defects.empty() ? " (the map is valid)" : " (map on the input surface: " + defects + ")";
  }

  void fail(StatusCode code, const std::string& message)
  {
    result_.status = { code, message };
    result_.quads = {};
  }

  /// Says what the run will cost; false where the memory is not there.
  bool fitsIntoMemory()
  {
    std::size_t triangles = 0;
    for (std::size_t i = 0; i + 1 < input_.polygonOffsets.size(); ++i)
    {
      pollNowAndThen(i);
      const std::size_t corners = input_.polygonOffsets[i + 1] - input_.polygonOffsets[i];
      triangles += std::max<std::size_t>(corners, 2) - 2;
    }
    const double quads =
      static_cast<double>(std::min(options_.quads.value_or(0), options_.maximumNumberOfQuads));
    result_.estimate = estimateRun(triangles, quads, options_.threads);
    report(options_.progress, 0,
      "Preparing: " + describe(result_.estimate) + " for " + std::to_string(triangles) +
        " triangles");
    remembersIfRoom(static_cast<double>(triangles));
    const double limit = options_.memoryLimit.value_or(freeMemory());
    if (result_.estimate.bytes <= limit)
    {
      return true;
    }
    fail(StatusCode::TooLarge,
      "about " + describeBytes(result_.estimate.bytes) + " of memory would be needed for " +
        std::to_string(triangles) + " triangles, but " + describeBytes(limit) +
        (options_.memoryLimit ? " are allowed" : " are free") +
        "; free memory, raise the memory limit, or decimate the surface first");
    return false;
  }

  void remembersIfRoom(double triangles)
  {
    if (memory_ == nullptr)
    {
      return;
    }
    // What is held already is not free any more.
    const double held = static_cast<double>(memory_->bytes());
    const double needed =
      result_.estimate.bytes + std::max(0.0, kBytesRemembered * triangles - held);
    if (needed > options_.memoryLimit.value_or(freeMemory()))
    {
      memory_->clear();
      memory_ = nullptr;
      result_.notices.push_back("stages are not remembered: the run and its memory would need " +
        describeBytes(needed) + "; a change will start from the beginning");
    }
  }

  void reuse(const std::vector<std::string>& stages)
  {
    for (const std::string& stage : stages)
    {
      if (std::find(result_.reused.begin(), result_.reused.end(), stage) == result_.reused.end())
      {
        result_.reused.push_back(stage);
      }
    }
  }

  void forgetReuse(const std::string& stage)
  {
    std::vector<std::string>& reused = result_.reused;
    reused.erase(std::remove(reused.begin(), reused.end(), stage), reused.end());
  }

  void prepare()
  {
    if (memory_ != nullptr)
    {
      key_ = memoryKey(input_, options_.featureAngle, options_.closeHandles, options_.threads);
      key_.removeSmallComponents = options_.removeSmallComponents;
      if (memory_->knowsPrepared(key_))
      {
        checkRequests(input_);
        if (input_.sizing.empty())
        {
          result_.surface.area = memory_->area(); // all that the edge length needs
          result_.surface.boundingBoxDiagonal = memory_->boundingBoxDiagonal();
        }
        else
        {
          prepared_ = memory_->prepared();
          result_.surface = *prepared_;
        }
        reuse({ "repair", "order", "connectivity" });
        return;
      }
      memory_->clear(); // before the new one takes its memory
    }
    const bool sized = !input_.sizing.empty();
    PrepareOptions prepareOptions;
    prepareOptions.featureAngle = options_.featureAngle;
    prepareOptions.threads = options_.threads;
    prepareOptions.progress = subProgress(options_.progress, 0.0, 0.1, "Preparing: ");
    result_.surface = prepareSurface(input_, prepareOptions);
    const std::size_t polygons =
      input_.polygonOffsets.empty() ? 0 : input_.polygonOffsets.size() - 1;
    input_ = {};
    releaseFreedMemory();
    for (const auto& [name, seconds] : result_.surface.seconds)
    {
      addStage(name, seconds, polygons, result_.surface.mesh.faceCount());
    }
    if (memory_ != nullptr && sized)
    {
      prepared_ = result_.surface; // before the sizes are limited
    }
  }

  void chooseEdgeLength()
  {
    const double area = sizedArea();
    if (options_.quads)
    {
      result_.targetQuads = *options_.quads;
      result_.targetEdgeLength =
        roundedLength(std::sqrt(area / static_cast<double>(*options_.quads)));
      return;
    }
    result_.targetEdgeLength = options_.edgeLength
      ? *options_.edgeLength
      : roundedLength(options_.relativeEdgeLength * result_.surface.boundingBoxDiagonal);
    predictQuads();
  }

  /// The surface's area over its sizes.
  double sizedArea() const
  {
    return result_.surface.mesh.sizing.empty() ? result_.surface.area
                                               : quadrille::sizedArea(result_.surface.mesh);
  }

  /// Where an edge length is asked for.
  void predictQuads()
  {
    const double quads = sizedArea() / (result_.targetEdgeLength * result_.targetEdgeLength);
    result_.targetQuads = static_cast<std::size_t>(std::max(1.0, std::min(quads, 1e15)));
  }

  /// The edge length stays; where the number of quads was asked for, it is met by the scale of the map.
  void limitSizes()
  {
    Mesh& mesh = result_.surface.mesh;
    const SizingReport limited = limitSizeGrowth(mesh, result_.targetEdgeLength);
    const std::string notice = sizingNotice(mesh, limited);
    if (!notice.empty())
    {
      result_.notices.push_back(notice);
    }
    if (limited.changed > 0 && !options_.quads)
    {
      predictQuads();
    }
  }

  bool refuseTooMany()
  {
    if (result_.targetQuads <= options_.maximumNumberOfQuads)
    {
      return false;
    }
    fail(StatusCode::TooLarge,
      "about " + std::to_string(result_.targetQuads) +
        " quads would be made, more than the limit of " +
        std::to_string(options_.maximumNumberOfQuads) +
        "; ask for fewer or longer quads, or raise the limit (Maximum Number Of Quads, "
        "--maximum-quads)");
    return true;
  }

  void refine()
  {
    key_.edgeLength = result_.targetEdgeLength;
    if (memory_ != nullptr && memory_->knowsRefined(key_))
    {
      result_.surface = memory_->refined();
      const std::vector<std::string>& told = memory_->notices();
      result_.notices.insert(result_.notices.end(), told.begin(), told.end());
      if (options_.closeHandles == 0)
      {
        collectRequests(input_, result_.surface);
      }
      onMemory_ = true;
      reuse({ "refine" });
    }
    else
    {
      if (memory_ != nullptr && memory_->knowsPrepared(key_))
      {
        if (prepared_)
        {
          memory_->clear(); // the surface has its sizes already
        }
        else
        {
          result_.surface = memory_->takePrepared();
        }
        collectRequests(input_, result_.surface);
      }
      refinePrepared();
    }
    input_ = {};
    prepared_.reset();
    tellRequests();
    countSmallComponents();
  }

  /// What of the surface is left after the removal, or becomes blocks, sets the number of quads where an edge length is asked for.
  void countSmallComponents()
  {
    const double quad = result_.targetEdgeLength * result_.targetEdgeLength;
    const SmallComponents small = findSmallComponents(result_.surface, result_.targetEdgeLength);
    if (!options_.quads)
    {
      const double quads = (sizedArea() - small.area) / quad + small.quads;
      result_.targetQuads = static_cast<std::size_t>(std::max(1.0, std::min(quads, 1e15)));
    }
    if (small.count > 0)
    {
      result_.notices.push_back(smallComponentsText(small, small.count) +
        ": each was made of about the smallest block of quads there is, " +
        std::to_string(std::llround(small.quads)) +
        " altogether; ask for more quads to resolve them, or have them removed (Small Components, "
        "--small-components remove)");
    }
  }

  /// On request, before anything depends on them.
  void dropSmallComponents()
  {
    if (!options_.removeSmallComponents)
    {
      return;
    }
    const SmallComponents small = findSmallComponents(result_.surface, result_.targetEdgeLength);
    const std::size_t removed = quadrille::removeSmallComponents(result_.surface, small);
    if (removed > 0)
    {
      result_.notices.push_back(smallComponentsText(small, removed) + ": removed, as was asked for");
    }
  }

  std::string smallComponentsText(const SmallComponents& small, std::size_t count) const
  {
    std::ostringstream text;
    text << count << " of " << small.components
         << " connected components are smaller than a closed block of quads of this size, the "
            "largest with the area of "
         << std::setprecision(2)
         << small.largest / (result_.targetEdgeLength * result_.targetEdgeLength)
         << std::setprecision(6) << " quads near " << placeText(small.place);
    return text.str();
  }

  void refinePrepared()
  {
    if (memory_ != nullptr && !prepared_)
    {
      prepared_ = result_.surface;
    }
    const std::size_t told = result_.notices.size();
    const double start = now();
    const std::size_t before = result_.surface.mesh.faceCount();
    dropSmallComponents();
    tell(result_.surface.facets.text());
    const FeatureFilterReport filtered =
      removeUnresolvedFeatures(result_.surface.mesh, result_.targetEdgeLength);
    tell(featureNotice(filtered));
    refineSurface(result_.surface, result_.targetEdgeLength,
      subProgress(options_.progress, 0.1, 0.15, "Refining: "));
    addStage("refine", now() - start, before, result_.surface.mesh.faceCount());
    tell(result_.surface.notice);
    closeSmallHandles();
    if (memory_ != nullptr)
    {
      levels_.reset(); // not of the surface that is remembered
      memory_->keep(key_, std::move(*prepared_), result_.surface,
        { result_.notices.begin() + static_cast<std::ptrdiff_t>(told), result_.notices.end() });
      onMemory_ = true;
      prepared_.reset();
    }
  }

  void tellRequests()
  {
    const SurfaceGuides guides = surfaceGuides(result_.surface);
    for (const std::string& notice : requestNotices(result_.surface, guides))
    {
      result_.notices.push_back(notice);
    }
    for (const std::string& sentence : repairSentences(result_.surface.repair))
    {
      result_.notices.push_back("input: " + sentence);
    }
  }

  HierarchyOptions hierarchyOptions() const
  {
    HierarchyOptions hierarchyOptions;
    hierarchyOptions.targetEdgeLength = result_.targetEdgeLength;
    hierarchyOptions.coarseVertices = options_.coarseVertices;
    hierarchyOptions.guides = surfaceGuides(result_.surface).faces;
    hierarchyOptions.keepVertices = indexVertices(result_.surface);
    hierarchyOptions.threads = options_.threads;
    hierarchyOptions.progress = subProgress(options_.progress, 0.15, 0.45, "Decimating: ");
    return hierarchyOptions;
  }

  /// What one attempt at a map leaves behind, so that a later, worse one can be undone.
  struct MapState
  {
    Level coarse;
    std::vector<FixedVec2> coarseUv;
    PackedMap uv;
    std::vector<int> coarseTurns, turns;
    std::vector<std::uint8_t> integerVertex;
    Certificate coarseCertificate, certificate;
    TransferResult transfer;
  };
  MapState takeState()
  {
    PackedMap packed(result_.surface.mesh, result_.uv);
    std::vector<FixedVec2>().swap(result_.uv); // phase 1 comes again and needs the memory
    return { std::move(result_.coarse), std::move(result_.coarseUv), std::move(packed),
      std::move(result_.coarseTurns), std::move(result_.turns), std::move(integerVertex_),
      result_.coarseCertificate, result_.certificate, std::move(result_.transfer) };
  }
  /// Ends the attempts: the levels of the failed one are let go.
  void restore(MapState&& state)
  {
    letLevelsGo();
    result_.coarse = std::move(state.coarse);
    result_.coarseUv = std::move(state.coarseUv);
    std::vector<FixedVec2>().swap(result_.uv);
    result_.uv = state.uv.unpack(result_.surface.mesh);
    result_.coarseTurns = std::move(state.coarseTurns);
    result_.turns = std::move(state.turns);
    integerVertex_ = std::move(state.integerVertex);
    result_.coarseCertificate = state.coarseCertificate;
    result_.certificate = state.certificate;
    result_.transfer = std::move(state.transfer);
    result_.status = {};
    troubles_.clear();
  }

  /// Quads and all that they come from.
  struct QuadState
  {
    MapState map;
    QuadMesh quads;
    ExtractionCounts extraction;
    FinalQualityReport finalQuality;
    std::vector<std::uint8_t> flags;
    std::vector<float> sizing;
    std::vector<std::string> notices;
    std::string gridNotice;
    std::size_t turned = 0; ///< quads turned over
  };

  void restore(QuadState&& state)
  {
    result_.surface.mesh.flags = std::move(state.flags);
    result_.surface.mesh.sizing = std::move(state.sizing);
    result_.surface.hash = contentHash(result_.surface.mesh, options_.threads);
    restore(std::move(state.map));
    result_.quads = std::move(state.quads);
    result_.extraction = state.extraction;
    result_.finalQuality = std::move(state.finalQuality);
    result_.notices = std::move(state.notices);
    gridNotice_ = std::move(state.gridNotice);
  }

  /// The extraction finds quads through folds of the map, but some of them may be turned over there. Then features are given up
  /// near the folds as after a failure. As that has a price, the mesh before counts unless at most half as many quads are turned over.
  /// False when there is nothing (more) to try.
  bool tryForBetterQuads()
  {
    if (result_.transfer.offenders.empty() && !bestQuads_)
    {
      return false; // no folds
    }
    const std::vector<Vector3> folds =
      positionsOf(result_.surface.mesh, result_.transfer.offenders);
    const std::vector<Index> turned = quadsTurnedOver(result_.quads.points, result_.quads.quads);
    const bool fine = std::none_of(
      turned.begin(), turned.end(), [&](Index q) { return isNear(result_.quads.quads[q], folds); });
    const bool better = !bestQuads_ || 2 * turned.size() <= bestQuads_->turned;
    if (fine && better)
    {
      bestQuads_.reset();
      return false;
    }
    if (better)
    {
      bestQuads_ = QuadState{ {}, std::move(result_.quads), result_.extraction,
        result_.finalQuality, result_.surface.mesh.flags, result_.surface.mesh.sizing,
        result_.notices, gridNotice_, turned.size() };
      bestQuads_->map = takeState();
    }
    result_.quads = {};
    troubles_ = folds;
    return !fine && mayRepeat() && dropFeatures();
  }

  /// Has the quad a corner within kFoldRadius edge lengths of one of the places?
  bool isNear(const std::array<Index, 4>& quad, const std::vector<Vector3>& places) const
  {
    const double radius = kFoldRadius * result_.targetEdgeLength;
    const auto isClose = [&](const Vector3& place)
    {
      return std::any_of(quad.begin(), quad.end(),
        [&](Index p) { return (result_.quads.points[p] - place).squaredNorm() < radius * radius; });
    };
    return std::any_of(places.begin(), places.end(), isClose);
  }

  /// A map of the coarse mesh, carried to the input. Where the input's triangles have no room for it, their
  /// vertices are kept on all levels and the map is made again; the best attempt counts.
  bool computeMap()
  {
    HierarchyOptions levelOptions = hierarchyOptions();
    if (!computeCoarseMap(levelOptions))
    {
      return false;
    }
    transfer();
    mapLevels_ = levelOptions;
    for (int attempt = 1; attempt < kMaximumTransfers; ++attempt)
    {
      // With offenders everywhere it is not a matter of a few places, and the coarse level would grow out of hand.
      const std::vector<Index>& offenders = result_.transfer.offenders;
      // The last attempt is left out where features can be given up: what keeping vertices did not mend once is theirs.
      const bool last = attempt + 1 == kMaximumTransfers;
      if (hasPromised(result_.certificate, options_.method) || offenders.empty() || !mayRepeat() ||
        (last && !featuresNear(positionsOf(result_.surface.mesh, offenders)).empty()) ||
        offenders.size() > result_.coarse.mesh.vertexCount() / 2)
      {
        break;
      }
      keepVertices(offenders, result_.coarse.mesh.vertexCount(), levelOptions);
      const std::size_t defects = defectsOf(result_.certificate);
      MapState best = takeState();
      if (!computeCoarseMap(levelOptions))
      {
        restore(std::move(best));
        break;
      }
      transfer();
      if (defectsOf(result_.certificate) >= defects)
      {
        restore(std::move(best));
        break;
      }
      mapLevels_ = levelOptions;
    }
    tellOfRounding();
    return true;
  }

  /// Folds of the coarse map are a property of these methods: nothing is tried again for them.
  bool isRounded() const
  {
    return options_.method == MapMethod::MixedInteger || options_.method == MapMethod::QuadCover;
  }
  void tellOfRounding()
  {
    if (isRounded())
    {
      const Certificate& coarse = result_.coarseCertificate;
      const Certificate& fine = result_.certificate;
      std::ostringstream text;
      text << "the method '" << nameOf(options_.method)
           << "' gives no guarantee: " << coarse.notPositive << " of " << coarse.triangles
           << " triangles of the coarse map and " << fine.notPositive << " of " << fine.triangles
           << " of the map on the surface are inverted or degenerate";
      result_.notices.push_back(text.str());
    }
  }

  static std::size_t defectsOf(const Certificate& certificate)
  {
    return certificate.notPositive + certificate.wrongTurns + certificate.seamResiduals;
  }

  /// coarseVertices: of the last attempt.
  static void keepVertices(
    const std::vector<Index>& added, Index coarseVertices, HierarchyOptions& levelOptions)
  {
    std::vector<Index>& kept = levelOptions.keepVertices;
    kept.insert(kept.end(), added.begin(), added.end());
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    if (levelOptions.coarseVertices == 0)
    {
      levelOptions.coarseVertices = coarseVertices; // not fewer elsewhere because of these
    }
    levelOptions.coarseVertices += static_cast<Index>(added.size());
  }

  /// Decimates and maps; where the coarse triangulation lacks freedom, steps back around the
  /// offenders and tries again.
  bool computeCoarseMap(HierarchyOptions& levelOptions)
  {
    GridMapOptions mapOptions;
    mapOptions.method = options_.method;
    mapOptions.edgeLength = result_.targetEdgeLength;
    mapOptions.targetQuads = gridQuads();
    mapOptions.anisotropyLimit = options_.anisotropyLimit;
    mapOptions.progress = subProgress(options_.progress, 0.45, 0.8, "Mapping: ");

    GridMapResult map;
    StageTimes times;
    std::size_t offenders = 0;
    for (int attempt = 0; attempt < kMaximumAttempts; ++attempt)
    {
      times.phase1 += makeLevels(levelOptions);
      times.handles += attempt == 0 ? measureSmallParts() : 0;
      if (shrinkQuadsAtShortLoops())
      {
        times.phase1 += makeLevels(levelOptions);
      }
      mapOptions.guides = hierarchy().coarse.guides;
      times.metric += measureMetric(mapOptions);
      mapOptions.targetValences = levelValences(result_.surface, hierarchy().coarse.fineVertex);
      map = startingWarm(mapOptions);
      work_ += map.work;
      times.add(hierarchy(), map);
      const bool hopeless = map.status.code == StatusCode::TooLarge ||
        (map.status.code == StatusCode::Infeasible && map.offenders.empty());
      if (map.status.ok() || hopeless || !mayRepeat())
      {
        break;
      }
      const std::size_t count = map.offenders.size();
      if (attempt > 0 && count >= kManyOffenders && 2 * count > offenders)
      {
        break;
      }
      offenders = count;
      if (attempt + 1 < kMaximumAttempts)
      {
        giveFreedom(map.offenders, levelOptions);
      }
    }
    recordCoarse(map, times);
    return map.status.ok();
  }

  /// On request. Returns the seconds.
  double measureMetric(GridMapOptions& mapOptions) const
  {
    const double start = now();
    if (options_.distortionMetric)
    {
      mapOptions.stretch =
        measureStretch(hierarchy().intermediate, hierarchy().coarse, hierarchy().log).stretch;
    }
    return now() - start;
  }

  GridMapResult startingWarm(GridMapOptions mapOptions)
  {
    const Level& coarse = hierarchy().coarse;
    if (options_.coarsestIntegers)
    {
      return computeCoarsestMap(coarse.mesh, mapOptions);
    }
    const bool fits = onMemory_ && options_.method == MapMethod::ScaleAware;
    if (fits && options_.warmStart && memory_->map && memory_->mapQuads == gridQuads() &&
      memory_->mapAnisotropyLimit == options_.anisotropyLimit &&
      memory_->mapStretched == options_.distortionMetric)
    {
      mapOptions.previous = &*memory_->map;
      mapOptions.vertexIds = coarse.fineVertex;
    }
    GridMapResult map = computeGridMap(coarse.mesh, mapOptions);
    const auto reuseIf = [&](std::size_t components, const char* stage)
    {
      if (components > 0)
      {
        reuse({ stage });
      }
    };
    reuseIf(map.reuse.seamless, "seamless");
    reuseIf(map.reuse.integers, "quantize");
    reuseIf(map.reuse.embedded, "embed");
    if (fits && map.status.ok())
    {
      memory_->map = previousMap(coarse.mesh, map, coarse.fineVertex);
      memory_->mapQuads = gridQuads();
      memory_->mapAnisotropyLimit = options_.anisotropyLimit;
      memory_->mapStretched = options_.distortionMetric;
    }
    return map;
  }

  /// The levels with these options, from the intermediate one on where phase 1 has left all vertices that are to be
  /// kept. Returns the seconds of phase 1.
  double makeLevels(const HierarchyOptions& levelOptions)
  {
    recallLevels(levelOptions);
    const bool again = !levels_ || !levels_->allows(levelOptions);
    if (again)
    {
      ++result_.decimations;
      forgetReuse("phase1"); // what the memory had did for the first attempt only
      if (options_.warmStart)
      {
        levels_.reset(); // before the new one takes its memory
      }
      letLevelsGo();
      const PreparedSurface& surface = onMemory_ ? memory_->surface() : result_.surface;
      levels_.emplace(surface.mesh, surface.hash, levelOptions);
      levelsKept_ = levelOptions.keepVertices;
      releaseFreedMemory();
    }
    levels_->update(levelOptions);
    return again ? hierarchy().secondsPhase1 : 0.0;
  }
  const Hierarchy& hierarchy() const { return levels_->hierarchy(); }

  /// Phase 1 depends on the vertices that it keeps: with others it is what a run without memory makes only nearly.
  void recallLevels(const HierarchyOptions& levelOptions)
  {
    if (levels_ || !onMemory_ || !memory_->levels)
    {
      return;
    }
    if (!options_.warmStart && memory_->levelsKept != levelOptions.keepVertices)
    {
      memory_->levels.reset(); // before the new one takes its memory
      return;
    }
    levels_ = std::move(memory_->levels);
    memory_->levels.reset();
    levelsKept_ = std::move(memory_->levelsKept);
    if (levels_->allows(levelOptions))
    {
      reuse({ "phase1" });
    }
  }

  /// To the memory, if there is one that their surface belongs to: their log is a tenth of all memory. The first ones of a run are those
  /// that the next one begins with; those of later attempts keep vertices that it does not ask for, which only a warm start may do.
  void letLevelsGo()
  {
    if (onMemory_ && levels_ && (options_.warmStart || !memory_->levels))
    {
      memory_->levels = std::move(levels_);
      memory_->levelsKept = std::move(levelsKept_);
    }
    levels_.reset();
  }

  struct StageTimes
  {
    double phase1 = 0, phase2 = 0, handles = 0, metric = 0, field = 0, seamless = 0, quantize = 0,
           embed = 0;
    void add(const Hierarchy& hierarchy, const GridMapResult& map)
    {
      phase2 += hierarchy.secondsPhase2;
      field += map.secondsField;
      seamless += map.secondsSeamless;
      quantize += map.secondsQuantize;
      embed += map.secondsEmbed;
    }
  };

  /// On request. Loops are found on the intermediate level and cut on the surface, until there is no shorter one.
  void closeSmallHandles()
  {
    if (options_.closeHandles == 0)
    {
      return;
    }
    const double start = now();
    const std::size_t before = result_.surface.mesh.faceCount();
    const double limit = options_.closeHandles * result_.targetEdgeLength;
    std::size_t closed = 0;
    std::size_t left = 0;
    std::optional<Vector3> place;
    for (int closing = 0; closing < kMaximumClosings; ++closing)
    {
      levels_.reset();
      levels_.emplace(result_.surface.mesh, result_.surface.hash, hierarchyOptions());
      ++result_.decimations;
      const Level& level = hierarchy().intermediate;
      const HandleReport found = findHandles(level.mesh, limit);
      left = found.loops.size();
      if (left == 0)
      {
        break;
      }
      std::vector<std::vector<Index>> places;
      for (const HandleLoop& loop : found.loops)
      {
        places.emplace_back();
        for (const Index v : loop.vertices)
        {
          places.back().push_back(level.fineVertex[v]);
        }
      }
      if (!place)
      {
        place = result_.surface.mesh.position[places.front().front()];
      }
      const std::size_t now = closeHandles(result_.surface, places, kLongerAlongEdges * limit);
      if (now == 0)
      {
        break;
      }
      closed += now;
      levels_.reset();
      refineSurface(result_.surface, result_.targetEdgeLength, {});
    }
    tellClosed(closed, left, place);
    addStage("close", now() - start, before, result_.surface.mesh.faceCount());
  }

  void tellClosed(std::size_t closed, std::size_t left, const std::optional<Vector3>& place)
  {
    std::ostringstream text;
    text << closed << " handles shorter round than " << options_.closeHandles
         << " edge lengths were cut and closed";
    if (place)
    {
      text << ", the shortest near " << placeText(*place);
    }
    if (left > 0)
    {
      text << "; " << left
           << " are left: every short loop round them meets the boundary or another one";
    }
    result_.notices.push_back(text.str());
  }

  /// Once a run, as the surface stays the same. Returns the seconds.
  double measureSmallParts()
  {
    if (smallPartsKnown_)
    {
      return 0;
    }
    const double start = now();
    const double limit = kQuadsOfLoop * result_.targetEdgeLength;
    const Mesh& mesh = hierarchy().intermediate.mesh;
    const HandleReport found = findHandles(mesh, limit);
    SmallParts& parts = result_.smallParts;
    parts.handles = found.handles;
    parts.unresolvedHandles = found.loops.size();
    for (const HandleLoop& loop : found.loops)
    {
      const bool hopeless = loop.length < kHopelessLoop * result_.targetEdgeLength;
      HandleLoop onSurface{ {}, loop.length };
      for (std::size_t i = 0; i < loop.vertices.size(); ++i)
      {
        onSurface.vertices.push_back(hierarchy().intermediate.fineVertex[loop.vertices[i]]);
        if (hopeless)
        {
          handlePlaces_.push_back(mesh.position[loop.vertices[i]]);
        }
      }
      shortLoops_.push_back(std::move(onSurface));
    }
    parts.complete = found.complete;
    if (found.shortest)
    {
      parts.shortestLoop = found.shortest->length;
      for (const Index v : found.shortest->vertices)
      {
        parts.place += mesh.position[v] / static_cast<double>(found.shortest->vertices.size());
      }
    }
    parts.boundary = measureBoundary(result_.surface.mesh, limit);
    shortLoops_.insert(
      shortLoops_.end(), parts.boundary.tooShort.begin(), parts.boundary.tooShort.end());
    smallPartsKnown_ = true;
    if (parts.unresolvedHandles > 0)
    {
      result_.notices.push_back(unresolvedText());
    }
    if (parts.boundary.shortLoops > 0)
    {
      result_.notices.push_back(tinyHolesText());
    }
    return now() - start;
  }

  /// Quads round loops that are too short for three are made smaller before the first map, so that there is room for four, where that
  /// does not take too many. Waiting for the failure that most of them are would cost several maps. Once a run; true where sizes have
  /// changed, so that the levels have to be made anew.
  bool shrinkQuadsAtShortLoops()
  {
    if (loopsDone_ || shortLoops_.empty() || options_.coarsestIntegers ||
      options_.method != MapMethod::ScaleAware)
    {
      return false;
    }
    loopsDone_ = true;
    Mesh& mesh = result_.surface.mesh;
    std::vector<float> before = mesh.sizing;
    const double areaBefore = sizedArea();
    mesh.sizing.resize(mesh.vertexCount(), 1.0F);
    std::vector<float> factor(mesh.vertexCount(), 1.0F);
    for (const HandleLoop& loop : shortLoops_)
    {
      const double wanted = loop.length / (kQuadsOfShrunkLoop * result_.targetEdgeLength);
      for (const Index v : loop.vertices)
      {
        factor[v] = std::min(factor[v], static_cast<float>(std::max(kLeastShrink, wanted)));
      }
    }
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      mesh.sizing[v] *= factor[v];
    }
    limitSizeGrowth(mesh, result_.targetEdgeLength);
    if (sizedArea() > kMostGrowth * areaBefore)
    {
      mesh.sizing = std::move(before);
      return false;
    }
    letLevelsGo();
    onMemory_ = false; // its surface has not these sizes
    result_.notices.push_back("quads are made smaller round " + std::to_string(shortLoops_.size()) +
      " handles and holes that are shorter round than three of the wanted size, one of them near " +
      placeText(mesh.position[shortLoops_.front().vertices.front()]) +
      "; close or fill them for quads of one size");
    return true;
  }

  /// Of a loop that is too short: how long, where, and what would resolve it.
  void describeLoop(std::ostringstream& text, double length, const Vector3& place) const
  {
    const double s = result_.targetEdgeLength;
    const double factor = kQuadsOfLoop * s / length;
    const double quads = std::ceil(static_cast<double>(result_.targetQuads) * factor * factor);
    text << length * frame_.unit << " = " << length / s << " edge lengths near " << placeText(place) << ": ";
    if (quads <= static_cast<double>(options_.maximumNumberOfQuads))
    {
      text << "ask for smaller quads (about " << static_cast<std::size_t>(quads)
           << " resolve all) or ";
    }
  }
  std::string unresolvedText() const
  {
    const SmallParts& parts = result_.smallParts;
    std::ostringstream text;
    text << (parts.complete ? "" : "at least ") << parts.unresolvedHandles << " of "
         << parts.handles << " handles are shorter round than three quads, the shortest is ";
    describeLoop(text, parts.shortestLoop, parts.place);
    text << "have them closed (Close Handles, --close-handles 3), or quads there have a poor shape "
            "or fail";
    return text.str();
  }
  std::string tinyHolesText() const
  {
    const BoundaryReport& boundary = result_.smallParts.boundary;
    std::ostringstream text;
    text << boundary.shortLoops << " of " << boundary.loops
         << " boundary loops are shorter than three quads, the shortest is ";
    describeLoop(text, boundary.shortest, boundary.place);
    text << "fill these holes in the surface, or quads there have a poor shape or fail";
    return text.str();
  }

  /// Keeps the intermediate vertices near the offenders and raises the budget by their number and a half. Where the coarse level has all of
  /// the intermediate one already, both get about twice as many.
  void giveFreedom(const std::vector<Index>& offenders, HierarchyOptions& levelOptions) const
  {
    const Mesh& mesh = hierarchy().intermediate.mesh;
    const Index coarseVertices = hierarchy().coarse.mesh.vertexCount();
    if (coarseVertices == mesh.vertexCount())
    {
      levelOptions.targetEdgeLength /= std::sqrt(2.0);
      levelOptions.coarseVertices = 2 * coarseVertices;
      return;
    }
    std::vector<std::uint8_t> near(result_.surface.mesh.vertexCount(), 0);
    for (const Index v : offenders)
    {
      near[hierarchy().coarse.fineVertex[v]] = 1;
    }
    for (int ring = 0; ring < kFreedomRings; ++ring)
    {
      std::vector<Index> added;
      for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
      {
        pollNowAndThen(h);
        const Index from = hierarchy().intermediate.fineVertex[mesh.origin[h]];
        const Index to = hierarchy().intermediate.fineVertex[mesh.target(h)];
        if (near[from] != near[to])
        {
          added.push_back(near[from] ? to : from);
        }
      }
      for (const Index v : added)
      {
        near[v] = 1;
      }
    }
    std::size_t kept = levelOptions.keepVertices.size();
    for (const Index v : hierarchy().intermediate.fineVertex)
    {
      if (near[v])
      {
        levelOptions.keepVertices.push_back(v);
      }
    }
    std::sort(levelOptions.keepVertices.begin(), levelOptions.keepVertices.end());
    levelOptions.keepVertices.erase(
      std::unique(levelOptions.keepVertices.begin(), levelOptions.keepVertices.end()),
      levelOptions.keepVertices.end());
    kept = levelOptions.keepVertices.size() - kept;
    levelOptions.coarseVertices = static_cast<Index>(
      std::max<std::size_t>(coarseVertices + kept, coarseVertices * 5 / 4));
  }

  void recordCoarse(GridMapResult& map, const StageTimes& times)
  {
    const std::size_t fine = result_.surface.mesh.faceCount();
    const std::size_t middle = hierarchy().intermediate.mesh.faceCount();
    const std::size_t coarse = hierarchy().coarse.mesh.faceCount();
    addStage("phase1", times.phase1, fine, middle);
    addStage("phase2", times.phase2, middle, coarse);
    addStage("handles", times.handles, middle, result_.smallParts.handles);
    if (options_.distortionMetric)
    {
      addStage("metric", times.metric, middle, coarse);
    }
    addStage("field", times.field, coarse, coarse);
    addStage("seamless", times.seamless, coarse, coarse);
    addStage("quantize", times.quantize, coarse, coarse);
    addStage("embed", times.embed, coarse, coarse);
    tellInstead(levelNotice_, hierarchy().notice);
    tellInstead(refinementNotice_, refinementNotice(map.refinement));
    result_.coarseCertificate = map.certificate;
    result_.coarseUv = std::move(map.uv);
    coarseField_ = std::move(map.field);
    result_.coarseTurns = coarseField_.turns;
    result_.coarse = hierarchy().coarse;
    if (!map.status.ok())
    {
      fail(map.status.code, "no valid map of the coarse mesh: " + map.status.message);
      troubles_ = positionsOf(result_.coarse.mesh, map.offenders);
    }
  }

  void transfer()
  {
    ++result_.replays;
    const double start = now();
    const Mesh& mesh = result_.surface.mesh;
    TransferOptions transferOptions;
    transferOptions.threads = options_.threads;
    transferOptions.progress = subProgress(options_.progress, 0.8, 0.9, "Mapping back: ");
    result_.transfer =
      transferMap(mesh, result_.coarse, hierarchy().log, result_.coarseUv, transferOptions);
    result_.uv = std::move(result_.transfer.uv);
    result_.transfer.uv.clear();
    addStage("replay", now() - start, result_.coarse.mesh.faceCount(), mesh.faceCount());

    const double carried = now();
    expandSingularities();
    integerVertex_.assign(mesh.vertexCount(), 0);
    const std::vector<std::uint8_t> coarseInteger =
      integerVertices(result_.coarse.mesh, coarseField_);
    for (Index v = 0; v < coarseInteger.size(); ++v)
    {
      integerVertex_[result_.coarse.fineVertex[v]] = coarseInteger[v];
    }
    result_.certificate =
      certify(mesh, result_.uv, result_.turns, integerVertex_, options_.threads);
    addStage("certify", now() - carried, mesh.faceCount(), mesh.faceCount());
  }

  /// Turns of the finest level: removed vertices are regular.
  void expandSingularities()
  {
    const Mesh& mesh = result_.surface.mesh;
    result_.turns.assign(mesh.vertexCount(), 4);
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      pollNowAndThen(h);
      if (mesh.isBoundary(h))
      {
        result_.turns[mesh.origin[h]] = 2;
      }
    }
    for (Index v = 0; v < result_.coarse.mesh.vertexCount(); ++v)
    {
      result_.turns[result_.coarse.fineVertex[v]] = coarseField_.turns[v];
    }
  }

  /// On request: the same integers, solved again on a finer level.
  bool improve()
  {
    if (options_.finalQuality == FinalQuality::Coarse)
    {
      return true;
    }
    if (options_.method != MapMethod::ScaleAware && !result_.certificate.valid())
    {
      result_.notices.push_back(
        "final quality: the map of the coarse level was kept, as that by the "
        "method '" +
        std::string(nameOf(options_.method)) + "' is no integer-grid map to begin with");
      return true;
    }
    const double start = now();
    if (options_.finalQuality == FinalQuality::Intermediate && !levels_)
    {
      makeLevels(mapLevels_); // let go when an earlier attempt turned out to be the better one
    }
    if (options_.finalQuality == FinalQuality::Intermediate &&
      hierarchy().coarse.fineVertex != result_.coarse.fineVertex)
    {
      // Levels that a memory has kept from another run are nearly the same only.
      result_.notices.push_back("final quality: the map of the coarse level was kept, as its "
                                "decimation is not there any more");
      return true;
    }
    FinalQualityOptions finalOptions;
    finalOptions.level = options_.finalQuality;
    finalOptions.edgeLength = result_.targetEdgeLength;
    finalOptions.maximumNumberOfQuads = options_.maximumNumberOfQuads;
    finalOptions.smoothingSteps = options_.smoothingSteps;
    finalOptions.maximumBytes = options_.memoryLimit.value_or(freeMemory());
    finalOptions.threads = options_.threads;
    finalOptions.progress = subProgress(options_.progress, 0.9, 0.95, "Optimizing: ");
    SurfaceMap map{ std::move(result_.uv), result_.certificate };
    const CoarseMap coarse{ levels_ ? &hierarchy() : nullptr, &result_.coarseUv };
    result_.finalQuality =
      improveMap(result_.surface, result_.turns, integerVertex_, coarse, finalOptions, map);
    result_.uv = std::move(map.uv);
    result_.certificate = map.certificate;
    if (!result_.finalQuality.notice.empty())
    {
      result_.notices.push_back(result_.finalQuality.notice);
    }
    addStage(
      "optimize", now() - start, result_.finalQuality.elements, result_.surface.mesh.faceCount());
    return true;
  }

  /// After the extraction, so that the quads do not depend on it.
  void mergeMapCharts()
  {
    if (options_.mergeCharts && result_.status.ok())
    {
      const double start = now();
      const Mesh& mesh = result_.surface.mesh;
      result_.charts = mergeCharts(mesh, result_.uv);
      addStage("charts", now() - start, mesh.faceCount(), result_.charts.charts);
    }
  }

  bool extract()
  {
    letLevelsGo();
    if (options_.method == MapMethod::Seamless)
    {
      result_.notices.push_back("the method 'seamless' has no integers, so there are no quads: the "
                                "map on the surface is the result");
      return true;
    }
    const double start = now();
    const Mesh& mesh = result_.surface.mesh;
    ExtractionOptions extractionOptions;
    extractionOptions.maximumNumberOfQuads = options_.maximumNumberOfQuads;
    extractionOptions.smoothingSteps = options_.smoothingSteps;
    extractionOptions.fixedVertices = indexVertices(result_.surface);
    extractionOptions.threads = options_.threads;
    extractionOptions.progress = subProgress(options_.progress, 0.9, 1.0, "Extracting: ");
    ExtractionResult extracted = extractQuads(mesh, result_.uv, extractionOptions);
    addStage("extract", now() - start, mesh.faceCount(), extracted.mesh.quads.size());
    if (!extracted.status.ok())
    {
      fail(extracted.status.code,
        (isRounded()
            ? std::string("no valid quad mesh from the map by '") + nameOf(options_.method) +
              "', which may have folds (the scale aware method has none): "
            : std::string("no valid quad mesh: ")) +
          extracted.status.message + describeMap() +
          "; ask for more quads, raise the number of coarse vertices (Coarse Vertices, "
          "--coarse-vertices), or raise the feature angle where noise is taken for features");
      troubles_ = positionsOf(mesh, result_.transfer.offenders);
      return false;
    }
    tell(mapNotice(mesh, result_.certificate));
    result_.extraction = extracted;
    result_.quads = std::move(extracted.mesh);
    checkValences();
    return true;
  }

  /// Where the map on the input is not valid everywhere, what was asked for may be lost: that is told.
  void checkValences()
  {
    const std::vector<Index> vertices = indexVertices(result_.surface);
    std::vector<int> valence(vertices.empty() ? 0 : result_.surface.mesh.vertexCount(), 0);
    for (Index p = 0; p < result_.quads.points.size() && !valence.empty(); ++p)
    {
      if (const std::optional<Index> corner = meshCorner(result_.quads, p))
      {
        // On a boundary of k quads there are k + 1 edges; as if the quads went on, it would be k + 2.
        valence[result_.surface.mesh.origin[*corner]] =
          result_.quads.valence[p] + (result_.quads.onBoundary[p] != 0 ? 1 : 0);
      }
    }
    std::vector<ValenceRequest> missed;
    for (const ValenceRequest& request : result_.surface.valenceRequests)
    {
      if (request.valence != kRegularValence && valence[request.vertex] != request.valence)
      {
        missed.push_back(request);
      }
    }
    if (!missed.empty())
    {
      result_.notices.push_back(std::to_string(missed.size()) +
        " points did not get the valence that was asked for, where the map has folds; one is "
        "point " +
        std::to_string(missed.front().point) + " at " +
        placeText(result_.surface.mesh.position[missed.front().vertex]) +
        ": ask for smaller quads, or for fewer irregular vertices there");
    }
  }

  /// Where quads of the coarse map touch themselves.
  struct GridTroubles
  {
    std::size_t defects = 0;
    std::vector<Vector3> places;
  };
  /// Where a loop round a small handle or a thin part is one or two quads long, quads touch themselves though the map is valid: that shows
  /// on the coarse map already, and only smaller quads can help. None when this is not the cause of a failure.
  std::optional<GridTroubles> gridTroubles() const
  {
    if (result_.coarseUv.empty() || !result_.coarseCertificate.valid())
    {
      return std::nullopt;
    }
    ExtractionOptions extractionOptions;
    extractionOptions.maximumNumberOfQuads = options_.maximumNumberOfQuads;
    extractionOptions.smoothingSteps = 0;
    extractionOptions.threads = options_.threads;
    const ExtractionResult coarse =
      extractQuads(result_.coarse.mesh, result_.coarseUv, extractionOptions);
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

  /// Smaller quads for a map whose quads touch themselves: first there, and where that does not do, everywhere.
  bool takeFinerGrid()
  {
    if (options_.coarsestIntegers)
    {
      return false; // a size that fits was looked for
    }
    const std::optional<GridTroubles> troubles = gridTroubles();
    if (!(shrinkQuadsNear(troubles) || doubleQuads(troubles)))
    {
      return false;
    }
    result_.status = {};
    troubles_.clear();
    return true;
  }

  /// False, with the sizes as they were, where this leads to nothing (more).
  bool shrinkQuadsNear(const std::optional<GridTroubles>& troubles)
  {
    if (!mayShrink_)
    {
      return false;
    }
    Mesh& mesh = result_.surface.mesh;
    // A map with other sizes has other places where quads only just fit, so their number need not fall each time.
    if (shrinks_ == kMaximumShrinks || !troubles || troubles->places.empty())
    {
      giveSizesBack();
      return false;
    }
    if (shrinks_++ == 0)
    {
      letLevelsGo();
      onMemoryBefore_ = std::exchange(onMemory_, false); // its surface has not these sizes
      sizesBefore_ = mesh.sizing;
      areaBefore_ = sizedArea();
      firstTroubles_ = *troubles;
    }
    gridDefects_ = troubles->defects;
    std::vector<Vector3> places = troubles->places;
    if (shrinks_ == 1)
    {
      places.insert(places.end(), handlePlaces_.begin(), handlePlaces_.end());
    }
    scaleSizesNear(mesh, places, kShrinkRadius * result_.targetEdgeLength, kShrink);
    limitSizeGrowth(mesh, result_.targetEdgeLength);
    if (sizedArea() > kMostGrowth * areaBefore_)
    {
      giveSizesBack();
      return false;
    }
    std::ostringstream text;
    text << "quads of the wanted size do not fit round a handle or a thin part near "
         << placeText(firstTroubles_.places.front())
         << (firstTroubles_.places.size() > 1 ? " and other places" : "")
         << ": they are made smaller there, about " << std::llround(gridQuads())
         << " quads altogether; close the handle for a result without this";
    gridNotice_ = text.str();
    return true;
  }

  void giveSizesBack()
  {
    if (shrinks_ > 0)
    {
      letLevelsGo();
      onMemory_ = onMemoryBefore_;
      result_.surface.mesh.sizing = sizesBefore_;
    }
    mayShrink_ = false;
  }

  bool doubleQuads(const std::optional<GridTroubles>& troubles)
  {
    // The first time after sizes were tried it is their beginning that counts.
    const bool afterSizes = shrinks_ > 0 && finerGrids_ == 0;
    if (afterSizes)
    {
      gridNotice_.clear();
    }
    const std::optional<GridTroubles> now = afterSizes ? firstTroubles_ : troubles;
    if (!now || finerGrids_ >= kMaximumFinerGrids)
    {
      return false;
    }
    if (finerGrids_ > 0 && now->defects >= gridDefects_)
    {
      troubles_.insert(troubles_.end(), now->places.begin(), now->places.end());
      finerGrids_ = 0; // not a matter of size
      shrinks_ = 0;
      gridNotice_.clear();
      return false;
    }
    ++finerGrids_;
    gridDefects_ = now->defects;
    std::ostringstream text;
    text << "quads of the wanted size do not fit round a handle or a thin part";
    if (!now->places.empty())
    {
      text << " near " << placeText(now->places.front());
    }
    text << ": made for " << std::llround(gridQuads())
         << " quads instead; ask for that many, or close the handle, for a result without this";
    gridNotice_ = text.str();
    return true;
  }

  /// Repeating what takes very long leads nowhere, on the models seen.
  bool mayRepeat() const { return work_ < kMaximumWork; }

  /// What the map is scaled to.
  double gridQuads() const
  {
    const double local = areaBefore_ > 0 && mayShrink_ ? sizedArea() / areaBefore_ : 1.0;
    return static_cast<double>(result_.targetQuads) * std::pow(2.0, finerGrids_) * local;
  }

  static std::vector<Vector3> positionsOf(const Mesh& mesh, const std::vector<Index>& vertices)
  {
    std::vector<Vector3> points;
    for (const Index v : vertices)
    {
      points.push_back(mesh.position[v]);
    }
    return points;
  }

  /// Features that can be given up near the places of the last failure.
  std::vector<Index> featuresNear(const std::vector<Vector3>& troubles) const
  {
    const double radius =
      kFirstFeatureDrop * result_.targetEdgeLength * std::pow(2.0, featureDrops_);
    return featureDrops_ < kMaximumFeatureDrops
      ? detectedFeaturesNear(result_.surface.mesh, troubles, radius)
      : std::vector<Index>{};
  }

  /// Where a map or its quads fail, features that only the dihedral angle asked for are given up near the places of the failure,
  /// further round them each time. False when there is nothing (more) to give up.
  bool dropFeatures()
  {
    const std::vector<Index> features = featuresNear(troubles_);
    if (result_.status.code == StatusCode::TooLarge || features.empty())
    {
      return false;
    }
    ++featureDrops_;
    mayShrink_ = true;
    shrinks_ = 0;
    areaBefore_ = 0;
    unmarkFeatures(result_.surface.mesh, features);
    result_.surface.hash = contentHash(result_.surface.mesh, options_.threads);
    std::ostringstream text;
    text << features.size() << " sharp edges near " << placeText(troubles_.front())
         << (troubles_.size() > 1 ? " and other places" : "")
         << " leave no room for quads of this edge length and were not used as features";
    result_.notices.push_back(text.str());
    result_.status = {};
    troubles_.clear();
    letLevelsGo();
    onMemory_ = false; // its surface has these features
    return true;
  }

  SurfaceInput input_; ///< in the frame from enter() on; empty once the surface is prepared
  Frame frame_;
  std::vector<Vector3> userPoints_; ///< of the input, as they came
  PlaceScope places_;
  std::optional<double> askedEdgeLength_; ///< in units of the input
  RemeshOptions options_;
  PollScope poll_;
  RemeshResult result_;
  RemeshMemory* memory_;                    ///< null: none
  RemeshMemory::Key key_;                   ///< of the surface
  std::optional<PreparedSurface> prepared_; ///< for the memory, while the surface is refined
  bool onMemory_ = false;                   ///< result_.surface is the one that the memory holds
  std::optional<Redecimation> levels_;
  std::vector<Index> levelsKept_; ///< HierarchyOptions::keepVertices of their phase 1
  CrossField coarseField_;
  HierarchyOptions mapLevels_;              ///< of the map that counts
  std::vector<std::uint8_t> integerVertex_; ///< #V of the surface
  std::vector<Vector3> troubles_;           ///< where the last map or its quads failed
  std::optional<QuadState> bestQuads_;      ///< of attempts whose maps have folds
  std::size_t work_ = 0;                    ///< GridMapResult::work of all maps so far
  bool smallPartsKnown_ = false;
  int featureDrops_ = 0;
  bool mayShrink_ = true; ///< whether sizes near the places of failures may help
  int shrinks_ = 0;       ///< how often they were tried
  std::vector<float> sizesBefore_;
  bool onMemoryBefore_ = false;
  double areaBefore_ = 0; ///< over the sizes, before
  GridTroubles firstTroubles_;
  std::vector<HandleLoop> shortLoops_; ///< round handles and holes, of vertices of the surface
  bool loopsDone_ = false;             ///< whether quads were made smaller for them, or cannot be
  std::vector<Vector3> handlePlaces_; ///< on the loops of handles that are too short
  int finerGrids_ = 0;                ///< how often the number of quads was doubled
  std::string gridNotice_;            ///< of the last doubling, while it holds
  std::string levelNotice_, refinementNotice_; ///< of the last attempt
  std::size_t gridDefects_ =
    0; ///< of the quads of the coarse map before the last attempt with smaller ones
};

} // namespace

RemeshResult remesh(SurfaceInput input, const RemeshOptions& options)
{
  return Run(std::move(input), options, nullptr).execute();
}

RemeshResult remesh(SurfaceInput input, const RemeshOptions& options, RemeshMemory& memory)
{
  return Run(std::move(input), options, &memory).execute();
}

} // namespace quadrille

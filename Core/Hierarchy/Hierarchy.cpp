// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/Hierarchy.h"

#include "Base/Clock.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Hierarchy/BudgetDecimation.h"
#include "Hierarchy/ChangedMesh.h"
#include "Hierarchy/DecimationMesh.h"
#include "Hierarchy/GaussianCurvatureCost.h"
#include "Hierarchy/GuideRegions.h"
#include "Hierarchy/HierarchyChecks.h"
#include "Hierarchy/LevelTerms.h"
#include "Hierarchy/LogBuilder.h"
#include "Hierarchy/OrderedDecimation.h"
#include "Hierarchy/StarCache.h"
#include "Hierarchy/UniformDecimation.h"
#include "Hierarchy/VertexRestoration.h"
#include "Hierarchy/VertexScales.h"
#include "Mesh/Sizing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

namespace quadrille
{

namespace
{

/// How far a curve of a coarser level may lie from the input's, in s: a tenth of a quad is not seen in the
/// quads, while a circle of radius s still gets an edge per 0.9 s.
constexpr double kCurveTolerance = 0.1;
/// How far the border of a guided region may lie from its course on the intermediate level, in s: no guide has to be
/// finer than a quad, and the triangles that it follows make it jagged by that much.
constexpr double kRegionTolerance = 0.5;
/// How far a guide reaches beyond its face on the way to the intermediate level, in s.
constexpr double kGuideReach = 0.25;
/// Vertices that phase 1 leaves on the area of a square with its edge length.
constexpr double kVerticesPerSquare = 0.35;
/// Distance on both sides over which the bend at a corner is measured, in s.
constexpr double kCornerScale = 0.25;
/// What bringing a vertex back undoes, in removals, and what another size does, at most, where it is worth it.
constexpr std::size_t kUndoneForKept = 32;
constexpr std::size_t kUndoneForSize = 2;
/// Of an intermediate level and of its DecimationMesh, about.
constexpr std::size_t kBytesOfLevelVertex = 200;

std::vector<Index> sorted(std::vector<Index> values)
{
  sortUnique(values);
  return values;
}

} // namespace

/// The intermediate level as phase 2 begins on it, small and without gaps, and what phase 2 needs from the finest mesh.
class Redecimation::Implementation
{
public:
  Implementation(const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options)
    : fine_(fine), edgeLength_(options.targetEdgeLength), order_(options.order),
      draws_(options.draws), byPhase1_{ sorted(options.keepVertices), fine.sizing }
  {
    checkOptions(fine, options);
    const Stopwatch watch;
    thinOut(fineHash, options);
    hierarchy_.secondsPhase1 = watch.seconds();
  }

  bool allows(const HierarchyOptions& options) const
  {
    return options.targetEdgeLength == edgeLength_ && options.order == order_ &&
      (order_ != DecimationOrder::Stochastic || options.draws == draws_);
  }

  const Level& levelOfPhase1() const
  {
    return asPhase1Left_ ? asPhase1Left_->level : hierarchy_.intermediate;
  }

  /// Puts these vertices (ascending) on the intermediate level, and as many as the sizes ask for that the finest mesh
  /// has now. All else is as phase 1 has left it.
  void putOnLevel(const std::vector<Index>& vertices, const HierarchyOptions& options)
  {
    if ((asPhase1Left_ ? byRestoration_ : byPhase1_).is(vertices, fine_))
    {
      return;
    }
    returnToPhase1();
    if (byPhase1_.is(vertices, fine_))
    {
      return;
    }
    const std::vector<Index> missing = missingVertices(vertices);
    if (missing.empty() && byPhase1_.sizing == fine_.sizing)
    {
      return;
    }
    hierarchy_.coarse = {};
    hierarchy_.log.truncate(intermediateEnd_);
    if (!logPlaces_)
    {
      logPlaces_.emplace(hierarchy_.log, options.threads);
    }
    restore(removalsFrom(hierarchy_.log, *logPlaces_, missing), vertices, options);
  }

  /// See Redecimation::follow.
  bool follow(const Mesh& fine, std::uint64_t fineHash, const NamesBefore& names,
    const HierarchyOptions& options)
  {
    const Stopwatch watch;
    returnToPhase1();
    hierarchy_.coarse = {};
    hierarchy_.log.truncate(intermediateEnd_);
    const ChangedMesh changed(fine, names, options.threads);
    fineCurves_ = traceFeatureCurves(fine, kCornerScale * edgeLength_);
    std::vector<Index> wanted = changed.wanted();
    for (Index v = 0; v < fine.vertexCount(); ++v)
    {
      // The change may have made an end of a curve of a vertex that was none.
      if (fineCurves_.kind[v] == VertexKind::Protected && names.vertex[v] != kInvalidIndex)
      {
        wanted.push_back(names.vertex[v]);
      }
    }
    wanted = sorted(std::move(wanted));
    std::vector<Index> missing;
    std::set_difference(wanted.begin(), wanted.end(), hierarchy_.intermediate.fineVertex.begin(),
      hierarchy_.intermediate.fineVertex.end(), std::back_inserter(missing));
    if (kUndoneForKept * missing.size() > fine.vertexCount())
    {
      return false;
    }
    const std::vector<LoggedRemoval> removals =
      removalsFrom(hierarchy_.log, LogPlaces(hierarchy_.log, options.threads), missing);
    const RestoredLevel level = changed.apply(
      undoRemovals(hierarchy_.intermediate, intermediate_->curveError, hierarchy_.log, removals));
    takeOut(hierarchy_.log, removals);
    changed.rename(hierarchy_.log, options.threads);
    hierarchy_.log.fineHash = fineHash;
    hierarchy_.log.fineFaces = fine.faceCount();
    fine_ = fine;
    byPhase1_ = { {}, fine.sizing };
    byRestoration_ = {};
    logPlaces_.reset();
    fineDefect_.clear();
    cache_.clear();
    anySmallComponent_ =
      vertexScales(fine, edgeLength_, options.isConnected, options.threads).anySmallComponent;
    putThere(thinOutAgain(level, {}, options));
    fineCurves_ = {};
    hierarchy_.secondsPhase1 += watch.seconds();
    return true;
  }

  /// Of what is held only to go back to the level that phase 1 left.
  std::size_t bytesAside() const
  {
    std::size_t bytes = fineCurves_.kind.size() * (sizeof(VertexKind) + sizeof(Index)) +
      (logPlaces_ ? logPlaces_->bytes() : 0);
    if (asPhase1Left_)
    {
      for (const auto& [id, block] : asPhase1Left_->blocks)
      {
        bytes += block.capacity();
      }
      bytes += asPhase1Left_->level.mesh.position.size() * kBytesOfLevelVertex;
    }
    return bytes;
  }

  void setSizes(SharedArray<float> sizing) { fine_.sizing = std::move(sizing); }

  const Hierarchy& update(const HierarchyOptions& options)
  {
    if (!allows(options))
    {
      throw InvalidInput("The coarse level cannot be made anew: the edge length or the order of "
                         "phase 1 has changed.");
    }
    checkPhase2(fine_, options);
    const Stopwatch watch;
    putOnLevel(sorted(options.keepVertices), options);
    if (cost_ != options.cost)
    {
      cache_.clear();
      cost_ = options.cost;
    }
    hierarchy_.log.truncate(intermediateEnd_);
    hierarchy_.coarse = {};
    carryGuides(options);
    DecimationMesh mesh(*intermediate_);
    BudgetOptions budget = budgetOptions(options);
    if (!hierarchy_.intermediate.guides.empty())
    {
      const std::vector<Index> corners =
        markGuideRegions(mesh, hierarchy_.intermediate.guides, edgeLength_);
      budget.keepVertices.insert(budget.keepVertices.end(), corners.begin(), corners.end());
    }
    thinOutFurther(mesh, options.mostOrdered, budget);
    BudgetResult result = decimateToBudget(mesh, budget, cache_);
    hierarchy_.notice = std::move(result.notice);
    hierarchy_.cache = result.cache;
    hierarchy_.curvatureShift = result.curvatureShift / edgeLength_;
    append(result.records);
    hierarchy_.coarse = inFineTerms(mesh.extract(), hierarchy_.intermediate);
    hierarchy_.secondsPhase2 = watch.seconds();
    return hierarchy_;
  }

  Hierarchy& hierarchy() { return hierarchy_; }

private:
  /// Phase 1.
  void thinOut(std::uint64_t fineHash, const HierarchyOptions& options)
  {
    DecimationMesh mesh(
      fine_, traceFeatureCurves(fine_, kCornerScale * edgeLength_), options.threads);
    UniformOptions uniform = uniformOptions(options);
    VertexScales scales = vertexScales(fine_, edgeLength_, options.isConnected, options.threads);
    anySmallComponent_ = scales.anySmallComponent;
    uniform.scale = std::move(scales.scale);
    uniform.keepVertices = byPhase1_.kept;
    uniform.isRough = options.isRough;
    uniform.progress = subProgress(options.progress, 0.0, 0.6);
    LogBuilder log;
    switch (options.order)
    {
      case DecimationOrder::Sweeps:
        decimateUniformly(mesh, uniform, log);
        break;
      case DecimationOrder::Heap:
        decimateByHeap(mesh, uniform, log);
        break;
      case DecimationOrder::Stochastic:
        decimateByDraws(mesh, uniform, options.draws, log);
        break;
    }
    log.endIntermediate();
    Level& level = hierarchy_.intermediate;
    level = mesh.extract();
    makeIntermediate(mesh.curves, mesh.curveError, level.fineVertex);
    hierarchy_.log = log.finish();
    hierarchy_.log.fineHash = fineHash;
    hierarchy_.log.fineFaces = fine_.faceCount();
    intermediateEnd_ = hierarchy_.log.end();
  }

  UniformOptions uniformOptions(const HierarchyOptions& options) const
  {
    UniformOptions uniform;
    uniform.edgeLength = 0.5 * edgeLength_;
    uniform.curveTolerance = kCurveTolerance * edgeLength_;
    uniform.threads = options.threads;
    return uniform;
  }

  /// The intermediate level as it is told, for phase 2. curveError: of the vertices of a mesh, `ids` there.
  void makeIntermediate(const FeatureCurves& fineCurves, const std::vector<float>& curveError,
    const std::vector<Index>& ids)
  {
    const Level& level = hierarchy_.intermediate;
    intermediate_ = std::make_unique<DecimationMesh>(level.mesh, curvesOf(level, fineCurves));
    for (std::size_t v = 0; v < ids.size(); ++v)
    {
      intermediate_->curveError[v] = curveError[ids[v]];
    }
  }

  /// Of these, and where quads are to be smaller than phase 1 had them, those that it has removed.
  std::vector<Index> missingVertices(const std::vector<Index>& vertices) const
  {
    std::vector<Index> wanted = smallerThan(fine_, byPhase1_.sizing);
    wanted.insert(wanted.end(), vertices.begin(), vertices.end());
    wanted = sorted(std::move(wanted));
    std::vector<Index> missing;
    std::set_difference(wanted.begin(), wanted.end(), hierarchy_.intermediate.fineVertex.begin(),
      hierarchy_.intermediate.fineVertex.end(), std::back_inserter(missing));
    return missing;
  }

  /// Undoes the removals, and thins out again what they have touched, but for the vertices.
  void restore(const std::vector<LoggedRemoval>& removals, const std::vector<Index>& vertices,
    const HierarchyOptions& options)
  {
    const RestoredLevel restored = undoRemovals(
      fine_, hierarchy_.intermediate, intermediate_->curveError, hierarchy_.log, removals);
    if (fineCurves_.kind.empty())
    {
      fineCurves_ = traceFeatureCurves(fine_, kCornerScale * edgeLength_);
    }
    ThinnedAgain again = thinOutAgain(restored, vertices, options);
    asPhase1Left_.emplace(AsPhase1Left{ std::move(hierarchy_.intermediate),
      std::move(intermediate_), intermediateEnd_, takeOut(hierarchy_.log, removals) });
    try
    {
      putThere(std::move(again));
    }
    catch (...)
    {
      returnToPhase1();
      throw;
    }
    byRestoration_ = { vertices, fine_.sizing };
  }

  /// What uniform decimation near some places leads to, in terms of the finest mesh.
  struct ThinnedAgain
  {
    Level level;
    std::vector<float> curveError; ///< of the vertices of the level before
    std::vector<Index> ids;        ///< that those of the level have there
    BlockRecords records;
    std::size_t collapses = 0, flips = 0;
  };

  /// Thins out where the level was touched, but for these vertices of the finest mesh.
  ThinnedAgain thinOutAgain(const RestoredLevel& restored, const std::vector<Index>& vertices,
    const HierarchyOptions& options)
  {
    DecimationMesh mesh(restored.level.mesh, curvesOf(restored.level, fineCurves_));
    mesh.curveError = restored.curveError;
    UniformOptions uniform = uniformOptions(options);
    uniform.candidates = restored.touched;
    for (const Index v : vertices)
    {
      uniform.keepVertices.push_back(*positionIn(restored.level, v));
    }
    uniform.scale = restored.level.mesh.sizing;
    if (anySmallComponent_)
    {
      const VertexScales scales =
        vertexScales(fine_, edgeLength_, options.isConnected, options.threads);
      uniform.scale.clear();
      for (const Index v : restored.level.fineVertex)
      {
        uniform.scale.push_back(scales.scale[v]);
      }
    }
    LogBuilder builder;
    decimateUniformly(mesh, uniform, builder);
    const DecimationLog log = builder.finish();
    ThinnedAgain again;
    for (const BlockRecords& block : log.blocks)
    {
      again.records.insert(again.records.end(), block.begin(), block.end());
    }
    again.collapses = log.collapses;
    again.flips = log.flips;
    again.level = mesh.extract();
    again.ids = again.level.fineVertex;
    again.curveError = std::move(mesh.curveError);
    again.level = inFineTerms(std::move(again.level), restored.level);
    again.records = inFineTerms(std::move(again.records), restored.level);
    return again;
  }

  /// As the intermediate level.
  void putThere(ThinnedAgain again)
  {
    hierarchy_.intermediate = std::move(again.level);
    makeIntermediate(fineCurves_, again.curveError, again.ids);
    hierarchy_.log.append(std::move(again.records), again.collapses, again.flips);
    endIntermediate();
  }

  /// The intermediate level and its log without what was brought back.
  void returnToPhase1()
  {
    if (!asPhase1Left_)
    {
      return;
    }
    hierarchy_.coarse = {};
    hierarchy_.log.truncate(asPhase1Left_->end);
    for (auto& [id, block] : asPhase1Left_->blocks)
    {
      hierarchy_.log.blocks[id] = std::move(block);
    }
    hierarchy_.intermediate = std::move(asPhase1Left_->level);
    intermediate_ = std::move(asPhase1Left_->mesh);
    asPhase1Left_.reset();
    endIntermediate();
  }

  /// What the log has leads to the intermediate level, of which nothing is known yet.
  void endIntermediate()
  {
    intermediateEnd_ = hierarchy_.log.end();
    hierarchy_.log.intermediateRounds = hierarchy_.log.rounds.size();
    hierarchy_.intermediate.guides = {};
    guides_ = {};
  }

  /// Brings the guides to the intermediate level, where they have changed.
  void carryGuides(const HierarchyOptions& options)
  {
    if (options.guides == guides_)
    {
      return;
    }
    // In case that what follows is stopped: neither may say that the guides of before are there.
    guides_ = {};
    hierarchy_.intermediate.guides = {};
    hierarchy_.intermediate.guides = guidesOfLevel(
      fine_, hierarchy_.intermediate, options.guides, kGuideReach * edgeLength_, options.threads);
    guides_ = options.guides;
  }

  BudgetOptions budgetOptions(const HierarchyOptions& options)
  {
    const Level& level = hierarchy_.intermediate;
    BudgetOptions budget;
    budget.vertices = options.coarseVertices;
    budget.edgeLength = edgeLength_;
    budget.cost = options.cost;
    for (const Index v : options.keepVertices)
    {
      budget.keepVertices.push_back(*positionIn(level, v));
    }
    if (options.cost == DecimationCost::GaussianMemory)
    {
      if (fineDefect_.empty())
      {
        fineDefect_ = angleDefects(fine_);
      }
      for (const Index v : level.fineVertex)
      {
        budget.inputDefect.push_back(fineDefect_[v]);
      }
    }
    budget.names = &level.fineVertex; // which are the same on the level that vertices came back to
    budget.curveTolerance = kCurveTolerance * edgeLength_;
    budget.regionTolerance = kRegionTolerance * edgeLength_;
    budget.threads = options.threads;
    budget.progress = subProgress(options.progress, 0.6, 1.0);
    return budget;
  }

  /// Rounds like those of phase 1 on its level, until about so many vertices are left, more where guides are: their
  /// regions wait for phase 2, which carries them.
  void thinOutFurther(DecimationMesh& mesh, Index mostOrdered, const BudgetOptions& budget)
  {
    const Mesh& level = hierarchy_.intermediate.mesh;
    if (level.vertexCount() <= mostOrdered)
    {
      return;
    }
    UniformOptions uniform;
    uniform.edgeLength = std::sqrt(kVerticesPerSquare * sizedArea(level) / mostOrdered);
    uniform.scale = vertexScales(level, 2 * uniform.edgeLength, false, budget.threads).scale;
    uniform.curveTolerance = budget.curveTolerance;
    uniform.keepVertices = budget.keepVertices;
    for (std::size_t h = 0; h < mesh.guides.size() * 3; ++h)
    {
      if (!mesh.guides[h / 3].isFree())
      {
        uniform.keepVertices.push_back(mesh.origin[h]);
      }
    }
    uniform.threads = budget.threads;
    uniform.progress = subProgress(budget.progress, 0.0, 0.5);
    LogBuilder builder;
    decimateUniformly(mesh, uniform, builder);
    DecimationLog rounds = builder.finish();
    parallelFor(rounds.blocks.size(), 1, budget.threads,
      [&](std::size_t i, std::size_t)
      { rounds.blocks[i] = inFineTerms(std::move(rounds.blocks[i]), hierarchy_.intermediate); });
    hierarchy_.log.append(std::move(rounds));
  }

  /// Adds the records of phase 2, whose slots are the intermediate level's.
  void append(const RecordWriter& records)
  {
    hierarchy_.log.append(
      inFineTerms(records.bytes(), hierarchy_.intermediate), records.collapses(), records.flips());
  }

  Mesh fine_;
  double edgeLength_ = 0;
  DecimationOrder order_ = DecimationOrder::Sweeps;
  RandomDraws draws_;
  Hierarchy hierarchy_;
  std::unique_ptr<DecimationMesh> intermediate_; ///< on the positions of hierarchy_.intermediate
  DecimationLog::End intermediateEnd_;
  bool anySmallComponent_ = false; ///< see VertexScales
  /// What the intermediate level was made for.
  struct Wanted
  {
    std::vector<Index> kept;   ///< ascending
    SharedArray<float> sizing; ///< of the finest mesh

    bool is(const std::vector<Index>& vertices, const Mesh& fine) const
    {
      return kept == vertices && sizing == fine.sizing;
    }
  };
  Wanted byPhase1_;
  Wanted byRestoration_; ///< where something is set aside
  /// Set aside while vertices are back that phase 1 has removed.
  struct AsPhase1Left
  {
    Level level;
    std::unique_ptr<DecimationMesh> mesh;
    DecimationLog::End end;
    std::vector<std::pair<std::size_t, BlockRecords>> blocks; ///< that records were taken from
  };
  std::optional<AsPhase1Left> asPhase1Left_;
  FeatureCurves fineCurves_;           ///< for vertices that come back, when first needed
  std::optional<LogPlaces> logPlaces_; ///< of phase 1, the same
  std::vector<float> fineDefect_;      ///< for GaussianMemory, when first needed
  DecimationCost cost_ = DecimationCost::Gaussian; ///< that the cache was filled with
  std::vector<FaceGuide> guides_;                  ///< that the intermediate level has
  StarCache cache_;
};

bool isLocalChange(const Mesh& fine, const std::vector<float>& sizesBefore, std::size_t kept)
{
  return kUndoneForKept * kept + kUndoneForSize * smallerThan(fine, sizesBefore).size() <=
    fine.vertexCount();
}

Redecimation::Redecimation(
  const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options)
  : implementation_(std::make_unique<Implementation>(fine, fineHash, options))
{
}

Redecimation::~Redecimation() = default;
Redecimation::Redecimation(Redecimation&&) noexcept = default;
Redecimation& Redecimation::operator=(Redecimation&&) noexcept = default;

bool Redecimation::follow(const Mesh& fine, std::uint64_t fineHash, const NamesBefore& names,
  const HierarchyOptions& options)
{
  return implementation_->follow(fine, fineHash, names, options);
}

bool Redecimation::allows(const HierarchyOptions& options) const
{
  return implementation_->allows(options);
}

const Level& Redecimation::intermediateOfPhase1() const
{
  return implementation_->levelOfPhase1();
}

void Redecimation::setSizes(SharedArray<float> sizing)
{
  implementation_->setSizes(std::move(sizing));
}

const Hierarchy& Redecimation::update(const HierarchyOptions& options)
{
  return implementation_->update(options);
}

std::size_t Redecimation::bytesAside() const
{
  return implementation_->bytesAside();
}

void Redecimation::replaceCoarseGuides(std::vector<Guide> guides)
{
  implementation_->hierarchy().coarse.guides = std::move(guides);
}

const Hierarchy& Redecimation::hierarchy() const
{
  return implementation_->hierarchy();
}

Hierarchy Redecimation::take()
{
  return std::move(implementation_->hierarchy());
}

Hierarchy buildHierarchy(const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options)
{
  HierarchyOptions phase1 = options;
  if (isLocalChange(fine, fine.sizing, options.keepVertices.size()))
  {
    phase1.keepVertices.clear();
  }
  Redecimation levels(fine, fineHash, phase1);
  levels.update(options);
  return levels.take();
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/Hierarchy.h"

#include "Base/Clock.h"
#include "Base/DisjointSets.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Hierarchy/BudgetDecimation.h"
#include "Hierarchy/DecimationMesh.h"
#include "Hierarchy/GaussianCurvatureCost.h"
#include "Hierarchy/GuideRegions.h"
#include "Hierarchy/LogBuilder.h"
#include "Hierarchy/OrderedDecimation.h"
#include "Hierarchy/StarCache.h"
#include "Hierarchy/UniformDecimation.h"
#include "Mesh/Sizing.h"
#include "Mesh/SmallComponents.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
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
/// Distance on both sides over which the bend at a corner is measured, in s.
constexpr double kCornerScale = 0.25;
/// Faces of a chunk of the passes over the mesh.
constexpr std::size_t kChunkFaces = std::size_t{ 1 } << 15;

/// What may change from one update to the next.
void checkPhase2(const Mesh& fine, const HierarchyOptions& options)
{
  for (std::size_t i = 0; i < options.guides.size(); ++i)
  {
    const Index f = options.guides[i].face;
    if (f >= fine.faceCount() || (i > 0 && options.guides[i - 1].face >= f))
    {
      throw InvalidInput("Guide " + std::to_string(i) + " is of face " + std::to_string(f) +
        ", but guides must ascend by face, and the mesh has " + std::to_string(fine.faceCount()) +
        " faces.");
    }
  }
  if (options.coarseVertices == 0 && options.cost != DecimationCost::Gaussian &&
    options.cost != DecimationCost::GaussianMemory)
  {
    throw InvalidInput("A coarse level without a number of vertices needs a cost that measures the "
                       "change of curvature.");
  }
}

void checkOptions(const Mesh& fine, const HierarchyOptions& options)
{
  if (!(options.targetEdgeLength > 0) || !std::isfinite(options.targetEdgeLength))
  {
    throw InvalidInput(
      "The target edge length of a decimation must be positive and finite, but is " +
      std::to_string(options.targetEdgeLength) + ".");
  }
  if (options.order == DecimationOrder::Stochastic && options.draws.candidates < 1)
  {
    throw InvalidInput("A draw of vertices needs at least one candidate, but is to have " +
      std::to_string(options.draws.candidates) + ".");
  }
  checkPhase2(fine, options);
  for (const Index v : options.keepVertices)
  {
    if (v >= fine.vertexCount())
    {
      throw InvalidInput("Vertex " + std::to_string(v) + " is to be kept, but the mesh has only " +
        std::to_string(fine.vertexCount()) + " vertices.");
    }
  }
}

/// The vertices of each component, joined along edges.
DisjointSets componentsOf(const Mesh& fine, int threads)
{
  DisjointSets components(fine.vertexCount(), threads);
  parallelFor(fine.faceCount(), kChunkFaces, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t h = 3 * begin; h < 3 * end; h += 3)
      {
        components.join(fine.origin[h], fine.origin[h + 1]);
        components.join(fine.origin[h], fine.origin[h + 2]);
      }
    });
  return components;
}

/// Area of each component over its sizes, at its root.
std::vector<double> componentAreas(const Mesh& fine, DisjointSets& components, int threads)
{
  // Sums of consecutive faces of one component, chunk by chunk, so that the number of threads does not show.
  struct Sum
  {
    Index root = kInvalidIndex;
    double doubledArea = 0;
  };
  std::vector<std::vector<Sum>> sums(fine.faceCount() / kChunkFaces + 1);
  parallelFor(fine.faceCount(), kChunkFaces, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<Sum>& sum = sums[begin / kChunkFaces];
      for (Index f = static_cast<Index>(begin); f < static_cast<Index>(end); ++f)
      {
        const Index root = components.find(fine.origin[3 * f]);
        if (sum.empty() || sum.back().root != root)
        {
          sum.push_back({ root, 0 });
        }
        sum.back().doubledArea += fine.sizing.empty()
          ? fine.edgeVector(3 * f).cross(fine.edgeVector(3 * f + 1)).norm()
          : 2 * sizedArea(fine, f);
      }
    });
  std::vector<double> area(fine.vertexCount(), 0.0);
  for (const std::vector<Sum>& chunk : sums)
  {
    for (const Sum& sum : chunk)
    {
      area[sum.root] += 0.5 * sum.doubledArea;
    }
  }
  return area;
}

/// Factor on s per vertex, beside the sizes that are asked for; empty when there are none and no component is small
/// against s.
std::vector<float> vertexScales(const Mesh& fine, double edgeLength, int threads)
{
  DisjointSets components = componentsOf(fine, threads);
  const std::vector<double> area = componentAreas(fine, components, threads);
  const auto scale = [&](Index root) { return triangulationScale(area[root], edgeLength); };
  bool anySmall = false;
  for (Index v = 0; v < fine.vertexCount() && !anySmall; ++v)
  {
    pollNowAndThen(v);
    anySmall = components.find(v) == v && scale(v) < 1;
  }
  std::vector<float> scales(anySmall || !fine.sizing.empty() ? fine.vertexCount() : 0);
  for (Index v = 0; v < static_cast<Index>(scales.size()); ++v)
  {
    scales[v] = static_cast<float>(scale(components.find(v)) * sizeAt(fine, v));
  }
  return scales;
}

/// The vertex of the level that is vertex v of the finest one, if it is there.
std::optional<Index> positionIn(const Level& level, Index v)
{
  const auto found = std::lower_bound(level.fineVertex.begin(), level.fineVertex.end(), v);
  return found != level.fineVertex.end() && *found == v
    ? std::optional<Index>(static_cast<Index>(found - level.fineVertex.begin()))
    : std::nullopt;
}

/// The curves among the vertices of a level; the ends of curves are on every level.
FeatureCurves curvesOf(const Level& level, const FeatureCurves& fine)
{
  FeatureCurves curves;
  for (const Index v : level.fineVertex)
  {
    curves.kind.push_back(fine.kind[v]);
    curves.curve.push_back(fine.curve[v]);
  }
  const auto toLevel = [&](const std::array<Index, 2>& ends)
  {
    return ends[0] == kInvalidIndex
      ? ends
      : std::array<Index, 2>{ *positionIn(level, ends[0]), *positionIn(level, ends[1]) };
  };
  for (const std::array<Index, 2>& ends : fine.ends)
  {
    curves.ends.push_back(toLevel(ends));
  }
  for (const std::array<Index, 2>& ends : fine.endPairs)
  {
    curves.endPairs.push_back(toLevel(ends)); // the order of the vertices is kept
  }
  return curves;
}

} // namespace

/// The intermediate level as phase 2 begins on it, small and without gaps, and what phase 2 needs from the finest mesh.
class Redecimation::Implementation
{
public:
  Implementation(const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options)
    : fine_(fine), edgeLength_(options.targetEdgeLength), order_(options.order),
      draws_(options.draws)
  {
    checkOptions(fine, options);
    const Stopwatch watch;
    thinOut(fineHash, options);
    hierarchy_.secondsPhase1 = watch.seconds();
  }

  bool allows(const HierarchyOptions& options) const
  {
    return options.targetEdgeLength == edgeLength_ && options.order == order_ &&
      (order_ != DecimationOrder::Stochastic || options.draws == draws_) &&
      std::all_of(options.keepVertices.begin(), options.keepVertices.end(),
        [&](Index v) { return positionIn(hierarchy_.intermediate, v).has_value(); });
  }

  const Hierarchy& update(const HierarchyOptions& options)
  {
    if (!allows(options))
    {
      throw InvalidInput(
        "The coarse level cannot be made anew: the edge length or the order of "
        "phase 1 has changed, or a vertex that is to be kept is not on the intermediate level.");
    }
    checkPhase2(fine_, options);
    const Stopwatch watch;
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
    BudgetResult result = decimateToBudget(mesh, budget, cache_);
    hierarchy_.notice = std::move(result.notice);
    hierarchy_.cache = result.cache;
    hierarchy_.curvatureShift = result.curvatureShift / edgeLength_;
    append(result.records);
    hierarchy_.coarse = inFineTerms(mesh.extract());
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
    UniformOptions uniform;
    uniform.edgeLength = 0.5 * edgeLength_;
    uniform.scale = vertexScales(fine_, edgeLength_, options.threads);
    uniform.curveTolerance = kCurveTolerance * edgeLength_;
    uniform.keepVertices = options.keepVertices;
    uniform.threads = options.threads;
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
    intermediate_.emplace(level.mesh, curvesOf(level, mesh.curves));
    for (Index v = 0; v < level.mesh.vertexCount(); ++v)
    {
      pollNowAndThen(v);
      intermediate_->curveError[v] = mesh.curveError[level.fineVertex[v]];
    }
    hierarchy_.log = log.finish();
    hierarchy_.log.fineHash = fineHash;
    hierarchy_.log.fineFaces = fine_.faceCount();
    intermediateEnd_ = hierarchy_.log.end();
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
    budget.curveTolerance = kCurveTolerance * edgeLength_;
    budget.regionTolerance = kRegionTolerance * edgeLength_;
    budget.threads = options.threads;
    budget.progress = subProgress(options.progress, 0.6, 1.0);
    return budget;
  }

  /// Adds the records of phase 2, whose slots are the intermediate level's.
  void append(const RecordWriter& records)
  {
    const std::vector<Index>& fineFace = hierarchy_.intermediate.fineFace;
    BlockRecords bytes = records.bytes();
    renameSlots(bytes, [&](Index slot) { return 3 * fineFace[slot / 3] + slot % 3; });
    hierarchy_.log.append(std::move(bytes), records.collapses(), records.flips());
  }

  Level inFineTerms(Level level) const
  {
    for (Index& v : level.fineVertex)
    {
      v = hierarchy_.intermediate.fineVertex[v];
    }
    for (Index& f : level.fineFace)
    {
      f = hierarchy_.intermediate.fineFace[f];
    }
    return level;
  }

  const Mesh& fine_;
  double edgeLength_ = 0;
  DecimationOrder order_ = DecimationOrder::Sweeps;
  RandomDraws draws_;
  Hierarchy hierarchy_;
  std::optional<DecimationMesh> intermediate_;
  DecimationLog::End intermediateEnd_;
  std::vector<float> fineDefect_;                  ///< for GaussianMemory, when first needed
  DecimationCost cost_ = DecimationCost::Gaussian; ///< that the cache was filled with
  std::vector<FaceGuide> guides_;                  ///< that the intermediate level has
  StarCache cache_;
};

Redecimation::Redecimation(
  const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options)
  : implementation_(std::make_unique<Implementation>(fine, fineHash, options))
{
}

Redecimation::~Redecimation() = default;
Redecimation::Redecimation(Redecimation&&) noexcept = default;
Redecimation& Redecimation::operator=(Redecimation&&) noexcept = default;

bool Redecimation::allows(const HierarchyOptions& options) const
{
  return implementation_->allows(options);
}

const Hierarchy& Redecimation::update(const HierarchyOptions& options)
{
  return implementation_->update(options);
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
  Redecimation levels(fine, fineHash, options);
  levels.update(options);
  return levels.take();
}

} // namespace quadrille

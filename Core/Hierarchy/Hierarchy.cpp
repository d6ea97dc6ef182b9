// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/Hierarchy.h"

#include "Base/Clock.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Hierarchy/BudgetDecimation.h"
#include "Hierarchy/GaussianCurvatureCost.h"
#include "Hierarchy/HierarchyChecks.h"
#include "Hierarchy/IntermediateLevel.h"
#include "Hierarchy/LevelTerms.h"
#include "Hierarchy/LogBuilder.h"
#include "Hierarchy/StarCache.h"
#include "Hierarchy/UniformDecimation.h"
#include "Hierarchy/VertexScales.h"
#include "Mesh/Sizing.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace quadrille
{

namespace
{
/// Vertices that phase 1 leaves on the area of a square with its edge length.
constexpr double kVerticesPerSquare = 0.35;

/// Without what GaussianMemory needs of the finest mesh.
BudgetOptions budgetOptions(const Level& level, const HierarchyOptions& options)
{
  BudgetOptions budget;
  budget.vertices = options.coarseVertices;
  budget.edgeLength = options.targetEdgeLength;
  budget.cost = options.cost;
  for (const Index v : options.keepVertices)
  {
    budget.keepVertices.push_back(*positionIn(level, v));
  }
  budget.curveTolerance = kCurveTolerance * options.targetEdgeLength;
  budget.threads = options.threads;
  budget.progress = subProgress(options.progress, 0.6, 1.0);
  return budget;
}

/// Rounds like those of phase 1 on its level, until about so many vertices are left. What they do goes to the log.
void thinOutFurther(const Level& level, Index mostOrdered, const BudgetOptions& budget,
  DecimationMesh& mesh, DecimationLog& log)
{
  if (level.mesh.vertexCount() <= mostOrdered)
  {
    return;
  }
  UniformOptions uniform;
  uniform.edgeLength = std::sqrt(kVerticesPerSquare * sizedArea(level.mesh) / mostOrdered);
  uniform.scale = vertexScales(level.mesh, 2 * uniform.edgeLength, false, budget.threads).scale;
  uniform.curveTolerance = budget.curveTolerance;
  uniform.keepVertices = budget.keepVertices;
  uniform.threads = budget.threads;
  uniform.progress = subProgress(budget.progress, 0.0, 0.5);
  LogBuilder builder;
  decimateUniformly(mesh, uniform, builder);
  DecimationLog rounds = builder.finish();
  parallelFor(rounds.blocks.size(), 1, budget.threads,
    [&](std::size_t i, std::size_t)
    { rounds.blocks[i] = inFineTerms(std::move(rounds.blocks[i]), level); });
  log.append(std::move(rounds));
}

} // namespace

/// Phase 2, from the intermediate level on, as often as it is asked for.
class Redecimation::Implementation
{
public:
  Implementation(const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options)
    : intermediate_(fine, fineHash, options, hierarchy_)
  {
  }

  IntermediateLevel& intermediate() { return intermediate_; }
  Hierarchy& hierarchy() { return hierarchy_; }

  const Hierarchy& update(const HierarchyOptions& options)
  {
    refuseIf(options.targetEdgeLength != intermediate_.edgeLength(),
      "The coarse level cannot be made anew: the edge length of phase 1 has changed.");
    checkPhase2(intermediate_.fine(), options);
    const Stopwatch watch;
    std::vector<Index> kept = options.keepVertices;
    sortUnique(kept);
    intermediate_.put(kept, options);
    intermediate_.dropCoarse();
    decimate(options);
    intermediate_.carryGuides(options);
    hierarchy_.secondsPhase2 = watch.seconds();
    return hierarchy_;
  }

private:
  void decimate(const HierarchyOptions& options)
  {
    const Level& level = hierarchy_.intermediate;
    DecimationMesh mesh(intermediate_.mesh());
    BudgetOptions budget = budgetOptions(level, options);
    budget.names = &level.fineVertex; // the same on the level that vertices came back to
    if (options.cost == DecimationCost::GaussianMemory)
    {
      budget.inputDefect = inputDefects(level);
    }
    thinOutFurther(level, options.mostOrdered, budget, mesh, hierarchy_.log);
    BudgetResult result = decimateToBudget(mesh, budget, cacheFor(options.cost));
    hierarchy_.notice = std::move(result.notice);
    hierarchy_.cache = result.cache;
    hierarchy_.curvatureShift = result.curvatureShift / options.targetEdgeLength;
    // Slots of phase 2 are the intermediate level's.
    hierarchy_.log.append(inFineTerms(result.records.bytes(), level), result.records.collapses(),
      result.records.flips());
    hierarchy_.coarse = inFineTerms(mesh.extract(), level);
  }

  /// Empty where the stars before were those of another cost.
  StarCache& cacheFor(DecimationCost cost)
  {
    if (costOfCache_ != cost)
    {
      cache_.clear();
      costOfCache_ = cost;
    }
    return cache_;
  }

  std::vector<float> inputDefects(const Level& level)
  {
    if (fineDefect_.empty())
    {
      fineDefect_ = angleDefects(intermediate_.fine());
    }
    std::vector<float> defects;
    for (const Index v : level.fineVertex)
    {
      defects.push_back(fineDefect_[v]);
    }
    return defects;
  }

  Hierarchy hierarchy_;
  IntermediateLevel intermediate_;
  std::vector<float> fineDefect_; ///< for GaussianMemory, when first needed
  StarCache cache_;
  DecimationCost costOfCache_ = DecimationCost::Gaussian;
};

Redecimation::Redecimation(
  const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options)
  : implementation_(std::make_unique<Implementation>(fine, fineHash, options))
{
}

Redecimation::~Redecimation() = default;
Redecimation::Redecimation(Redecimation&&) noexcept = default;
Redecimation& Redecimation::operator=(Redecimation&&) noexcept = default;

const Level& Redecimation::intermediateOfPhase1() const
{
  return implementation_->intermediate().ofPhase1();
}

void Redecimation::setSizes(SharedArray<float> sizing)
{
  implementation_->intermediate().setSizes(std::move(sizing));
}

const Hierarchy& Redecimation::update(const HierarchyOptions& options)
{
  return implementation_->update(options);
}

std::size_t Redecimation::bytesAside() const
{
  return implementation_->intermediate().bytesAside();
}

void Redecimation::setGuides(const HierarchyOptions& options)
{
  implementation_->intermediate().carryGuides(options);
}

void Redecimation::setCoarseGuides(std::vector<Guide> guides)
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

std::vector<Index> onFinest(const std::vector<Index>& vertices, const Level& level)
{
  std::vector<Index> finest(vertices.size());
  std::transform(
    vertices.begin(), vertices.end(), finest.begin(), [&](Index v) { return level.fineVertex[v]; });
  return finest;
}

} // namespace quadrille

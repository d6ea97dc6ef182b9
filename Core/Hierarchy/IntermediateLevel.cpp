// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/IntermediateLevel.h"

#include "Base/Clock.h"
#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Hierarchy/GuidesOfLevel.h"
#include "Hierarchy/HierarchyChecks.h"
#include "Hierarchy/LevelTerms.h"
#include "Hierarchy/LogBuilder.h"
#include "Hierarchy/UniformDecimation.h"
#include "Hierarchy/VertexScales.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace quadrille
{

namespace
{

/// Half an edge of the intermediate level, about, in s: how far a guide reaches beyond its face on the way there, and
/// the distance on both sides over which the bend at a corner is measured.
constexpr double kHalfEdge = 0.25;
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

/// Those of the wanted vertices that the level lacks.
std::vector<Index> missingOn(const Level& level, std::vector<Index> wanted)
{
  wanted = sorted(std::move(wanted));
  std::vector<Index> missing;
  std::set_difference(wanted.begin(), wanted.end(), level.fineVertex.begin(),
    level.fineVertex.end(), std::back_inserter(missing));
  return missing;
}

UniformOptions uniformOptions(double edgeLength, const HierarchyOptions& options)
{
  UniformOptions uniform;
  uniform.edgeLength = 0.5 * edgeLength;
  uniform.curveTolerance = kCurveTolerance * edgeLength;
  uniform.isExact = options.isExact;
  uniform.threads = options.threads;
  return uniform;
}

FeatureCurves curvesOfFinest(const Mesh& fine, double edgeLength)
{
  return traceFeatureCurves(fine, kHalfEdge * edgeLength);
}

} // namespace

/// What uniform decimation near some places leads to, in terms of the finest mesh.
struct IntermediateLevel::ThinnedAgain
{
  Level level;
  std::vector<float> curveError; ///< of the vertices of the level before
  std::vector<Index> ids;        ///< that those of the level have there
  BlockRecords records;
  std::size_t collapses = 0, flips = 0;
};

IntermediateLevel::IntermediateLevel(
  const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options, Hierarchy& hierarchy)
  : hierarchy_(hierarchy), fine_(fine),
    edgeLength_(options.targetEdgeLength), byPhase1_{ sorted(options.keepVertices), fine.sizing }
{
  checkOptions(fine, options);
  const Stopwatch watch;
  thinOut(fineHash, options);
  hierarchy_.secondsPhase1 = watch.seconds();
}

/// Phase 1.
void IntermediateLevel::thinOut(std::uint64_t fineHash, const HierarchyOptions& options)
{
  DecimationMesh mesh(fine_, curvesOfFinest(fine_, edgeLength_), options.threads);
  UniformOptions uniform = uniformOptions(edgeLength_, options);
  VertexScales scales = vertexScales(fine_, edgeLength_, options.isConnected, options.threads);
  anySmallComponent_ = scales.anySmallComponent;
  uniform.scale = std::move(scales.scale);
  uniform.keepVertices = byPhase1_.kept;
  uniform.isRough = options.isRough;
  uniform.progress = subProgress(options.progress, 0.0, 0.6);
  LogBuilder log;
  decimateUniformly(mesh, uniform, log);
  log.endIntermediate();
  Level& level = hierarchy_.intermediate;
  level = mesh.extract();
  makeMesh(mesh.curves, mesh.curveError, level.fineVertex);
  hierarchy_.log = log.finish();
  hierarchy_.log.fineHash = fineHash;
  hierarchy_.log.fineFaces = fine_.faceCount();
  end_ = hierarchy_.log.end();
}

/// The level as it is told, for phase 2. curveError: of the vertices of a mesh, `ids` there.
void IntermediateLevel::makeMesh(const FeatureCurves& fineCurves,
  const std::vector<float>& curveError, const std::vector<Index>& ids)
{
  const Level& level = hierarchy_.intermediate;
  mesh_ = std::make_unique<DecimationMesh>(level.mesh, curvesOf(level, fineCurves));
  for (std::size_t v = 0; v < ids.size(); ++v)
  {
    mesh_->curveError[v] = curveError[ids[v]];
  }
}

void IntermediateLevel::dropCoarse()
{
  hierarchy_.coarse = {};
  hierarchy_.log.truncate(end_);
}

// Vertices that come back

void IntermediateLevel::put(const std::vector<Index>& vertices, const HierarchyOptions& options)
{
  if ((aside_ ? byRestoration_ : byPhase1_).is(vertices, fine_))
  {
    return;
  }
  returnToPhase1();
  if (byPhase1_.is(vertices, fine_))
  {
    return;
  }
  // Also where quads are to be smaller than phase 1 had them.
  std::vector<Index> wanted = smallerThan(fine_, byPhase1_.sizing);
  wanted.insert(wanted.end(), vertices.begin(), vertices.end());
  const std::vector<Index> missing = missingOn(hierarchy_.intermediate, std::move(wanted));
  if (missing.empty() && byPhase1_.sizing == fine_.sizing)
  {
    return;
  }
  dropCoarse();
  restore(removalsFrom(hierarchy_.log, missing), vertices, options);
}

/// Undoes the removals, and thins out again what they have touched, but for the vertices.
void IntermediateLevel::restore(const std::vector<LoggedRemoval>& removals,
  const std::vector<Index>& vertices, const HierarchyOptions& options)
{
  const RestoredLevel restored =
    undoRemovals(fine_, hierarchy_.intermediate, mesh_->curveError, hierarchy_.log, removals);
  if (fineCurves_.kind.empty())
  {
    fineCurves_ = curvesOfFinest(fine_, edgeLength_);
  }
  ThinnedAgain again = thinOutAgain(restored, vertices, options);
  aside_.emplace(Aside{ std::move(hierarchy_.intermediate), std::move(mesh_), end_,
    takeOut(hierarchy_.log, removals) });
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

/// Thins out where the level was touched, but for these vertices of the finest mesh.
IntermediateLevel::ThinnedAgain IntermediateLevel::thinOutAgain(const RestoredLevel& restored,
  const std::vector<Index>& vertices, const HierarchyOptions& options) const
{
  DecimationMesh mesh(restored.level.mesh, curvesOf(restored.level, fineCurves_));
  mesh.curveError = restored.curveError;
  UniformOptions uniform = uniformOptions(edgeLength_, options);
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
void IntermediateLevel::putThere(ThinnedAgain again)
{
  hierarchy_.intermediate = std::move(again.level);
  makeMesh(fineCurves_, again.curveError, again.ids);
  hierarchy_.log.append(std::move(again.records), again.collapses, again.flips);
  finish();
}

/// The level and its log without what was brought back.
void IntermediateLevel::returnToPhase1()
{
  if (!aside_)
  {
    return;
  }
  hierarchy_.coarse = {};
  hierarchy_.log.truncate(aside_->end);
  for (auto& [id, block] : aside_->blocks)
  {
    hierarchy_.log.blocks[id] = std::move(block);
  }
  hierarchy_.intermediate = std::move(aside_->level);
  mesh_ = std::move(aside_->mesh);
  aside_.reset();
  finish();
}

/// What the log has leads to the level, of which nothing is known yet.
void IntermediateLevel::finish()
{
  end_ = hierarchy_.log.end();
  hierarchy_.log.intermediateRounds = hierarchy_.log.rounds.size();
  hierarchy_.intermediate.guides = {};
  guides_ = {};
}

std::size_t IntermediateLevel::bytesAside() const
{
  std::size_t bytes = fineCurves_.kind.size() * (sizeof(VertexKind) + sizeof(Index));
  if (aside_)
  {
    for (const auto& [id, block] : aside_->blocks)
    {
      bytes += block.capacity();
    }
    bytes += aside_->level.mesh.position.size() * kBytesOfLevelVertex;
  }
  return bytes;
}

void IntermediateLevel::carryGuides(const HierarchyOptions& options)
{
  if (options.guides == guides_)
  {
    return;
  }
  // In case that what follows is stopped: neither may say that the guides of before are there.
  guides_ = {};
  hierarchy_.intermediate.guides = {};
  hierarchy_.intermediate.guides = guidesOfLevel(
    fine_, hierarchy_.intermediate, options.guides, kHalfEdge * edgeLength_, options.threads);
  guides_ = options.guides;
}

bool isLocalChange(const Mesh& fine, const std::vector<float>& sizesBefore, std::size_t kept)
{
  return kUndoneForKept * kept + kUndoneForSize * smallerThan(fine, sizesBefore).size() <=
    fine.vertexCount();
}

} // namespace quadrille

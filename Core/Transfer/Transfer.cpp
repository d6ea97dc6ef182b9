// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/Transfer.h"

#include "Base/LargeArray.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "GridMap/MapCheck.h"
#include "Transfer/ExpectedTurns.h"
#include "Transfer/PatchMender.h"
#include "Transfer/Replay.h"

#include <utility>

namespace quadrille
{

namespace
{

void checkFaces(const Level& level, Index fineFaces)
{
  refuseIf(level.fineFace.size() != level.mesh.faceCount(), "A level of ", level.mesh.faceCount(),
    " faces names ", level.fineFace.size(), " faces of the surface.");
  for (const Index f : level.fineFace)
  {
    refuseIf(f >= fineFaces, "A level names face ", f, " of a surface of ", fineFaces, " faces.");
  }
}

/// uv of the finest mesh's corners, set on the slots of the coarse level; anything elsewhere.
std::vector<FixedVec2> spreadOnSlots(const Level& coarse, const std::vector<FixedVec2>& coarseUv,
  Index fineFaces, const TransferOptions& options)
{
  checkFaces(coarse, fineFaces);
  refuseIf(coarseUv.size() != coarse.mesh.halfEdgeCount(), "The map has ", coarseUv.size(),
    " corners, but the coarse level has ", coarse.mesh.halfEdgeCount(), ".");
  std::vector<FixedVec2> uv;
  if (options.spare != nullptr && options.spare->size() == 3 * std::size_t{ fineFaces })
  {
    uv.swap(*options.spare);
  }
  reserveLarge(uv, 3 * std::size_t{ fineFaces }, options.threads);
  growLarge(uv, 3 * std::size_t{ fineFaces });
  for (Index h = 0; h < coarse.mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    uv[3 * std::size_t{ coarse.fineFace[h / 3] } + h % 3] = coarseUv[h];
  }
  return uv;
}

void checkFineSize(const Mesh& fine, const DecimationLog& log)
{
  refuseIf(log.fineFaces != fine.faceCount(), "The decimation log was made for a surface of ",
    log.fineFaces, " faces, not of ", fine.faceCount(), ".");
}

void checkSizes(const Mesh& fine, const Level& coarse, const DecimationLog& log)
{
  checkFineSize(fine, log);
  refuseIf(coarse.mesh.vertexCount() + log.collapses != fine.vertexCount(),
    "The coarse level does not belong to this decimation log.");
}

std::size_t countNotPositive(const std::vector<FixedVec2>& uv, int threads)
{
  const std::size_t faces = uv.size() / 3;
  return parallelCount(faces, kMediumChunk, threads,
    [&](std::size_t f) { return !(determinant(uv[3 * f], uv[3 * f + 1], uv[3 * f + 2]) > 0); });
}

/// Quarter turns of a map of the coarse level round each of its vertices.
std::vector<int> turnsOf(const Mesh& mesh, const std::vector<FixedVec2>& uv)
{
  return sumTurns(mesh,
    [&](Index h) { return quadrantsEntered(&uv[3 * Mesh::face(h)], static_cast<int>(h % 3), 1); });
}

/// Whether a map that is not valid is one of a few triangles.
enum class MendWhat
{
  PositiveLevels, ///< what was invalid already on the coarse level is not
  All             ///< the level's map was carried there
};

/// turns: what the finest map should wind round each vertex, asked for only where something is to be mended.
template <typename Turns>
TransferResult replayAndMend(const Mesh& fine, const Level& level, std::size_t rounds,
  const DecimationLog& log, const std::vector<FixedVec2>& levelUv, const Turns& turns,
  MendWhat mended, const TransferOptions& options)
{
  const bool levelIsPositive = countNotPositive(levelUv, 1) == 0;
  TransferResult result;
  result.uv = spreadOnSlots(level, levelUv, log.fineFaces, options);
  const ReplayCounts counts =
    replayRounds(log, { rounds, 0 }, result.uv, options.threads, options.progress);
  result.invertedStars = counts.invertedStars;
  result.movedToKernel = counts.movedToKernel;
  result.withoutKernel = counts.withoutKernel;
  // A replay leaves stars positive but for those that it counts, and nothing but what it was given.
  const bool isPositive =
    levelIsPositive && counts.withoutKernel == 0 && counts.lostTransitions == 0;
  result.notPositive = isPositive ? 0 : countNotPositive(result.uv, options.threads);
  result.replayNotPositive = result.notPositive;
  if ((result.notPositive > 0 || result.withoutKernel > 0) &&
    (levelIsPositive || mended == MendWhat::All))
  {
    const MendResult mend =
      mendPatches(fine, result.uv, turns(), options.threads, options.progress);
    result.mendedPatches = mend.patches;
    result.notPositive = mend.notPositive;
    result.defectVertices = cornerVertices(fine, mend.defects);
  }
  return result;
}

} // namespace

TransferResult transferMap(const Mesh& fine, const Level& coarse, const DecimationLog& log,
  const std::vector<FixedVec2>& coarseUv, const TransferOptions& options)
{
  checkSizes(fine, coarse, log);
  return replayAndMend(
    fine, coarse, log.rounds.size(), log, coarseUv,
    [&]() { return expectedTurns(fine, coarse, turnsOf(coarse.mesh, coarseUv)); },
    MendWhat::PositiveLevels, options);
}

TransferResult transferFromLevel(const Mesh& fine, const Level& level, std::size_t rounds,
  const DecimationLog& log, const std::vector<FixedVec2>& uv, const std::vector<int>& turns,
  const TransferOptions& options)
{
  checkFineSize(fine, log);
  refuseIf(turns.size() != fine.position.size(), "The turns have not the size of the surface.");
  return replayAndMend(
    fine, level, rounds, log, uv, [&]() { return turns; }, MendWhat::All, options);
}

std::vector<FixedVec2> transferToLevel(const Level& coarse, const Level& level, std::size_t rounds,
  const DecimationLog& log, const std::vector<FixedVec2>& coarseUv, const TransferOptions& options)
{
  checkFaces(level, log.fineFaces);
  std::vector<FixedVec2> slots = spreadOnSlots(coarse, coarseUv, log.fineFaces, options);
  replayRounds(log, { log.rounds.size(), rounds }, slots, options.threads, options.progress);
  std::vector<FixedVec2> uv(level.mesh.halfEdgeCount());
  for (Index h = 0; h < level.mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    uv[h] = slots[3 * std::size_t{ level.fineFace[h / 3] } + h % 3];
  }
  if (options.spare != nullptr)
  {
    *options.spare = std::move(slots);
  }
  return uv;
}

} // namespace quadrille

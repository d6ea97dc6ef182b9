// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/Transfer.h"

#include "GridMap/MapCheck.h"
#include "Transfer/PatchMender.h"
#include "Transfer/Replay.h"

#include <algorithm>
#include <string>

namespace quadrille
{

namespace
{

void checkSizes(const Mesh& fine, const Level& coarse, const DecimationLog& log,
  const std::vector<FixedVec2>& coarseUv)
{
  if (log.fineFaces != fine.faceCount())
  {
    throw InvalidInput("The decimation log was made for a surface of " +
      std::to_string(log.fineFaces) + " faces, not of " + std::to_string(fine.faceCount()) + ".");
  }
  if (coarseUv.size() != coarse.mesh.halfEdgeCount() ||
    coarse.fineFace.size() != coarse.mesh.faceCount())
  {
    throw InvalidInput("The map has " + std::to_string(coarseUv.size()) +
      " corners, but the coarse level has " + std::to_string(coarse.mesh.halfEdgeCount()) + ".");
  }
  if (coarse.mesh.vertexCount() + log.collapses != fine.vertexCount())
  {
    throw InvalidInput("The coarse level does not belong to this decimation log.");
  }
  for (const Index f : coarse.fineFace)
  {
    if (f >= fine.faceCount())
    {
      throw InvalidInput("The coarse level names face " + std::to_string(f) + " of a surface of " +
        std::to_string(fine.faceCount()) + " faces.");
    }
  }
}

std::size_t countNotPositive(const std::vector<FixedVec2>& uv)
{
  std::size_t count = 0;
  for (std::size_t h = 0; h < uv.size(); h += 3)
  {
    count += determinant(uv[h], uv[h + 1], uv[h + 2]) > 0 ? 0U : 1U;
  }
  return count;
}

std::vector<Index> verticesOf(const Mesh& fine, const std::vector<Index>& faces)
{
  std::vector<Index> vertices;
  for (const Index f : faces)
  {
    vertices.insert(
      vertices.end(), { fine.origin[3 * f], fine.origin[3 * f + 1], fine.origin[3 * f + 2] });
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

/// Turns of the finest map: those of the coarse map at its vertices; removed vertices are regular.
std::vector<int> expectedTurns(
  const Mesh& fine, const Level& coarse, const std::vector<FixedVec2>& coarseUv)
{
  std::vector<int> turns(fine.vertexCount(), 4);
  for (Index h = 0; h < fine.halfEdgeCount(); ++h)
  {
    if (fine.isBoundary(h))
    {
      turns[fine.origin[h]] = 2;
    }
  }
  for (const Index v : coarse.fineVertex)
  {
    turns[v] = 0;
  }
  for (Index h = 0; h < coarse.mesh.halfEdgeCount(); ++h)
  {
    turns[coarse.fineVertex[coarse.mesh.origin[h]]] +=
      quadrantsEntered(&coarseUv[3 * Mesh::face(h)], static_cast<int>(h % 3), 1);
  }
  return turns;
}

} // namespace

TransferResult transferMap(const Mesh& fine, const Level& coarse, const DecimationLog& log,
  const std::vector<FixedVec2>& coarseUv, const TransferOptions& options)
{
  checkSizes(fine, coarse, log, coarseUv);
  TransferResult result;
  result.uv.resize(fine.halfEdgeCount());
  for (Index h = 0; h < coarse.mesh.halfEdgeCount(); ++h)
  {
    result.uv[3 * coarse.fineFace[h / 3] + h % 3] = coarseUv[h];
  }
  const ReplayCounts counts = replayLog(log, result.uv, options.threads, options.progress);
  result.invertedStars = counts.invertedStars;
  result.movedToKernel = counts.movedToKernel;
  result.withoutKernel = counts.withoutKernel;
  result.notPositive = countNotPositive(result.uv);
  // What was invalid already on the coarse level is not a matter of a few triangles here.
  if ((result.notPositive > 0 || result.withoutKernel > 0) && countNotPositive(coarseUv) == 0)
  {
    const MendResult mended =
      mendPatches(fine, result.uv, expectedTurns(fine, coarse, coarseUv), options.progress);
    result.mendedPatches = mended.patches;
    result.notPositive = mended.notPositive;
    result.offenders = verticesOf(fine, mended.defects);
  }
  return result;
}

} // namespace quadrille

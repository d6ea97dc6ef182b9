// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/ChangedMesh.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"

#include <algorithm>
#include <cstddef>

namespace quadrille
{
namespace
{

constexpr std::size_t kChangedFaceChunk = std::size_t{ 1 } << 16;

/// The ids now of the ids before; those that were made are listed in `made`.
std::vector<Index> invert(
  const std::vector<Index>& names, Index countBefore, std::vector<Index>& made)
{
  std::vector<Index> now(countBefore, kInvalidIndex);
  for (Index i = 0; i < names.size(); ++i)
  {
    if (names[i] == kInvalidIndex)
    {
      made.push_back(i);
    }
    else
    {
      now[names[i]] = i;
    }
  }
  return now;
}

} // namespace

ChangedMesh::ChangedMesh(const Mesh& fine, const NamesBefore& names, int threads)
  : fine_(fine), names_(names), newVertex_(invert(names.vertex, names.vertices, madeVertices_)),
    newFace_(invert(names.face, names.faces, madeFaces_)), changed_(fine.vertexCount(), false)
{
  const auto corner = [&](Index f, Index i) { return fine.origin[3 * f + i]; };
  const std::vector<Index> changedFaces =
    parallelSelect(fine.faceCount(), kChangedFaceChunk, threads,
      [&](Index f)
      {
        const auto isMade = [&](Index i) { return names.vertex[corner(f, i)] == kInvalidIndex; };
        return names.face[f] == kInvalidIndex || isMade(0) || isMade(1) || isMade(2);
      });
  for (const Index f : changedFaces)
  {
    for (Index i = 0; i < 3; ++i)
    {
      changed_[corner(f, i)] = true;
      changedVertices_.push_back(corner(f, i));
    }
  }
  sortUnique(changedVertices_);
  const std::vector<Index> stars = parallelSelect(fine.faceCount(), kChangedFaceChunk, threads,
    [&](Index f)
    {
      return hasChangedStar(corner(f, 0)) || hasChangedStar(corner(f, 1)) ||
        hasChangedStar(corner(f, 2));
    });
  for (const Index f : stars)
  {
    for (Index i = 0; i < 3; ++i)
    {
      const Index before = names.vertex[corner(f, i)];
      if (before != kInvalidIndex)
      {
        wanted_.push_back(before);
      }
    }
  }
  for (Index v = 0; v < names.vertices; ++v)
  {
    if (newVertex_[v] == kInvalidIndex)
    {
      wanted_.push_back(v);
    }
  }
  sortUnique(wanted_);
}

RestoredLevel ChangedMesh::apply(const RestoredLevel& before) const
{
  const Level& old = before.level;
  RestoredLevel result;
  Level& level = result.level;
  for (const Index v : old.fineVertex)
  {
    if (newVertex_[v] != kInvalidIndex)
    {
      level.fineVertex.push_back(newVertex_[v]);
    }
  }
  level.fineVertex.insert(level.fineVertex.end(), madeVertices_.begin(), madeVertices_.end());
  std::sort(level.fineVertex.begin(), level.fineVertex.end());
  for (const Index f : old.fineFace)
  {
    if (newFace_[f] != kInvalidIndex)
    {
      level.fineFace.push_back(newFace_[f]);
    }
  }
  level.fineFace.insert(level.fineFace.end(), madeFaces_.begin(), madeFaces_.end());
  std::sort(level.fineFace.begin(), level.fineFace.end());

  for (const Index v : level.fineVertex)
  {
    level.mesh.position.push_back(fine_.position[v]);
    if (!fine_.sizing.empty())
    {
      level.mesh.sizing.push_back(fine_.sizing[v]);
    }
    const Index name = names_.vertex[v];
    result.curveError.push_back(
      name == kInvalidIndex ? 0.0F : before.curveError[indexIn(old.fineVertex, name)]);
  }
  const auto slotNow = [&](Index fineSlot)
  { return 3 * indexIn(level.fineFace, fineSlot / 3) + fineSlot % 3; };
  for (const Index f : level.fineFace)
  {
    const Index name = names_.face[f];
    const Index oldFace = name == kInvalidIndex ? kInvalidIndex : indexIn(old.fineFace, name);
    for (Index i = 0; i < 3; ++i)
    {
      const Index h = 3 * f + i;
      // Both faces of an edge at a vertex whose star has changed are as they are on the finest mesh.
      const bool isFineCorner = hasChangedStar(fine_.origin[h]);
      const bool isFineEdge = isFineCorner || hasChangedStar(fine_.target(h));
      const bool isFineFace = isFineEdge || hasChangedStar(fine_.origin[Mesh::previous(h)]);
      const Index oldSlot = 3 * oldFace + i;
      const Index v =
        isFineFace ? fine_.origin[h] : newVertex_[old.fineVertex[old.mesh.origin[oldSlot]]];
      level.mesh.origin.push_back(indexIn(level.fineVertex, v));
      Index twin = fine_.twin[h];
      if (!isFineEdge)
      {
        const Index g = old.mesh.twin[oldSlot];
        twin = g == kInvalidIndex ? g : 3 * newFace_[old.fineFace[g / 3]] + g % 3;
      }
      level.mesh.twin.push_back(twin == kInvalidIndex ? twin : slotNow(twin));
      level.mesh.flags.push_back(isFineEdge ? fine_.flags[h] : old.mesh.flags[oldSlot]);
    }
  }
  for (const Index v : before.touched)
  {
    const Index now = newVertex_[old.fineVertex[v]];
    if (now != kInvalidIndex)
    {
      result.touched.push_back(indexIn(level.fineVertex, now));
    }
  }
  for (const Index v : changedVertices_)
  {
    result.touched.push_back(indexIn(level.fineVertex, v));
  }
  sortUnique(result.touched);
  return result;
}

void ChangedMesh::rename(DecimationLog& log, int threads) const
{
  parallelFor(log.blocks.size(), 1, threads,
    [&](std::size_t i, std::size_t)
    {
      renameRecords(
        log.blocks[i], [&](Index slot) { return 3 * newFace_[slot / 3] + slot % 3; },
        [&](Index v) { return newVertex_[v]; });
    });
}

} // namespace quadrille

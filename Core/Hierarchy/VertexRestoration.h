// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Brings vertices back that phase 1 has removed. The removal of a vertex is undone together with all later ones that
/// depend on it, and only these, so that what it costs goes with the place and not with the mesh; the log without them
/// leads to the level that comes of it.
///
/// Two removals commute where their stars have no face in common. So the removals that come later and share faces with
/// one of them, directly or through others, are all that has to be undone. Counted in vertices of the mesh as it was
/// when they went, the place that a removal has an influence on does not grow: of each resolution a few hundred come
/// back.
#pragma once

#include "Hierarchy/DecimationLog.h"
#include "Hierarchy/Hierarchy.h"
#include "Mesh/Mesh.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace quadrille
{

/// A removal in a log: the record of its collapse and those of its flips, bytes [begin, end) of a block.
struct LoggedRemoval
{
  std::size_t block = 0;
  std::size_t begin = 0, end = 0;
};

/// The removals of these vertices (ids of the finest mesh, ascending) and all that depend on them, in the order of the
/// log.
std::vector<LoggedRemoval> removalsFrom(
  const DecimationLog& log, const std::vector<Index>& vertices);

/// A level with removals undone.
struct RestoredLevel
{
  Level level; ///< ascending as any other
  std::vector<float>
    curveError; ///< #V, see DecimationMesh; no smaller than it was before the removals
  std::vector<Index> touched; ///< vertices of faces that were in a star, ascending
};

/// The level that the log leads to, without these removals: a set as removalsFrom() gives it.
RestoredLevel undoRemovals(const Mesh& fine, const Level& level,
  const std::vector<float>& curveError, const DecimationLog& log,
  const std::vector<LoggedRemoval>& removals);

/// Takes the records of removals, in the order of the log, out of it. Returns the blocks that held them, as they were.
std::vector<std::pair<std::size_t, BlockRecords>> takeOut(
  DecimationLog& log, const std::vector<LoggedRemoval>& removals);

} // namespace quadrille

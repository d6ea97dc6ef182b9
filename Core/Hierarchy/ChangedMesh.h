// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Takes a hierarchy along when few places of its finest mesh are changed, as where a handle is cut. The removals of
/// all vertices near these places are undone, so that their stars are on the level what they were on the finest mesh;
/// there the level is then what the finest mesh has become, and all else only gets other ids.
#pragma once

#include "Hierarchy/DecimationLog.h"
#include "Hierarchy/Hierarchy.h"
#include "Hierarchy/VertexRestoration.h"
#include "Mesh/NamesBefore.h"

#include <vector>

namespace quadrille
{

class ChangedMesh
{
public:
  /// fine: the finest mesh as it is now. What was changed are faces that were made, faces with a vertex that was made,
  /// and those that have gone, whose place is closed by such. fine and names must outlive this object. threads: 0: all.
  ChangedMesh(const Mesh& fine, const NamesBefore& names, int threads);

  /// Vertices whose stars have changed or that are next to one of these, and those that have gone; ids before,
  /// ascending. None of their removals may be left in the log that rename() is given, nor any that depends on one.
  const std::vector<Index>& wanted() const { return wanted_; }

  /// The level in terms of the mesh as it is now, with its changes. before: has all vertices of wanted(), untouched
  /// by any removal; its positions are not asked for.
  RestoredLevel apply(const RestoredLevel& before) const;

  /// Names of the finest mesh as it is now in place of those before.
  void rename(DecimationLog& log, int threads) const;

private:
  bool hasChangedStar(Index v) const { return changed_[v]; }

  const Mesh& fine_;
  const NamesBefore& names_;
  std::vector<Index> madeVertices_;        ///< ascending
  std::vector<Index> madeFaces_;           ///< ascending
  std::vector<Index> newVertex_, newFace_; ///< by ids before; kInvalidIndex for what has gone
  std::vector<bool> changed_;              ///< #V; the star is another one
  std::vector<Index> changedVertices_;     ///< ascending
  std::vector<Index> wanted_;
};

} // namespace quadrille

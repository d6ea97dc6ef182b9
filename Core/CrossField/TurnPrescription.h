// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Valences that the user asks for, as sums of quarter turns over fans, and whether a field can have them.
#pragma once

#include "Base/Error.h"
#include "CrossField/FieldTopology.h"

#include <vector>

namespace quadrille
{

/// The fans of a group, all sectors of one vertex or its whole ring, make `turns` quarter turns together.
struct TurnPrescription
{
  std::vector<Index> groupOfFan; ///< #fans, kInvalidIndex where free; empty when nothing is asked
  std::vector<int> turns;        ///< per group
  std::size_t valences = 0;      ///< groups of vertices, which come before those of sectors

  bool isFree(Index fan) const { return groupOfFan.empty() || groupOfFan[fan] == kInvalidIndex; }
};

/// targetValence: empty or #V, 0 where free; on the boundary a vertex makes two turns less than its valence says
/// (see ValenceRequest). sectorTurns: empty or #H, see CrossFieldOptions. Throws InvalidInput, naming the vertex, for a
/// wrong size and for a valence below 2 (3 on the boundary).
TurnPrescription prescribeTurns(const Mesh& mesh, const FieldTopology& topology,
  const std::vector<int>& targetValence, const std::vector<int>& sectorTurns = {});

/// Shifts of jumps keep the sum of turns of all fans that unconstrained edges join (and that belong to one vertex with
/// a prescription). Infeasible, with the place and what is missing, where the fans that are free cannot make up for
/// those that are not: an inner vertex goes from 3 to 6 turns, a sector from one to what its triangles carry.
/// turns: per fan, now.
Status checkPrescription(const Mesh& mesh, const FieldTopology& topology,
  const TurnPrescription& prescription, const std::vector<int>& turns);

} // namespace quadrille

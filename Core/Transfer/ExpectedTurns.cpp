// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/ExpectedTurns.h"

#include "Mesh/Topology.h"

namespace quadrille
{

std::vector<int> expectedTurns(
  const Mesh& fine, const Level& coarse, const std::vector<int>& coarseTurns)
{
  std::vector<int> turns = regularTurns(fine);
  for (Index v = 0; v < coarse.mesh.vertexCount(); ++v)
  {
    turns[coarse.fineVertex[v]] = coarseTurns[v];
  }
  return turns;
}

} // namespace quadrille

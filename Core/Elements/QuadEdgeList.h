// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The edges that the nodes between corners lie on.
#pragma once

#include "Elements/SecondOrder.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

/// The edges of the quads, numbered by their first quad.
class QuadEdgeList
{
public:
  QuadEdgeList(const QuadsOnSurface& quads, SecondOrderNodes& nodes);

  const Index* begin(Index edge) const { return halfEdges_.data() + first_[edge]; }
  const Index* end(Index edge) const { return halfEdges_.data() + first_[edge + 1]; }

private:
  std::vector<std::size_t> first_;
  std::vector<Index> halfEdges_; ///< 4 quad + side, of each edge
};

} // namespace quadrille

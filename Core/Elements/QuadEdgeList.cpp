// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Elements/QuadEdgeList.h"

#include <algorithm>
#include <tuple>

namespace quadrille
{

QuadEdgeList::QuadEdgeList(const QuadsOnSurface& quads, SecondOrderNodes& nodes)
{
  struct Side
  {
    Index a, b, halfEdge;
  };
  std::vector<Side> sides;
  sides.reserve(4 * quads.quads.size());
  for (Index q = 0; q < quads.quads.size(); ++q)
  {
    for (Index i = 0; i < 4; ++i)
    {
      const auto [a, b] = std::minmax(quads.quads[q][i], quads.quads[q][(i + 1) % 4]);
      sides.push_back({ a, b, 4 * q + i });
    }
  }
  std::sort(sides.begin(), sides.end(),
    [](const Side& l, const Side& r)
    { return std::tie(l.a, l.b, l.halfEdge) < std::tie(r.a, r.b, r.halfEdge); });
  const auto isFirst = [&sides](std::size_t i)
  { return i == 0 || sides[i].a != sides[i - 1].a || sides[i].b != sides[i - 1].b; };
  std::vector<Index> firstOf(sides.size(), kInvalidIndex); // per half-edge that begins an edge
  for (std::size_t i = 0; i < sides.size(); ++i)
  {
    if (isFirst(i))
    {
      firstOf[sides[i].halfEdge] = static_cast<Index>(i);
    }
  }
  nodes.edgesOfQuad.resize(quads.quads.size());
  first_.push_back(0);
  for (const Index first : firstOf)
  {
    if (first == kInvalidIndex)
    {
      continue;
    }
    const auto edge = static_cast<Index>(nodes.edges.size());
    nodes.edges.push_back({ sides[first].a, sides[first].b });
    std::size_t i = first;
    do
    {
      halfEdges_.push_back(sides[i].halfEdge);
      nodes.edgesOfQuad[sides[i].halfEdge / 4][sides[i].halfEdge % 4] = edge;
      ++i;
    } while (i < sides.size() && !isFirst(i));
    first_.push_back(halfEdges_.size());
    nodes.onBoundary.push_back(first_[edge + 1] - first_[edge] == 1);
  }
}

} // namespace quadrille

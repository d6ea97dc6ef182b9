// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/BoundaryNodes.h"

#include "Base/Progress.h"

#include <algorithm>
#include <cstdlib>

namespace quadrille
{
int axesInCorner(const ExactMap& map, Index h)
{
  const FixedVec2 left = map.at(Mesh::previous(h)) - map.at(h);
  const int first = firstAxis(map.edge(h));
  int count = 0;
  while (count < 2 && orientation(axisVector(first + count), left) > 0)
  {
    ++count;
  }
  return count;
}

std::optional<int> lastIsoline(const ExactMap& map, Index h)
{
  const FixedVec2 p = map.at(h);
  const int first = firstAxis(map.edge(h));
  for (int i = axesInCorner(map, h); i-- > 0;)
  {
    const int direction = (first + i) & 3;
    if (isInteger((direction & 1) == 0 ? p.v : p.u))
    {
      return direction;
    }
  }
  return std::nullopt;
}

Boundary::Boundary(const ExactMap& map, const GridVertices& grid)
  : map_(map), grid_(grid), rank_(map.mesh.halfEdgeCount(), kInvalidIndex),
    leaving_(map.mesh.vertexCount(), kInvalidIndex)
{
  const Mesh& mesh = map.mesh;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.isBoundary(h))
    {
      rank_[h] = static_cast<Index>(halfEdges_.size());
      leaving_[mesh.origin[h]] = h;
      halfEdges_.push_back(h);
    }
  }
  first_.push_back(0);
  for (const Index h : halfEdges_)
  {
    pollNowAndThen(h);
    addOrigin(h);
    addCrossings(h);
    first_.push_back(static_cast<Index>(nodes_.size()));
  }
}

std::optional<Index> Boundary::nodeAtOrigin(Index h) const
{
  const Index n = firstNode(h);
  return n < lastNode(h) && nodes_[n].atOrigin() ? std::optional<Index>(n) : std::nullopt;
}

std::optional<Index> Boundary::nodeOnLine(Index h, FixedVec2 target, int direction) const
{
  for (Index n = firstNode(h); n < lastNode(h); ++n)
  {
    const bool onLine = (direction & 1) == 0 ? nodes_[n].onV : nodes_[n].onU;
    if (onLine && along(nodes_[n].uv - target, direction + 1) == 0)
    {
      return n;
    }
  }
  return std::nullopt;
}

Index Boundary::before(Index h) const
{
  Index last = h;
  forEachFrom(map_.mesh, h, [&](Index g) { last = g; });
  return Mesh::previous(last);
}

void Boundary::addOrigin(Index h)
{
  const FixedVec2 p = map_.at(h);
  if (!isInteger(p.u) && !isInteger(p.v))
  {
    return;
  }
  bool met = map_.isOnIsoline(before(h));
  forEachFrom(map_.mesh, h, [&](Index g) { met = met || lastIsoline(map_, g).has_value(); });
  if (!met)
  {
    return;
  }
  BoundaryNode node;
  node.h = h;
  node.uv = p;
  node.onU = isInteger(p.u);
  node.onV = isInteger(p.v);
  if (node.onU && node.onV)
  {
    node.gridVertex = grid_.findCorner(h).value_or(kInvalidIndex);
  }
  nodes_.push_back(node);
}

void Boundary::addAxis(Index h, bool u, std::vector<BoundaryNode>& list) const
{
  const FixedVec2 a = map_.at(h);
  const FixedVec2 e = map_.edge(h);
  const std::int64_t from = u ? a.u : a.v;
  const std::int64_t length = u ? e.u : e.v;
  const std::int64_t otherFrom = u ? a.v : a.u;
  const std::int64_t otherLength = u ? e.v : e.u;
  const std::int64_t low = std::min(from, from + length);
  const std::int64_t high = std::max(from, from + length);
  for (std::int64_t x = unitAbove(low); x < high; x += kOne)
  {
    BoundaryNode node;
    node.h = h;
    node.numerator = length > 0 ? x - from : from - x;
    node.denominator = std::abs(length);
    const Int128 product = Int128{ node.numerator } * otherLength;
    const Int128 moved = floorDivide(product, node.denominator);
    const Int128 rest = product - moved * node.denominator;
    const std::int64_t other = otherFrom + static_cast<std::int64_t>(moved);
    const auto fine = static_cast<std::int64_t>(rest * kFine / node.denominator);
    node.uv = u ? FixedVec2{ x, other } : FixedVec2{ other, x };
    node.fine = u ? FixedVec2{ 0, fine } : FixedVec2{ fine, 0 };
    const bool both = rest == 0 && isInteger(other);
    node.onU = u || both;
    node.onV = !u || both;
    list.push_back(node);
  }
}

void Boundary::addCrossings(Index h)
{
  std::vector<BoundaryNode> list;
  addAxis(h, true, list);
  addAxis(h, false, list);
  std::sort(list.begin(), list.end(),
    [](const BoundaryNode& a, const BoundaryNode& b)
    { return Int128{ a.numerator } * b.denominator < Int128{ b.numerator } * a.denominator; });
  for (BoundaryNode& node : list)
  {
    if (node.onU && node.onV)
    {
      if (!nodes_.empty() && nodes_.back().h == h && nodes_.back().uv == node.uv &&
        nodes_.back().gridVertex != kInvalidIndex)
      {
        continue; // both isolines found it
      }
      node.gridVertex = grid_.find(Mesh::face(h), node.uv).value_or(kInvalidIndex);
    }
    nodes_.push_back(node);
  }
}

std::vector<BoundaryLoop> loopsWithoutNodes(const ExactMap& map, const Boundary& boundary)
{
  std::vector<BoundaryLoop> loops;
  std::vector<std::uint8_t> seen(map.mesh.vertexCount(), 0);
  for (const Index start : boundary.halfEdges())
  {
    BoundaryLoop loop;
    bool met = false;
    for (Index h = start; !seen[map.mesh.origin[h]]; h = boundary.leaving(map.mesh.target(h)))
    {
      seen[map.mesh.origin[h]] = 1;
      met = met || boundary.firstNode(h) < boundary.lastNode(h);
      loop.push_back(h);
    }
    if (!met && !loop.empty())
    {
      loops.push_back(std::move(loop));
    }
  }
  return loops;
}

bool developLoop(const ExactMap& map, const BoundaryLoop& loop, std::vector<Transition>& toFirst)
{
  toFirst.assign(1, {});
  Transition here;
  for (std::size_t i = 0; i < loop.size(); ++i)
  {
    const Index out = loop[(i + 1) % loop.size()];
    for (Index corner = Mesh::next(loop[i]); corner != out;
         corner = map.mesh.rotateClockwise(corner))
    {
      Transition t;
      if (!map.transition(corner, t))
      {
        return false;
      }
      here = here.after(t.inverse());
    }
    toFirst.push_back(here);
  }
  const bool closes = toFirst.back().isIdentity();
  toFirst.pop_back();
  return closes;
}

} // namespace quadrille

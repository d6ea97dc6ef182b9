// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/NearLoops.h"

#include "Base/Lists.h"
#include "Base/Progress.h"

#include <utility>

namespace quadrille
{
namespace
{

std::vector<Index> allOf(const std::vector<std::vector<Index>>& places)
{
  std::vector<Index> vertices;
  for (const std::vector<Index>& place : places)
  {
    vertices.insert(vertices.end(), place.begin(), place.end());
  }
  return vertices;
}

std::optional<LoopNeighbourhood> partNear(
  const Mesh& mesh, const std::vector<std::vector<Index>>& places, double bound, int threads)
{
  return loopNeighbourhood(mesh, allOf(places), (1 + kRounding) * bound / 2, threads);
}

/// The shortest loop below the bound that meets a vertex of the place. part: what is searched; null: all.
std::optional<LoopSearch::Loop> shortestAt(
  LoopSearch& search, const LoopNeighbourhood* part, const std::vector<Index>& place, double bound)
{
  std::optional<LoopSearch::Loop> best;
  for (const Index root : place)
  {
    const Index from = part != nullptr ? indexIn(part->vertex, root) : root;
    if (std::optional<LoopSearch::Loop> loop = search.shortest(from, best ? best->length : bound))
    {
      best = std::move(loop);
    }
  }
  return best;
}

} // namespace

NearLoops::NearLoops(const Mesh& mesh, const std::vector<std::vector<Index>>& places, double bound,
  LoopSearch::Moves moves, int threads)
  : part_(partNear(mesh, places, bound, threads)), search_(part_ ? part_->mesh : mesh, moves),
    bound_(bound)
{
}

std::optional<LoopSearch::Loop> NearLoops::shortestNear(const std::vector<Index>& place)
{
  return shortestAt(search_, part_ ? &*part_ : nullptr, place, bound_);
}

LoopSearch::Loop NearLoops::onSurface(LoopSearch::Loop loop) const
{
  for (Index& v : loop.vertices)
  {
    v = part_ ? part_->vertex[v] : v;
  }
  for (LoopSearch::Arc& arc : loop.arcs)
  {
    arc.halfEdge = part_ ? part_->halfEdge(arc.halfEdge) : arc.halfEdge;
  }
  return loop;
}

std::optional<std::vector<double>> lengthsNear(
  const Mesh& mesh, const std::vector<std::vector<Index>>& places, double bound, int threads)
{
  std::vector<double> lengths;
  if (places.empty())
  {
    return lengths;
  }
  const std::optional<LoopNeighbourhood> part = partNear(mesh, places, bound, threads);
  if (!part)
  {
    return std::nullopt;
  }
  LoopSearch search(part->mesh, LoopSearch::kStraightened);
  for (const std::vector<Index>& place : places)
  {
    poll();
    const auto loop = shortestAt(search, &*part, place, bound);
    lengths.push_back(loop ? loop->length : 0);
  }
  return lengths;
}

} // namespace quadrille

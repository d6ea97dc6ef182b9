// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/LoopSearch.h"

#include "Base/Progress.h"
#include "Mesh/BreadthFirst.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace quadrille
{

namespace
{

/// A well mixed number for each index [Steele et al. 2014, splitmix64].
std::uint64_t mixed(std::uint64_t i)
{
  std::uint64_t z = (i + 1) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

void flip(LoopSearch::Class& sum, std::size_t i)
{
  sum[i / 64] ^= std::uint64_t{ 1 } << i % 64;
}

bool has(const LoopSearch::Class& sum, std::size_t i)
{
  return (sum[i / 64] >> i % 64 & 1) != 0;
}

/// From corner to corner across the edge of h, both triangles laid into one plane; none where that line does not cross
/// the edge.
std::optional<double> straightAcross(const Mesh& mesh, Index h)
{
  const Vector3& p = mesh.position[mesh.origin[h]];
  const Vector3 edge = mesh.edgeVector(h);
  const double length = edge.norm();
  if (!(length > 0))
  {
    return std::nullopt;
  }
  const auto inPlane = [&](Index corner)
  {
    const Vector3 d = mesh.position[mesh.origin[corner]] - p;
    const double along = d.dot(edge) / length;
    return Vector2(along, std::sqrt(std::max(0.0, d.squaredNorm() - along * along)));
  };
  const Vector2 a = inPlane(Mesh::previous(h));
  const Vector2 b = inPlane(Mesh::previous(mesh.twin[h]));
  const double height = a.y() + b.y();
  if (!(height > 0))
  {
    return std::nullopt;
  }
  const double crossing = a.x() + (b.x() - a.x()) * a.y() / height;
  return crossing > 0 && crossing < length ? std::optional(std::hypot(a.x() - b.x(), height))
                                           : std::nullopt;
}

} // namespace

LoopSearch::LoopSearch(const Mesh& mesh, Moves moves)
  : vertices_(mesh.vertexCount()), faces_(mesh.faceCount()), moves_(moves)
{
  mesh_.position = mesh.position;
  mesh_.origin = mesh.origin;
  mesh_.twin = mesh.twin;
  closeBoundary();
  if (!mesh.sizing.empty())
  {
    mesh_.sizing = mesh.sizing;
    mesh_.sizing.resize(mesh_.vertexCount(), 1.0F); // of vertices that no path meets
  }
  outgoing_ = outgoingHalfEdges(mesh_);
  growTree();
  growCotree();
  collectGenerators();
  labelEdges();
  walkContour();
  visits_.resize(generators_.empty() ? 0 : mesh_.vertexCount());
}

void LoopSearch::closeBoundary()
{
  barred_.assign(vertices_, 0);
  const Index halfEdges = 3 * faces_;
  for (Index start = 0; start < halfEdges; ++start)
  {
    pollNowAndThen(start);
    if (!mesh_.isBoundary(start))
    {
      continue;
    }
    const Index middle = mesh_.vertexCount();
    mesh_.position.push_back(Vector3::Zero());
    barred_.push_back(1);
    // Faces (target, origin, middle), from each boundary half-edge to the one before it on the loop.
    const Index first = mesh_.halfEdgeCount();
    Index h = start;
    do
    {
      const Index face = mesh_.halfEdgeCount();
      mesh_.origin.append({ mesh_.target(h), mesh_.origin[h], middle });
      mesh_.twin.append({ h, face + 5, face - 2 });
      mesh_.twin.edit()[h] = face;
      barred_[mesh_.origin[h]] = moves_ == kInnerEdges ? 1 : 0;
      // What comes in at the origin along the boundary: the last of the fan that is not closed yet. Closed are the
      // starts only.
      h = Mesh::previous(h);
      while (mesh_.twin[h] != kInvalidIndex && Mesh::face(mesh_.twin[h]) < faces_)
      {
        h = Mesh::previous(mesh_.twin[h]);
      }
    } while (mesh_.twin[h] == kInvalidIndex);
    const Index last = mesh_.halfEdgeCount() - 3;
    mesh_.twin.edit()[last + 1] = first + 2;
    mesh_.twin.edit()[first + 2] = last + 1;
  }
}

void LoopSearch::growTree()
{
  inTree_.assign(mesh_.halfEdgeCount(), 0);
  std::vector<std::uint8_t> reached(mesh_.vertexCount(), 0);
  std::vector<Index> queue;
  queue.reserve(mesh_.vertexCount());
  for (Index seed = 0; seed < vertices_; ++seed)
  {
    if (reached[seed] != 0)
    {
      continue;
    }
    reached[seed] = 1;
    for (std::size_t i = (queue.push_back(seed), queue.size() - 1); i < queue.size(); ++i)
    {
      pollNowAndThen(i);
      forEachInFan(mesh_, outgoing_[queue[i]],
        [&](Index h)
        {
          if (reached[mesh_.target(h)] == 0)
          {
            reached[mesh_.target(h)] = 1;
            inTree_[h] = inTree_[mesh_.twin[h]] = 1;
            queue.push_back(mesh_.target(h));
          }
        });
    }
  }
}

void LoopSearch::growCotree()
{
  const Index count = mesh_.faceCount();
  parent_.assign(count, kInvalidIndex);
  const auto enter = [this](Index h)
  {
    if (inTree_[h] != 0)
    {
      return false;
    }
    parent_[Mesh::face(mesh_.twin[h])] = mesh_.twin[h];
    return true;
  };
  order_ = visitFaces(
    mesh_.twin, [](Index) {}, enter);
  // Ranks in which each subtree is an interval: from the sizes of the subtrees.
  std::vector<Index> size(count, 1);
  for (std::size_t i = count; i-- > 0;)
  {
    const Index f = order_[i];
    if (parent_[f] != kInvalidIndex)
    {
      size[Mesh::face(mesh_.twin[parent_[f]])] += size[f];
    }
  }
  rank_.assign(count, 0);
  lastRank_.assign(count, 0);
  std::vector<Index> nextOfChild(count, 0);
  Index nextRoot = 0;
  for (const Index f : order_)
  {
    Index& next =
      parent_[f] == kInvalidIndex ? nextRoot : nextOfChild[Mesh::face(mesh_.twin[parent_[f]])];
    rank_[f] = next;
    next += size[f];
    lastRank_[f] = next - 1;
    nextOfChild[f] = rank_[f] + 1;
  }
}

void LoopSearch::collectGenerators()
{
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    const Index g = mesh_.twin[h];
    if (h < g && inTree_[h] == 0 && parent_[Mesh::face(h)] != h && parent_[Mesh::face(g)] != g)
    {
      generators_.push_back({ h, 0 });
    }
  }
  for (std::size_t i = 0; i < generators_.size(); ++i)
  {
    generators_[i].code = generators_.size() <= 64 ? std::uint64_t{ 1 } << i : mixed(i);
  }
}

/// An edge of the cotree has the generators of which one side is in the subtree beyond it.
void LoopSearch::labelEdges()
{
  label_.assign(generators_.empty() ? 0 : mesh_.halfEdgeCount(), 0);
  if (generators_.empty())
  {
    return;
  }
  std::vector<std::uint64_t> sum(mesh_.faceCount(), 0);
  for (const Generator& generator : generators_)
  {
    const Index h = generator.halfEdge;
    label_[h] = label_[mesh_.twin[h]] = generator.code;
    sum[Mesh::face(h)] ^= generator.code;
    sum[Mesh::face(mesh_.twin[h])] ^= generator.code;
  }
  for (std::size_t i = order_.size(); i-- > 0;)
  {
    const Index h = parent_[order_[i]];
    if (h != kInvalidIndex)
    {
      label_[h] = label_[mesh_.twin[h]] = sum[order_[i]];
      sum[Mesh::face(mesh_.twin[h])] ^= sum[order_[i]];
    }
  }
}

/// Numbers the ends of generators as one meets them on a walk round the tree. With the tree drawn together into a
/// point, two generators cross there if their ends alternate.
void LoopSearch::walkContour()
{
  if (generators_.empty())
  {
    return;
  }
  std::vector<Index> generatorOf(mesh_.halfEdgeCount(), kInvalidIndex);
  for (Index i = 0; i < generators_.size(); ++i)
  {
    generatorOf[generators_[i].halfEdge] = generatorOf[mesh_.twin[generators_[i].halfEdge]] = i;
  }
  std::vector<std::uint8_t> passed(mesh_.halfEdgeCount(), 0);
  std::vector<std::uint8_t> met(generators_.size(), 0);
  std::size_t end = 0;
  for (const Generator& generator : generators_)
  {
    for (Index h = generator.halfEdge; passed[h] == 0;)
    {
      passed[h] = 1;
      if (const Index i = generatorOf[h]; i != kInvalidIndex)
      {
        (met[i] != 0 ? generators_[i].lastEnd : generators_[i].firstEnd) = end++;
        met[i] = 1;
      }
      h = mesh_.rotateCounterclockwise(inTree_[h] != 0 ? mesh_.twin[h] : h);
    }
  }
}

std::vector<Index> LoopSearch::roots() const
{
  std::vector<Index> roots;
  for (Index v = 0; v < vertices_ && !generators_.empty(); ++v)
  {
    bool labelled = false;
    forEachInFan(mesh_, outgoing_[v], [&](Index h) { labelled = labelled || label_[h] != 0; });
    if (labelled && barred_[v] == 0)
    {
      roots.push_back(v);
    }
  }
  return roots;
}

std::vector<Index> LoopSearch::generatorRoots() const
{
  std::vector<Index> roots;
  for (const Generator& generator : generators_)
  {
    const Index v = mesh_.origin[generator.halfEdge];
    roots.push_back(v < vertices_ ? v : mesh_.target(generator.halfEdge));
  }
  return roots;
}

template <typename Visitor>
void LoopSearch::forEachArc(Index v, Visitor&& visit) const
{
  forEachInFan(mesh_, outgoing_[v],
    [&](Index h)
    {
      if (barred_[mesh_.target(h)] == 0)
      {
        visit(Arc{ h, false }, mesh_.target(h), sizedLength(mesh_, h), label_[h]);
      }
      const Index e = Mesh::next(h);
      if (moves_ == kStraightened && Mesh::face(e) < faces_ && Mesh::face(mesh_.twin[e]) < faces_)
      {
        if (const std::optional<double> length = straightAcross(mesh_, e))
        {
          const Index w = mesh_.origin[Mesh::previous(mesh_.twin[e])];
          visit(Arc{ e, true }, w, *length / std::sqrt(sizeAt(mesh_, v) * sizeAt(mesh_, w)),
            label_[h] ^ label_[Mesh::next(mesh_.twin[e])]);
        }
      }
    });
}

/// Dijkstra's algorithm up to half the bound, which may shrink on the way; meet(a, b, arc, length, label) for each arc
/// that closes a loop round a handle in less than the bound.
template <typename Meeting>
void LoopSearch::spread(Index root, const double& bound, Meeting&& meet)
{
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  ++search_;
  visits_[root] = {};
  visits_[root].search = search_;
  queue.push({ 0.0, root });
  while (!queue.empty() && queue.top().first <= bound / 2)
  {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (visits_[v].settled)
    {
      continue;
    }
    visits_[v].settled = true;
    pollNowAndThen(++work_);
    forEachArc(v,
      [&, distance = distance, v = v](
        const Arc& arc, Index to, double length, std::uint64_t arcLabel)
      {
        Visit& next = visits_[to];
        const std::uint64_t label = visits_[v].label ^ arcLabel;
        if (next.search == search_ && next.settled)
        {
          const double around = distance + next.distance + length;
          if (label != next.label && around < bound)
          {
            meet(v, to, arc, around, label ^ next.label);
          }
        }
        else if (next.search != search_ || distance + length < next.distance)
        {
          next = { search_, false, v, arc, distance + length, label };
          queue.push({ next.distance, to });
        }
      });
  }
}

/// The loop of the two paths and the arc, without the way that both paths share at the root.
LoopSearch::Loop LoopSearch::trace(Index a, Index b, const Arc& arc, double length) const
{
  const auto pathFrom = [this](Index v)
  {
    std::vector<Index> path{ v };
    while (visits_[path.back()].from != kInvalidIndex)
    {
      path.push_back(visits_[path.back()].from);
    }
    return path;
  };
  std::vector<Index> left = pathFrom(a);
  std::vector<Index> right = pathFrom(b);
  while (left.size() > 1 && right.size() > 1 && left[left.size() - 2] == right[right.size() - 2])
  {
    left.pop_back();
    right.pop_back();
  }
  Loop loop;
  loop.length = length - 2 * visits_[left.back()].distance;
  for (auto v = left.rbegin(); v != left.rend(); ++v)
  {
    loop.vertices.push_back(*v);
    loop.arcs.push_back(v + 1 != left.rend() ? visits_[*(v + 1)].arc : arc);
  }
  for (std::size_t i = 0; i + 1 < right.size(); ++i)
  {
    loop.vertices.push_back(right[i]);
    loop.arcs.push_back(visits_[right[i]].arc);
  }
  return loop;
}

void LoopSearch::search(Index root, double bound, LoopsByLabel& loops)
{
  if (generators_.empty() || barred_[root] != 0)
  {
    return;
  }
  spread(root, bound,
    [&](Index a, Index b, const Arc& arc, double length, std::uint64_t label)
    {
      const auto found = loops.find(label);
      if (found == loops.end())
      {
        loops.emplace(label, trace(a, b, arc, length));
      }
      else if (length < found->second.length)
      {
        found->second = trace(a, b, arc, length);
      }
    });
}

std::optional<LoopSearch::Loop> LoopSearch::shortest(Index root, double bound)
{
  std::optional<Loop> best;
  if (generators_.empty() || barred_[root] != 0)
  {
    return best;
  }
  spread(root, bound,
    [&](Index a, Index b, const Arc& arc, double length, std::uint64_t)
    {
      best = trace(a, b, arc, length);
      bound = best->length;
    });
  return best;
}

void LoopSearch::addEdge(Index h, Class& sum) const
{
  const Index g = mesh_.twin[h];
  const auto at = std::lower_bound(generators_.begin(), generators_.end(), std::min(h, g),
    [](const Generator& generator, Index e) { return generator.halfEdge < e; });
  if (at != generators_.end() && at->halfEdge == std::min(h, g))
  {
    flip(sum, static_cast<std::size_t>(at - generators_.begin()));
    return;
  }
  const bool below = parent_[Mesh::face(h)] == h;
  if (!below && parent_[Mesh::face(g)] != g)
  {
    return; // an edge of the tree
  }
  const Index child = Mesh::face(below ? h : g);
  const auto inside = [&](Index f)
  { return rank_[f] >= rank_[child] && rank_[f] <= lastRank_[child]; };
  for (std::size_t i = 0; i < generators_.size(); ++i)
  {
    const Index e = generators_[i].halfEdge;
    if (inside(Mesh::face(e)) != inside(Mesh::face(mesh_.twin[e])))
    {
      flip(sum, i);
    }
  }
}

LoopSearch::Class LoopSearch::classOf(const Loop& loop) const
{
  Class sum((generators_.size() + 63) / 64, 0);
  for (const Arc& arc : loop.arcs)
  {
    if (arc.across)
    {
      addEdge(Mesh::previous(arc.halfEdge), sum);
      addEdge(Mesh::next(mesh_.twin[arc.halfEdge]), sum);
    }
    else
    {
      addEdge(arc.halfEdge, sum);
    }
  }
  return sum;
}

LoopSearch::Class LoopSearch::crossings(const Class& loop) const
{
  // odd[k]: whether the loop has an odd number of ends before end k of the contour.
  std::vector<std::uint8_t> ends(2 * generators_.size() + 1, 0);
  for (std::size_t i = 0; i < generators_.size(); ++i)
  {
    if (has(loop, i))
    {
      ends[generators_[i].firstEnd + 1] ^= 1;
      ends[generators_[i].lastEnd + 1] ^= 1;
    }
  }
  for (std::size_t k = 1; k < ends.size(); ++k)
  {
    ends[k] ^= ends[k - 1];
  }
  Class result(loop.size(), 0);
  for (std::size_t i = 0; i < generators_.size(); ++i)
  {
    if (ends[generators_[i].firstEnd + 1] != ends[generators_[i].lastEnd])
    {
      flip(result, i);
    }
  }
  return result;
}

} // namespace quadrille

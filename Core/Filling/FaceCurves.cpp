// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/FaceCurves.h"

#include "Base/Lists.h"
#include "Mesh/CutOpen.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <set>
#include <tuple>

namespace quadrille
{
namespace
{

/// A curve that bends by more than this has a corner, where the quads have a point.
constexpr double kCurveCorner = 0.5235987755982988; // 30 degrees

Index beginOf(const Mesh& mesh, const CurveStep& step)
{
  return step.forwards ? mesh.origin[step.h] : mesh.target(step.h);
}

Index endOf(const Mesh& mesh, const CurveStep& step)
{
  return step.forwards ? mesh.target(step.h) : mesh.origin[step.h];
}

/// Per half-edge of the boundary the number of its loop; kInvalidIndex inside.
std::vector<Index> boundaryLoops(const Mesh& mesh, Index& count)
{
  std::vector<Index> loopOf(mesh.halfEdgeCount(), kInvalidIndex);
  count = 0;
  for (Index first = 0; first < mesh.halfEdgeCount(); ++first)
  {
    if (mesh.isBoundary(first) && loopOf[first] == kInvalidIndex)
    {
      for (Index h = first; loopOf[h] == kInvalidIndex; h = nextOnBoundary(mesh, h))
      {
        loopOf[h] = count;
      }
      ++count;
    }
  }
  return loopOf;
}

} // namespace

FaceCurves::FaceCurves(const Mesh& mesh, std::vector<std::uint8_t> isGiven, double edgeLength)
  : mesh_(mesh), isGiven_(std::move(isGiven)), edgeLength_(edgeLength),
    edges_(constrainedEdges(mesh)), at_(mesh.vertexCount())
{
  Mesh opened = mesh;
  cutOpenAtFeatures(opened);
  faceOf_ = faceComponents(opened, faces_);
  loopOf_ = boundaryLoops(opened, loops_);
  for (const Index h : edges_)
  {
    at_[mesh.origin[h]].push_back(h);
    at_[mesh.target(h)].push_back(h);
  }
  findCurves();
  findGroups();
}

/// Where curves end or meet, or where one has a corner.
bool FaceCurves::isNode(Index v) const
{
  const std::vector<Index>& edges = at_[v];
  if (edges.size() != 2 || isGiven_[edges[0]] != 0 || isGiven_[edges[1]] != 0)
  {
    return true;
  }
  const auto outgoing = [&](Index h) -> Vector3
  { return mesh_.origin[h] == v ? mesh_.edgeVector(h) : Vector3(-mesh_.edgeVector(h)); };
  const Vector3 a = outgoing(edges[0]), b = -outgoing(edges[1]);
  return a.dot(b) < std::cos(kCurveCorner) * a.norm() * b.norm();
}

std::optional<CurveStep> FaceCurves::stepAfter(const CurveStep& step) const
{
  const Index v = endOf(mesh_, step);
  if (isNode(v))
  {
    return std::nullopt;
  }
  const Index h = at_[v][0] == step.h ? at_[v][1] : at_[v][0];
  return CurveStep{ h, mesh_.origin[h] == v };
}

FaceCurve FaceCurves::trace(CurveStep first, std::vector<std::uint8_t>& isDone) const
{
  FaceCurve curve;
  const Index twin = mesh_.isBoundary(first.h) ? kInvalidIndex : mesh_.twin[first.h];
  curve.faces = { faceOf_[Mesh::face(first.h)],
    twin == kInvalidIndex ? kInvalidIndex : faceOf_[Mesh::face(twin)] };
  curve.loops = { loopOf_[first.h], twin == kInvalidIndex ? kInvalidIndex : loopOf_[twin] };
  for (std::optional<CurveStep> step = first; step && isDone[step->h] == 0; step = stepAfter(*step))
  {
    isDone[step->h] = 1;
    curve.steps.push_back(*step);
    curve.length += sizedLength(mesh_, step->h) / edgeLength_;
  }
  curve.closed = endOf(mesh_, curve.steps.back()) == beginOf(mesh_, first);
  return curve;
}

/// From the nodes, then what is closed without one.
void FaceCurves::findCurves()
{
  std::vector<std::uint8_t> isDone(mesh_.halfEdgeCount(), 0);
  for (const bool fromNodes : { true, false })
  {
    for (const Index h : edges_)
    {
      for (const bool forwards : { true, false })
      {
        const CurveStep step{ h, forwards };
        if (isGiven_[h] == 0 && isDone[h] == 0 && isNode(beginOf(mesh_, step)) == fromNodes)
        {
          curves_.push_back(trace(step, isDone));
        }
      }
    }
  }
  // One of those between the same ends may be a single edge.
  std::set<std::pair<Index, Index>> ends;
  for (FaceCurve& curve : curves_)
  {
    const Index a = beginOf(mesh_, curve.steps.front()), b = endOf(mesh_, curve.steps.back());
    const bool isFirst = ends.insert(std::minmax(a, b)).second;
    curve.least = curve.closed ? 3 : isFirst ? 1 : 2;
  }
}

void FaceCurves::findGroups()
{
  groupOf_.resize(faces_);
  for (Index f = 0; f < faces_; ++f)
  {
    groupOf_[f] = f;
  }
  const auto root = [&](Index f)
  {
    while (groupOf_[f] != f)
    {
      f = groupOf_[f];
    }
    return f;
  };
  for (const FaceCurve& curve : curves_)
  {
    if (curve.faces[1] != kInvalidIndex)
    {
      const Index a = root(curve.faces[0]), b = root(curve.faces[1]);
      groupOf_[std::max(a, b)] = std::min(a, b);
    }
  }
  reachesBoundary_.assign(faces_, 0);
  for (Index f = 0; f < faces_; ++f)
  {
    groupOf_[f] = root(f);
  }
  for (const FaceCurve& curve : curves_)
  {
    if (curve.faces[1] == kInvalidIndex)
    {
      reachesBoundary_[groupOf_[curve.faces[0]]] = 1;
    }
  }
}

/// Half-edges of the boundary at whose beginnings curves end on a given part, or that part itself.
std::vector<Index> FaceCurves::endsOnGiven() const
{
  return idsWhere(mesh_.halfEdgeCount(),
    [&](Index h)
    {
      const std::vector<Index>& edges = at_[mesh_.origin[h]];
      const auto given =
        std::count_if(edges.begin(), edges.end(), [&](Index e) { return isGiven_[e] != 0; });
      return mesh_.isBoundary(h) && given > 0 && given < static_cast<long>(edges.size());
    });
}

void FaceCurves::setGiven(std::vector<CurvePoint> points)
{
  given_ = std::move(points);
  // A point at the end of an edge is one at the beginning of the next.
  for (CurvePoint& point : given_)
  {
    if (point.t >= 1)
    {
      point = { nextOnBoundary(mesh_, point.h), 0 };
    }
  }
  const std::vector<Index> ends = endsOnGiven();
  Index loops = 0;
  const std::vector<Index> loopOf = boundaryLoops(mesh_, loops);
  std::vector<std::tuple<double, Index, std::size_t>> pairs; // the nearest first
  for (const Index h : ends)
  {
    for (std::size_t i = 0; i < given_.size(); ++i)
    {
      if (loopOf[given_[i].h] == loopOf[h])
      {
        const Vector3 way =
          positionOf(mesh_, given_[i].onSurface()) - mesh_.position[mesh_.origin[h]];
        pairs.emplace_back(way.squaredNorm(), h, i);
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::set<Index> done;
  std::vector<std::uint8_t> isTaken(given_.size(), 0);
  for (const auto& [distance, h, i] : pairs)
  {
    if (isTaken[i] == 0 && done.insert(h).second)
    {
      isTaken[i] = 1;
      given_[i] = { h, 0 };
    }
  }
}

std::vector<Index> FaceCurves::chooseNumbers()
{
  std::vector<std::size_t> around(faces_, 0), aroundLoop(loops_, 0);
  const auto add = [&](FaceCurve& curve, std::size_t edges)
  {
    curve.edges += edges;
    for (const std::size_t side : { 0, 1 })
    {
      if (curve.faces[side] != kInvalidIndex)
      {
        around[curve.faces[side]] += edges;
        aroundLoop[curve.loops[side]] += edges;
      }
    }
  };
  for (const CurvePoint& point : given_)
  {
    around[faceOf_[Mesh::face(point.h)]] += isGiven_[point.h];
    aroundLoop[loopOf_[point.h]] += isGiven_[point.h];
  }
  for (FaceCurve& curve : curves_)
  {
    curve.edges = 0;
    add(curve, std::max(curve.least, static_cast<std::size_t>(std::llround(curve.length))));
  }
  // Two edges round a face, or round a hole in it, would lie on each other.
  const auto hasFewer = [&](const FaceCurve& curve, std::size_t least)
  {
    return std::any_of(curve.loops.begin(), curve.loops.end(),
      [&](Index loop) { return loop != kInvalidIndex && aroundLoop[loop] < least; });
  };
  for (FaceCurve& curve : curves_)
  {
    const bool isTight = std::any_of(curve.faces.begin(), curve.faces.end(),
      [&](Index f) { return f != kInvalidIndex && around[f] < 4; });
    if ((isTight || hasFewer(curve, 3)) && curve.edges < 3)
    {
      add(curve, 2);
    }
  }
  // A tree over the faces of each group, and over what is outside, where one is reached: from its leaves on an odd face
  // passes an edge on to the one before it.
  std::vector<std::vector<std::pair<std::size_t, Index>>> beside(std::size_t{ faces_ } + 1);
  for (std::size_t c = 0; c < curves_.size(); ++c)
  {
    const Index a = curves_[c].faces[0];
    const Index b = curves_[c].faces[1] == kInvalidIndex ? faces_ : curves_[c].faces[1];
    if (a != b)
    {
      beside[a].emplace_back(c, b);
      beside[b].emplace_back(c, a);
    }
  }
  std::vector<std::uint8_t> isReached(std::size_t{ faces_ } + 1, 0);
  std::vector<std::pair<Index, std::size_t>> order; // face, the curve that leads to it
  std::vector<Index> before(std::size_t{ faces_ } + 1, kInvalidIndex);
  std::vector<Index> roots;
  for (Index i = 0; i <= faces_; ++i)
  {
    const Index root = i == 0 ? faces_ : i - 1; // what is outside comes first
    if (isReached[root] != 0)
    {
      continue;
    }
    isReached[root] = 1;
    roots.push_back(root);
    std::deque<Index> queue{ root };
    while (!queue.empty())
    {
      const Index face = queue.front();
      queue.pop_front();
      for (const auto& [c, next] : beside[face])
      {
        if (isReached[next] == 0)
        {
          isReached[next] = 1;
          before[next] = face;
          order.emplace_back(next, c);
          queue.push_back(next);
        }
      }
    }
  }
  std::vector<Index> odd;
  for (auto step = order.rbegin(); step != order.rend(); ++step)
  {
    if (around[step->first] % 2 != 0)
    {
      FaceCurve& curve = curves_[step->second];
      const bool isShortened = static_cast<double>(curve.edges) > curve.length &&
        curve.edges > curve.least && !hasFewer(curve, 4);
      add(curve, isShortened ? std::size_t(-1) : 1);
    }
  }
  for (const Index root : roots)
  {
    if (root < faces_ && around[root] % 2 != 0)
    {
      odd.push_back(root);
    }
  }
  return odd;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/FaceCurves.h"

#include "Base/Lists.h"
#include "Mesh/BentCurves.h"
#include "Mesh/CutOpen.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace quadrille
{
namespace
{

/// Per half-edge of the boundary the one after it; kInvalidIndex inside.
std::vector<Index> nextOnBoundaries(const Mesh& mesh)
{
  std::vector<Index> next(mesh.halfEdgeCount(), kInvalidIndex);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    next[h] = mesh.isBoundary(h) ? nextOnBoundary(mesh, h) : kInvalidIndex;
  }
  return next;
}

/// Per half-edge of these the number of its loop.
std::vector<Index> boundaryLoops(const std::vector<Index>& next, Index& count)
{
  std::vector<Index> loopOf(next.size(), kInvalidIndex);
  count = 0;
  for (Index first = 0; first < next.size(); ++first)
  {
    if (next[first] != kInvalidIndex && loopOf[first] == kInvalidIndex)
    {
      for (Index h = first; loopOf[h] == kInvalidIndex; h = next[h])
      {
        loopOf[h] = count;
      }
      ++count;
    }
  }
  return loopOf;
}

/// Per half-edge of these a number that rises along each loop.
std::vector<Index> ranksOnLoops(const std::vector<Index>& next)
{
  std::vector<Index> rank(next.size(), kInvalidIndex);
  Index count = 0;
  for (Index first = 0; first < next.size(); ++first)
  {
    for (Index h = first; next[h] != kInvalidIndex && rank[h] == kInvalidIndex; h = next[h])
    {
      rank[h] = count++;
    }
  }
  return rank;
}

} // namespace

FaceCurves::FaceCurves(const Mesh& mesh, std::vector<std::uint8_t> isGiven, double edgeLength)
  : mesh_(mesh), isGiven_(std::move(isGiven)), quads_(quadsAlongCurves(mesh, edgeLength)),
    edges_(constrainedEdges(mesh)), at_(mesh.vertexCount())
{
  Mesh opened = mesh;
  cutOpenAtFeatures(opened);
  faceOf_ = faceComponents(opened, faces_);
  nextOnLoop_ = nextOnBoundaries(opened);
  loopOf_ = boundaryLoops(nextOnLoop_, loops_);
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
  const Index v = endOf(step);
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
    curve.length += quads_[step->h];
  }
  curve.closed = endOf(curve.steps.back()) == beginOf(first);
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
        if (isGiven_[h] == 0 && isDone[h] == 0 && isNode(beginOf(step)) == fromNodes)
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
    const Index a = beginOf(curve.steps.front()), b = endOf(curve.steps.back());
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

void FaceCurves::setGiven(std::vector<CurvePoint> given)
{
  given_ = std::move(given);
  // A point at the end of an edge is one at the beginning of the next.
  for (CurvePoint& point : given_)
  {
    if (point.t >= 1)
    {
      point = { nextOnBoundary(mesh_, point.h), 0 };
    }
  }
  Index loops = 0;
  const std::vector<Index> next = nextOnBoundaries(mesh_);
  const std::vector<Index> loopOf = boundaryLoops(next, loops);
  const std::vector<Index> ranks = ranksOnLoops(next);
  std::vector<std::vector<LoopPlace>> ends(loops), points(loops);
  for (const Index h : endsOnGiven())
  {
    ends[loopOf[h]].push_back({ ranks[h], 0, h });
  }
  for (Index i = 0; i < given_.size(); ++i)
  {
    points[loopOf[given_[i].h]].push_back({ ranks[given_[i].h], given_[i].t, i });
  }
  for (Index loop = 0; loop < loops; ++loop)
  {
    std::sort(ends[loop].begin(), ends[loop].end());
    std::sort(points[loop].begin(), points[loop].end());
    moveToEnds(ends[loop], points[loop]);
  }
}

/// Of a loop, in the order round it: half-edges that ends begin, and points that are given. Each end takes the nearer
/// one of the points on both sides of it that are free yet; those that others have taken in between move on by one, so
/// that the order stays.
void FaceCurves::moveToEnds(
  const std::vector<LoopPlace>& ends, const std::vector<LoopPlace>& points)
{
  const std::size_t count = points.size();
  if (count < ends.size())
  {
    return;
  }
  std::vector<std::uint8_t> isTaken(count, 0);
  const auto freeFrom = [&](std::size_t i, std::size_t step)
  {
    while (isTaken[i % count] != 0)
    {
      i += step;
    }
    return i % count;
  };
  const auto distance = [&](const LoopPlace& end, std::size_t i)
  {
    return (
      positionOf(mesh_, given_[points[i].id].onSurface()) - mesh_.position[mesh_.origin[end.id]])
      .norm();
  };
  const auto nearest = [&](const LoopPlace& end)
  {
    const auto at = std::lower_bound(points.begin(), points.end(), end) - points.begin();
    const std::size_t before = freeFrom(static_cast<std::size_t>(at) + count - 1, count - 1);
    const std::size_t behind = freeFrom(static_cast<std::size_t>(at), 1);
    return std::min(
      std::pair(distance(end, behind), behind), std::pair(distance(end, before), before));
  };
  std::vector<std::pair<double, std::size_t>> order; // of ends, the nearest first
  for (std::size_t k = 0; k < ends.size(); ++k)
  {
    order.emplace_back(nearest(ends[k]).first, k);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [apart, k] : order)
  {
    isTaken[nearest(ends[k]).second] = 1;
  }
  // Round the loop from a point that stays: between two of those there are as many ends as points that move.
  std::size_t first = 0, k = 0;
  if (ends.size() < count)
  {
    first = freeFrom(0, 1);
    k = static_cast<std::size_t>(
      std::upper_bound(ends.begin(), ends.end(), points[first]) - ends.begin());
  }
  else if (!ends.empty())
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      first = distance(ends[0], i) < distance(ends[0], first) ? i : first;
    }
  }
  for (std::size_t i = first; i < first + count; ++i)
  {
    if (isTaken[i % count] != 0)
    {
      given_[points[i % count].id] = { ends[k++ % ends.size()].id, 0 };
    }
  }
}

std::vector<CurvePoint> FaceCurves::pointsAlong(const FaceCurve& curve) const
{
  std::vector<CurvePoint> points;
  const double apart = curve.length / static_cast<double>(curve.edges);
  double gone = 0;
  std::size_t next = 1;
  for (const CurveStep& step : curve.steps)
  {
    const double length = quads_[step.h];
    for (; next < curve.edges && apart * static_cast<double>(next) < gone + length; ++next)
    {
      const double part = (apart * static_cast<double>(next) - gone) / length;
      points.push_back({ step.h, step.forwards ? part : 1 - part });
    }
    gone += length;
  }
  return points;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/FaceCurves.h"

#include "Base/Lists.h"
#include "Mesh/CutOpen.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace quadrille
{
namespace
{

/// A curve that bends by more than this has a corner, where the quads have a point.
constexpr double kCurveCorner = 0.5235987755982988; // 30 degrees

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

} // namespace

FaceCurves::FaceCurves(const Mesh& mesh, std::vector<std::uint8_t> isGiven, double edgeLength)
  : mesh_(mesh), isGiven_(std::move(isGiven)), edgeLength_(edgeLength),
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
    curve.length += sizedLength(mesh_, step->h) / edgeLength_;
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
  const std::vector<Index> loopOf = boundaryLoops(nextOnBoundaries(mesh_), loops);
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

std::vector<CurvePoint> FaceCurves::pointsAlong(const FaceCurve& curve) const
{
  std::vector<CurvePoint> points;
  const double apart = curve.length / static_cast<double>(curve.edges);
  double gone = 0;
  std::size_t next = 1;
  for (const CurveStep& step : curve.steps)
  {
    const double length = sizedLength(mesh_, step.h) / edgeLength_;
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

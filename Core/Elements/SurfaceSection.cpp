// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Elements/SurfaceSection.h"

#include "Base/Angles.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>
#include <utility>

namespace quadrille
{
namespace
{

constexpr double kLongestSection = 3; ///< over the distance of its ends

/// Corners of the point's face that have a weight, as half-edges that leave them.
std::vector<Index> weightedCorners(const SurfacePoint& point)
{
  std::vector<Index> corners;
  for (Index i = 0; i < 3; ++i)
  {
    if (point.weights[i] > kRounding)
    {
      corners.push_back(3 * point.face + i);
    }
  }
  return corners;
}

/// The plane halfway between two places that is perpendicular to their connection.
class MiddlePlane
{
public:
  MiddlePlane(const Vector3& a, const Vector3& b) : middle_(a + (b - a) / 2), along_(b - a) {}

  /// At which part of the way from a to b it is crossed; none where both are on one side.
  std::optional<double> crossing(const Vector3& a, const Vector3& b) const
  {
    const double before = (a - middle_).dot(along_);
    const double behind = (b - middle_).dot(along_);
    if ((before < 0) == (behind < 0))
    {
      return std::nullopt;
    }
    return before / (before - behind);
  }
  double squaredDistance(const Vector3& p) const { return (p - middle_).squaredNorm(); }

private:
  Vector3 middle_, along_;
};

//------------------------------------------------------------------------------
/// The section of a surface with a plane, followed from face to face. Vertices in the plane count as above it, so that
/// each face that is cut has two edges that are.
class PlaneSection
{
public:
  PlaneSection(const Mesh& mesh, const SurfacePoint& from, const SurfacePoint& to, const Vector3& m)
    : mesh_(mesh), from_(from), to_(to), start_(positionOf(mesh, from)), end_(positionOf(mesh, to)),
      plane_(m), targets_(facesAt(mesh, to)), best_(kLongestSection * (end_ - start_).norm())
  {
  }

  /// The shorter of the ways that reach the target.
  std::optional<SurfacePoint> middle()
  {
    for (const Index f : facesAt(mesh_, from_))
    {
      if (std::find(targets_.begin(), targets_.end(), f) != targets_.end())
      {
        return between(f, from_, to_, 0.5);
      }
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        if (isCut(h)) // both ways, as the shorter one may begin away from the target
        {
          follow(h);
        }
      }
    }
    return way_.empty() ? std::nullopt : middleOfWay();
  }

private:
  bool isAbove(Index v) const { return (mesh_.position[v] - start_).dot(plane_) >= 0; }
  bool isCut(Index h) const { return isAbove(mesh_.origin[h]) != isAbove(mesh_.target(h)); }

  CurvePoint cutOf(Index h) const
  {
    const double a = (mesh_.position[mesh_.origin[h]] - start_).dot(plane_);
    const double b = (mesh_.position[mesh_.target(h)] - start_).dot(plane_);
    return { h, a / (a - b) };
  }

  Vector3 crossing(Index h) const { return positionOf(mesh_, cutOf(h).onSurface()); }

  /// From the start through h and on, until it is in a face of the target or too long.
  void follow(Index h)
  {
    std::vector<Index> way{ h };
    Vector3 last = crossing(h);
    double length = (last - start_).norm();
    while (length < best_)
    {
      const Index g = mesh_.twin[way.back()];
      if (g == kInvalidIndex)
      {
        return;
      }
      if (std::find(targets_.begin(), targets_.end(), Mesh::face(g)) != targets_.end())
      {
        length += (end_ - last).norm();
        if (length < best_)
        {
          best_ = length;
          way_ = std::move(way);
        }
        return;
      }
      way.push_back(isCut(Mesh::next(g)) ? Mesh::next(g) : Mesh::previous(g));
      const Vector3 next = crossing(way.back());
      length += (next - last).norm();
      last = next;
      if (way.size() > 2 && way.back() == h)
      {
        return; // round a peak, back to the beginning
      }
    }
  }

  /// Part of the straight way between two places of face f.
  std::optional<SurfacePoint> between(
    Index f, const SurfacePoint& a, const SurfacePoint& b, double part) const
  {
    const auto first = inFace(mesh_, a, f);
    const auto second = inFace(mesh_, b, f);
    if (!first || !second)
    {
      return std::nullopt;
    }
    SurfacePoint point{ f, {} };
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
    {
      point.weights[i] = (1 - part) * first->weights[i] + part * second->weights[i];
      sum += point.weights[i];
    }
    for (double& weight : point.weights)
    {
      weight /= sum;
    }
    return point;
  }

  std::optional<SurfacePoint> middleOfWay() const
  {
    const MiddlePlane middle(start_, end_);
    std::optional<SurfacePoint> best;
    double least = kInfinity;
    SurfacePoint last = from_;
    Vector3 here = start_;
    const auto look = [&](Index f, const SurfacePoint& next)
    {
      const Vector3 there = positionOf(mesh_, next);
      const std::optional<double> part = middle.crossing(here, there);
      const auto point = part ? between(f, last, next, *part) : std::nullopt;
      if (point && middle.squaredDistance(positionOf(mesh_, *point)) < least)
      {
        best = point;
        least = middle.squaredDistance(positionOf(mesh_, *point));
      }
      last = next;
      here = there;
    };
    for (const Index h : way_)
    {
      look(Mesh::face(h), cutOf(h).onSurface());
    }
    look(Mesh::face(mesh_.twin[way_.back()]), to_);
    return best;
  }

  const Mesh& mesh_;
  const SurfacePoint& from_;
  const SurfacePoint& to_;
  Vector3 start_, end_, plane_;
  std::vector<Index> targets_; ///< faces
  double best_;                ///< length of the way, or what it must be below
  std::vector<Index> way_; ///< edges that it crosses, each by the half-edge of the face before it
};

//------------------------------------------------------------------------------
/// What an edge counts that no feature runs along, over its length: up to 1 + kFlat.
constexpr double kFlat = 4;
constexpr double kFlatAngle = kPi / 18;
constexpr double kLongestChain = 10; ///< over the distance of its ends

/// Dijkstra's algorithm on the edges of a surface, from a place to another.
class EdgeSearch
{
public:
  EdgeSearch(const Mesh& mesh, bool boundaryOnly, double longest)
    : mesh_(mesh), boundaryOnly_(boundaryOnly), longest_(longest)
  {
  }

  std::optional<CurveChain> run(const SurfacePoint& from, const SurfacePoint& to)
  {
    const auto starts = edgesOf(from);
    const auto ends = edgesOf(to);
    for (const CurvePoint& s : starts)
    {
      for (const CurvePoint& e : ends)
      {
        joinOnOneEdge(s, e);
      }
      leave(s, false);
      leave(s, true);
    }
    while (!queue_.empty())
    {
      const auto [cost, v] = queue_.top();
      queue_.pop();
      if (cost >= best_ || cost > longest_)
      {
        break;
      }
      Label& label = labels_.at(v);
      if (std::exchange(label.done, true))
      {
        continue;
      }
      arrive(v, label, ends);
      relax(v, label);
    }
    return best_ <= longest_ ? std::optional(chain()) : std::nullopt;
  }

private:
  struct Label
  {
    double cost = 0;
    Index corner = kInvalidIndex;   ///< at the vertex
    Index previous = kInvalidIndex; ///< vertex; none: the start
    CurvePoint from, to;            ///< the segment that leads here
    bool done = false;
  };

  bool isAllowed(Index h) const { return !boundaryOnly_ || mesh_.isBoundary(h); }

  double factor(Index h) const
  {
    if (mesh_.isConstrained(h))
    {
      return 1;
    }
    const auto normal = [this](Index f) { return mesh_.doubleAreaNormal(f).stableNormalized(); };
    const double cosine = normal(Mesh::face(h)).dot(normal(Mesh::face(mesh_.twin[h])));
    return 1 + kFlat * std::exp(-std::acos(std::clamp(cosine, -1.0, 1.0)) / kFlatAngle);
  }

  double costOf(const CurvePoint& a, const CurvePoint& b) const
  {
    return std::abs(b.t - a.t) * mesh_.edgeVector(a.h).norm() * factor(a.h);
  }

  /// The edges that the place lies on, each once: at a vertex all of it, from there.
  std::vector<CurvePoint> edgesOf(const SurfacePoint& point) const
  {
    const std::vector<Index> corners = weightedCorners(point);
    std::vector<CurvePoint> edges;
    if (corners.size() == 2)
    {
      const Index h = Mesh::next(corners[0]) == corners[1] ? corners[0] : corners[1];
      const double a = point.weights[h % 3];
      const double b = point.weights[Mesh::next(h) % 3];
      add(edges, h, b / (a + b));
    }
    else if (corners.size() == 1)
    {
      forEachEdge(corners[0], [&](const CurvePoint& p) { edges.push_back(p); });
    }
    return edges;
  }

  void add(std::vector<CurvePoint>& edges, Index h, double t) const
  {
    if (isAllowed(h))
    {
      edges.push_back({ h, t });
    }
  }

  /// Calls visit with the edges at a vertex, at it; each by one of its half-edges.
  template <class Visitor>
  void forEachEdge(Index corner, const Visitor& visit) const
  {
    forEachInFan(mesh_, corner,
      [&](Index g)
      {
        if (isAllowed(g))
        {
          visit(CurvePoint{ g, 0 });
        }
        const Index before = Mesh::previous(g);
        if (mesh_.isBoundary(before) && isAllowed(before))
        {
          visit(CurvePoint{ before, 1 });
        }
      });
  }

  /// The same place on the other half-edge.
  CurvePoint flipped(const CurvePoint& p) const { return { mesh_.twin[p.h], 1 - p.t }; }

  void joinOnOneEdge(const CurvePoint& s, CurvePoint e)
  {
    if (e.h != s.h && e.h == mesh_.twin[s.h])
    {
      e = flipped(e);
    }
    if (e.h == s.h && costOf(s, e) < best_)
    {
      best_ = costOf(s, e);
      lastVertex_ = kInvalidIndex;
      lastFrom_ = s;
      lastTo_ = e;
    }
  }

  /// To an end of the edge that the start lies on.
  void leave(const CurvePoint& s, bool forwards)
  {
    const CurvePoint end{ s.h, forwards ? 1.0 : 0.0 };
    offer(forwards ? Mesh::next(s.h) : s.h, costOf(s, end), kInvalidIndex, s, end);
  }

  void offer(
    Index corner, double cost, Index previous, const CurvePoint& from, const CurvePoint& to)
  {
    const Index v = mesh_.origin[corner];
    const auto [label, isNew] = labels_.try_emplace(v);
    if (isNew || cost < label->second.cost)
    {
      label->second = { cost, corner, previous, from, to, false };
      queue_.push({ cost, v });
    }
  }

  void arrive(Index v, const Label& label, const std::vector<CurvePoint>& ends)
  {
    for (const CurvePoint& e : ends)
    {
      for (const bool atTarget : { false, true })
      {
        const CurvePoint s{ e.h, atTarget ? 1.0 : 0.0 };
        const Index end = atTarget ? mesh_.target(e.h) : mesh_.origin[e.h];
        const double cost = label.cost + costOf(s, e);
        if (end == v && cost < best_)
        {
          best_ = cost;
          lastVertex_ = v;
          lastFrom_ = s;
          lastTo_ = e;
        }
      }
    }
  }

  void relax(Index v, const Label& label)
  {
    const double cost = label.cost;
    forEachEdge(label.corner,
      [&](const CurvePoint& from)
      {
        const CurvePoint to{ from.h, 1 - from.t };
        const Index corner = from.t == 0 ? Mesh::next(from.h) : from.h;
        const auto known = labels_.find(mesh_.origin[corner]);
        if (known == labels_.end() || !known->second.done)
        {
          offer(corner, cost + costOf(from, to), v, from, to);
        }
      });
  }

  CurveChain chain() const
  {
    std::vector<std::pair<CurvePoint, CurvePoint>> segments{ { lastFrom_, lastTo_ } };
    for (Index v = lastVertex_; v != kInvalidIndex; v = labels_.at(v).previous)
    {
      segments.emplace_back(labels_.at(v).from, labels_.at(v).to);
    }
    CurveChain result;
    for (auto segment = segments.rbegin(); segment != segments.rend(); ++segment)
    {
      result.points.push_back(segment->first);
      result.points.push_back(segment->second);
      result.length +=
        std::abs(segment->second.t - segment->first.t) * mesh_.edgeVector(segment->first.h).norm();
    }
    return result;
  }

  const Mesh& mesh_;
  bool boundaryOnly_;
  double longest_; ///< of the cost
  std::unordered_map<Index, Label> labels_;
  /// Of equal costs the lowest vertex first, so that the way does not depend on anything but the surface.
  std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>,
    std::greater<>>
    queue_;
  double best_ = kInfinity; ///< cost of the best way
  Index lastVertex_ = kInvalidIndex;
  CurvePoint lastFrom_, lastTo_; ///< its last segment
};

} // namespace

std::optional<SurfacePoint> inFace(const Mesh& mesh, const SurfacePoint& point, Index face)
{
  if (point.face == face)
  {
    return point;
  }
  SurfacePoint result{ face, {} };
  for (const Index corner : weightedCorners(point))
  {
    Index i = 0;
    while (i < 3 && mesh.origin[3 * face + i] != mesh.origin[corner])
    {
      ++i;
    }
    if (i == 3)
    {
      return std::nullopt;
    }
    result.weights[i] = point.weights[corner % 3];
  }
  return result;
}

std::vector<Index> facesAt(const Mesh& mesh, const SurfacePoint& point)
{
  const std::vector<Index> corners = weightedCorners(point);
  std::vector<Index> faces;
  if (corners.size() == 1)
  {
    forEachInFan(mesh, corners[0], [&](Index g) { faces.push_back(Mesh::face(g)); });
    return faces;
  }
  faces.push_back(point.face);
  if (corners.size() == 2)
  {
    const Index h = Mesh::next(corners[0]) == corners[1] ? corners[0] : corners[1];
    if (!mesh.isBoundary(h))
    {
      faces.push_back(Mesh::face(mesh.twin[h]));
    }
  }
  return faces;
}

std::optional<SurfacePoint> middleOnSection(
  const Mesh& mesh, const SurfacePoint& from, const SurfacePoint& to, const Vector3& normal)
{
  const Vector3 along = positionOf(mesh, to) - positionOf(mesh, from);
  const Vector3 plane = along.cross(normal).stableNormalized();
  if (!(plane.squaredNorm() > 0))
  {
    return std::nullopt;
  }
  return PlaneSection(mesh, from, to, plane).middle();
}

SurfacePoint approach(const Mesh& mesh, SurfacePoint from, const Vector3& target)
{
  constexpr int kMostSectionSteps = 40;
  double distance = (target - positionOf(mesh, from)).norm();
  double part = 1;
  for (int i = 0; i < kMostSectionSteps && distance > 0; ++i)
  {
    const Vector3 wanted = part * (target - positionOf(mesh, from));
    const std::optional<SurfacePoint> place = walkSurface(mesh, from, wanted);
    const double there = place ? (target - positionOf(mesh, *place)).norm() : distance;
    if (there < (1 - kRounding) * distance)
    {
      from = *place;
      distance = there;
      part = 1;
    }
    else
    {
      part /= 2;
    }
  }
  return from;
}

CurvePoint CurveChain::middle(const Mesh& mesh) const
{
  const MiddlePlane plane(
    positionOf(mesh, points.front().onSurface()), positionOf(mesh, points.back().onSurface()));
  CurvePoint best = points.front();
  double least = kInfinity;
  for (std::size_t i = 0; i < points.size(); i += 2)
  {
    const CurvePoint& a = points[i];
    const CurvePoint& b = points[i + 1];
    const std::optional<double> part =
      plane.crossing(positionOf(mesh, a.onSurface()), positionOf(mesh, b.onSurface()));
    const CurvePoint here{ a.h, a.t + part.value_or(0) * (b.t - a.t) };
    const double distance = plane.squaredDistance(positionOf(mesh, here.onSurface()));
    if (part && distance < least)
    {
      least = distance;
      best = here;
    }
  }
  return best;
}

CurvePoint CurveChain::nearest(const Mesh& mesh, const Vector3& p) const
{
  CurvePoint best = points.front();
  double least = kInfinity;
  for (std::size_t i = 0; i < points.size(); i += 2)
  {
    const auto [low, high] = std::minmax(points[i].t, points[i + 1].t);
    const Index h = points[i].h;
    const Vector3 edge = mesh.edgeVector(h);
    const double foot = (p - mesh.position[mesh.origin[h]]).dot(edge) / edge.squaredNorm();
    const CurvePoint here{ h, std::clamp(foot, low, high) };
    const double distance = (positionOf(mesh, here.onSurface()) - p).squaredNorm();
    if (distance < least)
    {
      least = distance;
      best = here;
    }
  }
  return best;
}

std::optional<CurveChain> chainBetween(
  const Mesh& mesh, const SurfacePoint& from, const SurfacePoint& to, bool boundaryOnly)
{
  const double distance = (positionOf(mesh, to) - positionOf(mesh, from)).norm();
  return EdgeSearch(mesh, boundaryOnly, kLongestChain * distance).run(from, to);
}

} // namespace quadrille

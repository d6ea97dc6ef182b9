// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/DrawnConstraints.h"

#include "Base/PlaceText.h"
#include "Base/Refuse.h"
#include "Mesh/Distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <utility>

namespace quadrille
{

namespace
{

/// What was moved by more than this part of the surface's bounding-box diagonal is worth a warning. Points of lines
/// that are clicked in a window lie in front of the surface as a rule.
constexpr double kFarPoint = 0.05;
constexpr double kFarLine = 0.1;
/// Samples of a stroke in each edge length of the polygons below.
constexpr double kSamplesAnEdge = 3;
constexpr double kMostSamples = 4096;
/// Barycentric nearness to an edge of a sample that lies on it.
constexpr double kOnEdgeOfPolygon = 1e-6;
/// Of the path under a stroke, which only says which polygons get the stroke's direction.
constexpr double kHaste = 1.3;

void markPath(
  const EdgeGraph& graph, const std::vector<Index>& path, std::map<Index, std::uint8_t>& marks)
{
  for (std::size_t k = 0; k + 1 < path.size(); ++k)
  {
    for (std::size_t i = graph.first[path[k]]; i < graph.first[path[k] + 1]; ++i)
    {
      if (graph.uses[i].target == path[k + 1])
      {
        marks[graph.uses[i].polygon] |= graph.uses[i].bit;
      }
    }
  }
}
} // namespace

void addGuideMarks(SurfaceInput& input, std::size_t polygons, const std::vector<GuideMark>& marks)
{
  if (marks.empty())
  {
    return;
  }
  const bool full = input.guideWeights.empty() &&
    std::all_of(marks.begin(), marks.end(), [](const GuideMark& m) { return m.weight == 1; });
  input.guideDirections.resize(polygons, Vector3::Zero());
  if (!full)
  {
    input.guideWeights.resize(polygons, 1);
  }
  for (const GuideMark& mark : marks)
  {
    input.guideDirections[mark.polygon] = mark.direction;
    if (!full)
    {
      input.guideWeights[mark.polygon] = mark.weight;
    }
  }
}

void addFeatureMarks(
  SurfaceInput& input, std::size_t polygons, const std::vector<FeatureMark>& marks)
{
  if (marks.empty())
  {
    return;
  }
  input.featureEdges.resize(polygons);
  for (const FeatureMark& mark : marks)
  {
    if (mark.polygon >= input.featureEdges.size())
    {
      refuse("a feature is marked on polygon ", mark.polygon, ", but there are only ",
        input.featureEdges.size());
    }
    input.featureEdges[mark.polygon] |= mark.bits;
  }
}

GuidedPolygon guidedPolygon(
  const SurfaceInput& input, Index polygon, const Vector3& direction, double weight)
{
  const Index begin = input.polygonOffsets[polygon];
  const Index end = input.polygonOffsets[polygon + 1];
  const auto corner = [&](Index i) { return input.points[input.polygonPoints[i]]; };
  GuidedPolygon guided;
  guided.polygon = polygon;
  guided.weight = weight;
  Vector3 normal = Vector3::Zero(); // twice as long as the area is large
  for (Index i = begin; i < end; ++i)
  {
    guided.centre += corner(i) / static_cast<double>(end - begin);
    normal +=
      (corner(i) - corner(begin)).cross(corner(i + 1 < end ? i + 1 : begin) - corner(begin));
  }
  guided.area = 0.5 * normal.norm();
  guided.normal = normal.stableNormalized();
  const Vector3 along = direction.stableNormalized();
  guided.direction = (along - guided.normal * guided.normal.dot(along)).stableNormalized();
  return guided;
}

const char* nameOf(ConstraintKind kind)
{
  switch (kind)
  {
    case ConstraintKind::Feature:
      return "feature curve";
    case ConstraintKind::Stroke:
      return "guide stroke";
    case ConstraintKind::Valence:
      return "valence";
    case ConstraintKind::Connection:
      return "connection";
    case ConstraintKind::Move:
      return "move";
    default:
      return "cycle";
  }
}

//------------------------------------------------------------------------------
std::vector<Index> ConstraintPlacement::pathBetween(
  const char* what, std::int64_t line, Index a, Index b, double haste) const
{
  std::vector<Index> path = findEdgePath(input_, places_.edges(), a, b, haste);
  if (path.empty())
  {
    refuse(what, " ", line, ": no path of edges leads from ", placeText(input_.points[a]), " to ",
      placeText(input_.points[b]),
      "; the places lie on different parts of the surface, or points at the same place are not "
      "merged: draw one line for "
      "each part, or apply Clean to the surface first");
  }
  std::reverse(path.begin(), path.end());
  return path;
}

void ConstraintPlacement::tellIfFar(const char* what, const PlacedConstraint& placed)
{
  const double far = placed.kind == ConstraintKind::Valence ? kFarPoint : kFarLine;
  if (placed.distance > far * places_.diagonal())
  {
    std::ostringstream text;
    text << what << " " << placed.source << " was moved by up to " << placed.distance
         << " to lie on the surface, near " << placeText(placed.path.front())
         << ": look at the output Constraints, and move its points if that is not what was meant";
    result_.notices.push_back(text.str());
  }
}

void ConstraintPlacement::drop(const char* what, PlacedConstraint line, const std::string& whyNot)
{
  result_.notices.push_back(std::string(what) + " " + std::to_string(line.source) + " " + whyNot);
  line.whyNot = whyNot;
  result_.placed.push_back(std::move(line));
}

void ConstraintPlacement::addFeature(const DrawnLine& line)
{
  PlacedConstraint placed;
  placed.kind = ConstraintKind::Feature;
  placed.source = line.source;
  placed.given = line.points;
  std::map<Index, std::uint8_t> marks;
  Index previous = kInvalidIndex;
  for (const Vector3& p : line.points)
  {
    const Index v = places_.nearestCorner(p);
    placed.distance = std::max(placed.distance, (input_.points[v] - p).norm());
    if (previous == kInvalidIndex)
    {
      placed.path.push_back(input_.points[v]);
    }
    else if (v != previous)
    {
      const std::vector<Index> path = pathBetween("feature curve", line.source, previous, v, 1);
      markPath(places_.edges(), path, marks);
      for (std::size_t i = 1; i < path.size(); ++i)
      {
        placed.path.push_back(input_.points[path[i]]);
      }
    }
    previous = v;
  }
  if (placed.path.size() < 2)
  {
    drop("feature curve", std::move(placed),
      "has no edge of the surface along it and is not followed: all its points have the same "
      "nearest point of the surface");
    return;
  }
  for (const auto& [polygon, bits] : marks)
  {
    features_[polygon] |= bits;
  }
  tellIfFar("feature curve", placed);
  result_.placed.push_back(std::move(placed));
}

std::vector<SurfacePlaces::Place> ConstraintPlacement::sampleBetween(
  const SurfacePlaces::Place& first, const SurfacePlaces::Place& last) const
{
  const Vector3& a = first.point;
  const Vector3& b = last.point;
  const double edge = std::min(meanEdge(input_, first.polygon), meanEdge(input_, last.polygon));
  const double wanted = kSamplesAnEdge * (b - a).norm() / std::max(edge, 1e-300);
  const int count = static_cast<int>(std::clamp(std::ceil(wanted), 4.0, kMostSamples));
  const double step = (b - a).norm() / count;
  std::vector<SurfacePlaces::Place> places{ first };
  for (int i = 0; i < count; ++i)
  {
    places.push_back(places_.nearestPlace(a + (i + 0.5) / count * (b - a)));
  }
  places.push_back(last);
  // Over a bulge places move apart, but where they jump the segment left this part of the surface.
  constexpr double kJump = 6;
  for (std::size_t i = 0; i + 1 < places.size(); ++i)
  {
    if ((places[i + 1].point - places[i].point).norm() > kJump * std::max(step, 1e-300))
    {
      return {};
    }
  }
  return places;
}

/// The polygon of the place, and where it lies on an edge that beyond it. At a corner none: which one is not said.
void ConstraintPlacement::guide(
  const SurfacePlaces::Place& place, const Stroke& stroke, Strokes& strokes) const
{
  const Index begin = input_.polygonOffsets[place.polygon];
  const Index corners = input_.polygonOffsets[place.polygon + 1] - begin;
  const double near = kOnEdgeOfPolygon * meanEdge(input_, place.polygon);
  for (Index i = 0; i < corners; ++i)
  {
    if ((input_.points[input_.polygonPoints[begin + i]] - place.point).norm() < near)
    {
      return;
    }
  }
  strokes[place.polygon] = stroke;
  for (Index i = 0; i < corners; ++i)
  {
    const Index a = input_.polygonPoints[begin + i];
    const Index b = input_.polygonPoints[begin + (i + 1) % corners];
    if (distanceToSegment(place.point, input_.points[a], input_.points[b]) < near)
    {
      guideAlong({ a, b }, stroke, strokes);
    }
  }
}

/// The polygons on both sides of a path of edges.
void ConstraintPlacement::guideAlong(
  const std::vector<Index>& path, const Stroke& stroke, Strokes& strokes) const
{
  for (std::size_t k = 0; k + 1 < path.size(); ++k)
  {
    for (std::size_t i = places_.edges().first[path[k]]; i < places_.edges().first[path[k] + 1];
         ++i)
    {
      if (places_.edges().uses[i].target == path[k + 1])
      {
        strokes[places_.edges().uses[i].polygon] = stroke;
      }
    }
  }
}

/// The polygons round those that have directions already.
void ConstraintPlacement::guideAround(
  const std::vector<Vector3>& line, double weight, double radius, Strokes& strokes) const
{
  std::set<Index> front;
  for (const auto& [polygon, stroke] : strokes)
  {
    front.insert(polygon);
  }
  std::set<Index> seen = front;
  while (!front.empty())
  {
    const Index polygon = *front.begin();
    front.erase(front.begin());
    if (strokes.count(polygon) == 0)
    {
      const Vector3 centre = guidedPolygon(input_, polygon, Vector3::UnitX(), weight).centre;
      double nearest = std::numeric_limits<double>::infinity();
      Vector3 direction = Vector3::Zero();
      for (std::size_t i = 0; i + 1 < line.size(); ++i)
      {
        const double distance = distanceToSegment(centre, line[i], line[i + 1]);
        if (distance < nearest && line[i] != line[i + 1])
        {
          nearest = distance;
          direction = (line[i + 1] - line[i]).stableNormalized();
        }
      }
      if (nearest > radius)
      {
        continue;
      }
      strokes[polygon] = { direction, weight };
    }
    const Index begin = input_.polygonOffsets[polygon];
    const Index corners = input_.polygonOffsets[polygon + 1] - begin;
    for (Index i = 0; i < corners; ++i)
    {
      const Index a = input_.polygonPoints[begin + i];
      const Index b = input_.polygonPoints[begin + (i + 1) % corners];
      for (std::size_t k = places_.edges().first[a]; k < places_.edges().first[a + 1]; ++k)
      {
        const EdgeUse& use = places_.edges().uses[k];
        if (use.target == b && seen.insert(use.polygon).second)
        {
          front.insert(use.polygon);
        }
      }
    }
  }
}

void ConstraintPlacement::addStroke(const DrawnLine& line, double weight, double radius)
{
  Strokes strokes;
  PlacedConstraint placed;
  placed.kind = ConstraintKind::Stroke;
  placed.source = line.source;
  placed.given = line.points;
  placed.weight = weight;
  std::vector<SurfacePlaces::Place> ends;
  for (const Vector3& p : line.points)
  {
    ends.push_back(places_.nearestPlace(p));
    placed.distance = std::max(placed.distance, (ends.back().point - p).norm());
  }
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
  {
    const Vector3& a = ends[i].point;
    const Vector3& b = ends[i + 1].point;
    if (a == b)
    {
      continue;
    }
    const Stroke stroke{ (b - a).stableNormalized(), weight };
    const std::vector<SurfacePlaces::Place> places = sampleBetween(ends[i], ends[i + 1]);
    for (const SurfacePlaces::Place& place : places)
    {
      guide(place, stroke, strokes);
      placed.path.push_back(place.point);
    }
    if (places.empty())
    {
      const std::vector<Index> path = pathBetween(
        "guiding stroke", line.source, places_.nearestCorner(a), places_.nearestCorner(b), kHaste);
      guideAlong(path, stroke, strokes);
      for (const Index v : path)
      {
        placed.path.push_back(input_.points[v]);
      }
    }
  }
  if (placed.path.size() < 2)
  {
    placed.path.assign(1, ends.empty() ? Vector3(Vector3::Zero()) : ends.front().point);
    drop("guiding stroke", std::move(placed),
      "has no length and is not followed: give it two different points");
    return;
  }
  if (radius > 0)
  {
    std::vector<Vector3> onSurface;
    onSurface.reserve(ends.size());
    for (const SurfacePlaces::Place& end : ends)
    {
      onSurface.push_back(end.point);
    }
    guideAround(onSurface, weight, radius, strokes);
  }
  for (const auto& [polygon, stroke] : strokes)
  {
    strokes_[polygon] = stroke;
    placed.guided.push_back(guidedPolygon(input_, polygon, stroke.direction, stroke.weight));
  }
  tellIfFar("guiding stroke", placed);
  result_.placed.push_back(std::move(placed));
}

void ConstraintPlacement::addValence(std::int64_t source, const Vector3& point, int valence)
{
  const Index v = places_.nearestCorner(point);
  if (valence == kLeastValence && places_.isOnBoundary(v))
  {
    refuse("valence ", valence, " is asked for at ", placeText(input_.points[v]),
      ", on the boundary of the surface, where the least is 3, a corner with one quad: ask for 3 "
      "or more there, or move the "
      "point inside");
  }
  const int given = input_.targetValences.empty() ? 0 : input_.targetValences[v];
  int& asked = valences_.emplace(v, given).first->second;
  if (asked != 0 && asked != valence)
  {
    refuse("valence point ", source, " asks for valence ", valence, " at ",
      placeText(input_.points[v]), ", where ", asked,
      " is asked for already: give both the same, or take one away");
  }
  asked = valence;
  PlacedConstraint placed;
  placed.kind = ConstraintKind::Valence;
  placed.source = source;
  placed.given = { point };
  placed.path = { input_.points[v] };
  placed.distance = (input_.points[v] - point).norm();
  placed.valence = valence;
  tellIfFar("valence point", placed);
  result_.placed.push_back(std::move(placed));
}

void ConstraintPlacement::leaveOutValence(
  std::int64_t source, const Vector3& point, int valence, const std::string& whyNot)
{
  PlacedConstraint placed;
  placed.kind = ConstraintKind::Valence;
  placed.source = source;
  placed.path = { input_.points[places_.nearestCorner(point)] };
  placed.valence = valence;
  placed.whyNot = whyNot;
  result_.notices.push_back("valence point " + std::to_string(source) + " is left out: " + whyNot);
  result_.placed.push_back(std::move(placed));
}

void ConstraintPlacement::addCurve(std::int64_t source, CurveKind kind, std::vector<Vector3> points)
{
  PlacedConstraint placed;
  placed.kind = kind == CurveKind::Cycle ? ConstraintKind::Cycle : ConstraintKind::Connection;
  placed.source = source;
  placed.given = points;
  placed.path = points;
  if (kind == CurveKind::Cycle)
  {
    if (points.size() > 1 && points.front() == points.back())
    {
      points.pop_back();
    }
    placed.path = points;
    placed.path.push_back(points.front());
  }
  placed.curve = input_.curves.size() + curves_.size();
  const CurveRequest curve{ kind, std::move(points) };
  checkCurve(curve, static_cast<std::size_t>(source));
  curves_.push_back(curve);
  result_.placed.push_back(std::move(placed));
}

std::vector<FeatureMark> ConstraintPlacement::featureMarks() const
{
  std::vector<FeatureMark> marks;
  for (const auto& [polygon, bits] : features_)
  {
    marks.push_back({ polygon, bits });
  }
  return marks;
}

std::vector<GuideMark> ConstraintPlacement::guideMarks() const
{
  std::vector<GuideMark> marks;
  for (const auto& [polygon, stroke] : strokes_)
  {
    marks.push_back({ polygon, stroke.direction, stroke.weight });
  }
  return marks;
}

void ConstraintPlacement::setValences(SurfaceInput& input) const
{
  if (!valences_.empty())
  {
    input.targetValences.resize(input.points.size(), 0);
  }
  for (const auto& [point, valence] : valences_)
  {
    input.targetValences[point] = valence;
  }
}

void ConstraintPlacement::addCurves(SurfaceInput& input) const
{
  input.curves.insert(input.curves.end(), curves_.begin(), curves_.end());
}

} // namespace quadrille

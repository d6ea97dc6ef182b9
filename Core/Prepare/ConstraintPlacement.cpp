// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Prepare/ConstraintPlacement.h"

#include "Base/Lists.h"
#include "Base/PlaceText.h"
#include "Base/Refuse.h"
#include "Requests/CurveRequests.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{

namespace
{

PlacedConstraint atPlace(
  ConstraintKind kind, std::int64_t source, const Vector3& given, const Vector3& place)
{
  PlacedConstraint placed;
  placed.kind = kind;
  placed.source = source;
  placed.given = { given };
  placed.path = { place };
  placed.distance = (place - given).norm();
  return placed;
}

} // namespace

std::vector<Vector3> courseOf(
  const CurveRequest& curve, const SurfacePlaces& places, const SurfacePaths& paths)
{
  std::vector<Vector3> points;
  for (const Vector3& p : curve.points)
  {
    points.push_back(places.nearestPlace(p).point);
  }
  if (curve.kind == CurveKind::Cycle)
  {
    points.push_back(points.front());
  }
  return paths.through(points).points;
}

int arrayValenceAt(const SurfaceInput& input, const SurfacePlaces::Place& place, double sameWithin)
{
  if (input.targetValences.empty())
  {
    return 0;
  }
  for (Index i = input.polygonOffsets[place.polygon]; i < input.polygonOffsets[place.polygon + 1];
       ++i)
  {
    const Index p = input.polygonPoints[i];
    if (input.targetValences[p] != 0 && (input.points[p] - place.point).norm() <= sameWithin)
    {
      return input.targetValences[p];
    }
  }
  return 0;
}

//------------------------------------------------------------------------------
std::vector<Vector3> ConstraintPlacement::follow(
  const DrawnLine& line, PlacedConstraint& placed, std::vector<std::vector<Vector3>>* course) const
{
  placed.source = line.source;
  placed.given = line.points;
  std::vector<Vector3> points;
  for (const Vector3& p : line.points)
  {
    const Vector3 place = places_.nearestPlace(p).point;
    placed.distance = std::max(placed.distance, (place - p).norm());
    if (points.empty() || points.back() != place)
    {
      points.push_back(place);
    }
  }
  placed.path = { points.empty() ? Vector3::Zero() : points.front() };
  if (points.size() < 2)
  {
    placed.whyNot = "it has no length: all its points have the same nearest place on the surface";
    return points;
  }
  MeshCourse found = paths_.through(points);
  if (!found.tornBehind.empty())
  {
    const std::size_t last = found.tornBehind.front();
    placed.remark = "it is not followed from " + placeText(points[last]) + " to " +
      placeText(points[last + 1]) + ", which lie on different parts of the surface";
  }
  if (course != nullptr)
  {
    *course = found.parts();
  }
  placed.path = std::move(found.points);
  return points;
}

bool ConstraintPlacement::take(PlacedConstraint line)
{
  const bool isFollowed = line.whyNot.empty();
  if (!isFollowed)
  {
    result_.notices.push_back(std::string(nameOf(line.kind)) + " " + std::to_string(line.source) +
      " is not followed: " + line.whyNot);
  }
  result_.placed.push_back(std::move(line));
  return isFollowed;
}

void ConstraintPlacement::addFeature(const DrawnLine& line)
{
  PlacedConstraint placed;
  placed.kind = ConstraintKind::Feature;
  std::vector<Vector3> points = follow(line, placed);
  if (take(std::move(placed)))
  {
    requests_.features.push_back({ std::move(points) });
  }
}

void ConstraintPlacement::addStroke(const DrawnLine& line, double weight, double radius, int order)
{
  PlacedConstraint placed;
  placed.kind = ConstraintKind::Stroke;
  placed.weight = weight;
  placed.radius = radius;
  std::vector<std::vector<Vector3>> course;
  std::vector<Vector3> points = follow(line, placed, &course);
  for (const std::vector<Vector3>& part : course)
  {
    append(placed.guided, guidedAlong(input_, places_, part, weight, radius));
  }
  if (take(std::move(placed)))
  {
    requests_.strokes.push_back({ std::move(points), weight, radius, order });
  }
}

void ConstraintPlacement::addValence(std::int64_t source, const Vector3& point, int valence)
{
  const SurfacePlaces::Place place = places_.nearestPlace(point);
  if (valence < kLeastOnBoundary && places_.isOnBoundary(place))
  {
    refuse("valence ", valence, " is asked for at ", placeText(place.point),
      ", on the boundary of the surface, where the least is 3, a corner with one quad: ask for 3 "
      "or more there, or move the "
      "point inside");
  }
  int asked = arrayValenceAt(input_, place, sameWithin_);
  bool isThere = false;
  for (const ValencePlace& other : requests_.valences)
  {
    if ((other.place - place.point).norm() <= sameWithin_)
    {
      asked = other.valence;
      isThere = true;
    }
  }
  if (asked != 0 && asked != valence)
  {
    refuse("valence point ", source, " asks for valence ", valence, " at ", placeText(place.point),
      ", where ", asked, " is asked for already: give both the same, or take one away");
  }
  if (!isThere)
  {
    requests_.valences.push_back({ place.point, valence });
  }
  PlacedConstraint placed = atPlace(ConstraintKind::Valence, source, point, place.point);
  placed.valence = valence;
  result_.placed.push_back(std::move(placed));
}

void ConstraintPlacement::addCleared(std::int64_t source, const Vector3& point)
{
  const Vector3 place = places_.nearestPlace(point).point;
  requests_.cleared.push_back(place);
  result_.placed.push_back(atPlace(ConstraintKind::Cleared, source, point, place));
}

void ConstraintPlacement::addSize(
  std::int64_t source, const Vector3& point, double radius, double factor, int order)
{
  if (!(radius >= 0) || !std::isfinite(radius) || !(factor > 0) || !std::isfinite(factor))
  {
    refuse("size ", source, " at ", placeText(point), " has the radius ", radius,
      " and the factor ", factor, ", but needs a radius of at least 0 and a factor above 0");
  }
  const Vector3 place = places_.nearestPlace(point).point;
  requests_.sizes.push_back({ place, radius, factor, order });
  PlacedConstraint placed = atPlace(ConstraintKind::Size, source, point, place);
  placed.radius = radius;
  placed.factor = factor;
  result_.placed.push_back(std::move(placed));
}

void ConstraintPlacement::leaveOutValence(
  std::int64_t source, const Vector3& point, int valence, const std::string& whyNot)
{
  PlacedConstraint placed =
    atPlace(ConstraintKind::Valence, source, point, places_.nearestPlace(point).point);
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
  if (kind == CurveKind::Cycle)
  {
    if (points.size() > 1 && points.front() == points.back())
    {
      points.pop_back();
    }
  }
  placed.curve = input_.curves.size() + curves_.size();
  const CurveRequest curve{ kind, std::move(points) };
  checkCurve(curve, static_cast<std::size_t>(source));
  placed.path = courseOf(curve, places_, paths_);
  curves_.push_back(curve);
  result_.placed.push_back(std::move(placed));
}

void ConstraintPlacement::addTo(SurfaceInput& input) const
{
  input.drawn.append(requests_);
  input.curves.insert(input.curves.end(), curves_.begin(), curves_.end());
}

} // namespace quadrille

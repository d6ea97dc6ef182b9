// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/GuidedPlaces.h"

#include "Base/Progress.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace quadrille
{

namespace
{

/// Places along a stroke, and steps to each side of it within its radius, about; fewer where it is short.
constexpr double kPlacesAlong = 256;
constexpr double kStepsBeside = 6;
/// A step along the surface leaves it, at a boundary or a sharp edge, where it ends farther off than this part of it:
/// what is nearest there lies on the edge, to which steps would come again and again.
constexpr double kOffStep = 0.5;
/// Faces turned by 60 degrees from that below a stroke, the cosine, are another side, which it says nothing of.
constexpr double kSameSide = 0.5;

/// The normal of a polygon, twice as long as its area is large.
Vector3 areaNormal(const SurfaceInput& input, Index polygon)
{
  const Index begin = input.polygonOffsets[polygon];
  const Index end = input.polygonOffsets[polygon + 1];
  const auto corner = [&](Index i) { return input.points[input.polygonPoints[i]]; };
  Vector3 normal = Vector3::Zero();
  for (Index i = begin; i < end; ++i)
  {
    normal +=
      (corner(i) - corner(begin)).cross(corner(i + 1 < end ? i + 1 : begin) - corner(begin));
  }
  return normal;
}

Vector3 inPlane(const Vector3& direction, const Vector3& normal)
{
  const Vector3 along = direction.stableNormalized();
  return (along - normal * normal.dot(along)).stableNormalized();
}

class StrokePlaces
{
public:
  StrokePlaces(const SurfaceInput& input, const SurfacePlaces& places,
    const std::vector<Vector3>& course, double weight, double radius)
    : input_(input), places_(places), course_(course), segments_(course), weight_(weight),
      radius_(radius)
  {
    for (std::size_t i = 0; i + 1 < course.size(); ++i)
    {
      length_ += (course[i + 1] - course[i]).norm();
    }
    step_ = length_ / kPlacesAlong;
    if (radius > 0)
    {
      // As many along as that a place stands for about a square; each in the middle of what it stands for.
      step_ = std::max(step_, std::min(radius / kStepsBeside, length_ / 2));
      step_ = length_ / std::max(1.0, std::round(length_ / step_));
      beside_ = radius / std::max(1.0, std::round(radius / step_));
    }
  }

  std::vector<GuidedPlace> run()
  {
    double passed = 0.5 * step_; // of the segment and those before it, up to the next place
    for (std::size_t i = 0; i + 1 < course_.size(); ++i)
    {
      const Vector3 along = course_[i + 1] - course_[i];
      const double length = along.norm();
      for (; length > 0 && passed <= length; passed += step_)
      {
        pollNowAndThen(found_.size());
        const SurfacePlaces::Place at = placeBelow(course_[i] + passed / length * along);
        addAcross(at, along / length, step_);
      }
      passed -= length;
    }
    if (radius_ > 0)
    {
      addBeyond(course_.front(), course_.front() - course_[1]);
      addBeyond(course_.back(), course_.back() - course_[course_.size() - 2]);
    }
    return std::move(found_);
  }

private:
  /// Of a place of the course, whose side counts from now on.
  SurfacePlaces::Place placeBelow(const Vector3& p)
  {
    SurfacePlaces::Place at = places_.nearestPlace(p);
    side_ = normalAt(at);
    return at;
  }
  /// At a place of the course or, where it has a radius, to both sides of it. length: that they stand for along it.
  void addAcross(const SurfacePlaces::Place& at, const Vector3& along, double length)
  {
    if (radius_ == 0)
    {
      add(at, along, length * length);
      return;
    }
    const Vector3 aside = normalAt(at).cross(along);
    march(at, aside, along, length);
    march(at, -aside, along, length);
  }
  /// Beyond an end of the course.
  void addBeyond(const Vector3& end, const Vector3& out)
  {
    SurfacePlaces::Place at = placeBelow(end);
    Vector3 along = out;
    for (double step = 0.5 * beside_, way = step; way < radius_; step = beside_, way += step)
    {
      const std::optional<SurfacePlaces::Place> next = stepFrom(at, along, step);
      if (!next || segments_.at(next->point).distance > radius_)
      {
        return;
      }
      at = *next;
      along = inPlane(along, normalAt(at));
      addAcross(at, along, beside_);
    }
  }
  Vector3 normalAt(const SurfacePlaces::Place& at) const
  {
    return areaNormal(input_, at.polygon).stableNormalized();
  }
  bool isSameSide(const SurfacePlaces::Place& at) const
  {
    return normalAt(at).dot(side_) > kSameSide;
  }
  /// None where that leaves the surface, or the side of the course.
  std::optional<SurfacePlaces::Place> stepFrom(
    const SurfacePlaces::Place& at, const Vector3& direction, double step) const
  {
    const Vector3 p = at.point + step * inPlane(direction, normalAt(at));
    const SurfacePlaces::Place next = places_.nearestPlace(p);
    const bool isOff = (next.point - p).norm() > kOffStep * step;
    return isOff || !isSameSide(next) ? std::nullopt : std::optional(next);
  }
  void march(SurfacePlaces::Place at, Vector3 direction, const Vector3& along, double length)
  {
    const Vector3 begin = at.point;
    for (double step = 0.5 * beside_, way = step; way < radius_; step = beside_, way += step)
    {
      const std::optional<SurfacePlaces::Place> next = stepFrom(at, direction, step);
      if (!next)
      {
        return;
      }
      at = *next;
      const NearestSegments::Place nearest = segments_.at(at.point);
      if (nearest.distance > radius_)
      {
        return;
      }
      // What is nearer to another part of the course comes from there.
      const bool isEnd = (nearest.point - course_.front()).norm() <= kRounding * length_ ||
        (nearest.point - course_.back()).norm() <= kRounding * length_;
      if (!isEnd && (nearest.point - begin).norm() > 2 * step_)
      {
        return;
      }
      direction = inPlane(direction, normalAt(at));
      add(at, isEnd ? along : nearest.direction, length * beside_);
    }
  }
  void add(const SurfacePlaces::Place& at, const Vector3& direction, double area)
  {
    GuidedPlace guided;
    guided.polygon = at.polygon;
    guided.place = at.point;
    guided.normal = normalAt(at);
    guided.direction = inPlane(direction, guided.normal);
    guided.area = area;
    guided.weight = weight_;
    found_.push_back(guided);
  }

  const SurfaceInput& input_;
  const SurfacePlaces& places_;
  const std::vector<Vector3>& course_;
  NearestSegments segments_;
  double weight_, radius_;
  double length_ = 0, step_ = 0;
  double beside_ = 0; ///< the step to the sides and beyond the ends; 0 without a radius
  Vector3 side_ = Vector3::Zero(); ///< the normal below the last place of the course
  std::vector<GuidedPlace> found_;
};

/// A single point where the line is none.
TriangleList segmentsOf(const std::vector<Vector3>& line)
{
  TriangleList list{ line, {} };
  for (Index i = 0; i + 1 < line.size(); ++i)
  {
    if (line[i] != line[i + 1])
    {
      list.corners.push_back({ i, i + 1, i + 1 });
    }
  }
  if (list.corners.empty())
  {
    list.corners.push_back({ 0, 0, 0 });
  }
  return list;
}

} // namespace

GuidedPlace guidedPolygon(
  const SurfaceInput& input, Index polygon, const Vector3& direction, double weight)
{
  const Index begin = input.polygonOffsets[polygon];
  const Index end = input.polygonOffsets[polygon + 1];
  GuidedPlace guided;
  guided.polygon = polygon;
  guided.weight = weight;
  for (Index i = begin; i < end; ++i)
  {
    guided.place += input.points[input.polygonPoints[i]] / static_cast<double>(end - begin);
  }
  const Vector3 normal = areaNormal(input, polygon);
  guided.area = 0.5 * normal.norm();
  guided.normal = normal.stableNormalized();
  guided.direction = inPlane(direction, guided.normal);
  return guided;
}

std::vector<GuidedPlace> guidedAlong(const SurfaceInput& input, const SurfacePlaces& places,
  const std::vector<Vector3>& course, double weight, double radius)
{
  return StrokePlaces(input, places, course, weight, radius).run();
}

//------------------------------------------------------------------------------
NearestSegments::NearestSegments(const std::vector<Vector3>& line) : segments_(segmentsOf(line)) {}

NearestSegments::Place NearestSegments::at(const Vector3& p) const
{
  const NearestTriangle::Place nearest = *segments_.at(p);
  const TriangleList& list = segments_.triangles();
  const std::array<Index, 3>& ends = list.corners[nearest.triangle];
  return { nearest.distance, nearest.point,
    (list.points[ends[1]] - list.points[ends[0]]).stableNormalized() };
}

} // namespace quadrille

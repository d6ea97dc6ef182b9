// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/PartRequests.h"

#include "Base/Angles.h"
#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"
#include "Requests/Guides.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

namespace quadrille
{

namespace
{

/// Guides of both sides that differ by more contradict each other.
const double kGuidesAgree = radians(10);
/// So that a point on an axis of order 2 has no two quads that share two edges.
constexpr int kQuadsAtHalfTurn = 2;

/// The faces of other parts that have something.
class AskingFaces
{
public:
  AskingFaces(const PartTask& task, const std::function<bool(Index face)>& has)
    : task_(task), has_(has), asking_(listOf(task, has))
  {
  }

  struct Found
  {
    NearestTriangle::Place place;
    int steps = 0; ///< how often the isometry takes the place of the part to it
  };
  /// The face under the image of a place of the part, by the fewest steps, that has something.
  std::optional<Found> at(const Vector3& p, const Vector3& normal) const
  {
    const bool isEmpty = asking_.triangles().corners.empty();
    for (int steps = 1; steps < task_.isometry.order && !isEmpty; ++steps)
    {
      const Vector3 image = task_.isometry.image(p, steps);
      // The order of corners of a mirror image is reversed, and so is its normal once more.
      const Vector3 facing = task_.isometry.imageOf(normal, steps);
      if (!asking_.at(image, facing, task_.deviation + task_.tolerance))
      {
        continue; // a quick no
      }
      const auto place = task_.whole.faces.at(image, facing);
      if (place && has_(place->triangle))
      {
        return Found{ *place, steps };
      }
    }
    return std::nullopt;
  }

private:
  static TriangleList listOf(const PartTask& task, const std::function<bool(Index face)>& has)
  {
    const Mesh& mesh = task.whole.surface.mesh;
    TriangleList list;
    list.points = mesh.position;
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      const std::array<Index, 3> corners{ mesh.origin[3 * f], mesh.origin[3 * f + 1],
        mesh.origin[3 * f + 2] };
      const auto isBehind = [&](Index v)
      { return task.isometry.plane().height(mesh.position[v]) < -task.tolerance; };
      const bool isOther =
        !task.isometry.isReflection || std::any_of(corners.begin(), corners.end(), isBehind);
      if (isOther && has(f))
      {
        list.corners.push_back(corners);
      }
    }
    return list;
  }

  const PartTask& task_;
  std::function<bool(Index face)> has_;
  NearestTriangle asking_;
};

/// Of two directions as those of crosses: the angle modulo a quarter turn.
double crossAngle(const Vector3& a, const Vector3& b)
{
  const double angle = std::acos(std::clamp(a.dot(b), -1.0, 1.0));
  return std::abs(angle - kPi / 2 * std::round(angle / (kPi / 2)));
}

Vector3 centreOf(const SurfaceInput& input, std::size_t t)
{
  return (input.points[input.polygonPoints[3 * t]] + input.points[input.polygonPoints[3 * t + 1]] +
           input.points[input.polygonPoints[3 * t + 2]]) /
    3;
}

Vector3 faceNormalOf(const Mesh& mesh, Index f)
{
  return mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1));
}

/// Returns what the user should know, or nothing.
std::string askGuides(const PartTask& task, SurfacePart& part)
{
  const PreparedSurface& surface = task.whole.surface;
  const SurfaceGuides guides = surfaceGuides(surface, task.threads);
  if (guides.faces.empty())
  {
    return {};
  }
  std::vector<Guide> guideOf(surface.mesh.faceCount());
  for (const FaceGuide& guide : guides.faces)
  {
    guideOf[guide.face] = guide.guide;
  }
  const AskingFaces asking(task, [&](Index f) { return !guideOf[f].isFree(); });
  const std::size_t count = part.face.size();
  part.input.guideDirections.assign(count, Vector3::Zero());
  part.input.guideWeights.assign(count, 1);
  std::vector<std::uint8_t> contradicts(count, 0);
  const auto guideAt = [&](std::size_t t)
  {
    const Guide& own = guideOf[part.face[t]];
    if (!own.isFree() && !task.isometry.isReflection)
    {
      return own;
    }
    const auto found = asking.at(centreOf(part.input, t), faceNormalOf(surface.mesh, part.face[t]));
    if (!found)
    {
      return own;
    }
    Guide image = guideOf[found->place.triangle];
    image.direction = task.isometry.imageOf(image.direction, -found->steps);
    const bool differs = !own.isFree() && crossAngle(own.direction, image.direction) > kGuidesAgree;
    contradicts[t] = differs ? 1 : 0;
    return own.isFree() ? image : own;
  };
  parallelForEach(count, kHeavyChunk, task.threads,
    [&](std::size_t t)
    {
      const Guide guide = guideAt(t);
      if (!guide.isFree())
      {
        part.input.guideDirections[t] = guide.direction;
        part.input.guideWeights[t] = double{ guide.weight };
      }
    });
  const auto first = std::find(contradicts.begin(), contradicts.end(), 1);
  if (first == contradicts.end())
  {
    return {};
  }
  return std::to_string(std::count(contradicts.begin(), contradicts.end(), 1)) +
    " faces have a guiding direction that differs from the image of the one on the other side of "
    "the mirror plane, one near " +
    placeText(centreOf(part.input, static_cast<std::size_t>(first - contradicts.begin()))) +
    ": those in front of the plane are followed";
}

class PartValences
{
public:
  PartValences(const PartTask& task, SurfacePart& part) : task_(task), part_(part) {}

  std::vector<std::string> ask()
  {
    const std::vector<ValenceRequest>& requests = task_.whole.surface.valenceRequests;
    const bool hasPoles = task_.isometry.order == 2 && !part_.poles.empty();
    if (requests.empty() && !hasPoles)
    {
      return {};
    }
    findPoints();
    part_.input.targetValences.assign(part_.input.points.size(), 0);
    for (std::size_t i = 0; hasPoles && i < part_.poles.size(); ++i)
    {
      part_.input.targetValences[nearestPoint(part_.poles[i])] = kQuadsAtHalfTurn + kBesideQuads;
    }
    // What was drawn in the part goes before.
    for (const bool own : { true, false })
    {
      // All others regular: those in front say all, and an image that is off by a vertex would be one too many.
      const bool isSaid = !own && task_.isometry.isReflection &&
        task_.whole.surface.regularElsewhere && !askedBy_.empty();
      for (const ValenceRequest& request : requests)
      {
        if (!isSaid && (pointOf_[request.vertex] != kInvalidIndex) == own)
        {
          askOne(request);
        }
      }
    }
    return std::move(notices_);
  }

private:
  void findPoints()
  {
    const Mesh& mesh = task_.whole.surface.mesh;
    pointOf_.assign(mesh.vertexCount(), kInvalidIndex);
    for (std::size_t i = 0; i < part_.vertex.size(); ++i)
    {
      if (part_.vertex[i] != kInvalidIndex)
      {
        pointOf_[part_.vertex[i]] = static_cast<Index>(i);
      }
    }
    isBoundary_ = boundaryVertices(mesh);
  }

  const Vector3& placeOf(const ValenceRequest& request) const
  {
    return task_.whole.surface.mesh.position[request.vertex];
  }

  void tell(const ValenceRequest& request, const std::string& but)
  {
    notices_.push_back(textOf(request) + ", but " + but);
  }

  std::string textOf(const ValenceRequest& request) const
  {
    return "point " + std::to_string(request.point) + " at " + placeText(placeOf(request)) +
      " asks for valence " + std::to_string(request.valence);
  }

  void askOne(const ValenceRequest& request)
  {
    const bool isReflection = task_.isometry.isReflection;
    const Index point = pointFor(request);
    if (point == kInvalidIndex)
    {
      tell(request,
        "there is no point in front of the mirror plane near its mirror image: it was not asked");
      return;
    }
    const bool isFixed = task_.isometry.fixes(part_.input.points[point], task_.tolerance);
    const std::optional<int> valence = isFixed ? sharedValence(request) : request.valence;
    if (!valence)
    {
      return;
    }
    const auto [other, isNew] = askedBy_.emplace(point, request);
    if (isNew)
    {
      part_.input.targetValences[point] = *valence;
    }
    else if (other->second.valence != request.valence)
    {
      tell(request,
        textOf(other->second) +
          (isReflection
              ? ", where its mirror image is: the one in front of the mirror plane is followed"
              : ", where the rotation takes it: that one is followed"));
    }
  }

  Index pointFor(const ValenceRequest& request) const
  {
    if (pointOf_[request.vertex] != kInvalidIndex)
    {
      return pointOf_[request.vertex];
    }
    const Vector3& place = placeOf(request);
    const Vector3 image = task_.isometry.image(place, task_.stepsToPart(place));
    return task_.isometry.isReflection ? pointInFront(image) : nearestPoint(image);
  }

  /// Of a point that is its own image: what the part's border has there, as if the quads went on beyond. None, with a
  /// notice, where that cannot be.
  std::optional<int> sharedValence(const ValenceRequest& request)
  {
    const Isometry& isometry = task_.isometry;
    if (task_.midLine)
    {
      if (request.valence != kRegularValence)
      {
        tell(request,
          "lies in the mirror plane, which quads straddle, so that no point of them is there: it "
          "was not asked (move it aside, or choose an isoline for the plane's curve)");
      }
      return std::nullopt;
    }
    if (request.valence % isometry.order != 0)
    {
      tell(request,
        isometry.isReflection
          ? "lies in the mirror plane, whose curve is an isoline, so that only even numbers have a "
            "mirror image: it was not asked"
          : "lies on the axis of rotation, where quads come in multiples of " +
            std::to_string(isometry.order) + ": it was not asked");
      return std::nullopt;
    }
    return request.valence / isometry.order + kBesideQuads -
      (isBoundary_[request.vertex] != 0 ? 1 : 0);
  }

  Index nearestPoint(const Vector3& p) const
  {
    const std::vector<Vector3>& points = part_.input.points;
    const auto nearest = std::min_element(points.begin(), points.end(),
      [&](const Vector3& a, const Vector3& b)
      { return (a - p).squaredNorm() < (b - p).squaredNorm(); });
    return static_cast<Index>(nearest - points.begin());
  }

  /// The nearest corner of the nearest face that is in front, not in the plane.
  Index pointInFront(const Vector3& p) const
  {
    const Mesh& mesh = task_.whole.surface.mesh;
    const auto place = task_.whole.faces.at(p);
    Index best = kInvalidIndex;
    for (Index i = 0; place && i < 3; ++i)
    {
      const Index v = mesh.origin[3 * place->triangle + i];
      const bool isInFront = pointOf_[v] != kInvalidIndex &&
        task_.isometry.plane().height(mesh.position[v]) > task_.tolerance;
      if (isInFront &&
        (best == kInvalidIndex ||
          (mesh.position[v] - p).norm() < (part_.input.points[best] - p).norm()))
      {
        best = pointOf_[v];
      }
    }
    return best;
  }

  const PartTask& task_;
  SurfacePart& part_;
  std::vector<Index> pointOf_; ///< per vertex of the whole
  std::vector<std::uint8_t> isBoundary_;
  std::map<Index, ValenceRequest> askedBy_;
  std::vector<std::string> notices_;
};

void askSizes(const PartTask& task, SurfacePart& part)
{
  const Mesh& mesh = task.whole.surface.mesh;
  if (mesh.sizing.empty())
  {
    return;
  }
  const auto sizeOf = [&](Index h) { return double{ mesh.sizing[mesh.origin[h]] }; };
  const auto sizeIn = [&](Index f, const std::array<double, 3>& weights)
  {
    return weights[0] * sizeOf(3 * f) + weights[1] * sizeOf(3 * f + 1) +
      weights[2] * sizeOf(3 * f + 2);
  };
  const AskingFaces asking(task,
    [&](Index f)
    { return sizeOf(3 * f) != 1 || sizeOf(3 * f + 1) != 1 || sizeOf(3 * f + 2) != 1; });
  const SurfaceInput& input = part.input;
  std::vector<Index> cornerOf(input.points.size(), kInvalidIndex); // the first one
  for (Index i = 0; i < input.polygonPoints.size(); ++i)
  {
    Index& corner = cornerOf[input.polygonPoints[i]];
    corner = corner == kInvalidIndex ? i : corner;
  }
  std::vector<float>& sizing = part.input.sizing;
  sizing.assign(cornerOf.size(), 0);
  parallelForEach(sizing.size(), kHeavyChunk, task.threads,
    [&](std::size_t i)
    {
      const Index corner = cornerOf[i];
      const Index f = part.face[corner / 3];
      double size = sizeIn(f, part.weights[corner / 3][corner % 3]);
      if (size == 1 && !task.isometry.fixes(input.points[i], task.tolerance))
      {
        if (const auto found = asking.at(input.points[i], faceNormalOf(mesh, f)))
        {
          size = sizeIn(found->place.triangle, found->place.weights);
        }
      }
      sizing[i] = static_cast<float>(size);
    });
}

bool liesInPlane(const PartTask& task, const CurveRequest& curve)
{
  return std::all_of(curve.points.begin(), curve.points.end(),
    [&](const Vector3& p) { return task.isometry.fixes(p, task.tolerance); });
}

/// How often the isometry takes a curve into the part; none where it crosses a cut, or may not be there.
std::optional<int> stepsOfCurve(const PartTask& task, const CurveRequest& curve)
{
  if (!task.isometry.isReflection)
  {
    const int steps = task.stepsToPart(curve.points[curve.points.size() / 2]);
    const bool isInOne = std::all_of(curve.points.begin(), curve.points.end(),
      [&](const Vector3& p) { return task.stepsToPart(p) == steps; });
    return isInOne ? std::optional<int>(steps) : std::nullopt;
  }
  // Drawn points need not lie on the surface: as far off as its image may be.
  const double slack = task.deviation + task.tolerance;
  double low = 0, high = 0;
  for (const Vector3& p : curve.points)
  {
    low = std::min(low, task.isometry.plane().height(p));
    high = std::max(high, task.isometry.plane().height(p));
  }
  if ((low < -slack && high > slack) || (task.midLine && liesInPlane(task, curve)))
  {
    return std::nullopt;
  }
  return -low > high ? 1 : 0;
}

} // namespace

int PartTask::stepsToPart(const Vector3& p) const
{
  if (isometry.isReflection)
  {
    return isometry.plane().height(p) < -tolerance ? 1 : 0;
  }
  const RotationAxis axis = isometry.axis();
  const Vector3 start = axis.turned(axis.direction.unitOrthogonal(), startAngle);
  const Vector3 arm = axis.radial(p);
  const double step = 2 * kPi / isometry.order;
  const double angle = std::atan2(axis.direction.dot(start.cross(arm)), start.dot(arm)) / step;
  // Places in the cuts, up to the tolerance, are those of the part.
  const double slack = tolerance / std::max(step * arm.norm(), tolerance);
  for (int steps = 0; steps < isometry.order; ++steps)
  {
    double turned = angle + steps;
    turned -= turned >= isometry.order - slack ? isometry.order : 0;
    if (turned >= -slack && turned <= 1 + slack)
    {
      return steps;
    }
  }
  return 0;
}

std::vector<std::string> askOfPart(const PartTask& task, SurfacePart& part)
{
  std::vector<std::string> notices = PartValences(task, part).ask();
  const std::string guides = askGuides(task, part);
  if (!guides.empty())
  {
    notices.push_back(guides);
  }
  askSizes(task, part);
  return notices;
}

PartCurves askCurvesOfPart(const PartTask& task)
{
  PartCurves asked;
  const std::vector<CurveRequest>& curves = task.whole.surface.curves;
  for (std::size_t i = 0; i < curves.size(); ++i)
  {
    if (const std::optional<int> steps = stepsOfCurve(task, curves[i]))
    {
      CurveRequest curve = curves[i];
      for (Vector3& p : curve.points)
      {
        p = task.isometry.image(p, *steps);
      }
      asked.curves.push_back(std::move(curve));
      asked.ofWhole.push_back(static_cast<Index>(i));
      asked.steps.push_back(*steps);
    }
  }
  return asked;
}

std::vector<CurveOutcome> outcomesOfWhole(
  const PartTask& task, const PartCurves& asked, const std::vector<CurveOutcome>& ofPart)
{
  const std::vector<CurveRequest>& curves = task.whole.surface.curves;
  CurveOutcome crossing;
  crossing.why = task.isometry.isReflection
    ? "it crosses the mirror plane, where quads are those of one side and their image: draw it on "
      "one side, or switch the symmetry off"
    : "it crosses a cut between two wedges of the rotation, where quads are those of one wedge and "
      "their images: draw it in one wedge, or switch the symmetry off";
  std::vector<CurveOutcome> outcomes(curves.size(), crossing);
  for (std::size_t i = 0; i < outcomes.size(); ++i)
  {
    outcomes[i].start = curves[i].points.front();
    outcomes[i].end = curves[i].points.back();
    if (task.midLine && liesInPlane(task, curves[i]))
    {
      outcomes[i].why =
        "it lies in the mirror plane, which quads straddle: draw it beside the plane, or choose an "
        "isoline for the plane's curve";
    }
  }
  for (std::size_t i = 0; i < ofPart.size(); ++i)
  {
    CurveOutcome& outcome = outcomes[asked.ofWhole[i]];
    outcome = ofPart[i];
    outcome.start = task.isometry.image(outcome.start, -asked.steps[i]);
    outcome.end = task.isometry.image(outcome.end, -asked.steps[i]);
  }
  return outcomes;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/RotationRequests.h"

#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Mesh/Sizing.h"
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

constexpr std::size_t kTurnedChunk = 256;
/// Of an edge on the boundary beyond its quads: a vertex of valence n + 2 has n quads in the wedge.
constexpr int kBesideQuads = 2;
/// So that a point on an axis of order 2 has no two quads that share two edges.
constexpr int kQuadsAtHalfTurn = 2;

Vector3 normalOfFace(const Mesh& mesh, Index f)
{
  return mesh.edgeVector(3 * f).cross(mesh.edgeVector(3 * f + 1));
}

/// The faces that have something, all round the axis.
class AskingFaces
{
public:
  AskingFaces(const RotationTask& task, const std::function<bool(Index face)>& has)
    : task_(task), has_(has), asking_(listOf(task, has))
  {
  }

  bool empty() const { return asking_.triangles().corners.empty(); }

  struct Found
  {
    NearestTriangle::Place place;
    int steps = 0; ///< by which the place of the wedge was turned to it
  };
  /// The face under a place of the wedge turned by the fewest steps, that has something.
  std::optional<Found> at(const Vector3& p, const Vector3& normal) const
  {
    const MadeRotation& rotation = task_.rotation;
    for (int steps = 1; steps < rotation.order && !empty(); ++steps)
    {
      const Vector3 image = rotation.axis.image(p, steps, rotation.order);
      const Vector3 facing = rotation.axis.imageOf(normal, steps, rotation.order);
      if (!asking_.at(image, facing, task_.deviation + task_.tolerance))
      {
        continue;
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
  static TriangleList listOf(const RotationTask& task, const std::function<bool(Index face)>& has)
  {
    const Mesh& mesh = task.whole.surface.mesh;
    TriangleList list;
    list.points = mesh.position;
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      if (has(f))
      {
        list.corners.push_back(
          { mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] });
      }
    }
    return list;
  }

  const RotationTask& task_;
  std::function<bool(Index face)> has_;
  NearestTriangle asking_;
};

void askWedgeGuides(const RotationTask& task, const SurfaceWedge& wedge, SurfaceInput& input)
{
  const PreparedSurface& surface = task.whole.surface;
  const SurfaceGuides guides = surfaceGuides(surface, task.threads);
  if (guides.faces.empty())
  {
    return;
  }
  std::vector<Guide> guideOf(surface.mesh.faceCount());
  for (const FaceGuide& guide : guides.faces)
  {
    guideOf[guide.face] = guide.guide;
  }
  const AskingFaces asking(task, [&](Index f) { return !guideOf[f].isFree(); });
  input.guideDirections.assign(wedge.face.size(), Vector3::Zero());
  input.guideWeights.assign(wedge.face.size(), 1);
  parallelFor(wedge.face.size(), kTurnedChunk, task.threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        Guide guide = guideOf[wedge.face[t]];
        if (guide.isFree())
        {
          const Vector3 centre = (input.points[input.polygonPoints[3 * t]] +
                                   input.points[input.polygonPoints[3 * t + 1]] +
                                   input.points[input.polygonPoints[3 * t + 2]]) /
            3;
          if (const auto found = asking.at(centre, normalOfFace(surface.mesh, wedge.face[t])))
          {
            guide = guideOf[found->place.triangle];
            guide.direction =
              task.rotation.axis.imageOf(guide.direction, -found->steps, task.rotation.order);
          }
        }
        if (!guide.isFree())
        {
          input.guideDirections[t] = guide.direction;
          input.guideWeights[t] = double{ guide.weight };
        }
      }
    });
}

class WedgeValences
{
public:
  WedgeValences(const RotationTask& task, const SurfaceWedge& wedge, SurfaceInput& input)
    : task_(task), wedge_(wedge), input_(input)
  {
  }

  std::vector<std::string> ask()
  {
    const std::vector<ValenceRequest>& requests = task_.whole.surface.valenceRequests;
    if (requests.empty() && (task_.rotation.order != 2 || wedge_.poles.empty()))
    {
      return {};
    }
    input_.targetValences.assign(input_.points.size(), 0);
    for (const Vector3& pole : wedge_.poles)
    {
      if (task_.rotation.order == 2)
      {
        input_.targetValences[nearestPoint(pole)] = kQuadsAtHalfTurn + kBesideQuads;
      }
    }
    // What was drawn in the wedge goes before.
    for (const bool isOwn : { true, false })
    {
      for (const ValenceRequest& request : requests)
      {
        if ((task_.stepsToWedge(placeOf(request)) == 0) == isOwn)
        {
          askOne(request);
        }
      }
    }
    return std::move(notices_);
  }

private:
  const Vector3& placeOf(const ValenceRequest& request) const
  {
    return task_.whole.surface.mesh.position[request.vertex];
  }

  std::string textOf(const ValenceRequest& request) const
  {
    return "point " + std::to_string(request.point) + " at " + placeText(placeOf(request)) +
      " asks for valence " + std::to_string(request.valence);
  }

  Index nearestPoint(const Vector3& p) const
  {
    const auto nearest = std::min_element(input_.points.begin(), input_.points.end(),
      [&](const Vector3& a, const Vector3& b)
      { return (a - p).squaredNorm() < (b - p).squaredNorm(); });
    return static_cast<Index>(nearest - input_.points.begin());
  }

  void askOne(const ValenceRequest& request)
  {
    const MadeRotation& rotation = task_.rotation;
    const Vector3 place =
      rotation.axis.image(placeOf(request), task_.stepsToWedge(placeOf(request)), rotation.order);
    const Index point = nearestPoint(place);
    int valence = request.valence;
    if (rotation.axis.radial(place).norm() <= task_.tolerance)
    {
      if (valence % rotation.order != 0)
      {
        notices_.push_back(textOf(request) +
          ", but lies on the axis of rotation, where quads come in multiples of " +
          std::to_string(rotation.order) + ": it was not asked");
        return;
      }
      valence = valence / rotation.order + kBesideQuads;
    }
    const auto other = askedBy_.find(point);
    if (other != askedBy_.end())
    {
      if (other->second.valence != request.valence)
      {
        notices_.push_back(textOf(request) + ", but " + textOf(other->second) +
          ", where the rotation takes it: that one is followed");
      }
      return;
    }
    askedBy_[point] = request;
    input_.targetValences[point] = valence;
  }

  const RotationTask& task_;
  const SurfaceWedge& wedge_;
  SurfaceInput& input_;
  std::map<Index, ValenceRequest> askedBy_;
  std::vector<std::string> notices_;
};

void askWedgeSizes(const RotationTask& task, const SurfaceWedge& wedge, SurfaceInput& input)
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
  input.sizing.assign(input.points.size(), 0);
  for (std::size_t i = 0; i < input.polygonPoints.size(); ++i)
  {
    const Index point = input.polygonPoints[i];
    if (input.sizing[point] > 0)
    {
      continue;
    }
    const Index f = wedge.face[i / 3];
    double size = sizeIn(f, wedge.weights[i / 3][i % 3]);
    if (size == 1)
    {
      if (const auto found = asking.at(input.points[point], normalOfFace(mesh, f)))
      {
        size = sizeIn(found->place.triangle, found->place.weights);
      }
    }
    input.sizing[point] = static_cast<float>(size);
  }
}

} // namespace

int RotationTask::stepsToWedge(const Vector3& p) const
{
  const Vector3 start = rotation.axis.turned(rotation.axis.direction.unitOrthogonal(), startAngle);
  const Vector3 arm = rotation.axis.radial(p);
  const double step = 2 * kPi / rotation.order;
  const double angle =
    std::atan2(rotation.axis.direction.dot(start.cross(arm)), start.dot(arm)) / step;
  // Places in the cuts, up to the tolerance, are those of the wedge.
  const double slack = tolerance / std::max(step * arm.norm(), tolerance);
  for (int steps = 0; steps < rotation.order; ++steps)
  {
    double turned = angle + steps;
    turned -= turned >= rotation.order - slack ? rotation.order : 0;
    if (turned >= -slack && turned <= 1 + slack)
    {
      return steps;
    }
  }
  return 0;
}

std::vector<std::string> askOfWedge(
  const RotationTask& task, const SurfaceWedge& wedge, SurfaceInput& input)
{
  std::vector<std::string> notices = WedgeValences(task, wedge, input).ask();
  askWedgeGuides(task, wedge, input);
  askWedgeSizes(task, wedge, input);
  return notices;
}

WedgeCurves askCurvesOfWedge(const RotationTask& task)
{
  WedgeCurves asked;
  const MadeRotation& rotation = task.rotation;
  const std::vector<CurveRequest>& curves = task.whole.surface.curves;
  for (std::size_t i = 0; i < curves.size(); ++i)
  {
    const auto isAt = [&](int steps)
    {
      return std::all_of(curves[i].points.begin(), curves[i].points.end(),
        [&](const Vector3& p) { return task.stepsToWedge(p) == steps; });
    };
    const int steps = task.stepsToWedge(curves[i].points[curves[i].points.size() / 2]);
    if (!isAt(steps))
    {
      continue;
    }
    CurveRequest curve = curves[i];
    for (Vector3& p : curve.points)
    {
      p = rotation.axis.image(p, steps, rotation.order);
    }
    asked.curves.push_back(std::move(curve));
    asked.ofWhole.push_back(static_cast<Index>(i));
    asked.steps.push_back(steps);
  }
  return asked;
}

std::vector<CurveOutcome> outcomesOfWhole(
  const RotationTask& task, const WedgeCurves& asked, const std::vector<CurveOutcome>& wedge)
{
  const MadeRotation& rotation = task.rotation;
  CurveOutcome crossing;
  crossing.why =
    "it crosses a cut between two wedges of the rotation, where quads are those of one "
    "wedge and their images: draw it in one wedge, or switch the symmetry off";
  std::vector<CurveOutcome> outcomes(task.whole.surface.curves.size(), crossing);
  for (std::size_t i = 0; i < outcomes.size(); ++i)
  {
    outcomes[i].start = task.whole.surface.curves[i].points.front();
    outcomes[i].end = task.whole.surface.curves[i].points.back();
  }
  for (std::size_t i = 0; i < wedge.size(); ++i)
  {
    CurveOutcome& outcome = outcomes[asked.ofWhole[i]];
    outcome = wedge[i];
    outcome.start = rotation.axis.image(outcome.start, -asked.steps[i], rotation.order);
    outcome.end = rotation.axis.image(outcome.end, -asked.steps[i], rotation.order);
  }
  return outcomes;
}

} // namespace quadrille

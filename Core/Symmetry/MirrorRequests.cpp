// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/MirrorRequests.h"

#include "Base/Angles.h"
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

constexpr std::size_t kAskChunk = 256;
/// Guides of both sides that differ by more contradict each other.
const double kGuidesAgree = radians(10);

/// The faces that have something behind the plane, for a quick no.
class FacesBehind
{
public:
  FacesBehind(const MirrorTask& task, const std::function<bool(Index face)>& has)
    : task_(task), has_(has), behind_(listOf(task, has))
  {
  }

  bool empty() const { return behind_.triangles().corners.empty(); }

  /// The face under the image of a place, where it has something.
  std::optional<NearestTriangle::Place> at(const Vector3& p, const Vector3& normal) const
  {
    const Vector3 image = task_.plane.image(p);
    // The order of corners of an image is reversed, and so is its normal once more.
    const Vector3 facing = task_.plane.imageOf(normal);
    if (!behind_.at(image, facing, task_.deviation + task_.tolerance))
    {
      return std::nullopt;
    }
    auto place = task_.whole.faces.at(image, facing);
    return place && has_(place->triangle) ? place : std::nullopt;
  }

private:
  static TriangleList listOf(const MirrorTask& task, const std::function<bool(Index face)>& has)
  {
    const Mesh& mesh = task.whole.surface.mesh;
    TriangleList list;
    list.points = mesh.position;
    for (Index f = 0; f < mesh.faceCount(); ++f)
    {
      const auto height = [&](Index h) { return task.plane.height(mesh.position[mesh.origin[h]]); };
      const bool isBehind =
        std::min({ height(3 * f), height(3 * f + 1), height(3 * f + 2) }) < -task.tolerance;
      if (isBehind && has(f))
      {
        list.corners.push_back(
          { mesh.origin[3 * f], mesh.origin[3 * f + 1], mesh.origin[3 * f + 2] });
      }
    }
    return list;
  }

  const MirrorTask& task_;
  std::function<bool(Index face)> has_;
  NearestTriangle behind_;
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

/// "12 faces ... near (...)"; empty for none.
std::string conflictText(
  std::size_t count, const Vector3& place, const std::string& what, const std::string& outcome)
{
  return count == 0
    ? std::string()
    : std::to_string(count) + " " + what + ", one near " + placeText(place) + ": " + outcome;
}

std::string askGuides(const MirrorTask& task, MirrorHalf& half)
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
  const FacesBehind behind(task, [&](Index f) { return !guideOf[f].isFree(); });
  const std::size_t count = half.face.size();
  half.input.guideDirections.assign(count, Vector3::Zero());
  half.input.guideWeights.assign(count, 1);
  std::vector<std::uint8_t> contradicts(count, 0);
  parallelFor(count, kAskChunk, task.threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        Guide guide = guideOf[half.face[t]];
        if (!behind.empty())
        {
          if (const auto place =
                behind.at(centreOf(half.input, t), faceNormalOf(surface.mesh, half.face[t])))
          {
            Guide image = guideOf[place->triangle];
            image.direction = task.plane.imageOf(image.direction);
            const bool differs =
              !guide.isFree() && crossAngle(guide.direction, image.direction) > kGuidesAgree;
            contradicts[t] = differs ? 1 : 0;
            guide = guide.isFree() ? image : guide;
          }
        }
        if (!guide.isFree())
        {
          half.input.guideDirections[t] = guide.direction;
          half.input.guideWeights[t] = double{ guide.weight };
        }
      }
    });
  const auto first = std::find(contradicts.begin(), contradicts.end(), 1);
  return first == contradicts.end()
    ? std::string()
    : conflictText(static_cast<std::size_t>(std::count(contradicts.begin(), contradicts.end(), 1)),
        centreOf(half.input, static_cast<std::size_t>(first - contradicts.begin())),
        "faces have a guiding direction that differs from the image of the one on the other side "
        "of the mirror plane",
        "those in front of the plane are followed");
}

class HalfValences
{
public:
  HalfValences(const MirrorTask& task, MirrorHalf& half) : task_(task), half_(half)
  {
    const Mesh& mesh = task.whole.surface.mesh;
    pointOf_.assign(mesh.vertexCount(), kInvalidIndex);
    for (std::size_t i = 0; i < half.origin.size(); ++i)
    {
      if (half.origin[i].isVertex())
      {
        pointOf_[half.origin[i].from] = static_cast<Index>(i);
      }
    }
    isBoundary_.assign(mesh.vertexCount(), 0);
    for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
    {
      if (mesh.isBoundary(h))
      {
        isBoundary_[mesh.origin[h]] = isBoundary_[mesh.target(h)] = 1;
      }
    }
  }

  std::vector<std::string> ask()
  {
    half_.input.targetValences.assign(half_.input.points.size(), 0);
    const std::vector<ValenceRequest>& requests = task_.whole.surface.valenceRequests;
    for (const ValenceRequest& request : requests)
    {
      if (pointOf_[request.vertex] != kInvalidIndex)
      {
        askInFront(request);
      }
    }
    // All others regular: those in front say all, and an image that is off by a vertex would be one too many.
    const bool isWhole = task_.whole.surface.regularElsewhere && !askedBy_.empty();
    for (const ValenceRequest& request : requests)
    {
      if (!isWhole && pointOf_[request.vertex] == kInvalidIndex)
      {
        askBehind(request);
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

  /// What the half's boundary has in the plane: as if the quads went on beyond.
  void askInFront(const ValenceRequest& request)
  {
    const Index point = pointOf_[request.vertex];
    int valence = request.valence;
    if (task_.plane.height(half_.input.points[point]) <= task_.tolerance)
    {
      if (task_.midLine)
      {
        if (valence != kRegularValence)
        {
          notices_.push_back(textOf(request) +
            ", but lies in the mirror plane, which quads straddle, so that no point of them is "
            "there: it was not asked (move it aside, or choose an isoline for the plane's curve)");
        }
        return;
      }
      if (valence % 2 != 0)
      {
        notices_.push_back(textOf(request) +
          ", but lies in the mirror plane, whose curve is an isoline, so that only even numbers "
          "have a mirror image: it was not asked");
        return;
      }
      valence = valence / 2 + (isBoundary_[request.vertex] != 0 ? 1 : 2);
    }
    half_.input.targetValences[point] = valence;
    askedBy_[point] = request;
  }

  void askBehind(const ValenceRequest& request)
  {
    const Index point = pointNear(task_.plane.image(placeOf(request)));
    if (point == kInvalidIndex)
    {
      notices_.push_back(textOf(request) +
        ", but there is no point in front of the mirror plane near its mirror image: it was not "
        "asked");
      return;
    }
    const auto other = askedBy_.find(point);
    if (other == askedBy_.end())
    {
      askedBy_[point] = request;
      half_.input.targetValences[point] = request.valence;
    }
    else if (other->second.valence != request.valence)
    {
      notices_.push_back(textOf(request) + ", but " + textOf(other->second) +
        ", where its mirror image is: the one in front of the mirror plane is followed");
    }
  }

  /// The nearest corner of the nearest face that is in front, not in the plane.
  Index pointNear(const Vector3& p) const
  {
    const Mesh& mesh = task_.whole.surface.mesh;
    const auto place = task_.whole.faces.at(p);
    Index best = kInvalidIndex;
    for (Index i = 0; place && i < 3; ++i)
    {
      const Index v = mesh.origin[3 * place->triangle + i];
      const bool isInFront =
        pointOf_[v] != kInvalidIndex && task_.plane.height(mesh.position[v]) > task_.tolerance;
      if (isInFront &&
        (best == kInvalidIndex ||
          (mesh.position[v] - p).norm() < (half_.input.points[best] - p).norm()))
      {
        best = pointOf_[v];
      }
    }
    return best;
  }

  const MirrorTask& task_;
  MirrorHalf& half_;
  std::vector<Index> pointOf_; ///< per vertex of the whole
  std::vector<std::uint8_t> isBoundary_;
  std::map<Index, ValenceRequest> askedBy_;
  std::vector<std::string> notices_;
};

void askSizes(const MirrorTask& task, MirrorHalf& half)
{
  const Mesh& mesh = task.whole.surface.mesh;
  if (mesh.sizing.empty())
  {
    return;
  }
  std::vector<Vector3> normals(mesh.vertexCount(), Vector3::Zero());
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    normals[mesh.origin[h]] += faceNormalOf(mesh, Mesh::face(h));
  }
  const auto sizeOf = [&](Index h) { return double{ mesh.sizing[mesh.origin[h]] }; };
  const FacesBehind behind(task,
    [&](Index f)
    { return sizeOf(3 * f) != 1 || sizeOf(3 * f + 1) != 1 || sizeOf(3 * f + 2) != 1; });
  std::vector<float>& sizing = half.input.sizing;
  sizing.resize(half.origin.size());
  parallelFor(sizing.size(), kAskChunk, task.threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        const CutPoint& at = half.origin[i];
        double size =
          (1 - at.share) * double{ mesh.sizing[at.from] } + at.share * double{ mesh.sizing[at.to] };
        const bool inPlane = task.plane.height(half.input.points[i]) <= task.tolerance;
        if (size == 1 && !inPlane && !behind.empty())
        {
          if (const auto place = behind.at(half.input.points[i], normals[at.from]))
          {
            const Index h = 3 * place->triangle;
            size = place->weights[0] * sizeOf(h) + place->weights[1] * sizeOf(h + 1) +
              place->weights[2] * sizeOf(h + 2);
          }
        }
        sizing[i] = static_cast<float>(size);
      }
    });
}

bool liesInPlane(const MirrorTask& task, const CurveRequest& curve)
{
  return std::all_of(curve.points.begin(), curve.points.end(),
    [&](const Vector3& p) { return std::abs(task.plane.height(p)) <= task.tolerance; });
}

} // namespace

std::vector<std::string> askOfHalf(const MirrorTask& task, MirrorHalf& half)
{
  std::vector<std::string> notices;
  if (!task.whole.surface.valenceRequests.empty())
  {
    notices = HalfValences(task, half).ask();
  }
  const std::string guides = askGuides(task, half);
  if (!guides.empty())
  {
    notices.push_back(guides);
  }
  askSizes(task, half);
  return notices;
}

HalfCurves askCurvesOfHalf(const MirrorTask& task)
{
  HalfCurves asked;
  const std::vector<CurveRequest>& curves = task.whole.surface.curves;
  for (std::size_t i = 0; i < curves.size(); ++i)
  {
    // Drawn points need not lie on the surface: as far off as its image may be.
    const double slack = task.deviation + task.tolerance;
    double low = 0, high = 0;
    for (const Vector3& p : curves[i].points)
    {
      low = std::min(low, task.plane.height(p));
      high = std::max(high, task.plane.height(p));
    }
    if ((low < -slack && high > slack) || (task.midLine && liesInPlane(task, curves[i])))
    {
      continue;
    }
    const bool isImage = -low > high;
    CurveRequest curve = curves[i];
    for (Vector3& p : curve.points)
    {
      p = isImage ? task.plane.image(p) : p;
    }
    asked.curves.push_back(std::move(curve));
    asked.ofWhole.push_back(static_cast<Index>(i));
    asked.isImage.push_back(isImage ? 1 : 0);
  }
  return asked;
}

std::vector<CurveOutcome> outcomesOfWhole(
  const MirrorTask& task, const HalfCurves& asked, const std::vector<CurveOutcome>& half)
{
  CurveOutcome crossing;
  crossing.why = "it crosses the mirror plane, where quads are those of one side and their image: "
                 "draw it on one side, or switch the symmetry off";
  std::vector<CurveOutcome> outcomes(task.whole.surface.curves.size(), crossing);
  for (std::size_t i = 0; i < outcomes.size(); ++i)
  {
    outcomes[i].start = task.whole.surface.curves[i].points.front();
    outcomes[i].end = task.whole.surface.curves[i].points.back();
    if (task.midLine && liesInPlane(task, task.whole.surface.curves[i]))
    {
      outcomes[i].why =
        "it lies in the mirror plane, which quads straddle: draw it beside the plane, or choose an "
        "isoline for the plane's curve";
    }
  }
  for (std::size_t i = 0; i < half.size(); ++i)
  {
    CurveOutcome& outcome = outcomes[asked.ofWhole[i]];
    outcome = half[i];
    if (asked.isImage[i] != 0)
    {
      outcome.start = task.plane.image(outcome.start);
      outcome.end = task.plane.image(outcome.end);
    }
  }
  return outcomes;
}

} // namespace quadrille

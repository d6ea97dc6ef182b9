// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/CurveIsolines.h"

#include "Base/ChartRotation.h"
#include "Base/PlaceText.h"
#include "Integers/AxisLines.h"
#include "Integers/Sight.h"
#include "Mesh/Distance.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

namespace quadrille
{
namespace
{

constexpr float kConnectionWeight = 0.5F;
/// In edges of quads: how far from an end of a connection the vertex may lie that it joins.
constexpr double kReachOfIrregular = 3;
constexpr double kReachOfCurve = 1.5;
/// In edges of quads: how far from a curve vertices had better be regular.
constexpr double kClearance = 1.5;
/// A line is the one asked for where it is at most so many times longer than the way along the curve.
constexpr std::int64_t kMostDetour = 2;

Index nearestVertex(const Mesh& mesh, const Vector3& p)
{
  Index best = 0;
  for (Index v = 1; v < mesh.vertexCount(); ++v)
  {
    best =
      (mesh.position[v] - p).squaredNorm() < (mesh.position[best] - p).squaredNorm() ? v : best;
  }
  return best;
}

/// The nearest of the flagged vertices within the radius.
Index nearestFlagged(
  const Mesh& mesh, const std::vector<std::uint8_t>& flags, const Vector3& p, double radius)
{
  Index best = kInvalidIndex;
  double least = radius;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    const double distance = (mesh.position[v] - p).norm();
    if (flags[v] != 0 && distance <= least)
    {
      least = distance;
      best = v;
    }
  }
  return best;
}

/// Between features these lead the field, and a coarse way would turn it away from them.
bool crossesFeature(const Mesh& mesh, const FacePath& path)
{
  return std::any_of(
    path.crossed.begin(), path.crossed.end(), [&mesh](Index h) { return mesh.isConstrained(h); });
}

struct CurveEnd
{
  Index vertex = kInvalidIndex;
  bool isPoint =
    false; ///< an irregular vertex, or a corner of a curve: it has a place of its own in the map
};

CurveEnd endNear(const Mesh& mesh, const CrossField& field, const Vector3& p, double edgeLength)
{
  const std::vector<std::uint8_t> integer = integerVertices(mesh, field);
  const Index irregular = nearestFlagged(mesh, integer, p, kReachOfIrregular * edgeLength);
  const Index curve =
    nearestFlagged(mesh, constrainedVertices(mesh), p, kReachOfCurve * edgeLength);
  const auto distance = [&](Index v)
  { return v == kInvalidIndex ? kInfinity : (mesh.position[v] - p).norm(); };
  // An irregular vertex that lies a little farther than the curve is what was meant.
  const bool point = distance(irregular) <= distance(curve) + edgeLength;
  const Index v = point ? irregular : curve;
  return { v, v != kInvalidIndex && integer[v] != 0 };
}

struct CurveVertices
{
  Index from = kInvalidIndex, to = kInvalidIndex;
};

/// What a connection joins, or, where that is too far, what is nearest to its ends.
CurveVertices verticesOf(
  const Mesh& mesh, const CrossField& field, const CurveRequest& curve, double edgeLength)
{
  const auto vertexAt = [&](const Vector3& place)
  {
    const CurveEnd end = endNear(mesh, field, place, edgeLength);
    return end.vertex != kInvalidIndex ? end.vertex : nearestVertex(mesh, place);
  };
  return { vertexAt(curve.points.front()), vertexAt(curve.points.back()) };
}

/// Flags the vertices near a curve but for its ends.
void clearTheWay(const Mesh& mesh, const CurveRequest& curve, const CurveVertices& ends,
  double edgeLength, std::vector<std::uint8_t>& regular)
{
  const std::vector<Vector3> samples = sampleCurve(curve, edgeLength);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    if (v != ends.from && v != ends.to &&
      distanceToCurve(samples, mesh.position[v]) <= kClearance * edgeLength)
    {
      regular[v] = 1;
    }
  }
}

Index cornerAt(const Mesh& mesh, Index f, Index v)
{
  Index h = 3 * f;
  while (h < 3 * f + 3 && mesh.origin[h] != v)
  {
    ++h;
  }
  return h < 3 * f + 3 ? h : kInvalidIndex;
}

/// In the field's frame of face f.
Vector2 inField(const Mesh& mesh, const CrossField& field, Index f, const Vector3& p)
{
  const Vector3 x = mesh.edgeVector(3 * f).stableNormalized();
  const Vector3 y = x.cross(mesh.edgeVector(3 * f + 1)).stableNormalized().cross(x);
  const double c = std::cos(field.angle[f]), s = std::sin(field.angle[f]);
  return { c * p.dot(x) + s * p.dot(y), c * p.dot(y) - s * p.dot(x) };
}

/// A way through the faces, by the middles of the edges that it crosses, as the field sees it: from end to end, in the
/// frame of the first face.
Vector2 wayInField(const Mesh& mesh, const CrossField& field, const FacePath& path,
  const Vector3& begin, const Vector3& end)
{
  Vector2 vector = Vector2::Zero();
  int rotation = 0; // from that frame to the frame of the face
  Index f = path.first;
  Vector3 at = begin;
  const auto go = [&](const Vector3& to)
  {
    vector += turned(inField(mesh, field, f, to - at), -rotation);
    at = to;
  };
  for (const Index h : path.crossed)
  {
    go((mesh.position[mesh.origin[h]] + mesh.position[mesh.target(h)]) / 2);
    rotation = (rotation + field.matching[h]) & 3;
    f = Mesh::face(mesh.twin[h]);
  }
  go(end);
  return vector;
}

int axisOf(const Vector2& vector)
{
  const bool alongU = std::abs(vector.x()) >= std::abs(vector.y());
  return alongU ? (vector.x() >= 0 ? 0 : 2) : (vector.y() >= 0 ? 1 : 3);
}

void leaveOut(RequestedLine& line, const std::string& why)
{
  line.outcome.why = why;
}

/// The way's places, in the middle of the edges that it crosses.
std::vector<Vector3> placesOf(const Mesh& mesh, const Isoline& line)
{
  std::vector<Vector3> places;
  for (const Index h : line.crossed)
  {
    places.emplace_back((mesh.position[mesh.origin[h]] + mesh.position[mesh.target(h)]) / 2);
  }
  return places;
}

std::optional<UvDirection> lineBetween(const UvMesh& map, const std::vector<std::uint8_t>& integer,
  Index from, Index to, std::int64_t length)
{
  for (const UvDirection& direction : axisDirections(map, from))
  {
    const LineStop end = followThrough(map, direction, length, integer);
    if (end.vertex == to && end.length == length)
    {
      return direction;
    }
  }
  return std::nullopt;
}

/// Whether a line from the irregular end of a connection meets a feature or boundary near its other end.
bool reachesCurve(const Mesh& mesh, const UvMesh& map, const std::vector<std::uint8_t>& integer,
  const CurveOutcome& ends, std::int64_t maximumLength, double reach)
{
  const bool forward = integer[ends.from] != 0;
  const Index from = forward ? ends.from : ends.to;
  const std::vector<std::uint8_t> onCurve = constrainedVertices(mesh);
  const Vector3 goal = mesh.position[forward ? ends.to : ends.from];
  for (const UvDirection& direction : axisDirections(map, from))
  {
    const LineStop end = followThrough(map, direction, maximumLength, integer);
    const bool atVertex = end.vertex != kInvalidIndex && onCurve[end.vertex] != 0 &&
      (mesh.position[end.vertex] - goal).norm() <= reach;
    const bool atCurve = end.curve != kInvalidIndex &&
      distanceToSegment(goal, mesh.position[mesh.origin[end.curve]],
        mesh.position[mesh.target(end.curve)]) <= reach;
    if (atVertex || atCurve)
    {
      return true;
    }
  }
  return false;
}

} // namespace

CurvesInField followedCurves(const Mesh& mesh, const CrossField& field,
  const std::vector<FollowedCurve>& curves, double edgeLength, std::vector<Guide> guides)
{
  CurvesInField result;
  guides.resize(mesh.faceCount());
  result.regular.assign(mesh.vertexCount(), 0);
  for (const auto& [curve, way] : curves)
  {
    const CurveVertices ends = verticesOf(mesh, field, curve, edgeLength);
    const std::optional<FacePath> path = way ? FacePath{ Mesh::face(way->start), way->crossed }
                                             : pathAlong(mesh, curve, ends.from, ends.to);
    if (path)
    {
      clearTheWay(mesh, curve, ends, edgeLength, result.regular);
    }
    if (path && !crossesFeature(mesh, *path))
    {
      result.lines.push_back({ path->crossed, directionsAlong(mesh, *path) });
      guideAlong(mesh, *path, kConnectionWeight, guides);
    }
  }
  result.guides = std::move(guides);
  return result;
}

std::vector<int> valencesOf(const Mesh& mesh, const CrossField& field, std::vector<int> valences)
{
  valences.resize(mesh.vertexCount(), 0);
  const std::vector<std::uint8_t> onCurve = constrainedVertices(mesh);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    valences[v] = valences[v] == 0 && onCurve[v] == 0 ? field.turns[v] : valences[v];
  }
  return valences;
}

std::vector<int> valencesWithEnds(const Mesh& mesh, const CrossField& field,
  const std::vector<FollowedCurve>& curves, double edgeLength, std::vector<int> valences)
{
  const std::vector<std::uint8_t> onCurve = constrainedVertices(mesh);
  for (const auto& [curve, way] : curves)
  {
    for (const Vector3& place : { curve.points.front(), curve.points.back() })
    {
      const CurveEnd end = endNear(mesh, field, place, edgeLength);
      if (end.isPoint && onCurve[end.vertex] == 0)
      {
        valences.resize(mesh.vertexCount(), 0);
        int& valence = valences[end.vertex];
        valence = valence == 0 ? field.turns[end.vertex] : valence;
      }
    }
  }
  return valences;
}

RequestedLine lineOf(
  const Mesh& mesh, const CrossField& field, const CurveRequest& curve, double edgeLength)
{
  RequestedLine result;
  const CurveEnd a = endNear(mesh, field, curve.points.front(), edgeLength);
  const CurveEnd b = endNear(mesh, field, curve.points.back(), edgeLength);
  for (const auto& [end, place] :
    { std::pair(a, curve.points.front()), std::pair(b, curve.points.back()) })
  {
    if (end.vertex == kInvalidIndex)
    {
      leaveOut(result,
        "no irregular vertex, feature or boundary lies within " +
          std::to_string(static_cast<int>(kReachOfIrregular)) + " quads of " + placeText(place) +
          ": draw to one, or ask for a valence there");
      return result;
    }
  }
  result.outcome.from = a.vertex;
  result.outcome.to = b.vertex;
  result.outcome.start = mesh.position[a.vertex];
  result.outcome.end = mesh.position[b.vertex];
  if (a.vertex == b.vertex)
  {
    leaveOut(result,
      "both ends are nearest to the same vertex, at " + placeText(result.outcome.start) +
        ": draw between two");
    return result;
  }
  if (!a.isPoint && !b.isPoint)
  {
    leaveOut(result, "neither end is near an irregular vertex: draw from one");
    return result;
  }
  const std::optional<FacePath> path = pathAlong(mesh, curve, a.vertex, b.vertex);
  if (!path)
  {
    leaveOut(result, "no way over the surface leads from one of its ends to the other");
    return result;
  }
  const Vector3 begin = mesh.position[a.vertex], end = mesh.position[b.vertex];
  result.line.crossed = path->crossed;
  result.line.start = cornerAt(mesh, path->first, a.vertex);
  result.line.end = cornerAt(mesh, path->faces(mesh).back(), b.vertex);
  result.line.axis = axisOf(wayInField(mesh, field, *path, begin, end));
  result.hasLine = a.isPoint && b.isPoint;
  result.endsOnCurve = !result.hasLine;
  return result;
}

std::optional<Isoline> straightWay(const Mesh& mesh, const CrossField& field,
  const std::vector<FixedVec2>& seamlessUv, const CurveRequest& curve, const CurveOutcome& ends,
  double edgeLength)
{
  constexpr double kMostOverStraight = 3;  // in quads, of a bent way and of sizes that differ
  constexpr double kMostTangent = 0.7;     // of the angle to the axis, where 45 degrees are 1
  constexpr double kPriceOfDistance = 0.1; // of an edge length from the curve
  const UvMesh map = UvMesh::from(mesh, field, seamlessUv);
  const double quads = (ends.end - ends.start).norm() / edgeLength;
  const Sight sight(map, ends.from, ends.to, kMostOverStraight * quads + kReachOfIrregular);
  const std::vector<Vector3> samples = sampleCurve(curve, edgeLength);
  std::optional<Isoline> best;
  double least = kInfinity;
  for (const Sight::Line& line : sight.lines())
  {
    const Vector2 vector = toDouble(line.vector);
    const double tangent =
      vector.cwiseAbs().minCoeff() / std::max(vector.cwiseAbs().maxCoeff(), 1e-300);
    Isoline way{ line.start, line.end, line.crossed, axisOf(vector) };
    double away = 0;
    for (const Vector3& p : placesOf(mesh, way))
    {
      away = std::max(away, distanceToCurve(samples, p) / edgeLength);
    }
    const double price = tangent + kPriceOfDistance * away;
    if (tangent <= kMostTangent && price < least)
    {
      least = price;
      best = std::move(way);
    }
  }
  return best;
}

int axisAlong(const Mesh& mesh, const CrossField& field, const Isoline& way)
{
  const FacePath path{ Mesh::face(way.start), way.crossed };
  const Vector3 begin = mesh.position[mesh.origin[way.start]];
  const Vector3 end = mesh.position[mesh.origin[way.end]];
  return axisOf(wayInField(mesh, field, path, begin, end));
}

FixedVec2 developedVector(const UvMesh& map, const Isoline& line)
{
  // From charts along the way to that of its first face.
  Transition back;
  for (const Index h : line.crossed)
  {
    back = back.after(map.transition(h).inverse());
  }
  return back.apply(map.uv[line.end]) - map.uv[line.start];
}

bool lockLine(UvMesh& map, UvEditor& editor, const std::vector<std::uint8_t>& integer,
  const Mesh& mesh, const Isoline& line, FixedVec2 developed)
{
  const std::int64_t length = std::abs(lengthAlong(developed, line.axis));
  if (length == 0)
  {
    return false;
  }
  const std::optional<UvDirection> start =
    lineBetween(map, integer, mesh.origin[line.start], mesh.origin[line.end], length);
  return start && lockParts(map, editor, *start, length);
}

bool hasGridLine(const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& uv,
  const RequestedLine& wanted, double edgeLength)
{
  const UvMesh map = UvMesh::from(mesh, field, uv);
  const std::vector<std::uint8_t> integer = integerVertices(mesh, field);
  const std::int64_t length =
    std::abs(lengthAlong(developedVector(map, wanted.line), wanted.line.axis));
  const std::int64_t most = kMostDetour * length + kOne;
  if (wanted.endsOnCurve)
  {
    return reachesCurve(mesh, map, integer, wanted.outcome, most, kReachOfIrregular * edgeLength);
  }
  const std::vector<UvDirection> directions = axisDirections(map, wanted.outcome.from);
  return std::any_of(directions.begin(), directions.end(),
    [&](const UvDirection& direction)
    { return followThrough(map, direction, most, integer, false).vertex == wanted.outcome.to; });
}

} // namespace quadrille

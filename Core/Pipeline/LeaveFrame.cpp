// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/LeaveFrame.h"

#include "Base/Progress.h"

#include <algorithm>
#include <utility>

namespace quadrille
{

namespace
{

using Weights = std::array<double, 3>;

void reverseQuads(QuadMesh& quads)
{
  for (std::array<Index, 4>& quad : quads.quads)
  {
    std::swap(quad[1], quad[3]);
  }
  for (Weights& weights : quads.sourceWeights)
  {
    std::swap(weights[1], weights[2]);
  }
  for (Weights& weights : quads.quadSourceWeights)
  {
    std::swap(weights[1], weights[2]);
  }
  for (std::size_t i = 0; i + 1 < quads.polygonOffsets.size(); ++i)
  {
    std::reverse(quads.polygonPoints.begin() + quads.polygonOffsets[i] + 1,
      quads.polygonPoints.begin() + quads.polygonOffsets[i + 1]);
  }
  for (QuadLine& line : quads.lines)
  {
    std::swap(line.a, line.b);
    line.halfEdge = line.halfEdge == kInvalidIndex ? kInvalidIndex : reversedEdge(line.halfEdge);
  }
}

/// Puts points of the quads where they lie on the user's surface. positionOf: of the vertex at a corner of the mapped
/// mesh.
template <typename PositionOf>
void leaveFrameAt(
  QuadMesh& quads, const Mesh& mapped, const Frame& frame, const PositionOf& positionOf)
{
  for (std::size_t p = 0; p < quads.points.size(); ++p)
  {
    pollNowAndThen(p);
    const Index h = 3 * quads.sourceFace[p];
    const Weights& weights = quads.sourceWeights[p];
    Vector3& point = quads.points[p];
    const Vector3 between = weights[0] * mapped.position[mapped.origin[h]] +
      weights[1] * mapped.position[mapped.origin[h + 1]] +
      weights[2] * mapped.position[mapped.origin[h + 2]];
    const auto corner = std::find(weights.begin(), weights.end(), 1.0);
    if ((between - point).cwiseAbs().maxCoeff() > kLastDigits)
    {
      point = frame.toUser(point); // it is not on its face
    }
    else if (corner != weights.end())
    {
      point = positionOf(h + static_cast<Index>(corner - weights.begin()));
    }
    else
    {
      Vector3 place = Vector3::Zero();
      for (Index i = 0; i < 3; ++i)
      {
        place += weights[i] * (positionOf(h + i) - frame.centre);
      }
      point = frame.centre + place;
    }
  }
  if (frame.reversed)
  {
    reverseQuads(quads);
  }
}

} // namespace

void leaveFrame(Level& level, const Frame& frame, const std::vector<Vector3>& positions)
{
  Vector3* position = level.mesh.position.edit();
  for (Index v = 0; v < level.mesh.vertexCount(); ++v)
  {
    position[v] = positions[level.fineVertex[v]];
  }
  for (Guide& guide : level.guides)
  {
    guide.direction = frame.mirrored(guide.direction);
  }
  if (frame.reversed)
  {
    reverseFaces(level.mesh);
  }
}

void leaveFrame(PreparedSurface& surface, const Frame& frame, std::vector<Vector3> positions)
{
  surface.mesh.position = std::move(positions);
  surface.area *= frame.unit * frame.unit;
  surface.boundingBoxDiagonal *= frame.unit;
  for (PolygonGuide& guide : surface.polygonGuides)
  {
    guide.direction = frame.mirrored(guide.direction);
  }
  for (StrokeFace& guided : surface.strokeFaces)
  {
    guided.direction = frame.mirrored(guided.direction);
  }
  for (StrokeRequest& stroke : surface.strokes)
  {
    for (Vector3& p : stroke.points)
    {
      p = frame.toUser(p);
    }
    stroke.radius *= frame.unit;
  }
  visitPaths(
    surface, [&](Vector3& p) { p = frame.toUser(p); },
    [&](Vector3& direction) { direction = frame.mirrored(direction); });
  if (frame.reversed)
  {
    reverseFaces(surface);
  }
}

void leaveFrame(
  QuadMesh& quads, const Mesh& mapped, const Frame& frame, const std::vector<Vector3>& positions)
{
  leaveFrameAt(quads, mapped, frame, [&](Index h) { return positions[mapped.origin[h]]; });
}

void reverseMap(std::vector<FixedVec2>& uv)
{
  for (std::size_t h = 0; h < uv.size(); h += 3)
  {
    pollNowAndThen(h);
    std::swap(uv[h + 1], uv[h + 2]);
  }
  for (FixedVec2& p : uv)
  {
    std::swap(p.u, p.v);
  }
}

void reverseMatching(std::vector<std::int8_t>& matching)
{
  for (std::size_t h = 0; h < matching.size(); h += 3)
  {
    std::swap(matching[h], matching[h + 2]);
  }
  for (std::int8_t& turns : matching)
  {
    turns = static_cast<std::int8_t>(-turns & 3);
  }
}

namespace
{

void leaveMeasures(RemeshResult& result, const Frame& frame)
{
  result.targetEdgeLength *= frame.unit;
  for (Vector3& place : result.failed.places)
  {
    place = frame.toUser(place);
  }
  SmallParts& parts = result.smallParts;
  parts.shortestLoop *= frame.unit;
  parts.place = frame.toUser(parts.place);
  parts.boundary.shortest *= frame.unit;
  parts.boundary.place = frame.toUser(parts.boundary.place);
  for (GivenUpCurve& curve : result.givenUpFeatures)
  {
    curve.place = frame.toUser(curve.place);
    curve.length *= frame.unit;
  }
  for (SmallDetail& detail : result.details)
  {
    detail.place = frame.toUser(detail.place);
  }
  for (CurveOutcome& curve : result.curves)
  {
    curve.start = frame.toUser(curve.start);
    curve.end = frame.toUser(curve.end);
  }
  leaveFrame(result.onFeatures, frame);
  for (Vector3& place : result.withoutMap)
  {
    place = frame.toUser(place);
  }
}

} // namespace

void leaveFrameAlone(RemeshResult& result, const Frame& frame)
{
  leaveMeasures(result, frame);
  QuadMesh& quads = result.quads;
  for (Vector3& p : quads.points)
  {
    p = frame.toUser(p);
  }
  if (frame.reversed)
  {
    reverseQuads(quads);
  }
  quads.sourceFace.clear();
  quads.sourceWeights.clear();
  quads.quadSourceFace.clear();
  quads.quadSourceWeights.clear();
}

void leaveFrame(RemeshResult& result, const PreparedSurface& made, const Frame& frame,
  const std::vector<Vector3>& points)
{
  leaveMeasures(result, frame);
  leaveFrameAt(
    result.quads, made.mesh, frame, [&](Index h) { return userPosition(made, h, frame, points); });
}

void leaveFrame(RemeshResult& result, const Frame& frame, const std::vector<Vector3>& points,
  bool keepsPositions, int threads)
{
  leaveMeasures(result, frame);
  if (result.surface.mesh.position.empty())
  {
    return;
  }
  PreparedSurface& surface = result.surface;
  leaveFrameAt(result.quads, surface.mesh, frame,
    [&](Index h) { return userPosition(surface, h, frame, points); });
  if (keepsPositions)
  {
    putUserPositions(surface, frame, points, threads);
    leaveFrame(result.coarse, frame, surface.mesh.position);
  }
  else
  {
    surface.mesh.position.clear();
    for (Vector3& p : result.coarse.mesh.position.editAll())
    {
      p = frame.toUser(p);
    }
    if (frame.reversed)
    {
      reverseFaces(result.coarse.mesh);
    }
  }
  leaveFrame(surface, frame, surface.mesh.position.take());
  if (frame.reversed)
  {
    reverseMap(result.uv);
    reverseMap(result.coarseUv);
  }
}

} // namespace quadrille

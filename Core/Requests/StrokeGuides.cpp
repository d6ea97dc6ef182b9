// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/StrokeGuides.h"

#include "Mesh/NearestTriangle.h"
#include "Mesh/Sizing.h"
#include "Requests/MeshPaths.h"

#include <map>
#include <set>

namespace quadrille
{
namespace
{

/// A straight part of a path, in one face.
struct PathPart
{
  Index face = kInvalidIndex;
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();
};

using PathParts = std::vector<PathPart>;

/// Of each stroke.
std::vector<PathParts> partsOf(
  const Mesh& mesh, const std::vector<StrokeRequest>& strokes, int threads)
{
  std::vector<Vector3> points;
  for (const StrokeRequest& stroke : strokes)
  {
    points.insert(points.end(), stroke.points.begin(), stroke.points.end());
  }
  const std::vector<MeshPlace> places = placesOnMesh(mesh, points, threads);
  std::vector<PathParts> result(strokes.size());
  std::size_t at = 0;
  for (std::size_t k = 0; k < strokes.size(); ++k)
  {
    for (std::size_t i = 0; i + 1 < strokes[k].points.size(); ++i, ++at)
    {
      const auto path = pathOnMesh(mesh, places[at], places[at + 1]);
      if (!path)
      {
        continue;
      }
      Index face = path->face;
      Vector3 from = places[at].point;
      for (const EdgeCrossing& crossing : path->crossings)
      {
        result[k].push_back({ face, from, crossing.point(mesh) });
        from = result[k].back().to;
        face = Mesh::face(mesh.twin[crossing.halfEdge]);
      }
      result[k].push_back({ face, from, places[at + 1].point });
    }
    ++at;
  }
  return result;
}

/// Those that lead anywhere, as segments.
TriangleList segmentsOf(const PathParts& parts)
{
  TriangleList list;
  for (const PathPart& part : parts)
  {
    if (part.from != part.to)
    {
      list.addSegment(part.from, part.to);
    }
  }
  return list;
}

/// Of the nearest segment, where that is within the radius; else zero.
Vector3 directionNear(const NearestTriangle& segments, const Vector3& p, double radius)
{
  const auto nearest = segments.at(p, Vector3::Zero(), radius);
  if (!nearest)
  {
    return Vector3::Zero();
  }
  const TriangleList& list = segments.triangles();
  const std::array<Index, 3>& ends = list.corners[nearest->triangle];
  return (list.points[ends[1]] - list.points[ends[0]]).stableNormalized();
}

/// Directions of faces under one stroke and round it.
std::map<Index, Vector3> directionsOf(
  const Mesh& mesh, const PathParts& parts, double radius, double edgeLength)
{
  std::map<Index, Vector3> directions;
  for (const PathPart& part : parts)
  {
    Vector3& sum = directions.try_emplace(part.face, Vector3::Zero()).first->second;
    const Vector3 along = part.to - part.from;
    sum += sum.dot(along) < 0 ? Vector3(-along) : along;
  }
  std::set<Index> seen, front;
  for (auto& [face, direction] : directions)
  {
    direction = direction.stableNormalized();
    seen.insert(face);
    front.insert(face);
  }
  const NearestTriangle segments(segmentsOf(parts));
  while (!front.empty())
  {
    const Index face = *front.begin();
    front.erase(front.begin());
    for (Index h = 3 * face; h < 3 * face + 3; ++h)
    {
      const Index other = mesh.isBoundary(h) ? kInvalidIndex : Mesh::face(mesh.twin[h]);
      if (other == kInvalidIndex || !seen.insert(other).second)
      {
        continue;
      }
      const double reach = radius + 0.25 * edgeLength * sizeAt(mesh, mesh.origin[3 * other]);
      const Vector3 direction = directionNear(segments, mesh.middleOfFace(other), reach);
      if (!direction.isZero(0))
      {
        directions[other] = direction;
        front.insert(other);
      }
    }
  }
  return directions;
}

} // namespace

std::vector<StrokeFace> facesOfStrokes(
  const Mesh& mesh, const std::vector<StrokeRequest>& strokes, double edgeLength, int threads)
{
  std::vector<StrokeFace> result;
  if (strokes.empty())
  {
    return result;
  }
  const std::vector<PathParts> parts = partsOf(mesh, strokes, threads);
  std::map<Index, StrokeFace> faces;
  for (std::size_t k = 0; k < strokes.size(); ++k)
  {
    for (const auto& [face, direction] :
      directionsOf(mesh, parts[k], strokes[k].radius, edgeLength))
    {
      StrokeFace& guided = faces.try_emplace(face).first->second;
      if (guided.face == kInvalidIndex || guided.order <= strokes[k].order)
      {
        guided = { face, direction, static_cast<float>(strokes[k].weight), strokes[k].order };
      }
    }
  }
  for (const auto& [face, guided] : faces)
  {
    if (!guided.direction.isZero(0))
    {
      result.push_back(guided);
    }
  }
  return result;
}

} // namespace quadrille

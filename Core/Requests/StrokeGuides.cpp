// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/StrokeGuides.h"

#include "Mesh/BoxTree.h"
#include "Mesh/Distance.h"
#include "Mesh/Sizing.h"
#include "Requests/MeshPaths.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

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

/// Finds directions of the parts of a path.
class NearestPart
{
public:
  explicit NearestPart(PathParts parts) : parts_(std::move(parts))
  {
    parts_.erase(std::remove_if(parts_.begin(), parts_.end(),
                   [](const PathPart& part) { return part.from == part.to; }),
      parts_.end());
    std::vector<BoxTree::Box> boxes;
    boxes.reserve(parts_.size());
    for (const PathPart& part : parts_)
    {
      boxes.push_back({ part.from.cwiseMin(part.to), part.from.cwiseMax(part.to) });
    }
    tree_ = BoxTree(boxes, 1);
  }

  /// Of the nearest part, where that is within the radius; else zero.
  Vector3 direction(const Vector3& p, double radius) const
  {
    const auto distance = [&](Index i)
    { return distanceToSegment(p, parts_[i].from, parts_[i].to); };
    const Index nearest = tree_.nearest(p, [&](Index i) { return distance(i) * distance(i); });
    if (nearest == kInvalidIndex || distance(nearest) > radius)
    {
      return Vector3::Zero();
    }
    return (parts_[nearest].to - parts_[nearest].from).stableNormalized();
  }

private:
  PathParts parts_;
  BoxTree tree_;
};

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
  const NearestPart nearest(parts);
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
      const Vector3 direction = nearest.direction(mesh.middleOfFace(other), reach);
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

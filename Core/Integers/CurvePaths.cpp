// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/CurvePaths.h"

#include "Mesh/Distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

namespace quadrille
{
namespace
{

/// Way points lie about so many edges of the mesh apart: near enough to hold the path to the curve's course, and far
/// enough that one that fell on the wrong side of a thin part is rare.
constexpr double kEdgesPerWayPoint = 3;
constexpr std::size_t kMostWayPoints = 64;
/// In edges of the mesh: a way crosses a feature where the curve does, and not to and fro beside it.
constexpr double kPriceOfFeature = 2;

double meanEdge(const Mesh& mesh)
{
  double sum = 0;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    sum += mesh.edgeVector(h).norm();
  }
  return mesh.halfEdgeCount() > 0 ? sum / static_cast<double>(mesh.halfEdgeCount()) : 1;
}

Index nearestFace(const Mesh& mesh, const Vector3& p)
{
  Index best = 0;
  double least = kInfinity;
  for (Index f = 0; f < mesh.faceCount(); ++f)
  {
    const double distance = distanceToFace(mesh, f, p);
    if (distance < least)
    {
      least = distance;
      best = f;
    }
  }
  return best;
}

/// Shortest ways from face to face, dearer the farther they are from the curve.
class CurveWays
{
public:
  CurveWays(const Mesh& mesh, const CurveRequest& curve)
    : mesh_(mesh), edge_(meanEdge(mesh)), samples_(sampleCurve(curve, edge_)),
      price_(mesh.faceCount(), -1)
  {
  }

  /// Faces along the inside of the curve.
  std::vector<Index> wayPoints() const
  {
    std::vector<double> at{ 0 };
    for (std::size_t i = 1; i < samples_.size(); ++i)
    {
      at.push_back(at.back() + (samples_[i] - samples_[i - 1]).norm());
    }
    const double length = at.back();
    const std::size_t parts = std::clamp<std::size_t>(
      static_cast<std::size_t>(length / (kEdgesPerWayPoint * edge_)), 1, kMostWayPoints);
    std::vector<Index> faces;
    for (std::size_t k = 1; k < parts; ++k)
    {
      const double wanted = length * static_cast<double>(k) / static_cast<double>(parts);
      const std::size_t i = std::min<std::size_t>(
        std::upper_bound(at.begin(), at.end(), wanted) - at.begin(), samples_.size() - 1);
      const double part = at[i] > at[i - 1] ? (wanted - at[i - 1]) / (at[i] - at[i - 1]) : 0;
      faces.push_back(nearestFace(mesh_, samples_[i - 1] + part * (samples_[i] - samples_[i - 1])));
    }
    return faces;
  }

  /// From one of `from` to one of `to`: half-edges crossed, and the face that it begins in. False where there is none.
  bool find(const std::vector<Index>& from, const std::vector<Index>& to, FacePath& path)
  {
    using Entry = std::pair<double, Index>;
    std::vector<double> cost(mesh_.faceCount(), kInfinity);
    std::vector<Index> entered(mesh_.faceCount(), kInvalidIndex);
    std::vector<std::uint8_t> isGoal(mesh_.faceCount(), 0);
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index f : to)
    {
      isGoal[f] = 1;
    }
    for (const Index f : from)
    {
      cost[f] = 0;
      queue.push({ 0, f });
    }
    while (!queue.empty())
    {
      const auto [reached, f] = queue.top();
      queue.pop();
      if (reached > cost[f])
      {
        continue;
      }
      if (isGoal[f] != 0)
      {
        return trace(f, entered, path);
      }
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        if (mesh_.isBoundary(h))
        {
          continue;
        }
        const Index g = Mesh::face(mesh_.twin[h]);
        const double next = reached + (mesh_.isConstrained(h) ? kPriceOfFeature * edge_ : 0) +
          (mesh_.middleOfFace(g) - mesh_.middleOfFace(f)).norm() * (price(f) + price(g)) / 2;
        if (next < cost[g])
        {
          cost[g] = next;
          entered[g] = h;
          queue.push({ next, g });
        }
      }
    }
    return false;
  }

private:
  /// 1 on the curve.
  double price(Index f)
  {
    if (price_[f] < 0)
    {
      const double away = distanceToCurve(samples_, mesh_.middleOfFace(f)) / edge_;
      price_[f] = 1 + 4 * away * away;
    }
    return price_[f];
  }

  bool trace(Index goal, const std::vector<Index>& entered, FacePath& path) const
  {
    std::vector<Index> back;
    Index f = goal;
    for (; entered[f] != kInvalidIndex; f = Mesh::face(entered[f]))
    {
      back.push_back(entered[f]);
    }
    if (path.first == kInvalidIndex)
    {
      path.first = f;
    }
    path.crossed.insert(path.crossed.end(), back.rbegin(), back.rend());
    return true;
  }

  const Mesh& mesh_;
  double edge_;
  std::vector<Vector3> samples_;
  std::vector<double> price_; ///< #F, -1 where not known
};

/// Ways there and straight back say nothing.
void removeSpurs(const Mesh& mesh, FacePath& path)
{
  std::vector<Index> kept;
  for (const Index h : path.crossed)
  {
    if (!kept.empty() && kept.back() == mesh.twin[h])
    {
      kept.pop_back();
    }
    else
    {
      kept.push_back(h);
    }
  }
  path.crossed = std::move(kept);
  if (!path.crossed.empty())
  {
    path.first = Mesh::face(path.crossed.front());
  }
}

std::vector<Index> facesRound(const Mesh& mesh, Index v)
{
  std::vector<Index> faces;
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.origin[h] == v)
    {
      faces.push_back(Mesh::face(h));
    }
  }
  return faces;
}

/// From the last face at a to the first one at b.
void trimEnds(const Mesh& mesh, Index a, Index b, FacePath& path)
{
  const auto touches = [&](Index f, Index v)
  { return mesh.origin[3 * f] == v || mesh.origin[3 * f + 1] == v || mesh.origin[3 * f + 2] == v; };
  const std::vector<Index> faces = path.faces(mesh);
  std::size_t end = 0;
  while (end + 1 < faces.size() && !touches(faces[end], b))
  {
    ++end;
  }
  std::size_t begin = end;
  while (begin > 0 && !touches(faces[begin], a))
  {
    --begin;
  }
  path.first = faces[begin];
  const auto at = [&](std::size_t i)
  { return path.crossed.begin() + static_cast<std::ptrdiff_t>(i); };
  path.crossed = std::vector<Index>(at(begin), at(end));
}

/// Faces of a path laid out in the plane, one after the other.
class FaceStrip
{
public:
  /// In the plane of face f, with the half-edge 3 f along x.
  FaceStrip(const Mesh& mesh, Index f) : mesh_(mesh)
  {
    const Vector3 a = mesh.edgeVector(3 * f);
    corner_[0] = Vector2::Zero();
    corner_[1] = { a.norm(), 0 };
    corner_[2] = apex(3 * f, corner_[0], corner_[1]);
    first_ = 3 * f;
  }

  /// The middle of half-edge h of the last face.
  Vector2 middle(Index h) const { return (at(h) + at(Mesh::next(h))) / 2; }

  /// Adds the face beyond half-edge h of the last one.
  void cross(Index h)
  {
    const Vector2 a = at(h), b = at(Mesh::next(h));
    const Index g = mesh_.twin[h];
    first_ = g;
    corner_ = { b, a, apex(g, b, a) };
  }

private:
  Vector2 at(Index h) const
  {
    return h == first_ ? corner_[0] : h == Mesh::next(first_) ? corner_[1] : corner_[2];
  }

  /// The third corner of the face left of h, whose ends lie there.
  Vector2 apex(Index h, const Vector2& a, const Vector2& b) const
  {
    const Vector3 edge = mesh_.edgeVector(h);
    const Vector3 side = -mesh_.edgeVector(Mesh::previous(h));
    const double length = edge.norm();
    const double along = length > 0 ? edge.dot(side) / length : 0;
    const double away = length > 0 ? edge.cross(side).norm() / length : 0;
    const Vector2 x = (b - a).stableNormalized();
    return a + along * x + away * Vector2(-x.y(), x.x());
  }

  const Mesh& mesh_;
  Index first_ = kInvalidIndex; ///< half-edge of the last face whose origin lies at corner_[0]
  std::array<Vector2, 3> corner_;
};

/// From where the path is a few faces before to where it is a few behind, in the plane of its face i, which is f.
Vector2 chordAt(const Mesh& mesh, const FacePath& path, Index f, std::size_t i)
{
  constexpr std::size_t kFacesOfChord = 4;
  const std::size_t count = path.crossed.size();
  Vector2 ahead = Vector2::Zero(), behind = Vector2::Zero();
  FaceStrip forward(mesh, f);
  const std::size_t forwards = std::min(kFacesOfChord, count - std::min(i, count));
  for (std::size_t k = 0; k < forwards; ++k)
  {
    const Index h = path.crossed[i + k];
    ahead = forward.middle(h);
    forward.cross(h);
  }
  FaceStrip backward(mesh, f);
  const std::size_t backwards = std::min(kFacesOfChord, i);
  for (std::size_t k = 0; k < backwards; ++k)
  {
    const Index h = mesh.twin[path.crossed[i - 1 - k]];
    behind = backward.middle(h);
    backward.cross(h);
  }
  if (forwards > 0 && backwards > 0)
  {
    return ahead - behind;
  }
  // An end of the path: from, or to, the middle of the face.
  const FaceStrip here(mesh, f);
  const Vector2 centre = (here.middle(3 * f) + here.middle(3 * f + 1) + here.middle(3 * f + 2)) / 3;
  return forwards > 0 ? Vector2(ahead - centre)
    : backwards > 0   ? Vector2(centre - behind)
                      : Vector2(0, 0);
}

} // namespace

std::vector<Index> FacePath::faces(const Mesh& mesh) const
{
  std::vector<Index> result{ first };
  for (const Index h : crossed)
  {
    result.push_back(Mesh::face(mesh.twin[h]));
  }
  return result;
}

std::vector<Vector3> sampleCurve(const CurveRequest& curve, double spacing)
{
  std::vector<Vector3> samples;
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i)
  {
    const Vector3& p = curve.points[i];
    const Vector3 d = curve.points[i + 1] - p;
    const auto parts =
      static_cast<std::size_t>(std::clamp(std::ceil(d.norm() / spacing), 1.0, 10000.0));
    for (std::size_t k = 0; k < parts; ++k)
    {
      samples.push_back(p + d * (static_cast<double>(k) / static_cast<double>(parts)));
    }
  }
  samples.push_back(curve.points.back());
  return samples;
}

double distanceToCurve(const std::vector<Vector3>& samples, const Vector3& p)
{
  double least = kInfinity;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i)
  {
    least = std::min(least, distanceToSegment(p, samples[i], samples[i + 1]));
  }
  return least;
}

std::optional<FacePath> pathAlong(const Mesh& mesh, const CurveRequest& curve, Index a, Index b)
{
  CurveWays ways(mesh, curve);
  FacePath path;
  std::vector<Index> from = facesRound(mesh, a);
  for (const Index f : ways.wayPoints())
  {
    if (!ways.find(from, { f }, path))
    {
      return std::nullopt;
    }
    from.assign(1, f);
  }
  if (!ways.find(from, facesRound(mesh, b), path))
  {
    return std::nullopt;
  }
  removeSpurs(mesh, path);
  trimEnds(mesh, a, b, path);
  return path;
}

std::vector<Vector3> directionsAlong(const Mesh& mesh, const FacePath& path)
{
  const std::vector<Index> faces = path.faces(mesh);
  std::vector<Vector3> directions(faces.size(), Vector3::Zero());
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    const Vector2 along = chordAt(mesh, path, faces[i], i);
    const Index h = 3 * faces[i];
    if (along.squaredNorm() > 0)
    {
      const Vector3 x = mesh.edgeVector(h).stableNormalized();
      const Vector3 y = x.cross(mesh.edgeVector(h + 1)).stableNormalized().cross(x);
      directions[i] = (along.x() * x + along.y() * y).stableNormalized();
    }
  }
  return directions;
}

void guideAlong(const Mesh& mesh, const FacePath& path, float weight, std::vector<Guide>& guides)
{
  const std::vector<Index> faces = path.faces(mesh);
  const std::vector<Vector3> directions = directionsAlong(mesh, path);
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    if (guides[faces[i]].isFree() && !directions[i].isZero(0))
    {
      guides[faces[i]] = { directions[i], weight };
    }
  }
}

} // namespace quadrille

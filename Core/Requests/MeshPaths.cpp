// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Requests/MeshPaths.h"

#include "Base/Progress.h"
#include "Mesh/Distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <queue>
#include <utility>

namespace quadrille
{
namespace
{

/// A path may be this many times longer than needed rather than leave the segment by its own length.
constexpr double kDetour = 10;

/// Share of the edge a b, from a, at which it is nearest to the segment p q.
double shareNearestToSegment(const Vector3& a, const Vector3& b, const Vector3& p, const Vector3& q)
{
  const Vector3 edge = b - a, segment = q - p, between = a - p;
  const double ee = edge.squaredNorm(), ss = segment.squaredNorm(), es = edge.dot(segment);
  const double eb = edge.dot(between), sb = segment.dot(between);
  if (!(ee > 0))
  {
    return 0;
  }
  const double determinant = ee * ss - es * es;
  double share =
    determinant > 1e-12 * ee * ss ? std::clamp((es * sb - ss * eb) / determinant, 0.0, 1.0) : 0.5;
  if (ss > 0)
  {
    const double along = std::clamp((share * es + sb) / ss, 0.0, 1.0);
    share = std::clamp((along * es - eb) / ee, 0.0, 1.0);
  }
  else
  {
    share = std::clamp(-eb / ee, 0.0, 1.0);
  }
  return share;
}

/// How half-edges were reached, in pages that are made where the search comes to: it mostly stays near its ends, but
/// may have to go all over a surface of millions of faces, which lie along a space-filling curve.
class ReachedHalfEdges
{
public:
  struct Reached
  {
    double cost = kInfinity;
    Index before = kInvalidIndex;
    bool isDone = false;
  };

  explicit ReachedHalfEdges(Index halfEdges) : pages_(halfEdges / kHalfEdgesOfPage + 1) {}

  Reached& at(Index h)
  {
    std::unique_ptr<Page>& page = pages_[h / kHalfEdgesOfPage];
    if (!page)
    {
      page = std::make_unique<Page>();
    }
    return (*page)[h % kHalfEdgesOfPage];
  }

private:
  static constexpr Index kHalfEdgesOfPage = 256;
  using Page = std::array<Reached, kHalfEdgesOfPage>;

  std::vector<std::unique_ptr<Page>> pages_;
};

/// The half-edges over which the faces of a path are left.
class FaceStripSearch
{
public:
  FaceStripSearch(const Mesh& mesh, const MeshPlace& from, const MeshPlace& to)
    : mesh_(mesh), from_(from), to_(to),
      scale_(kDetour / std::max((to.point - from.point).norm(), 1e-300)),
      reached_(mesh.halfEdgeCount())
  {
  }

  std::optional<std::vector<Index>> run()
  {
    if (from_.face == to_.face)
    {
      return std::vector<Index>();
    }
    leave(from_.face, kInvalidIndex, from_.point, 0);
    while (!front_.empty())
    {
      const auto [whole, h] = front_.top();
      front_.pop();
      ReachedHalfEdges::Reached& here = reached_.at(h);
      if (here.isDone)
      {
        continue;
      }
      if (Mesh::face(mesh_.twin[h]) == to_.face)
      {
        return backFrom(h);
      }
      here.isDone = true;
      leave(Mesh::face(mesh_.twin[h]), h, crossing(h), here.cost);
    }
    return std::nullopt;
  }

private:
  using Entry = std::pair<double, Index>;

  /// Of an edge the point that is nearest to the straight segment.
  Vector3 crossing(Index h) const
  {
    const Vector3& a = mesh_.position[mesh_.origin[h]];
    const Vector3& b = mesh_.position[mesh_.target(h)];
    return a + shareNearestToSegment(a, b, from_.point, to_.point) * (b - a);
  }
  double away(const Vector3& p) const { return distanceToSegment(p, from_.point, to_.point); }

  /// From a point of the face over its other edges.
  void leave(Index face, Index over, const Vector3& point, double cost)
  {
    const double awayHere = away(point);
    for (Index h = 3 * face; h < 3 * face + 3; ++h)
    {
      if (mesh_.isBoundary(h) || (over != kInvalidIndex && h == mesh_.twin[over]))
      {
        continue;
      }
      ReachedHalfEdges::Reached& reached = reached_.at(h);
      if (reached.isDone)
      {
        continue;
      }
      const Vector3 next = crossing(h);
      const double awayThere = away(next);
      const double there =
        cost + (next - point).norm() * (1 + 0.5 * scale_ * (awayHere + awayThere));
      if (there < reached.cost)
      {
        reached.cost = there;
        reached.before = over;
        const double rest = (next - to_.point).norm();
        front_.push({ there + rest + 0.5 * scale_ * awayThere * awayThere, h });
      }
    }
  }

  std::vector<Index> backFrom(Index h)
  {
    std::vector<Index> strip;
    for (; h != kInvalidIndex; h = reached_.at(h).before)
    {
      strip.push_back(h);
    }
    std::reverse(strip.begin(), strip.end());
    return strip;
  }

  const Mesh& mesh_;
  const MeshPlace& from_;
  const MeshPlace& to_;
  double scale_;
  ReachedHalfEdges reached_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front_;
};

double crossOf(const Vector2& a, const Vector2& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

/// An edge between two faces that are laid out side by side, seen by who passes it.
struct Portal
{
  Vector2 right = Vector2::Zero(); ///< the origin of the half-edge
  Vector2 left = Vector2::Zero();
};

/// A strip of faces in the plane.
struct LaidOutStrip
{
  Vector2 from = Vector2::Zero(), to = Vector2::Zero();
  std::vector<Portal> portals;
};

/// Where p lies in the plane, p being in the plane of a face beside its half-edge h from a to b.
Vector2 laidOut(const Mesh& mesh, Index h, const Vector2& a, const Vector2& b, const Vector3& p)
{
  const Vector3 edge = mesh.edgeVector(h);
  const Vector3 out = p - mesh.position[mesh.origin[h]];
  const double length = std::max(edge.norm(), 1e-300);
  const double along = out.dot(edge) / length;
  const double beside = edge.cross(out).norm() / length;
  const Vector2 x = (b - a) / std::max((b - a).norm(), 1e-300);
  return a + along * x + beside * Vector2(-x.y(), x.x());
}

LaidOutStrip layOut(
  const Mesh& mesh, const std::vector<Index>& strip, const MeshPlace& from, const MeshPlace& to)
{
  LaidOutStrip flat;
  Index h = strip.front();
  Portal portal{ Vector2::Zero(), Vector2(mesh.edgeVector(h).norm(), 0) };
  flat.from = laidOut(mesh, h, portal.right, portal.left, from.point);
  for (std::size_t i = 0;; ++i)
  {
    flat.portals.push_back(portal);
    const Index twin = mesh.twin[h]; // from left to right
    if (i + 1 == strip.size())
    {
      flat.to = laidOut(mesh, twin, portal.left, portal.right, to.point);
      return flat;
    }
    const Vector2 apex = laidOut(
      mesh, twin, portal.left, portal.right, mesh.position[mesh.origin[Mesh::previous(twin)]]);
    h = strip[i + 1];
    portal = h == Mesh::next(twin) ? Portal{ portal.right, apex } : Portal{ apex, portal.left };
  }
}

/// A corner of the shortest path in a strip, and the first portal behind it.
struct PathCorner
{
  Vector2 point = Vector2::Zero();
  std::size_t portal = 0;
};

/// The funnel that opens from one corner of the path to the next.
std::vector<PathCorner> shortestIn(const LaidOutStrip& flat)
{
  std::vector<PathCorner> path{ { flat.from, 0 } };
  const std::size_t count = flat.portals.size();
  const auto portalAt = [&](std::size_t i) {
    return i < count ? flat.portals[i] : Portal{ flat.to, flat.to };
  };
  Vector2 apex = flat.from;
  Portal funnel = portalAt(0);
  std::size_t leftAt = 0, rightAt = 0;
  for (std::size_t i = 1; i <= count; ++i)
  {
    const Portal next = portalAt(i);
    const auto turn = [&](const Vector2& a, const Vector2& b)
    { return crossOf(a - apex, b - apex); };
    const auto restart = [&](const Vector2& corner, std::size_t at)
    {
      path.push_back({ corner, at + 1 });
      apex = corner;
      i = at + 1;
      funnel = portalAt(i);
      leftAt = rightAt = i;
    };
    if (turn(funnel.right, next.right) >= 0) // the funnel gets narrower from the right
    {
      if (apex == funnel.right || turn(funnel.left, next.right) < 0)
      {
        funnel.right = next.right;
        rightAt = i;
      }
      else
      {
        restart(funnel.left, leftAt);
        continue;
      }
    }
    if (turn(funnel.left, next.left) <= 0)
    {
      if (apex == funnel.left || turn(funnel.right, next.left) > 0)
      {
        funnel.left = next.left;
        leftAt = i;
      }
      else
      {
        restart(funnel.right, rightAt);
      }
    }
  }
  if (path.back().portal > count) // the end itself, which both sides have come to
  {
    path.pop_back();
  }
  path.push_back({ flat.to, count });
  return path;
}

double lengthOf(const std::vector<PathCorner>& path)
{
  double length = 0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
  {
    length += (path[i + 1].point - path[i].point).norm();
  }
  return length;
}

/// The end of a half-edge that lies where the corner of a path is.
Index vertexOfCorner(const Mesh& mesh, const LaidOutStrip& flat, const std::vector<Index>& strip,
  const PathCorner& corner)
{
  const std::size_t i = corner.portal - 1;
  const Portal& portal = flat.portals[i];
  const bool isRight =
    (corner.point - portal.right).squaredNorm() <= (corner.point - portal.left).squaredNorm();
  return isRight ? mesh.origin[strip[i]] : mesh.target(strip[i]);
}

bool endsAt(const Mesh& mesh, Index h, Index v)
{
  return mesh.origin[h] == v || mesh.target(h) == v;
}

/// Portals of a strip that end at one vertex.
struct FanOfStrip
{
  std::size_t first = 0, last = 0;
};

/// The way round a vertex on its other side, from the face before the portals that end there to that behind them; none
/// where the boundary is there.
std::optional<std::vector<Index>> otherWayRound(
  const Mesh& mesh, const std::vector<Index>& strip, const FanOfStrip& fan, Index v)
{
  const bool isLeft =
    mesh.target(strip[fan.first]) == v; // the strip runs counterclockwise round it
  const Index end = Mesh::face(mesh.twin[strip[fan.last]]);
  Index corner = isLeft ? Mesh::next(strip[fan.first]) : strip[fan.first]; // leaves v
  std::vector<Index> way;
  for (Index f = Mesh::face(corner); f != end; f = Mesh::face(corner))
  {
    const Index over = isLeft ? corner : Mesh::previous(corner);
    if (mesh.isBoundary(over) || way.size() > mesh.halfEdgeCount())
    {
      return std::nullopt;
    }
    way.push_back(over);
    corner = isLeft ? Mesh::next(mesh.twin[over]) : mesh.twin[over];
  }
  return way;
}

/// A strip, and the shortest path in it.
struct StripPath
{
  std::vector<Index> strip;
  LaidOutStrip flat;
  std::vector<PathCorner> corners;

  StripPath(const Mesh& mesh, std::vector<Index> faces, const MeshPlace& from, const MeshPlace& to)
    : strip(std::move(faces))
  {
    if (strip.empty())
    {
      corners = { { Vector2::Zero(), 0 }, { Vector2((to.point - from.point).norm(), 0), 0 } };
      return;
    }
    flat = layOut(mesh, strip, from, to);
    corners = shortestIn(flat);
  }
};

/// A part of a strip, from portal `first` on, and what it becomes.
struct ChangedPart
{
  std::size_t first = 0, end = 0;
  std::vector<Index> strip;
};

/// The place of a corner of the path, in the face behind it.
MeshPlace placeOfCorner(const Mesh& mesh, const StripPath& path, std::size_t k,
  const MeshPlace& from, const MeshPlace& to)
{
  if (k == 0 || k + 1 == path.corners.size())
  {
    return k == 0 ? from : to;
  }
  return { from.face, mesh.position[vertexOfCorner(mesh, path.flat, path.strip, path.corners[k])] };
}

/// Where the path has a corner and the other way round the vertex there is shorter: the strip from a corner before to
/// one behind, led that way.
std::optional<ChangedPart> ledRound(const Mesh& mesh, std::size_t k, const MeshPlace& from,
  const MeshPlace& to, const StripPath& path)
{
  const std::vector<PathCorner>& corners = path.corners;
  const std::vector<Index>& strip = path.strip;
  const Index v = vertexOfCorner(mesh, path.flat, strip, corners[k]);
  FanOfStrip fan{ corners[k].portal - 1, corners[k].portal - 1 };
  while (fan.first > 0 && endsAt(mesh, strip[fan.first - 1], v))
  {
    --fan.first;
  }
  while (fan.last + 1 < strip.size() && endsAt(mesh, strip[fan.last + 1], v))
  {
    ++fan.last;
  }
  const auto way = otherWayRound(mesh, strip, fan, v);
  if (!way)
  {
    return std::nullopt;
  }
  // A corner lies in the face before the last portal that ends there, and in the one behind.
  const auto endAt = [&](std::size_t i)
  { return i + 1 == corners.size() ? strip.size() : corners[i].portal - 1; };
  std::size_t low = k - 1, high = k + 1;
  while (corners[low].portal > fan.first)
  {
    --low;
  }
  while (endAt(high) <= fan.last)
  {
    ++high;
  }
  double before = 0;
  for (std::size_t i = low; i < high; ++i)
  {
    before += (corners[i + 1].point - corners[i].point).norm();
  }
  ChangedPart part{ corners[low].portal, endAt(high), {} };
  const auto at = [&](std::size_t i) { return strip.begin() + static_cast<std::ptrdiff_t>(i); };
  part.strip.assign(at(part.first), at(fan.first));
  part.strip.insert(part.strip.end(), way->begin(), way->end());
  part.strip.insert(part.strip.end(), at(fan.last + 1), at(part.end));
  const StripPath other(mesh, part.strip, placeOfCorner(mesh, path, low, from, to),
    placeOfCorner(mesh, path, high, from, to));
  return lengthOf(other.corners) < (1 - kLastDigits) * before
    ? std::optional<ChangedPart>(std::move(part))
    : std::nullopt;
}

/// Changes parts of the strip, ascending and apart, if that makes the path shorter as a whole: between needles parts
/// may be that are not, up to rounding, once they are joined.
bool changeStrip(const Mesh& mesh, const MeshPlace& from, const MeshPlace& to,
  const std::vector<const ChangedPart*>& parts, StripPath& path)
{
  std::vector<Index> strip;
  std::size_t taken = 0;
  const auto take = [&](std::size_t end)
  {
    strip.insert(strip.end(), path.strip.begin() + static_cast<std::ptrdiff_t>(taken),
      path.strip.begin() + static_cast<std::ptrdiff_t>(end));
    taken = end;
  };
  for (const ChangedPart* part : parts)
  {
    take(part->first);
    strip.insert(strip.end(), part->strip.begin(), part->strip.end());
    taken = part->end;
  }
  take(path.strip.size());
  StripPath other(mesh, std::move(strip), from, to);
  if (!(lengthOf(other.corners) < (1 - kLastDigits) * lengthOf(path.corners)))
  {
    return false;
  }
  path = std::move(other);
  return true;
}

/// The strip led round all corners where that makes the path shorter, but for those whose parts overlap; where these
/// undo each other, as those that meet at a vertex do, round one of them. Whether it has become shorter.
bool leadRound(const Mesh& mesh, const MeshPlace& from, const MeshPlace& to, StripPath& path)
{
  std::vector<ChangedPart> parts;
  for (std::size_t k = 1; k + 1 < path.corners.size(); ++k)
  {
    pollNowAndThen(k);
    if (auto part = ledRound(mesh, k, from, to, path))
    {
      parts.push_back(std::move(*part));
    }
  }
  std::vector<const ChangedPart*> apart;
  for (const ChangedPart& part : parts)
  {
    if (apart.empty() || part.first >= apart.back()->end)
    {
      apart.push_back(&part);
    }
  }
  return !parts.empty() &&
    (changeStrip(mesh, from, to, apart, path) ||
      std::any_of(parts.begin(), parts.end(),
        [&](const ChangedPart& part) { return changeStrip(mesh, from, to, { &part }, path); }));
}

bool liesOn(const Mesh& mesh, Index h, const Vector3& p)
{
  return distanceToSegment(p, mesh.position[mesh.origin[h]], mesh.position[mesh.target(h)]) <=
    kLastDigits * mesh.edgeVector(h).norm();
}

/// Without the faces that the path only touches, where it begins or ends on their edges. face: the first one of the
/// strip, before and afterwards.
std::vector<Index> trimmed(const Mesh& mesh, const std::vector<Index>& strip, const MeshPlace& from,
  const MeshPlace& to, Index& face)
{
  auto first = strip.begin(), last = strip.end();
  for (; first != last && liesOn(mesh, *first, from.point); ++first)
  {
    face = Mesh::face(mesh.twin[*first]);
  }
  while (first != last && liesOn(mesh, *(last - 1), to.point))
  {
    --last;
  }
  return { first, last };
}

/// A shortest path as near to the strip as can be [Mancinelli et al. 2022, after Xin, Wang 2007]: one that no way round
/// the other side of a vertex makes shorter.
StripPath straightPath(
  const Mesh& mesh, std::vector<Index> strip, const MeshPlace& from, const MeshPlace& to)
{
  StripPath path(mesh, std::move(strip), from, to);
  while (leadRound(mesh, from, to, path))
  {
  }
  return path;
}

double shareOfCrossing(const Portal& portal, const Vector2& p, const Vector2& q)
{
  const Vector2 edge = portal.left - portal.right;
  const Vector2 way = q - p;
  const double across = crossOf(edge, way);
  const double length = edge.norm();
  if (std::abs(across) > 1e-12 * length * way.norm())
  {
    return std::clamp(crossOf(p - portal.right, way) / across, 0.0, 1.0);
  }
  // Along the edge: where the way ends.
  return length > 0 ? std::clamp((q - portal.right).dot(edge) / (length * length), 0.0, 1.0) : 0;
}

} // namespace

std::optional<MeshPath> pathOnMesh(const Mesh& mesh, const MeshPlace& from, const MeshPlace& to)
{
  const std::optional<std::vector<Index>> strip = FaceStripSearch(mesh, from, to).run();
  if (!strip)
  {
    return std::nullopt;
  }
  MeshPath result{ from.face, {} };
  const StripPath path = straightPath(mesh, trimmed(mesh, *strip, from, to, result.face), from, to);
  std::size_t next = 1;
  for (std::size_t i = 0; i < path.strip.size(); ++i)
  {
    while (path.corners[next].portal <= i && next + 1 < path.corners.size())
    {
      ++next;
    }
    result.crossings.push_back({ path.strip[i],
      shareOfCrossing(
        path.flat.portals[i], path.corners[next - 1].point, path.corners[next].point) });
  }
  return result;
}

std::vector<std::vector<Vector3>> MeshCourse::parts() const
{
  std::vector<std::vector<Vector3>> parts;
  auto begin = points.begin();
  const auto takeUntil = [&](std::vector<Vector3>::const_iterator end)
  {
    if (end - begin > 1)
    {
      parts.emplace_back(begin, end);
    }
    begin = end;
  };
  for (const std::size_t last : tornBehind)
  {
    takeUntil(points.begin() + static_cast<std::ptrdiff_t>(own[last]) + 1);
  }
  takeUntil(points.end());
  return parts;
}

MeshCourse courseOnMesh(const Mesh& mesh, const std::vector<Vector3>& points, int threads)
{
  const std::vector<MeshPlace> places = placesOnMesh(mesh, points, threads);
  MeshCourse course;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (i > 0 && points[i - 1] != points[i])
    {
      const std::optional<MeshPath> way = pathOnMesh(mesh, places[i - 1], places[i]);
      if (way)
      {
        for (const EdgeCrossing& crossing : way->crossings)
        {
          course.points.push_back(crossing.point(mesh));
        }
      }
      else
      {
        course.tornBehind.push_back(i - 1);
      }
    }
    if (course.points.empty() || course.points.back() != points[i])
    {
      course.points.push_back(points[i]);
    }
    course.own.push_back(course.points.size() - 1);
  }
  return course;
}

} // namespace quadrille

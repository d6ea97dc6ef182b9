// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/FaceTrace.h"

#include "Extraction/GridTracing.h"

namespace quadrille
{
namespace
{

/// p with another coordinate along an axis.
FixedVec2 withAlong(FixedVec2 p, int direction, std::int64_t value)
{
  const std::int64_t signedValue = (direction & 3) >= 2 ? -value : value;
  return (direction & 1) == 0 ? FixedVec2{ signedValue, p.v } : FixedVec2{ p.u, signedValue };
}

/// As GridTracing.h walks along it; all triangles are positive.
Walk walkOf(const Side& side)
{
  return { side.place.face, {}, side.target, side.direction, 1 };
}

/// The constrained half-edge of the face that holds the point and runs along the direction.
Index constrainedAlong(const ExactMap& map, Index face, FixedVec2 point, int direction)
{
  for (Index h = 3 * face; h < 3 * face + 3; ++h)
  {
    const FixedVec2 e = map.edge(h);
    const std::int64_t reached = along(point - map.at(h), direction);
    if (map.mesh.isConstrained(h) && along(e, direction + 1) == 0 && along(e, direction) > 0 &&
      along(point - map.at(h), direction + 1) == 0 && reached >= 0 && reached < along(e, direction))
    {
      return h;
    }
  }
  return kInvalidIndex;
}

/// The constrained half-edge that leaves the vertex of a corner along a direction at or clockwise of the corner.
Index constrainedFrom(const ExactMap& map, Index corner, int direction)
{
  for (;;)
  {
    const FixedVec2 e = map.edge(corner);
    if (along(e, direction + 1) == 0 && along(e, direction) > 0)
    {
      return map.mesh.isConstrained(corner) ? corner : kInvalidIndex;
    }
    Transition t;
    if (map.mesh.isBoundary(corner) || !map.transition(corner, t))
    {
      return kInvalidIndex;
    }
    direction += t.rotation;
    corner = map.mesh.rotateClockwise(corner);
  }
}

} // namespace

FaceTrace::FaceTrace(const ExactMap& map, const GridVertices& grid, const Boundary& boundary)
  : map_(map), grid_(grid), boundary_(boundary),
    stepLimit_(3 * std::size_t{ map.mesh.faceCount() } + 16)
{
}

bool FaceTrace::fromNode(Index first)
{
  Place place{ Mesh::face(boundary_.nodes()[first].h), {} };
  Index node = first;
  do
  {
    Side side;
    if (!followBoundary(place, node, side) || !followSidesToBoundary(side))
    {
      return false;
    }
    const std::optional<Index> next = nodeHit(side);
    if (!next)
    {
      return false;
    }
    place = side.place;
    node = *next;
  } while (node != first);
  closeUp();
  return true;
}

bool FaceTrace::fromPort(const Sector& sector, int direction)
{
  const Side first = sideFrom({ sector.face, {} }, sector.point, direction);
  Side side = first;
  for (int i = 0; i < 4; ++i)
  {
    if (!followSide(side) || !side.arrived || !turnLeft(side))
    {
      return false;
    }
  }
  closeUp();
  return side.place.face == first.place.face && side.target == first.target;
}

Side FaceTrace::sideFrom(const Place& place, FixedVec2 from, int direction) const
{
  Side side;
  side.place = place;
  side.direction = direction & 3;
  side.target = withAlong(from, direction, unitAbove(along(from, direction)));
  side.length = along(side.target - from, direction);
  side.noted = side.length;
  return side;
}

bool FaceTrace::followSide(Side& side, bool noteVertices)
{
  side.arrived = false;
  side.hit = kInvalidIndex;
  for (std::size_t i = 0; i < stepLimit_; ++i)
  {
    if (map_.orientationOf(side.place.face) <= 0)
    {
      return false;
    }
    if (noteVertices)
    {
      noteVerticesOn(side);
    }
    const Index exit = exitEdge(map_, walkOf(side));
    if (exit == kInvalidIndex)
    {
      return false;
    }
    if (isBefore(map_, walkOf(side), exit))
    {
      side.arrived = true;
      return true;
    }
    if (map_.mesh.isBoundary(exit))
    {
      side.hit = exit;
      return true;
    }
    Transition t;
    if (!map_.transition(exit, t))
    {
      return false;
    }
    cross(side.place, exit, t);
    side.target = t.apply(side.target);
    side.direction = (side.direction + t.rotation) & 3;
  }
  return false;
}

void FaceTrace::cross(Place& place, Index h, const Transition& t) const
{
  place.face = Mesh::face(map_.mesh.twin[h]);
  place.toStart = place.toStart.after(t.inverse());
}

void FaceTrace::addStop(const Stop& stop)
{
  if (!stops.empty() && stops.back().isSame(stop))
  {
    stops.back().via = stop.via;
  }
  else
  {
    stops.push_back(stop);
  }
}

void FaceTrace::closeUp()
{
  if (stops.size() > 1 && stops.back().isSame(stops.front()))
  {
    stops.pop_back();
  }
}

Stop FaceTrace::stopAt(Index node, const Place& place, Index via) const
{
  const BoundaryNode& n = boundary_.nodes()[node];
  const bool whole = n.gridVertex != kInvalidIndex;
  return { whole ? StopKind::Grid : StopKind::Node, whole ? n.gridVertex : node,
    place.toStart.apply(n.uv), via, rotate(n.fine, place.toStart.rotation) };
}

bool FaceTrace::turnLeft(Side& side)
{
  const std::optional<Index> q = grid_.find(side.place.face, side.target);
  if (!q)
  {
    return false;
  }
  const FixedVec2 from = side.target;
  const Index via = constrainedAlong(map_, side.place.face, from, side.direction + 1);
  addStop({ StopKind::Grid, *q, side.place.toStart.apply(from), via });
  side = sideFrom(side.place, from, side.direction + 1);
  return true;
}

bool FaceTrace::followSidesToBoundary(Side& side)
{
  constexpr int kMaximumSides = 64; // a face of a grid has four corners
  for (int i = 0; i < kMaximumSides; ++i)
  {
    if (!followSide(side))
    {
      return false;
    }
    if (!side.arrived)
    {
      return true;
    }
    if (!turnLeft(side))
    {
      return false;
    }
  }
  return false;
}

std::optional<Index> FaceTrace::nodeHit(const Side& side) const
{
  const bool atOrigin = along(map_.at(side.hit) - side.target, side.direction + 1) == 0;
  return atOrigin ? boundary_.nodeAtOrigin(side.hit)
                  : boundary_.nodeOnLine(side.hit, side.target, side.direction);
}

void FaceTrace::noteVerticesOn(Side& side)
{
  for (int i = 0; i < 2; ++i) // a face has at most two on a line
  {
    Index farthest = kInvalidIndex;
    std::int64_t distance = 0;
    for (Index h = 3 * side.place.face; h < 3 * side.place.face + 3; ++h)
    {
      const std::int64_t ahead = along(side.target - map_.at(h), side.direction);
      if (boundary_.leaving(map_.mesh.origin[h]) != kInvalidIndex &&
        along(map_.at(h) - side.target, side.direction + 1) == 0 && ahead > distance &&
        ahead < side.noted)
      {
        farthest = h;
        distance = ahead;
      }
    }
    if (farthest == kInvalidIndex)
    {
      return;
    }
    side.noted = distance;
    noteVertex(side, farthest);
  }
}

void FaceTrace::noteVertex(const Side& side, Index corner)
{
  const Index out = boundary_.leaving(map_.mesh.origin[corner]);
  const std::optional<Index> node = boundary_.nodeAtOrigin(out);
  if (!node || isStraight(out))
  {
    return;
  }
  addStop({ StopKind::Node, *node, side.place.toStart.apply(map_.at(corner)),
    constrainedFrom(map_, corner, side.direction) });
}

bool FaceTrace::isStraight(Index out) const
{
  int axes = 0;
  forEachFrom(map_.mesh, out, [&](Index g) { axes += axesInCorner(map_, g); });
  return axes == 2 && map_.isOnIsoline(out) && map_.isOnIsoline(boundary_.before(out));
}

bool FaceTrace::followBoundary(Place& place, Index node, Side& side)
{
  startedAt.push_back(node);
  Index h = boundary_.nodes()[node].h;
  addStop(stopAt(node, place, h));
  for (Index next = node + 1;; next = boundary_.firstNode(h))
  {
    if (next < boundary_.lastNode(h))
    {
      startInside(place, next, side);
      return true;
    }
    Index corner = Mesh::next(h);
    const Index out = boundary_.leaving(map_.mesh.origin[corner]);
    if (boundary_.nodeAtOrigin(out))
    {
      return startAtVertex(place, corner, out, side);
    }
    while (corner != out)
    {
      if (!turnClockwise(place, corner))
      {
        return false;
      }
    }
    addStop({ StopKind::Vertex, out, place.toStart.apply(map_.at(out)), out });
    h = out;
  }
}

bool FaceTrace::turnClockwise(Place& place, Index& corner) const
{
  Transition t;
  if (!map_.transition(corner, t))
  {
    return false;
  }
  cross(place, corner, t);
  corner = map_.mesh.rotateClockwise(corner);
  return true;
}

void FaceTrace::startInside(const Place& place, Index node, Side& side)
{
  const BoundaryNode& n = boundary_.nodes()[node];
  const FixedVec2 e = map_.edge(n.h);
  if (n.gridVertex != kInvalidIndex)
  {
    const int direction = (firstAxis(e) + 1) & 3;
    addStop(stopAt(node, place, constrainedAlong(map_, place.face, n.uv, direction)));
    side = sideFrom(place, n.uv, direction);
    return;
  }
  addStop(stopAt(node, place, kInvalidIndex));
  int direction = n.onV ? 0 : 1;
  direction += orientation(e, axisVector(direction)) > 0 ? 0 : 2;
  // The exact place lies between this value and the next one, and on no integer.
  const std::int64_t below = n.onV ? n.uv.u : n.uv.v;
  const std::int64_t from = direction < 2 ? below : -below - 1;
  side = sideFrom(place, n.uv, direction);
  side.target = withAlong(n.uv, direction, unitAbove(from));
  side.length = side.noted = kOne;
}

bool FaceTrace::startAtVertex(Place& place, Index corner, Index out, Side& side)
{
  const Index node = *boundary_.nodeAtOrigin(out);
  for (;;)
  {
    if (const std::optional<int> direction = lastIsoline(map_, corner))
    {
      Stop stop =
        stopAt(node, place, constrainedAlong(map_, place.face, map_.at(corner), *direction));
      stop.uv = place.toStart.apply(map_.at(corner)); // of this corner's chart
      addStop(stop);
      side = sideFrom(place, map_.at(corner), *direction);
      return true;
    }
    if (corner == out || !turnClockwise(place, corner))
    {
      return false;
    }
  }
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/GridVertices.h"

#include "Base/Parallel.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>

namespace quadrille
{
namespace
{

SurfacePoint placeOnEdge(const ExactMap& map, const GridVertex& vertex)
{
  const FixedVec2 e = map.edge(vertex.site);
  const FixedVec2 d = vertex.uv - map.at(vertex.site);
  const bool byU = std::abs(e.u) >= std::abs(e.v);
  const double t = byU ? static_cast<double>(d.u) / static_cast<double>(e.u)
                       : static_cast<double>(d.v) / static_cast<double>(e.v);
  return CurvePoint{ vertex.site, t }.onSurface();
}

std::int64_t ceilUnit(std::int64_t x)
{
  return (x + kOne - 1) & ~(kOne - 1);
}

/// Corner whose fan walk lists all corners of the vertex: the boundary half-edge, else the lowest
/// id.
Index canonicalCorner(const Mesh& mesh, Index h)
{
  Index lowest = h;
  for (Index g = h; !mesh.isBoundary(g);)
  {
    g = mesh.rotateClockwise(g);
    if (g == h)
    {
      return lowest;
    }
    lowest = mesh.isBoundary(g) ? g : std::min(lowest, g);
  }
  return mesh.isBoundary(h) ? h : lowest;
}

/// canonicalCorner(mesh, h) == h, looking both ways only until a better corner comes: for all corners of a vertex
/// together that takes n log n steps, whatever the order of their ids.
bool isCanonicalCorner(const Mesh& mesh, Index h)
{
  if (mesh.isBoundary(h))
  {
    return true;
  }
  Index left = h;
  Index right = h;
  do
  {
    left = mesh.rotateCounterclockwise(left);
    right = mesh.rotateClockwise(right);
    if (left == kInvalidIndex || left < h || right < h || mesh.isBoundary(right))
    {
      return false;
    }
  } while (left != h);
  return true;
}

/// Open interval of u in which the row v meets the inside of triangle f, as the integers of fixed
/// point it holds: [low, high].
struct RowSpan
{
  Int128 low;
  Int128 high;
};

/// Left of edge a -> b means (b.u - a.u) (v - a.v) > (b.v - a.v) (u - a.u): one bound on u per
/// edge.
RowSpan rowSpan(const std::array<FixedVec2, 3>& p, std::int64_t v, Int128 low, Int128 high)
{
  for (int i = 0; i < 3; ++i)
  {
    const FixedVec2 a = p[i];
    const FixedVec2 e = p[(i + 1) % 3] - a;
    const Int128 c = Int128{ e.u } * (v - a.v) + Int128{ e.v } * a.u;
    if (e.v > 0)
    {
      high = std::min(high, floorDivide(c - 1, e.v)); // u < c / e.v
    }
    else if (e.v < 0)
    {
      low = std::max(low, floorDivide(c, e.v) + 1); // u > c / e.v
    }
    else if (c <= 0)
    {
      return { 1, 0 };
    }
  }
  return { low, high };
}

struct Box
{
  std::int64_t lowU, highU, lowV, highV;

  explicit Box(const std::array<FixedVec2, 3>& p)
    : lowU(std::min({ p[0].u, p[1].u, p[2].u })), highU(std::max({ p[0].u, p[1].u, p[2].u })),
      lowV(std::min({ p[0].v, p[1].v, p[2].v })), highV(std::max({ p[0].v, p[1].v, p[2].v }))
  {
  }
  bool hasInteger() const { return ceilUnit(lowU) <= highU && ceilUnit(lowV) <= highV; }
};

void addVertex(std::vector<GridVertex>& list, Site kind, Index site, FixedVec2 uv)
{
  GridVertex vertex;
  vertex.uv = uv;
  vertex.site = site;
  vertex.kind = kind;
  list.push_back(vertex);
}

/// Rotation of the frame that orders what lies in face f: its first edge with an image points along +u there, or up to
/// a quarter to the right of it. Numbers that follow this frame do not depend on the chart that the map has there.
int frameOf(const ExactMap& map, Index f)
{
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    if (map.edge(h) != FixedVec2{})
    {
      return firstAxis(map.edge(h));
    }
  }
  return 0;
}

/// From the chart into the frame; rotate(p, frame) is the way back.
FixedVec2 toFrame(FixedVec2 p, int frame)
{
  return rotate(p, (4 - frame) & 3);
}

/// Integer points strictly inside, row by row of the frame.
void scanInside(const ExactMap& map, Index f, int frame, std::vector<GridVertex>& list)
{
  std::array<FixedVec2, 3> p{ toFrame(map.at(3 * f), frame), toFrame(map.at(3 * f + 1), frame),
    toFrame(map.at(3 * f + 2), frame) };
  const Box box(p);
  const int sign = orientation(p[0], p[1], p[2]);
  if (sign == 0)
  {
    return;
  }
  if (sign < 0)
  {
    std::swap(p[1], p[2]);
  }
  for (std::int64_t v = ceilUnit(box.lowV); v <= box.highV; v += kOne)
  {
    const RowSpan span = rowSpan(p, v, box.lowU, box.highU);
    if (span.low > span.high)
    {
      continue;
    }
    const std::int64_t high = static_cast<std::int64_t>(span.high);
    for (std::int64_t u = ceilUnit(static_cast<std::int64_t>(span.low)); u <= high; u += kOne)
    {
      addVertex(list, Site::Face, f, rotate({ u, v }, frame));
    }
  }
}

/// Integer points strictly inside edge h, in ascending (v, u) of the frame.
void scanEdge(const ExactMap& map, Index h, int frame, std::vector<GridVertex>& list)
{
  const FixedVec2 a = toFrame(map.at(h), frame);
  const FixedVec2 e = toFrame(map.edge(h), frame);
  const bool byU = std::abs(e.u) >= std::abs(e.v);
  const std::int64_t length = byU ? e.u : e.v;
  const std::int64_t from = byU ? a.u : a.v;
  const std::int64_t low = std::min(from, from + length);
  const std::int64_t high = std::max(from, from + length);
  const std::int64_t cross = byU ? e.v : e.u;
  const std::size_t before = list.size();
  for (std::int64_t x = ceilUnit(low); x <= high; x += kOne)
  {
    if (x == low || x == high)
    {
      continue;
    }
    const Int128 product = Int128{ x - from } * cross;
    const std::int64_t y = (byU ? a.v : a.u) + static_cast<std::int64_t>(product / length);
    if (product % length == 0 && isInteger(y))
    {
      addVertex(list, Site::Edge, h, rotate(byU ? FixedVec2{ x, y } : FixedVec2{ y, x }, frame));
    }
  }
  if (byU && e.v != 0 && (e.u > 0) != (e.v > 0))
  {
    std::reverse(list.begin() + static_cast<std::ptrdiff_t>(before), list.end());
  }
}

/// Appends the integer points that face f owns, in the order of GridVertex::slot().
void scanFace(const ExactMap& map, Index f, std::vector<GridVertex>& list)
{
  const std::array<FixedVec2, 3> p{ map.at(3 * f), map.at(3 * f + 1), map.at(3 * f + 2) };
  const Box box(p);
  if (!box.hasInteger())
  {
    return; // the lot of nearly all triangles of a fine mesh
  }
  const int frame = frameOf(map, f);
  scanInside(map, f, frame, list);
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    if (h < map.mesh.twin[h]) // holds on the boundary, too
    {
      scanEdge(map, h, frame, list);
    }
  }
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    if (isInteger(map.at(h)) && isCanonicalCorner(map.mesh, h))
    {
      addVertex(list, Site::Vertex, h, map.at(h));
    }
  }
}

/// The order of grid vertices in a face with this frame.
bool before(const GridVertex& a, const GridVertex& b, int frame)
{
  const FixedVec2 p = toFrame(a.uv, frame);
  const FixedVec2 q = toFrame(b.uv, frame);
  return std::make_tuple(a.slot(), p.v, p.u) < std::make_tuple(b.slot(), q.v, q.u);
}

} // namespace

GridVertices::GridVertices(const ExactMap& map, int threads)
  : map_(map), faceFirst_(std::size_t{ map.mesh.faceCount() } + 1, 0)
{
  const std::size_t faces = map.mesh.faceCount();
  std::vector<Part> parts = parallelParts<Part>(faces, kMediumChunk, threads,
    [&](std::size_t begin, std::size_t end, Part& part)
    {
      for (std::size_t f = begin; f < end; ++f)
      {
        const std::size_t first = part.vertices.size();
        scanFace(map, static_cast<Index>(f), part.vertices);
        faceFirst_[f + 1] = static_cast<Index>(part.vertices.size());
        for (std::size_t q = first; q < part.vertices.size(); ++q)
        {
          numberPorts(part, static_cast<Index>(q));
        }
      }
    });

  std::vector<Index> firstVertex;
  std::vector<Index> firstPort;
  std::size_t total = 0;
  for (const Part& part : parts)
  {
    firstVertex.push_back(static_cast<Index>(total));
    firstPort.push_back(portCount_);
    total += part.vertices.size();
    portCount_ += part.ports;
  }
  vertices_.resize(total);
  parallelFor(faces, kMediumChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      const std::size_t chunk = begin / kMediumChunk;
      for (std::size_t q = 0; q < parts[chunk].vertices.size(); ++q)
      {
        vertices_[firstVertex[chunk] + q] = parts[chunk].vertices[q];
        vertices_[firstVertex[chunk] + q].firstPort += firstPort[chunk];
      }
      for (std::size_t f = begin; f < end; ++f)
      {
        faceFirst_[f + 1] += firstVertex[chunk];
      }
    });
}

void GridVertices::numberPorts(Part& part, Index q) const
{
  GridVertex& vertex = part.vertices[q];
  vertex.firstPort = part.ports;
  visitSectors(
    vertex, [&](const Sector& sector) { part.ports += static_cast<Index>(sector.count); });
}

Sector GridVertices::faceSector(const GridVertex& vertex) const
{
  const int sign = map_.orientationOf(vertex.site);
  return { vertex.site, kInvalidIndex, vertex.uv, frameOf(map_, vertex.site), sign != 0 ? 4 : 0,
    sign };
}

Sector GridVertices::edgeSector(Index h, FixedVec2 point) const
{
  const int sign = map_.orientationOf(Mesh::face(h));
  // A half plane that holds its right border and not its left one has two of the four directions.
  const FixedVec2 right = sign < 0 ? -map_.edge(h) : map_.edge(h);
  return { Mesh::face(h), h, point, firstAxis(right), sign != 0 ? 2 : 0, sign };
}

Sector GridVertices::cornerSector(Index h) const
{
  const int sign = map_.orientationOf(Mesh::face(h));
  Sector sector{ Mesh::face(h), h, map_.at(h), 0, 0, sign };
  if (sign == 0)
  {
    return sector;
  }
  FixedVec2 right = map_.edge(h);
  FixedVec2 left = map_.at(Mesh::previous(h)) - map_.at(h);
  if (sign < 0)
  {
    std::swap(left, right);
  }
  sector.firstDirection = firstAxis(right);
  // The angle is below 180 degrees: at most two directions, each tested against the left side.
  while (
    sector.count < 2 && orientation(axisVector(sector.firstDirection + sector.count), left) > 0)
  {
    ++sector.count;
  }
  return sector;
}

std::optional<Index> GridVertices::findRecord(Site kind, Index site, FixedVec2 uv) const
{
  GridVertex key;
  key.uv = uv;
  key.site = site;
  key.kind = kind;
  const auto first = vertices_.begin() + faceFirst_[key.face()];
  const auto last = vertices_.begin() + faceFirst_[key.face() + 1];
  const int frame = frameOf(map_, key.face());
  const auto found = std::lower_bound(first, last, key,
    [frame](const GridVertex& a, const GridVertex& b) { return before(a, b, frame); });
  if (found == last || before(key, *found, frame))
  {
    return std::nullopt;
  }
  return static_cast<Index>(found - vertices_.begin());
}

std::optional<Index> GridVertices::findOnEdge(Index h, FixedVec2 point) const
{
  const Index g = map_.mesh.twin[h];
  if (h < g)
  {
    return findRecord(Site::Edge, h, point);
  }
  Transition t;
  return map_.transition(h, t) ? findRecord(Site::Edge, g, t.apply(point)) : std::nullopt;
}

std::optional<Index> GridVertices::findCorner(Index h) const
{
  if (!isInteger(map_.at(h)))
  {
    return std::nullopt;
  }
  const Index corner = canonicalCorner(map_.mesh, h);
  return findRecord(Site::Vertex, corner, map_.at(corner));
}

std::optional<Index> GridVertices::find(Index f, FixedVec2 point) const
{
  if (!isInteger(point))
  {
    return std::nullopt;
  }
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    if (map_.at(h) == point)
    {
      return findCorner(h);
    }
  }
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    if (orientation(map_.at(h), map_.at(Mesh::next(h)), point) == 0)
    {
      if (const std::optional<Index> found = findOnEdge(h, point))
      {
        return found;
      }
    }
  }
  return findRecord(Site::Face, f, point);
}

Index GridVertices::rankOfSector(Index q, Index halfEdge) const
{
  Index rank = 0;
  bool found = false;
  visitSectors(vertices_[q],
    [&](const Sector& sector)
    {
      found = found || sector.halfEdge == halfEdge;
      rank += found ? 0 : static_cast<Index>(sector.count);
    });
  return rank;
}

std::optional<Index> GridVertices::findPort(Index q, Index f, FixedVec2 point, int direction) const
{
  const GridVertex& vertex = vertices_[q];
  Sector sector;
  if (vertex.kind == Site::Face)
  {
    sector = faceSector(vertex);
  }
  for (Index h = 3 * f; h < 3 * f + 3 && vertex.kind != Site::Face; ++h)
  {
    if (map_.at(h) == point)
    {
      sector = cornerSector(h);
      break;
    }
    if (vertex.kind == Site::Edge && orientation(map_.at(h), map_.at(Mesh::next(h)), point) == 0)
    {
      sector = edgeSector(h, point);
    }
  }
  const int axis = (direction - sector.firstDirection) & 3;
  if (axis >= sector.count)
  {
    return std::nullopt;
  }
  return vertex.firstPort + rankOfSector(q, sector.halfEdge) + static_cast<Index>(axis);
}

std::optional<Index> GridVertices::portAfter(Index q, Index port) const
{
  if (port + 1 < endOfPorts(q))
  {
    return port + 1;
  }
  return isOnBoundary(q) ? std::nullopt : std::optional<Index>(vertices_[q].firstPort);
}

std::optional<Index> GridVertices::portBefore(Index q, Index port) const
{
  if (port > vertices_[q].firstPort)
  {
    return port - 1;
  }
  return isOnBoundary(q) ? std::nullopt : std::optional<Index>(endOfPorts(q) - 1);
}

std::array<double, 3> weightsInFace(const ExactMap& map, Index face, FixedVec2 uv)
{
  const Index h = 3 * face;
  const FixedVec2 a = map.at(h);
  const FixedVec2 b = map.at(h + 1);
  const FixedVec2 c = map.at(h + 2);
  const double whole = static_cast<double>(determinant(a, b, c));
  const double wa = static_cast<double>(determinant(uv, b, c)) / whole;
  const double wb = static_cast<double>(determinant(a, uv, c)) / whole;
  const double wc = static_cast<double>(determinant(a, b, uv)) / whole;
  return { wa, wb, wc };
}

SurfacePoint placeOf(const ExactMap& map, const GridVertex& vertex)
{
  SurfacePoint place{ vertex.face(), {} };
  switch (vertex.kind)
  {
    case Site::Face:
      place.weights = weightsInFace(map, vertex.site, vertex.uv);
      break;
    case Site::Edge:
      return placeOnEdge(map, vertex);
    default:
      place.weights[vertex.site % 3] = 1;
  }
  return place;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/QuadMoves.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

PointLists endsOfLines(const QuadMesh& quads)
{
  return { quads.points.size(),
    [&](const auto& visit)
    {
      for (const QuadLine& line : quads.lines)
      {
        visit(line.a, line.b);
        visit(line.b, line.a);
      }
    } };
}

/// The corner that a place is, as meshCorner().
std::optional<Index> cornerAt(const SurfacePoint& place)
{
  for (Index i = 0; i < 3; ++i)
  {
    if (place.weights[i] == 1)
    {
      return 3 * place.face + i;
    }
  }
  return std::nullopt;
}

/// The same place by the lower half-edge of its edge.
CurvePoint lowestOf(const Mesh& mesh, const CurvePoint& at)
{
  return mesh.twin[at.h] < at.h ? CurvePoint{ mesh.twin[at.h], 1 - at.t } : at;
}

/// A curve from `start` over `way` to `end`.
QuadMoves::Span spanOf(const Vector3& start, const std::vector<Vector3>& way, const Vector3& end)
{
  QuadMoves::Span span;
  const Vector3 chord = end - start;
  const double squared = std::max(chord.squaredNorm(), std::numeric_limits<double>::min());
  Vector3 last = start;
  for (const Vector3& x : way)
  {
    const double part = std::clamp((x - start).dot(chord) / squared, 0.0, 1.0);
    span.deviation = std::max(span.deviation, (x - start - part * chord).norm());
    span.length += (x - last).norm();
    last = x;
  }
  span.length += (end - last).norm();
  return span;
}

/// Does the constrained curve run nearly straight through the vertex of corner h?
bool isSmoothCurve(const Mesh& mesh, Index h)
{
  const std::vector<Index> edges = constrainedEdgesAt(mesh, h);
  if (edges.size() != 2)
  {
    return false;
  }
  const auto outgoing = [&](Index e) -> Vector3
  { return mesh.origin[e] == mesh.origin[h] ? mesh.edgeVector(e) : -mesh.edgeVector(e); };
  const Vector3 a = outgoing(edges[0]);
  const Vector3 b = -outgoing(edges[1]);
  return a.dot(b) > std::cos(kCurveCorner) * a.norm() * b.norm();
}

} // namespace

QuadMoves::QuadMoves(const Mesh& mesh, QuadMesh& quads, const std::vector<Index>& fixedVertices)
  : mesh_(mesh), quads_(quads), incident_(quadsAtPoints(quads.quads, quads.points.size())),
    lines_(endsOfLines(quads))
{
  freedom_.resize(quads_.points.size());
  for (Index p = 0; p < quads_.points.size(); ++p)
  {
    freedom_[p] = freedomOf(p, fixedVertices);
  }
  for (const Index p : quads_.polygonPoints)
  {
    freedom_[p] = Freedom::Held;
  }
  computeNormals();
}

QuadMoves::Freedom QuadMoves::freedomOf(Index p, const std::vector<Index>& fixedVertices) const
{
  if (!fixedVertices.empty())
  {
    const std::optional<Index> corner = meshCorner(quads_, p);
    if (corner &&
      std::binary_search(fixedVertices.begin(), fixedVertices.end(), mesh_.origin[*corner]))
    {
      return Freedom::Held;
    }
  }
  if (lines_.size(p) != 0)
  {
    return curveFreedom(p);
  }
  return quads_.onBoundary[p] ? Freedom::Held : Freedom::Surface; // where cells were trimmed
}

/// A point slides where one curve goes through it, and straight on where it is a mesh vertex.
QuadMoves::Freedom QuadMoves::curveFreedom(Index p) const
{
  if (lines_.size(p) != 2)
  {
    return Freedom::Fixed;
  }
  const std::optional<Index> corner = meshCorner(quads_, p);
  const bool slides = corner ? isSmoothCurve(mesh_, *corner) : curvePoint(place(p)).has_value();
  return slides ? Freedom::Curve : Freedom::Fixed;
}

bool QuadMoves::isRegularOnCurve(Index p) const
{
  if (quads_.onBoundary[p])
  {
    return incident_.size(p) == 2;
  }
  if (incident_.size(p) != 4)
  {
    return false;
  }
  const Index a = lines_.begin(p)[0];
  const Index b = lines_.begin(p)[1];
  return std::none_of(incident_.begin(p), incident_.end(p),
    [&](Index q)
    {
      const std::array<Index, 4>& corners = quads_.quads[q];
      const bool hasA = std::find(corners.begin(), corners.end(), a) != corners.end();
      const bool hasB = std::find(corners.begin(), corners.end(), b) != corners.end();
      return hasA && hasB; // a quarter turn between them
    });
}

Vector3 QuadMoves::faceNormal(Index f) const
{
  return mesh_.doubleAreaNormal(f).normalized();
}

void QuadMoves::computeNormals()
{
  normal_.resize(quads_.quads.size());
  for (std::size_t q = 0; q < normal_.size(); ++q)
  {
    normal_[q] = faceNormal(quads_.quadSourceFace[q]);
    for (const Index p : quads_.quads[q])
    {
      if (lines_.size(p) == 0) // on a crease the face may be that of the other side
      {
        normal_[q] += faceNormal(quads_.sourceFace[p]);
      }
    }
  }
}

std::optional<CurvePoint> QuadMoves::curvePoint(const SurfacePoint& place) const
{
  if (const std::optional<Index> corner = cornerAt(place))
  {
    const std::vector<Index> edges = constrainedEdgesAt(mesh_, *corner);
    if (edges.empty())
    {
      return std::nullopt;
    }
    const bool starts = mesh_.origin[edges[0]] == mesh_.origin[*corner];
    return CurvePoint{ edges[0], starts ? 0.0 : 1.0 };
  }
  return locateOnCurve(mesh_, place);
}

std::optional<SurfacePoint> QuadMoves::target(Index p, const Vector3& displacement) const
{
  if (freedom_[p] != Freedom::Curve)
  {
    return walkSurface(mesh_, place(p), displacement);
  }
  const std::optional<CurvePoint> from = curvePoint(place(p));
  if (!from)
  {
    return std::nullopt;
  }
  const double length = displacement.dot(mesh_.edgeVector(from->h).normalized());
  const auto ahead = lines_.size(p) == 2 ? spanFrom(p, *from, length > 0) : std::nullopt;
  const bool passes = ahead && std::abs(length) >= ahead->second.length;
  return passes ? std::nullopt : slide(p, length);
}

std::optional<SurfacePoint> QuadMoves::slide(Index p, double length) const
{
  const std::optional<CurvePoint> from = curvePoint(place(p));
  const std::optional<CurvePoint> to = from ? walkCurve(mesh_, *from, length) : std::nullopt;
  return to ? std::optional<SurfacePoint>(to->onSurface()) : std::nullopt;
}

std::optional<QuadMoves::Spans> QuadMoves::spansAt(Index p, const SurfacePoint& place) const
{
  const std::optional<CurvePoint> at = curvePoint(place);
  if (!at || lines_.size(p) != 2)
  {
    return std::nullopt;
  }
  const auto backwards = spanFrom(p, *at, false);
  const auto forwards = spanFrom(p, *at, true);
  if (!backwards || !forwards || backwards->first == forwards->first)
  {
    return std::nullopt;
  }
  return Spans{ backwards->second, forwards->second };
}

/// The neighbour of p that the curve comes to first, and the way to it.
std::optional<std::pair<Index, QuadMoves::Span>> QuadMoves::spanFrom(
  Index p, CurvePoint from, bool forwards) const
{
  const std::array<CurveEnd, 2> ends{ curveEnd(lines_.begin(p)[0]), curveEnd(lines_.begin(p)[1]) };
  const Vector3 start = positionOf(mesh_, from.onSurface());
  std::vector<Vector3> way;
  for (Index i = 0; i < mesh_.faceCount(); ++i)
  {
    const CurvePoint at = lowestOf(mesh_, from);
    const bool rises = (at.h == from.h) == forwards;
    const auto ahead = [&](const CurveEnd& end)
    { return end.edge == at.h ? (rises ? end.t - at.t : at.t - end.t) : -1.0; };
    const CurveEnd& nearer =
      ahead(ends[1]) > 0 && !(ahead(ends[0]) > 0 && ahead(ends[0]) < ahead(ends[1])) ? ends[1]
                                                                                     : ends[0];
    if (ahead(nearer) > 0)
    {
      return std::make_pair(nearer.point, spanOf(start, way, quads_.points[nearer.point]));
    }
    const Index vertex = forwards ? mesh_.target(from.h) : mesh_.origin[from.h];
    for (const CurveEnd& end : ends)
    {
      if (end.vertex == vertex)
      {
        return std::make_pair(end.point, spanOf(start, way, quads_.points[end.point]));
      }
    }
    way.push_back(mesh_.position[vertex]);
    const std::optional<Index> next = continueCurve(mesh_, from.h, forwards);
    if (!next)
    {
      return std::nullopt;
    }
    forwards = mesh_.origin[*next] == vertex;
    from = { *next, forwards ? 0.0 : 1.0 };
  }
  return std::nullopt;
}

QuadMoves::CurveEnd QuadMoves::curveEnd(Index n) const
{
  CurveEnd end;
  end.point = n;
  if (const std::optional<Index> corner = cornerAt(place(n)))
  {
    end.vertex = mesh_.origin[*corner];
  }
  else if (const std::optional<CurvePoint> on = locateOnCurve(mesh_, place(n)))
  {
    const CurvePoint at = lowestOf(mesh_, *on);
    end.edge = at.h;
    end.t = at.t;
  }
  return end;
}

void QuadMoves::move(Index p, const SurfacePoint& place, const Vector3& position)
{
  quads_.points[p] = position;
  quads_.sourceFace[p] = place.face;
  quads_.sourceWeights[p] = place.weights;
}

std::array<Vector3, 4> QuadMoves::cornersWith(Index q, Index p, const Vector3& position) const
{
  std::array<Vector3, 4> corners;
  for (std::size_t i = 0; i < 4; ++i)
  {
    const Index c = quads_.quads[q][i];
    corners[i] = c == p ? position : quads_.points[c];
  }
  return corners;
}

bool QuadMoves::facesOutwards(Index q, const std::array<Vector3, 4>& corners) const
{
  return (corners[2] - corners[0]).cross(corners[3] - corners[1]).dot(normal_[q]) > 0;
}

} // namespace quadrille

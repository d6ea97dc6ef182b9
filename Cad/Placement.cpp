// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/Placement.h"

#include "Base/DisjointSets.h"
#include "Base/Refuse.h"
#include "Cad/Curvatures.h"
#include "Cad/Guarded.h"
#include "Cad/ShapeData.h"
#include "Mesh/NearestTriangle.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace quadrille
{

namespace
{

constexpr int kNewtonSteps = 30;
constexpr int kHalvings = 12;
constexpr double kConverged = 1e-14; // of a step, over the diagonal
constexpr double kFarthestMove = 8;  // over the reach; see PlacementOptions

Vector3 vectorOf(const gp_XYZ& p)
{
  return { p.X(), p.Y(), p.Z() };
}

//------------------------------------------------------------------------------
/// The curve of an edge, with its range.
class ExactCurve
{
public:
  explicit ExactCurve(const TopoDS_Edge& edge) : curve_(edge) {}

  /// The nearest place to p, from a parameter near it.
  Vector3 nearest(const Vector3& p, double t, double diagonal) const
  {
    const double first = curve_.FirstParameter(), last = curve_.LastParameter();
    t = std::clamp(t, first, last);
    double distance = squaredDistance(p, t);
    for (int i = 0; i < kNewtonSteps; ++i)
    {
      gp_Pnt at;
      gp_Vec d1, d2;
      curve_.D2(t, at, d1, d2);
      const Vector3 r = vectorOf(at.XYZ()) - p;
      const Vector3 a = vectorOf(d1.XYZ()), b = vectorOf(d2.XYZ());
      const double second = a.squaredNorm() + r.dot(b);
      const double whole = -r.dot(a) / (second > 0 ? second : a.squaredNorm());
      if (!std::isfinite(whole))
      {
        break;
      }
      double step = whole;
      bool isNearer = false;
      for (int k = 0; k < kHalvings && !isNearer; ++k, step /= 2)
      {
        const double next = std::clamp(t + step, first, last);
        const double nextDistance = squaredDistance(p, next);
        isNearer = nextDistance < distance;
        t = isNearer ? next : t;
        distance = isNearer ? nextDistance : distance;
      }
      if (!isNearer || std::abs(whole) * a.norm() < kConverged * diagonal)
      {
        break;
      }
    }
    return vectorOf(curve_.Value(t).XYZ());
  }

private:
  double squaredDistance(const Vector3& p, double t) const
  {
    return (vectorOf(curve_.Value(t).XYZ()) - p).squaredNorm();
  }

  BRepAdaptor_Curve curve_;
};

//------------------------------------------------------------------------------
/// The surface of a face, with the region of it that is the face.
class ExactFace
{
public:
  explicit ExactFace(const TopoDS_Face& face)
    : surface_(face, Standard_False), region_(face, kRegionTolerance),
      isTurned_((face.Orientation() == TopAbs_REVERSED) !=
        (face.Location().Transformation().IsNegative() == Standard_True)),
      low_(surface_.FirstUParameter(), surface_.FirstVParameter()),
      high_(surface_.LastUParameter(), surface_.LastVParameter())
  {
  }

  Vector3 at(const Vector2& uv) const { return vectorOf(surface_.Value(uv.x(), uv.y()).XYZ()); }

  bool contains(const Vector2& uv) const
  {
    return region_.Perform(gp_Pnt2d(uv.x(), uv.y())) != TopAbs_OUT;
  }

  /// The parameters of the nearest place to p on the surface, from those of a place near it.
  Vector2 nearest(const Vector3& p, Vector2 uv, double diagonal) const
  {
    uv = bounded(uv);
    double distance = (at(uv) - p).squaredNorm();
    for (int i = 0; i < kNewtonSteps; ++i)
    {
      const std::optional<Vector2> whole = stepAt(p, uv);
      if (!whole)
      {
        break;
      }
      Vector2 step = *whole;
      bool isNearer = false;
      const Vector3 from = at(uv);
      for (int k = 0; k < kHalvings && !isNearer; ++k, step /= 2)
      {
        const Vector2 next = bounded(uv + step);
        const double nextDistance = (at(next) - p).squaredNorm();
        isNearer = nextDistance < distance;
        uv = isNearer ? next : uv;
        distance = isNearer ? nextDistance : distance;
      }
      if (!isNearer || (at(uv) - from).norm() < kConverged * diagonal)
      {
        break;
      }
    }
    return uv;
  }

  void addDirections(const Vector2& uv, CadPlace& place) const
  {
    if (const std::optional<SurfaceBend> bend = bendOf(surface_, uv))
    {
      const auto [larger, smaller] = bend->curvatures;
      place.normal = isTurned_ ? Vector3(-bend->normal) : bend->normal;
      place.curvatures = isTurned_ ? std::array{ -smaller, -larger } : bend->curvatures;
    }
  }

private:
  static constexpr double kRegionTolerance =
    1e-7; // of parameters at the border, that still count as inside

  Vector2 bounded(Vector2 uv) const
  {
    if (!surface_.IsUPeriodic())
    {
      uv.x() = std::clamp(uv.x(), low_.x(), high_.x());
    }
    if (!surface_.IsVPeriodic())
    {
      uv.y() = std::clamp(uv.y(), low_.y(), high_.y());
    }
    return uv;
  }

  /// Of Newton's method on half the squared distance; of Gauss and Newton where that has no minimum nearby.
  std::optional<Vector2> stepAt(const Vector3& p, const Vector2& uv) const
  {
    gp_Pnt point;
    gp_Vec du, dv, duu, dvv, duv;
    surface_.D2(uv.x(), uv.y(), point, du, dv, duu, dvv, duv);
    const Vector3 r = vectorOf(point.XYZ()) - p;
    const Vector3 a = vectorOf(du.XYZ()), b = vectorOf(dv.XYZ());
    const Vector2 gradient(r.dot(a), r.dot(b));
    const double e = a.squaredNorm(), f = a.dot(b), g = b.squaredNorm();
    Eigen::Matrix2d hessian;
    hessian << e + r.dot(vectorOf(duu.XYZ())), f + r.dot(vectorOf(duv.XYZ())), 0,
      g + r.dot(vectorOf(dvv.XYZ()));
    hessian(1, 0) = hessian(0, 1);
    if (!(hessian(0, 0) > 0 && hessian.determinant() > 1e-10 * e * g))
    {
      const double damping = 1e-9; // at poles one of the two directions has no length
      hessian << e + damping * (e + g), f, f, g + damping * (e + g);
    }
    const Vector2 step = -hessian.inverse() * gradient;
    return step.allFinite() ? std::optional(step) : std::nullopt;
  }

  BRepAdaptor_Surface surface_;
  BRepTopAdaptor_FClass2d region_;
  bool isTurned_;
  Vector2 low_;
  Vector2 high_;
};

//------------------------------------------------------------------------------
/// The polylines of edges as segments, each with where it is.
struct EdgeSegments
{
  TriangleList list;
  std::vector<std::pair<Index, Index>> places; ///< edge, and which of its segments

  void add(const CadSurface& surface, Index edge)
  {
    const std::vector<Index>& points = surface.edges[edge].points;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
    {
      if (points[i] != points[i + 1])
      {
        const auto first = static_cast<Index>(list.points.size());
        list.points.push_back(surface.points[points[i]]);
        list.points.push_back(surface.points[points[i + 1]]);
        list.corners.push_back({ first, first + 1, first + 1 });
        places.emplace_back(edge, static_cast<Index>(i));
      }
    }
  }
};

/// What points of one part, or of any, may belong to.
struct Candidates
{
  std::vector<Index> triangles; ///< of those in `faces`
  std::unique_ptr<NearestTriangle> faces;
  EdgeSegments segments;
  std::unique_ptr<NearestTriangle> lines; ///< null where the part has no edges that points go onto
};

/// The faces that hang together, and with them their points.
class Parts
{
public:
  explicit Parts(const CadSurface& surface)
    : sets_(surface.points.size(), 1), pointOfFace_(surface.surfaceKinds.size(), kInvalidIndex)
  {
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    {
      const auto& [a, b, c] = surface.triangles[t];
      sets_.join(a, b);
      sets_.join(b, c);
      pointOfFace_[surface.faceOf[t]] = a;
    }
  }

  Index ofPoint(Index point) { return sets_.find(point); }
  /// kInvalidIndex where the face has no triangles.
  Index ofFace(Index face)
  {
    const Index point = face < pointOfFace_.size() ? pointOfFace_[face] : kInvalidIndex;
    return point == kInvalidIndex ? kInvalidIndex : ofPoint(point);
  }

private:
  DisjointSets sets_;
  std::vector<Index> pointOfFace_;
};

class Placer
{
public:
  Placer(const CadShape::Data& data, const CadSurface& surface, const PlacementOptions& options)
    : data_(data), surface_(surface), onEdge_(options.onEdge * data.diagonal),
      reach_(options.reach > 0 ? options.reach * data.diagonal : surface.chordError),
      faces_(static_cast<std::size_t>(data.faces.Extent())),
      curves_(static_cast<std::size_t>(data.edges.Extent())), tangentEdges_(options.tangentEdges),
      parts_(surface)
  {
  }

  /// face: of the part that the point is of; kInvalidIndex for any.
  CadPlace place(const Vector3& p, Index face)
  {
    CadPlace none;
    none.point = p;
    const Candidates& candidates = candidatesOf(parts_.ofFace(face));
    const auto nearest = candidates.faces->at(p, Vector3::Zero(), reach_);
    if (!p.allFinite() || !nearest)
    {
      return none;
    }
    CadPlace found = none;
    const Index triangle = candidates.triangles[nearest->triangle];
    found.face = surface_.faceOf[triangle];
    Vector2 uv = Vector2::Zero();
    for (std::size_t k = 0; k < 3; ++k)
    {
      uv += nearest->weights[k] * surface_.parameters[triangle][k];
    }
    uv = faceOf(found.face).nearest(p, uv, data_.diagonal);
    if (!placeOnLine(p, candidates, found) && !placeOnFace(p, uv, found))
    {
      placeOnBorder(p, found);
    }
    if (found.kind == CadPlaceKind::None || (found.point - p).norm() > kFarthestMove * reach_)
    {
      return none;
    }
    if (found.kind != CadPlaceKind::Face)
    {
      uv = faceOf(found.face).nearest(found.point, uv, data_.diagonal);
    }
    faceOf(found.face).addDirections(uv, found);
    return found;
  }

private:
  /// part: kInvalidIndex for all parts.
  const Candidates& candidatesOf(Index part)
  {
    const auto [at, isNew] = candidates_.try_emplace(part);
    Candidates& of = at->second;
    if (!isNew)
    {
      return of;
    }
    const auto isOf = [&](Index point)
    { return part == kInvalidIndex || parts_.ofPoint(point) == part; };
    TriangleList list;
    for (Index t = 0; t < surface_.triangles.size(); ++t)
    {
      if (isOf(surface_.triangles[t][0]))
      {
        of.triangles.push_back(t);
        std::array<Index, 3>& corners = list.corners.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
        {
          corners[k] = static_cast<Index>(list.points.size());
          list.points.push_back(surface_.points[surface_.triangles[t][k]]);
        }
      }
    }
    of.faces = std::make_unique<NearestTriangle>(std::move(list));
    for (Index e = 0; e < surface_.edges.size(); ++e)
    {
      const CadEdgeKind kind = surface_.edges[e].kind;
      const bool isLine = kind == CadEdgeKind::Sharp || kind == CadEdgeKind::Free ||
        (kind == CadEdgeKind::Tangent && tangentEdges_);
      if (isLine && isOf(surface_.edges[e].points.front()))
      {
        of.segments.add(surface_, e);
      }
    }
    if (!of.segments.places.empty())
    {
      of.lines = std::make_unique<NearestTriangle>(of.segments.list);
    }
    return of;
  }

  const ExactFace& faceOf(Index id)
  {
    if (!faces_[id])
    {
      faces_[id] = std::make_unique<ExactFace>(TopoDS::Face(data_.faces(static_cast<int>(id) + 1)));
    }
    return *faces_[id];
  }

  const ExactCurve& curveOf(Index id)
  {
    if (!curves_[id])
    {
      curves_[id] =
        std::make_unique<ExactCurve>(TopoDS::Edge(data_.edges(static_cast<int>(id) + 1)));
    }
    return *curves_[id];
  }

  /// The vertex at one end of the edge, where the point of that end is p.
  std::optional<Index> vertexAt(const Vector3& p, Index edge) const
  {
    const std::vector<Index>& points = surface_.edges[edge].points;
    for (const bool atEnd : { false, true })
    {
      const Index point = atEnd ? points.back() : points.front();
      if ((surface_.points[point] - p).norm() <= onEdge_)
      {
        const TopoDS_Edge along =
          TopoDS::Edge(data_.edges(static_cast<int>(edge) + 1).Oriented(TopAbs_FORWARD));
        const TopoDS_Vertex vertex = atEnd ? TopExp::LastVertex(along) : TopExp::FirstVertex(along);
        if (!vertex.IsNull())
        {
          return static_cast<Index>(data_.vertices.FindIndex(vertex)) - 1;
        }
      }
    }
    return std::nullopt;
  }

  void placeOnEdge(const Vector3& p, Index edge, Index segment, double weight, CadPlace& found)
  {
    if (const auto vertex = vertexAt(p, edge))
    {
      found.kind = CadPlaceKind::Vertex;
      found.id = *vertex;
      found.point = surface_.points[surface_.vertexPoints[*vertex]];
      return;
    }
    const std::vector<double>& t = surface_.edges[edge].parameters;
    found.kind = CadPlaceKind::Edge;
    found.id = edge;
    found.point =
      curveOf(edge).nearest(p, (1 - weight) * t[segment] + weight * t[segment + 1], data_.diagonal);
  }

  bool placeOnLine(const Vector3& p, const Candidates& candidates, CadPlace& found)
  {
    const auto nearest =
      candidates.lines ? candidates.lines->at(p, Vector3::Zero(), onEdge_) : std::nullopt;
    if (!nearest)
    {
      return false;
    }
    const auto [edge, segment] = candidates.segments.places[nearest->triangle];
    placeOnEdge(p, edge, segment, nearest->weights[1] + nearest->weights[2], found);
    return true;
  }

  bool placeOnFace(const Vector3& p, const Vector2& uv, CadPlace& found)
  {
    const ExactFace& face = faceOf(found.face);
    const Vector3 foot = face.at(uv);
    if (!face.contains(uv) || (foot - p).norm() > kFarthestMove * reach_)
    {
      return false;
    }
    found.kind = CadPlaceKind::Face;
    found.id = found.face;
    found.point = foot;
    return true;
  }

  /// Triangles reach over the border of a face by the sagitta of its polyline.
  void placeOnBorder(const Vector3& p, CadPlace& found)
  {
    EdgeSegments border;
    const TopoDS_Shape& face = data_.faces(static_cast<int>(found.face) + 1);
    for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next())
    {
      border.add(surface_, static_cast<Index>(data_.edges.FindIndex(at.Current())) - 1);
    }
    if (border.places.empty())
    {
      return;
    }
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = 0;
    double weight = 0;
    for (std::size_t i = 0; i < border.places.size(); ++i)
    {
      const Vector3& a = border.list.points[border.list.corners[i][0]];
      const Vector3 ab = border.list.points[border.list.corners[i][1]] - a;
      const double at = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
      const double distance = (a + at * ab - p).norm();
      if (distance < least)
      {
        least = distance;
        best = i;
        weight = at;
      }
    }
    placeOnEdge(p, border.places[best].first, border.places[best].second, weight, found);
  }

  const CadShape::Data& data_;
  const CadSurface& surface_;
  const double onEdge_;
  const double reach_;
  std::vector<std::unique_ptr<ExactFace>> faces_;
  std::vector<std::unique_ptr<ExactCurve>> curves_;
  const bool tangentEdges_;
  Parts parts_;
  std::map<Index, Candidates> candidates_; ///< by part
};

} // namespace

std::vector<CadPlace> placeOnShape(const CadShape& shape, const CadSurface& surface,
  const std::vector<Vector3>& points, const PlacementOptions& options,
  const std::vector<Index>& faces)
{
  refuseIf(shape.empty() || surface.edges.size() != shape.edgeCount(),
    "the triangles are not those of the shape: tessellate it");
  std::vector<CadPlace> places(points.size());
  guarded("putting points onto the shape",
    [&]
    {
      Placer placer(*shape.data(), surface, options);
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        places[i] = placer.place(points[i], faces.empty() ? kInvalidIndex : faces[i]);
      }
    });
  return places;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/Tessellation.h"

#include "Base/Refuse.h"
#include "Cad/Guarded.h"
#include "Cad/ShapeData.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GeomLProp_SLProps.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <cmath>
#include <optional>

namespace quadrille
{

namespace
{

Vector3 vectorOf(const gp_XYZ& p)
{
  return { p.X(), p.Y(), p.Z() };
}

CadSurfaceKind kindOf(const TopoDS_Face& face)
{
  switch (BRepAdaptor_Surface(face, Standard_False).GetType())
  {
    case GeomAbs_Plane:
      return CadSurfaceKind::Plane;
    case GeomAbs_Cylinder:
      return CadSurfaceKind::Cylinder;
    case GeomAbs_Cone:
      return CadSurfaceKind::Cone;
    case GeomAbs_Sphere:
      return CadSurfaceKind::Sphere;
    case GeomAbs_Torus:
      return CadSurfaceKind::Torus;
    case GeomAbs_BezierSurface:
      return CadSurfaceKind::Bezier;
    case GeomAbs_BSplineSurface:
      return CadSurfaceKind::Spline;
    case GeomAbs_SurfaceOfRevolution:
      return CadSurfaceKind::Revolution;
    case GeomAbs_SurfaceOfExtrusion:
      return CadSurfaceKind::Extrusion;
    case GeomAbs_OffsetSurface:
      return CadSurfaceKind::Offset;
    default:
      return CadSurfaceKind::Other;
  }
}

//------------------------------------------------------------------------------
/// A use of an edge by a face; the face that closes in it has two.
struct EdgeUse
{
  TopoDS_Face face;
  TopoDS_Edge edge; ///< with the orientation that it has in the face
};

/// The unit normal of the face at a parameter of the edge's curve; none where there is no direction.
std::optional<gp_Dir> normalAt(const EdgeUse& use, double parameter)
{
  double first = 0, last = 0;
  const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(use.edge, use.face, first, last);
  if (curve.IsNull())
  {
    return std::nullopt;
  }
  const gp_Pnt2d uv = curve->Value(std::clamp(parameter, first, last));
  TopLoc_Location location;
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(use.face, location);
  GeomLProp_SLProps properties(surface, uv.X(), uv.Y(), 1, 1e-9);
  if (!properties.IsNormalDefined())
  {
    return std::nullopt;
  }
  gp_Dir normal = properties.Normal().Transformed(location.Transformation());
  if (use.face.Orientation() == TopAbs_REVERSED)
  {
    normal.Reverse();
  }
  return normal;
}

constexpr int kPlacesOfAngle = 9; // along an edge

/// The largest angle along the edge, without its ends, where surfaces may be singular.
double angleBetween(const EdgeUse& a, const EdgeUse& b)
{
  double first = 0, last = 0;
  BRep_Tool::Range(a.edge, first, last);
  double angle = 0;
  for (int i = 0; i < kPlacesOfAngle; ++i)
  {
    const double t = first + (last - first) * (i + 0.5) / kPlacesOfAngle;
    const auto normalA = normalAt(a, t), normalB = normalAt(b, t);
    if (normalA && normalB)
    {
      angle = std::max(angle, normalA->Angle(*normalB));
    }
  }
  return angle;
}

//------------------------------------------------------------------------------
class Tessellator
{
public:
  Tessellator(const CadShape::Data& data, const TessellationOptions& options, CadSurface& surface)
    : data_(data), options_(options), surface_(surface),
      uses_(static_cast<std::size_t>(data.edges.Extent()))
  {
    surface_.edges.resize(uses_.size());
    surface_.vertexPoints.assign(static_cast<std::size_t>(data.vertices.Extent()), kInvalidIndex);
  }

  void run()
  {
    mesh();
    for (int i = 1; i <= data_.faces.Extent(); ++i)
    {
      addFace(TopoDS::Face(data_.faces(i)), static_cast<Index>(i - 1));
    }
    for (std::size_t e = 0; e < uses_.size(); ++e)
    {
      classify(e);
    }
    tell();
  }

private:
  void mesh()
  {
    BRepTools::Clean(data_.shape);
    surface_.chordError = options_.chordError * data_.diagonal;
    IMeshTools_Parameters parameters;
    parameters.Deflection = surface_.chordError;
    parameters.Angle = options_.angle;
    parameters.InParallel = Standard_False; // signals of damaged data come to this thread
    for (const TopoDS_Shape& shape : shapesToMesh())
    {
      const BRepMesh_IncrementalMesh mesher(shape, parameters);
    }
  }

  /// Of an assembly, which has instances that share a shape, each shape once without its place, where no two of them
  /// share an edge; else the shape as a whole, as the triangles of all faces at an edge are made together.
  std::vector<TopoDS_Shape> shapesToMesh() const
  {
    TopTools_IndexedMapOfShape shapes, edges;
    int instances = 0, edgesOfShapes = 0;
    for (TopoDS_Iterator at(data_.shape); data_.shape.ShapeType() == TopAbs_COMPOUND && at.More();
         at.Next())
    {
      const TopoDS_Shape shape = at.Value().Located(TopLoc_Location()).Oriented(TopAbs_FORWARD);
      const bool isNew = shapes.FindIndex(shape) == 0;
      shapes.Add(shape);
      ++instances;
      if (isNew)
      {
        TopTools_IndexedMapOfShape own;
        TopExp::MapShapes(shape, TopAbs_EDGE, own);
        TopExp::MapShapes(shape, TopAbs_EDGE, edges);
        edgesOfShapes += own.Extent();
      }
    }
    if (instances == shapes.Extent() || edges.Extent() != edgesOfShapes)
    {
      return { data_.shape };
    }
    std::vector<TopoDS_Shape> once;
    for (int i = 1; i <= shapes.Extent(); ++i)
    {
      once.push_back(shapes(i));
    }
    return once;
  }

  Index addPoint(const gp_XYZ& p)
  {
    surface_.points.push_back(vectorOf(p));
    return static_cast<Index>(surface_.points.size() - 1);
  }

  Index vertexPoint(const TopoDS_Vertex& vertex)
  {
    Index& point =
      surface_.vertexPoints[static_cast<std::size_t>(data_.vertices.FindIndex(vertex)) - 1];
    if (point == kInvalidIndex)
    {
      point = addPoint(BRep_Tool::Pnt(vertex).XYZ());
    }
    return point;
  }

  std::size_t idOf(const TopoDS_Edge& edge) const
  {
    return static_cast<std::size_t>(data_.edges.FindIndex(edge)) - 1;
  }

  /// Points of the edge in the order of its curve, made by the first face that has it.
  bool placeEdge(const TopoDS_Edge& edge, const Poly_Triangulation& triangles,
    const Poly_PolygonOnTriangulation& polygon, const gp_Trsf& place)
  {
    CadEdge& own = surface_.edges[idOf(edge)];
    const int count = polygon.NbNodes();
    if (!own.points.empty())
    {
      return own.points.size() == static_cast<std::size_t>(count);
    }
    TopoDS_Vertex first, last;
    TopExp::Vertices(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)), first, last);
    for (int i = 1; i <= count; ++i)
    {
      const TopoDS_Vertex& vertex = i == 1 ? first : last;
      const bool isEnd = (i == 1 || i == count) && !vertex.IsNull();
      own.points.push_back(isEnd
          ? vertexPoint(vertex)
          : addPoint(triangles.Node(polygon.Node(i)).Transformed(place).XYZ()));
      own.parameters.push_back(polygon.HasParameters() ? polygon.Parameter(i) : i);
    }
    return true;
  }

  void placeBorder(const TopoDS_Face& face, const Handle(Poly_Triangulation) & triangles,
    const TopLoc_Location& location, std::vector<Index>& points)
  {
    for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next())
    {
      const TopoDS_Edge& edge = TopoDS::Edge(at.Current());
      uses_[idOf(edge)].push_back({ face, edge });
      const Handle(Poly_PolygonOnTriangulation) polygon =
        BRep_Tool::PolygonOnTriangulation(edge, triangles, location);
      if (polygon.IsNull())
      {
        continue;
      }
      if (BRep_Tool::Degenerated(edge))
      {
        const Index pole = vertexPoint(TopExp::FirstVertex(edge));
        for (int i = 1; i <= polygon->NbNodes(); ++i)
        {
          points[static_cast<std::size_t>(polygon->Node(i)) - 1] = pole;
        }
        continue;
      }
      if (!placeEdge(edge, *triangles, *polygon, location.Transformation()))
      {
        ++unequalEdges_;
        continue;
      }
      const std::vector<Index>& own = surface_.edges[idOf(edge)].points;
      for (int i = 1; i <= polygon->NbNodes(); ++i)
      {
        points[static_cast<std::size_t>(polygon->Node(i)) - 1] =
          own[static_cast<std::size_t>(i) - 1];
      }
    }
  }

  void addFace(const TopoDS_Face& face, Index id)
  {
    surface_.surfaceKinds.push_back(kindOf(face));
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, location);
    if (triangles.IsNull() || triangles->NbTriangles() == 0)
    {
      emptyFaces_.push_back(id);
      for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next())
      {
        uses_[idOf(TopoDS::Edge(at.Current()))].push_back({ face, TopoDS::Edge(at.Current()) });
      }
      return;
    }
    std::vector<Index> points(static_cast<std::size_t>(triangles->NbNodes()), kInvalidIndex);
    placeBorder(face, triangles, location, points);
    const gp_Trsf& place = location.Transformation();
    for (int i = 1; i <= triangles->NbNodes(); ++i)
    {
      Index& point = points[static_cast<std::size_t>(i) - 1];
      point =
        point == kInvalidIndex ? addPoint(triangles->Node(i).Transformed(place).XYZ()) : point;
    }
    addTriangles(*triangles, points,
      (face.Orientation() == TopAbs_REVERSED) != (place.IsNegative() == Standard_True), id);
  }

  void addTriangles(
    const Poly_Triangulation& triangles, const std::vector<Index>& points, bool turned, Index id)
  {
    for (int i = 1; i <= triangles.NbTriangles(); ++i)
    {
      std::array<int, 3> nodes{};
      triangles.Triangle(i).Get(nodes[0], nodes[1], nodes[2]);
      if (turned)
      {
        std::swap(nodes[1], nodes[2]);
      }
      std::array<Index, 3> corners{};
      std::array<Vector2, 3> parameters;
      for (std::size_t k = 0; k < 3; ++k)
      {
        corners[k] = points[static_cast<std::size_t>(nodes[k]) - 1];
        const gp_Pnt2d uv = triangles.HasUVNodes() ? triangles.UVNode(nodes[k]) : gp_Pnt2d(0, 0);
        parameters[k] = { uv.X(), uv.Y() };
      }
      // At a pole two corners of a triangle are one point.
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      {
        surface_.triangles.push_back(corners);
        surface_.faceOf.push_back(id);
        surface_.parameters.push_back(parameters);
      }
    }
  }

  void classify(std::size_t id)
  {
    CadEdge& edge = surface_.edges[id];
    const std::vector<EdgeUse>& uses = uses_[id];
    if (BRep_Tool::Degenerated(TopoDS::Edge(data_.edges(static_cast<int>(id) + 1))))
    {
      edge.kind = CadEdgeKind::Pole;
      return;
    }
    if (uses.size() == 2)
    {
      const bool isOneFace = uses[0].face.IsSame(uses[1].face);
      edge.angle = angleBetween(uses[0], uses[1]);
      edge.kind = edge.angle > options_.sharpAngle ? CadEdgeKind::Sharp
        : isOneFace                                ? CadEdgeKind::Seam
                                                   : CadEdgeKind::Tangent;
      return;
    }
    edge.kind = uses.empty() ? CadEdgeKind::Wire
      : uses.size() == 1     ? CadEdgeKind::Free
                             : CadEdgeKind::Sharp;
  }

  void tell()
  {
    refuseIf(surface_.triangles.empty(), "no face of the shape can be tessellated: it is damaged");
    if (!emptyFaces_.empty())
    {
      std::string ids;
      for (std::size_t i = 0; i < emptyFaces_.size() && i < 10; ++i)
      {
        ids += (i > 0 ? ", " : "") + std::to_string(emptyFaces_[i]);
      }
      surface_.notices.push_back(std::to_string(emptyFaces_.size()) +
        " faces could not be tessellated, where the surface has holes: ids " + ids +
        (emptyFaces_.size() > 10 ? ", ..." : ""));
    }
    if (unequalEdges_ > 0)
    {
      surface_.notices.push_back(std::to_string(unequalEdges_) +
        " edges are divided in another way by each of their faces, where the surface is open");
    }
  }

  const CadShape::Data& data_;
  const TessellationOptions& options_;
  CadSurface& surface_;
  std::vector<std::vector<EdgeUse>> uses_; ///< by id of the edge
  std::vector<Index> emptyFaces_;
  std::size_t unequalEdges_ = 0;
};

void check(const TessellationOptions& options)
{
  refuseIf(!(options.chordError >= 1e-6 && options.chordError <= 0.1),
    "the chord error of a tessellation is from 1e-6 to 0.1 of the diagonal, not ",
    options.chordError);
  refuseIf(!(options.angle >= 0.01 && options.angle <= 1.5),
    "the angle of a tessellation is from 0.01 to 1.5 radians, not ", options.angle);
  refuseIf(!(options.sharpAngle > 0 && options.sharpAngle < 3.15),
    "the angle of sharp edges is above 0 and at most 180 degrees");
}

} // namespace

CadSurface tessellate(const CadShape& shape, const TessellationOptions& options)
{
  check(options);
  refuseIf(shape.empty(), "there is no shape to tessellate");
  CadSurface surface;
  guarded("tessellating the shape", [&] { Tessellator(*shape.data(), options, surface).run(); });
  return surface;
}

} // namespace quadrille

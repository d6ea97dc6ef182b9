// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/Curvatures.h"

#include "Cad/Guarded.h"
#include "Cad/ShapeData.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadrille
{

namespace
{

/// Parallel within this, directions of the parameters give no normal.
constexpr double kParallel = 1e-12;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

Vector3 vectorOf(const gp_Vec& v)
{
  return { v.X(), v.Y(), v.Z() };
}

/// Of the larger absolute value. NaN at a pole.
float largestAt(const Adaptor3d_Surface& surface, const Vector2& uv)
{
  const std::optional<SurfaceBend> bend = bendOf(surface, uv);
  return bend
    ? static_cast<float>(std::max(std::abs(bend->curvatures[0]), std::abs(bend->curvatures[1])))
    : kUnknown;
}

double curvatureAt(const BRepAdaptor_Curve& curve, double parameter)
{
  gp_Pnt point;
  gp_Vec first, second;
  curve.D2(parameter, point, first, second);
  const double speed = first.Magnitude();
  return speed > 0 ? first.Crossed(second).Magnitude() / (speed * speed * speed) : 0;
}

/// Of the triangles of a face, which are `begin` to `end`. Corners of several triangles are looked at once: `atPoint`,
/// #points, NaN, is left so. A pole has the largest curvature of the other corners.
class FaceCurvatures
{
public:
  explicit FaceCurvatures(CadSurface& surface)
    : surface_(surface), atPoint_(surface.points.size()),
      faceAt_(surface.points.size(), kInvalidIndex)
  {
    surface_.curvatures.assign(surface_.triangles.size(), { 0, 0, 0 });
  }

  void add(const BRepAdaptor_Surface& exact, std::size_t triangle)
  {
    std::array<float, 3>& corners = surface_.curvatures[triangle];
    float most = kUnknown;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const Index point = surface_.triangles[triangle][k], face = surface_.faceOf[triangle];
      if (faceAt_[point] != face)
      {
        faceAt_[point] = face;
        atPoint_[point] = largestAt(exact, surface_.parameters[triangle][k]);
      }
      corners[k] = atPoint_[point];
      most = std::fmax(most, corners[k]);
    }
    for (float& corner : corners)
    {
      corner = std::isnan(corner) ? most : corner;
    }
  }

private:
  CadSurface& surface_;
  std::vector<float> atPoint_;
  std::vector<Index> faceAt_; ///< of which atPoint_ is
};

void addToEdge(const TopoDS_Edge& shape, CadEdge& edge)
{
  const std::size_t segments = edge.points.empty() ? 0 : edge.points.size() - 1;
  edge.curvatures.assign(segments, 0);
  if (segments == 0)
  {
    return;
  }
  const BRepAdaptor_Curve curve(shape);
  for (std::size_t i = 0; curve.GetType() != GeomAbs_Line && i < segments; ++i)
  {
    const double a = edge.parameters[i], b = edge.parameters[i + 1];
    edge.curvatures[i] = static_cast<float>(
      std::max({ curvatureAt(curve, a), curvatureAt(curve, (a + b) / 2), curvatureAt(curve, b) }));
  }
}

} // namespace

std::optional<SurfaceBend> bendOf(const Adaptor3d_Surface& surface, const Vector2& uv)
{
  gp_Pnt point;
  gp_Vec du, dv, duu, dvv, duv;
  surface.D2(uv.x(), uv.y(), point, du, dv, duu, dvv, duv);
  const Vector3 a = vectorOf(du), b = vectorOf(dv);
  const Vector3 across = a.cross(b);
  const double area = across.norm();
  if (!(area > kParallel * (a.squaredNorm() + b.squaredNorm())))
  {
    return std::nullopt;
  }
  SurfaceBend bend;
  bend.normal = across / area;
  const double e = a.squaredNorm(), f = a.dot(b), g = b.squaredNorm();
  const double l = vectorOf(duu).dot(bend.normal), m = vectorOf(duv).dot(bend.normal);
  const double n = vectorOf(dvv).dot(bend.normal);
  const double mean = (e * n - 2 * f * m + g * l) / (2 * area * area);
  const double gauss = (l * n - m * m) / (area * area);
  const double root = std::sqrt(std::max(0.0, mean * mean - gauss));
  bend.curvatures = { mean + root, mean - root };
  return bend;
}

void addCurvatures(const CadShape& shape, CadSurface& surface)
{
  const CadShape::Data& data = *shape.data();
  guarded("the curvature of the shape",
    [&]
    {
      FaceCurvatures curvatures(surface);
      for (std::size_t t = 0; t < surface.triangles.size();)
      {
        const Index face = surface.faceOf[t];
        const BRepAdaptor_Surface exact(
          TopoDS::Face(data.faces(static_cast<int>(face) + 1)), Standard_False);
        const bool isPlane = exact.GetType() == GeomAbs_Plane;
        for (; t < surface.triangles.size() && surface.faceOf[t] == face; ++t)
        {
          if (!isPlane)
          {
            curvatures.add(exact, t);
          }
        }
      }
      for (std::size_t e = 0; e < surface.edges.size(); ++e)
      {
        addToEdge(TopoDS::Edge(data.edges(static_cast<int>(e) + 1)), surface.edges[e]);
      }
    });
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/FilledFaces.h"

#include "Base/Progress.h"
#include "Filling/FaceFilling.h"
#include "Filling/FaceGround.h"
#include "Mesh/CutOpen.h"
#include "Mesh/NearestTriangle.h"
#include "Mesh/Sizing.h"
#include "Mesh/Surface.h"
#include "Mesh/SurfaceEdit.h"
#include "Mesh/SurfaceParts.h"
#include "Mesh/Topology.h"
#include "Quads/QuadShape.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

namespace quadrille
{
namespace
{

class FilledFacesMaker
{
public:
  FilledFacesMaker(
    const Mesh& mesh, const FaceCurves& curves, double edgeLength, const QuadsOfFace& quadsOf)
    : mesh_(mesh), curves_(curves), edgeLength_(edgeLength), quadsOf_(quadsOf),
      atVertex_(mesh.vertexCount(), kInvalidIndex)
  {
  }

  FilledFaces make()
  {
    placeGiven();
    for (const FaceCurve& curve : curves_.curves())
    {
      placeAlong(curve);
    }
    open();
    Index faces = 0;
    const std::vector<Index> labels = faceComponents(opened_.mesh, faces);
    std::vector<std::vector<Index>> ofFace(faces);
    for (Index f = 0; f < labels.size(); ++f)
    {
      ofFace[labels[f]].push_back(f);
    }
    std::vector<OpenedFace> opened;
    std::vector<std::size_t> around;
    for (std::vector<Index>& triangles : ofFace)
    {
      opened.push_back({ partOf(opened_.mesh, triangles), std::move(triangles) });
      around.push_back(addLines(opened.back()));
    }
    joined_ = lines_;
    for (std::size_t i = 0; i < opened.size(); ++i)
    {
      poll();
      if (around[i] != 2)
      {
        fill(opened[i]);
      }
    }
    return std::move(made_);
  }

private:
  /// Of the opened mesh.
  struct OpenedFace : TrianglesOfMesh
  {
    std::vector<Index> triangles; ///< which of the opened mesh's these are
  };

  struct EdgePoint
  {
    double t;
    Index point;
  };

  Index addPoint(const SurfacePoint& place)
  {
    QuadMesh& quads = made_.quads;
    quads.points.push_back(positionOf(mesh_, place));
    quads.sourceFace.push_back(place.face);
    quads.sourceWeights.push_back(place.weights);
    return static_cast<Index>(quads.points.size() - 1);
  }

  /// On the lower half-edge of an edge, inside of it.
  void putOn(Index h, double t, Index point)
  {
    const bool isLower = mesh_.isBoundary(h) || h < mesh_.twin[h];
    onEdge_[isLower ? h : mesh_.twin[h]].push_back({ isLower ? t : 1 - t, point });
  }

  void placeGiven()
  {
    for (const CurvePoint& at : curves_.given())
    {
      const Index point = addPoint(at.onSurface());
      if (at.t <= 0)
      {
        atVertex_[mesh_.origin[at.h]] = point;
      }
      else
      {
        putOn(at.h, at.t, point);
      }
    }
  }

  void placeAt(Index v, Index h)
  {
    if (atVertex_[v] == kInvalidIndex)
    {
      atVertex_[v] = addPoint({ Mesh::face(h), cornerWeight(h) });
    }
  }

  void placeAlong(const FaceCurve& curve)
  {
    const auto begin = [&](const CurveStep& step)
    { return step.forwards ? step.h : Mesh::next(step.h); };
    const auto end = [&](const CurveStep& step)
    { return step.forwards ? Mesh::next(step.h) : step.h; };
    const Index first = begin(curve.steps.front()), last = end(curve.steps.back());
    placeAt(mesh_.origin[first], first);
    placeAt(mesh_.origin[last], last);
    for (const CurvePoint& at : curves_.pointsAlong(curve))
    {
      putOn(at.h, at.t, addPoint(at.onSurface()));
    }
  }

  /// Cuts the faces apart, and splits edges such that all points are at vertices.
  void open()
  {
    const Index faces = mesh_.faceCount();
    opened_.mesh = mesh_;
    std::vector<Index> polygons(faces);
    std::iota(polygons.begin(), polygons.end(), Index{ 0 });
    opened_.sourcePolygon = std::move(polygons);
    opened_.sourcePoints = std::vector<std::array<Index, 3>>(faces);
    pointAt_ = atVertex_;
    for (const Index v : cutOpenAtFeatures(opened_.mesh))
    {
      pointAt_.push_back(Index{ atVertex_[v] });
    }
    const Mesh& mesh = opened_.mesh;
    from_.assign(mesh.vertexCount(), kInvalidIndex);
    onSurface_.assign(mesh.vertexCount(), kInvalidIndex);
    std::vector<std::pair<Index, Index>> begins; // half-edge of the mesh, vertex
    for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
    {
      if (mesh.isBoundary(h))
      {
        from_[mesh.origin[h]] = h;
        onSurface_[mesh.origin[h]] = h;
        begins.emplace_back(h, mesh.origin[h]);
      }
    }
    for (const auto& [h, v] : begins)
    {
      splitAlong(h, v);
    }
  }

  /// h: of the surface; v: where it begins in the opened mesh.
  void splitAlong(Index h, Index v)
  {
    const bool isLower = mesh_.isBoundary(h) || h < mesh_.twin[h];
    const auto found = onEdge_.find(isLower ? h : mesh_.twin[h]);
    if (found == onEdge_.end())
    {
      return;
    }
    std::vector<EdgePoint> points = found->second;
    for (EdgePoint& point : points)
    {
      point.t = isLower ? point.t : 1 - point.t;
    }
    std::stable_sort(points.begin(), points.end(),
      [](const EdgePoint& a, const EdgePoint& b) { return a.t < b.t; });
    double before = 0;
    for (const EdgePoint& point : points)
    {
      const Index half = from_[v];
      const Index face = opened_.mesh.faceCount();
      const Index m = splitEdge(opened_, half, (point.t - before) / (1 - before));
      const Index rest = 3 * face + half % 3; // from m on
      pointAt_.push_back(Index{ point.point });
      from_.push_back(Index{ rest });
      onSurface_.push_back(Index{ h });
      const Index behind = Mesh::next(rest); // was moved there
      if (opened_.mesh.isBoundary(behind))
      {
        from_[opened_.mesh.origin[behind]] = behind;
      }
      before = point.t;
      v = m;
    }
  }

  void fill(const OpenedFace& opened)
  {
    const Mesh& face = opened.mesh;
    const std::vector<Index>& triangles = opened.triangles;
    std::vector<std::uint8_t> isPin(face.vertexCount(), 0);
    std::vector<Index> pointOf(face.vertexCount(), kInvalidIndex);
    for (Index v = 0; v < face.vertexCount(); ++v)
    {
      pointOf[v] = pointAt_[opened.vertices[v]];
      isPin[v] = pointOf[v] == kInvalidIndex ? 0 : 1;
    }
    const std::optional<FaceFill> filled = fillFace(face, isPin, edgeLength_, quadsOf_);
    if (!filled)
    {
      made_.failedAt.push_back(face.middleOfFace(0));
      return;
    }
    const std::size_t first = made_.quads.quads.size();
    const auto firstInside = static_cast<Index>(made_.quads.points.size());
    for (std::size_t i = 0; i < filled->points.size(); ++i)
    {
      pointOf.push_back(
        addPoint(onMesh(triangles[filled->sourceFace[i]], filled->sourceWeights[i])));
    }
    const NearestTriangle nearest(trianglesOf(face));
    const auto placeOf = [&](const Vector3& p)
    {
      const NearestTriangle::Place place = *nearest.at(p);
      return onMesh(triangles[place.triangle], place.weights);
    };
    std::vector<std::array<Index, 4>> quads = filled->quads;
    partJoined(firstInside, placeOf, quads, pointOf);
    for (std::array<Index, 4> quad : quads)
    {
      for (Index& p : quad)
      {
        p = pointOf[p];
      }
      made_.quads.quads.push_back(quad);
    }
    for (std::size_t q = first; q < made_.quads.quads.size(); ++q)
    {
      const std::array<Vector3, 4> corners = cornersOf(made_.quads.points, made_.quads.quads[q]);
      const SurfacePoint middle = placeOf((corners[0] + corners[1] + corners[2] + corners[3]) / 4);
      made_.quads.quadSourceFace.push_back(middle.face);
      made_.quads.quadSourceWeights.push_back({});
    }
  }

  /// Where a curve comes back near itself, faces on both sides may join the same two of its points by an edge inside,
  /// and where one ends in a face, both sides of it may be joined to the same point: that edge would have four quads.
  /// The later one becomes three edges instead, and the quads at it two each. firstInside: of the points of the face;
  /// quads: by vertices of the face and others, of which pointOf has the points.
  template <typename PlaceOf>
  void partJoined(Index firstInside, const PlaceOf& placeOf,
    std::vector<std::array<Index, 4>>& quads, std::vector<Index>& pointOf)
  {
    std::map<std::pair<Index, Index>, int> sides;
    for (const std::array<Index, 4>& quad : quads)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        ++sides[std::minmax(quad[i], quad[(i + 1) % 4])];
      }
    }
    for (const auto& [ends, count] : sides)
    {
      const auto [p, q] = std::minmax(pointOf[ends.first], pointOf[ends.second]);
      if (count != 2 || p >= firstInside || joined_.emplace(p, q).second)
      {
        continue;
      }
      const Vector3 from = made_.quads.points[pointOf[ends.first]];
      const Vector3 to = made_.quads.points[pointOf[ends.second]];
      const auto near = static_cast<Index>(pointOf.size()), far = near + 1;
      pointOf.push_back(addPoint(placeOf(from + (to - from) / 3)));
      pointOf.push_back(addPoint(placeOf(to + (from - to) / 3)));
      partBeside({ ends.first, near, far, ends.second }, pointOf, quads);
      partBeside({ ends.second, far, near, ends.first }, pointOf, quads);
    }
  }

  /// The quad with an edge between the ends of `way` gets the whole way in its place, and becomes two. Where a curve
  /// ends in it two of its corners are one point: these are parted.
  static void partBeside(const std::array<Index, 4>& way, const std::vector<Index>& pointOf,
    std::vector<std::array<Index, 4>>& quads)
  {
    const auto [a, m, n, b] = way;
    for (std::array<Index, 4>& quad : quads)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        if (quad[i] == a && quad[(i + 1) % 4] == b)
        {
          const Index c = quad[(i + 2) % 4], d = quad[(i + 3) % 4];
          const bool isEnd = pointOf[a] == pointOf[c];
          quad = isEnd ? std::array<Index, 4>{ a, m, n, d } : std::array<Index, 4>{ a, m, c, d };
          quads.push_back(
            isEnd ? std::array<Index, 4>{ n, b, c, d } : std::array<Index, 4>{ m, n, b, c });
          return;
        }
      }
    }
  }

  /// A place in a triangle of the opened mesh.
  SurfacePoint onMesh(Index f, const std::array<double, 3>& weights) const
  {
    const Index source = opened_.sourcePolygon[f];
    const Index entry = opened_.refinedEntry.empty() ? kInvalidIndex : opened_.refinedEntry[f];
    if (entry == kInvalidIndex)
    {
      return { source, weights };
    }
    std::array<double, 3> there{};
    for (std::size_t corner = 0; corner < 3; ++corner)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        there[k] += weights[corner] * opened_.cornerWeights[entry][corner][k];
      }
    }
    return { source, there };
  }

  /// Round one face; returns how many edges there are.
  std::size_t addLines(const OpenedFace& opened)
  {
    const Mesh& face = opened.mesh;
    const std::vector<Index>& vertexOf = opened.vertices;
    std::size_t around = 0;
    for (Index h = 0; h < face.halfEdgeCount(); ++h)
    {
      const Index a = pointAt_[vertexOf[face.origin[h]]];
      if (!face.isBoundary(h) || a == kInvalidIndex)
      {
        continue;
      }
      ++around;
      Index b = kInvalidIndex;
      for (Index g = nextOnBoundary(face, h); b == kInvalidIndex; g = nextOnBoundary(face, g))
      {
        b = pointAt_[vertexOf[face.origin[g]]];
      }
      if (lines_.insert(std::minmax(a, b)).second)
      {
        const Index edge = onSurface_[vertexOf[face.origin[h]]];
        made_.quads.lines.push_back(
          { a, b, edge, mesh_.isBoundary(edge) && !curves_.isGiven(edge) });
      }
    }
    return around;
  }

  const Mesh& mesh_;
  const FaceCurves& curves_;
  double edgeLength_;
  const QuadsOfFace& quadsOf_;
  FilledFaces made_;
  std::vector<Index> atVertex_;                    ///< #V: point of the quads there
  std::map<Index, std::vector<EdgePoint>> onEdge_; ///< by the lower half-edge
  PreparedSurface opened_;                         ///< its source polygons are faces of the mesh
  std::vector<Index> pointAt_;                     ///< #V of the opened mesh
  std::vector<Index> from_;      ///< #V of it: the half-edge of the boundary that leaves it
  std::vector<Index> onSurface_; ///< the same, of the mesh
  std::set<std::pair<Index, Index>> lines_;
  std::set<std::pair<Index, Index>> joined_; ///< points of curves that are joined by an edge
};

} // namespace

FilledFaces fillFaces(
  const Mesh& mesh, const FaceCurves& curves, double edgeLength, const QuadsOfFace& quadsOf)
{
  return FilledFacesMaker(mesh, curves, edgeLength, quadsOf).make();
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// How the points of a quad mesh may move over the surface that it was extracted from.
#pragma once

#include "Base/Lists.h"
#include "Quads/QuadMesh.h"
#include "Quads/SurfaceWalk.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace quadrille
{

/// A list per point.
using PointLists = Grouped<>;

/// Where the points of a quad mesh may go: straight over the faces of the mesh, so that sourceFace and sourceWeights
/// stay exact; points of features and boundaries along their curves. Corners, ends and junctions of curves stay on the
/// surface; points of polygons and of a trimmed boundary, and those on the fixed
/// vertices, stay whatever becomes of their quads.
class QuadMoves
{
public:
  enum class Freedom : std::uint8_t ///< less of it first
  {
    Held,  ///< for good
    Fixed, ///< on the surface
    Curve,
    Surface
  };

  /// fixedVertices: of the mesh, ascending. quads must be a manifold that was extracted from mesh.
  QuadMoves(const Mesh& mesh, QuadMesh& quads, const std::vector<Index>& fixedVertices);

  Freedom freedom(Index p) const { return freedom_[p]; }
  /// Do the quads at a point of a curve go straight on over it, two (or on a boundary one line of two) on each side?
  bool isRegularOnCurve(Index p) const;
  const PointLists& incidentQuads() const { return incident_; }
  const Vector3& position(Index p) const { return quads_.points[p]; }

  /// Where p comes when it moves by the displacement; none where something is in the way, as the next points of its
  /// curve are.
  std::optional<SurfacePoint> target(Index p, const Vector3& displacement) const;
  SurfacePoint place(Index p) const { return { quads_.sourceFace[p], quads_.sourceWeights[p] }; }
  /// position: of the place.
  void move(Index p, const SurfacePoint& place, const Vector3& position);

  /// How the curve through a point runs on to the next points of the quads on it, backwards and forwards.
  struct Span
  {
    double length = 0;    ///< along the curve
    double deviation = 0; ///< largest distance of the curve from the edge of the quads
  };
  using Spans = std::array<Span, 2>;
  /// If p, which slides along a curve, were at this place of it; none where it meets another point than its neighbours.
  std::optional<Spans> spansAt(Index p, const SurfacePoint& place) const;
  /// Where p comes when it slides by so much along its curve, backwards when negative.
  std::optional<SurfacePoint> slide(Index p, double length) const;

  /// Of the face that p lies on.
  Vector3 normalAt(Index p) const { return faceNormal(quads_.sourceFace[p]); }
  /// A direction in the face that p lies on.
  Vector3 tangentAt(Index p) const
  {
    return mesh_.edgeVector(3 * quads_.sourceFace[p]).normalized();
  }
  const Mesh& mesh() const { return mesh_; }

  /// The corners of quad q with p at another position.
  std::array<Vector3, 4> cornersWith(Index q, Index p, const Vector3& position) const;
  /// Does this face the side on which the surface below quad q lies? A scaled Jacobian cannot see a quad that is turned
  /// over as a whole.
  bool facesOutwards(Index q, const std::array<Vector3, 4>& corners) const;

  /// Edge neighbours of p, each once per quad: an inner edge counts twice, a boundary edge once.
  template <typename Visitor>
  void forEachNeighbour(Index p, const Visitor& visit) const
  {
    for (const Index* q = incident_.begin(p); q != incident_.end(p); ++q)
    {
      const std::array<Index, 4>& c = quads_.quads[*q];
      for (std::size_t i = 0; i < 4; ++i)
      {
        if (c[i] == p)
        {
          visit(quads_.points[c[(i + 1) % 4]]);
          visit(quads_.points[c[(i + 3) % 4]]);
        }
      }
    }
  }

  struct EdgeLengths
  {
    double shortest = kInfinity;
    double mean = 0;
  };

  /// Of the edges at p, if it were at `position`.
  EdgeLengths edgeLengths(Index p, const Vector3& position) const
  {
    EdgeLengths lengths;
    int count = 0;
    forEachNeighbour(p,
      [&](const Vector3& x)
      {
        const double length = (x - position).norm();
        lengths.shortest = std::min(lengths.shortest, length);
        lengths.mean += length;
        ++count;
      });
    lengths.mean /= std::max(count, 1);
    return lengths;
  }

private:
  Freedom freedomOf(Index p, const std::vector<Index>& fixedVertices) const;
  Freedom curveFreedom(Index p) const;
  std::optional<CurvePoint> curvePoint(const SurfacePoint& place) const;
  /// A point of a curve: on this vertex of the mesh, or on this edge (by its lower half-edge) at t.
  struct CurveEnd
  {
    Index point = kInvalidIndex, vertex = kInvalidIndex, edge = kInvalidIndex;
    double t = 0;
  };
  CurveEnd curveEnd(Index n) const;
  std::optional<std::pair<Index, Span>> spanFrom(Index p, CurvePoint from, bool forwards) const;
  Vector3 faceNormal(Index f) const;
  void computeNormals();

  const Mesh& mesh_;
  QuadMesh& quads_;
  PointLists incident_; ///< per point its quads
  PointLists lines_;    ///< per point the other ends of its lines
  std::vector<Freedom> freedom_;
  std::vector<Vector3> normal_; ///< per quad, of the surface below it
};

} // namespace quadrille

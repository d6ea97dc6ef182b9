// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/BentCurves.h"

#include "Base/Angles.h"
#include "Base/Progress.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadrille
{
namespace
{

/// By how much of s the middle of an edge may leave its curve.
constexpr double kMostSag = 0.05;
/// A polygon of five edges or fewer is one; with more it is a circle.
constexpr double kPolygonCorner = radians(60);
/// Bends are those between chords of about so much of s, so that steps to and fro within it are none.
constexpr double kChord = 0.5;

/// The curves of a mesh, through vertices that they pass without a corner.
class CurveWalk
{
public:
  CurveWalk(const Mesh& mesh, const std::vector<std::uint8_t>& smooth)
    : mesh_(mesh), edges_(edgesAtVertices(mesh, constrainedEdges(mesh))),
      passes_(mesh.vertexCount(), 0)
  {
    for (Index v = 0; v < mesh.vertexCount(); ++v)
    {
      const bool isSmooth = !smooth.empty() && smooth[v] != 0;
      passes_[v] = edges_.size(v) == 2 && (isSmooth || bendAt(v) <= kPolygonCorner) ? 1 : 0;
    }
  }

  bool passes(Index v) const { return passes_[v] != 0; }

  /// Of the curve that passes a vertex, between chords of at least the length, unless it ends before.
  double curvatureAt(Index v, double length) const
  {
    const Chord back = chord(v, edges_.begin(v)[0], length),
                ahead = chord(v, edges_.begin(v)[1], length);
    return angleBetween(-back.across, ahead.across) / (0.5 * (back.length + ahead.length));
  }

private:
  struct Chord
  {
    Vector3 across;
    double length = 0; ///< along the curve
  };

  Vector3 away(Index v, Index edge) const
  {
    return mesh_.position[mesh_.otherEnd(edge, v)] - mesh_.position[v];
  }
  double bendAt(Index v) const
  {
    return angleBetween(-away(v, edges_.begin(v)[0]), away(v, edges_.begin(v)[1]));
  }

  Chord chord(Index v, Index edge, double length) const
  {
    Index at = mesh_.otherEnd(edge, v);
    Chord result{ away(v, edge), mesh_.edgeVector(edge).norm() };
    while (result.length < length && passes(at))
    {
      edge = edges_.otherThan(at, edge);
      at = mesh_.otherEnd(edge, at);
      if (at == v)
      {
        break; // all round a curve shorter than the chord
      }
      result = { mesh_.position[at] - mesh_.position[v],
        result.length + mesh_.edgeVector(edge).norm() };
    }
    return result;
  }

  const Mesh& mesh_;
  Grouped<> edges_;                  ///< constrained ones at each vertex, by their lower half-edges
  std::vector<std::uint8_t> passes_; ///< flags
};

} // namespace

std::vector<double> quadsAlongCurves(
  const Mesh& mesh, double edgeLength, const std::vector<std::uint8_t>& smooth)
{
  const CurveWalk curves(mesh, smooth);
  std::vector<double> curvature(mesh.vertexCount(), -1.0); // none
  for (Index v = 0; v < mesh.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    curvature[v] =
      curves.passes(v) ? curves.curvatureAt(v, kChord * edgeLength * sizeAt(mesh, v)) : -1.0;
  }
  std::vector<double> quads(mesh.halfEdgeCount(), 0.0);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    pollNowAndThen(h);
    if (!mesh.isConstrained(h))
    {
      continue;
    }
    // Where one end is none of a bent curve the other one tells.
    const double a = curvature[mesh.origin[h]], b = curvature[mesh.target(h)];
    const double bent = std::max(a < 0 || b < 0 ? std::max(a, b) : 0.5 * (a + b), 0.0);
    const double size = edgeLength * sizeOfEdge(mesh, h);
    quads[h] =
      mesh.edgeVector(h).norm() / size * std::max(1.0, std::sqrt(bent * size / (8 * kMostSag)));
  }
  return quads;
}

} // namespace quadrille

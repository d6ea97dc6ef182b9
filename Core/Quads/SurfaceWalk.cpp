// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/SurfaceWalk.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// How fast the weights change along d; the part of d normal to the triangle does not matter. None
/// for a degenerate triangle.
std::optional<std::array<double, 3>> weightRates(const Mesh& mesh, Index f, const Vector3& d)
{
  const std::array<Vector3, 3> p = mesh.cornersOfFace(f);
  const Vector3 b = p[1] - p[0];
  const Vector3 c = p[2] - p[0];
  const double bb = b.dot(b), bc = b.dot(c), cc = c.dot(c);
  const double det = bb * cc - bc * bc;
  if (!(det > 1e-24 * bb * cc))
  {
    return std::nullopt;
  }
  const double rateB = (cc * d.dot(b) - bc * d.dot(c)) / det;
  const double rateC = (bb * d.dot(c) - bc * d.dot(b)) / det;
  return std::array<double, 3>{ -rateB - rateC, rateB, rateC };
}

/// In the plane of face(h), orthogonal to h, into the face.
Vector3 inward(const Mesh& mesh, Index h)
{
  const Vector3 edge = mesh.edgeVector(h).normalized();
  const Vector3 side =
    mesh.position[mesh.origin[Mesh::previous(h)]] - mesh.position[mesh.origin[h]];
  return (side - side.dot(edge) * edge).normalized();
}

/// Continues direction d over h in the plane of the twin's face.
Vector3 unfold(const Mesh& mesh, Index h, const Vector3& d)
{
  const Vector3 edge = mesh.edgeVector(h).normalized();
  const double outwards = -d.dot(inward(mesh, h));
  return d.dot(edge) * edge + std::max(outwards, 0.0) * inward(mesh, mesh.twin[h]);
}

/// The corner whose weight vanishes first along the rates, and when.
struct Exit
{
  double time = 1;
  Index corner = kInvalidIndex;
};

Exit findExit(
  const std::array<double, 3>& weights, const std::array<double, 3>& rates, Index entryCorner)
{
  Exit exit;
  for (Index i = 0; i < 3; ++i)
  {
    if (rates[i] < 0 && i != entryCorner && weights[i] + rates[i] * exit.time < 0)
    {
      exit = { std::max(0.0, -weights[i] / rates[i]), i };
    }
  }
  return exit;
}

void advance(std::array<double, 3>& weights, const std::array<double, 3>& rates, double time)
{
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
  {
    weights[i] = std::max(0.0, weights[i] + rates[i] * time);
    sum += weights[i];
  }
  for (double& w : weights)
  {
    w /= sum;
  }
}

} // namespace

Vector3 positionOf(const Mesh& mesh, const SurfacePoint& point)
{
  // From the corner with the largest weight on: exact on a vertex, and a coordinate that all
  // corners share stays as it is.
  const std::array<Vector3, 3> p = mesh.cornersOfFace(point.face);
  const std::array<double, 3>& w = point.weights;
  const std::size_t k = w[0] >= w[1] ? (w[0] >= w[2] ? 0 : 2) : (w[1] >= w[2] ? 1 : 2);
  const std::size_t i = (k + 1) % 3;
  const std::size_t j = (k + 2) % 3;
  return p[k] + w[i] * (p[i] - p[k]) + w[j] * (p[j] - p[k]);
}

std::optional<SurfacePoint> walkSurface(const Mesh& mesh, SurfacePoint from, Vector3 displacement)
{
  Index entryCorner = kInvalidIndex;
  for (Index i = 0; i < mesh.faceCount(); ++i)
  {
    const auto rates = weightRates(mesh, from.face, displacement);
    if (!rates)
    {
      return std::nullopt;
    }
    const Exit exit = findExit(from.weights, *rates, entryCorner);
    advance(from.weights, *rates, exit.time);
    if (exit.corner == kInvalidIndex)
    {
      return from;
    }
    const Index h = 3 * from.face + (exit.corner + 1) % 3; // opposite to the corner
    if (mesh.isConstrained(h))
    {
      return std::nullopt;
    }
    const Index g = mesh.twin[h];
    displacement = unfold(mesh, h, displacement * (1 - exit.time));
    SurfacePoint beyond{ Mesh::face(g), {} };
    beyond.weights[g % 3] = from.weights[Mesh::next(h) % 3];
    beyond.weights[Mesh::next(g) % 3] = from.weights[h % 3];
    entryCorner = Mesh::previous(g) % 3;
    from = beyond;
  }
  return std::nullopt;
}

std::vector<Index> constrainedEdgesAt(const Mesh& mesh, Index h)
{
  std::vector<Index> edges;
  const auto add = [&](Index e)
  {
    const Index lowest = std::min(e, mesh.twin[e]);
    if (mesh.isConstrained(e) && std::find(edges.begin(), edges.end(), lowest) == edges.end())
    {
      edges.push_back(lowest);
    }
  };
  forEachInFan(mesh, h,
    [&](Index corner)
    {
      add(corner);
      add(Mesh::previous(corner));
    });
  return edges;
}

SurfacePoint CurvePoint::onSurface() const
{
  SurfacePoint point{ Mesh::face(h), {} };
  point.weights[h % 3] = 1 - t;
  point.weights[Mesh::next(h) % 3] = t;
  return point;
}

std::optional<CurvePoint> locateOnCurve(const Mesh& mesh, const SurfacePoint& point)
{
  for (Index i = 0; i < 3; ++i)
  {
    const Index h = 3 * point.face + i;
    const double t = point.weights[(i + 1) % 3];
    if (point.weights[(i + 2) % 3] == 0 && t > 0 && t < 1 && mesh.isConstrained(h))
    {
      return CurvePoint{ h, t };
    }
  }
  return std::nullopt;
}

std::optional<Index> continueCurve(const Mesh& mesh, Index edge, bool atTarget)
{
  const std::vector<Index> edges = constrainedEdgesAt(mesh, atTarget ? Mesh::next(edge) : edge);
  if (edges.size() != 2)
  {
    return std::nullopt;
  }
  const Index lowest = std::min(edge, mesh.twin[edge]);
  return edges[0] == lowest ? edges[1] : edges[0];
}

std::optional<CurvePoint> walkCurve(const Mesh& mesh, CurvePoint from, double length)
{
  bool forwards = length >= 0;
  double rest = std::abs(length);
  for (Index i = 0; i < mesh.faceCount(); ++i)
  {
    const double whole = mesh.edgeVector(from.h).norm();
    const double ahead = whole * (forwards ? 1 - from.t : from.t);
    if (rest < ahead)
    {
      from.t += (forwards ? rest : -rest) / whole;
      return from;
    }
    rest -= ahead;
    const Index vertex = forwards ? mesh.target(from.h) : mesh.origin[from.h];
    const std::optional<Index> next = continueCurve(mesh, from.h, forwards);
    if (!next)
    {
      return std::nullopt;
    }
    forwards = mesh.origin[*next] == vertex;
    from = { *next, forwards ? 0.0 : 1.0 };
  }
  return std::nullopt;
}

} // namespace quadrille

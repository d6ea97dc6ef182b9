// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/RelaxedTriangles.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "GridMap/Certificate.h"
#include "GridMap/MapShape.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace quadrille
{
namespace
{

/// A step may not shrink a triangle below this part of its determinant, unless it stays above the same part of an
/// isometry's.
constexpr double kLeastShrink = 0.1;
/// How often the steps of single vertices are halved before they stay where they are.
constexpr int kHalvings = 12;
/// Strength of a guide of weight 1: isolines that are a degree off it cost as much as a stretch by 1.3.
constexpr double kGuideStrengthOfMap = 1000;
/// Three degrees: beyond that the pull of a guide grows no more, so that one that no map follows does not tear its
/// neighbours along.
constexpr double kGuideKneeOfMap = 0.05;

Vector2 imageOf(const Vector2& direction, const Jacobian& j)
{
  return direction.x() * j.head<2>() + direction.y() * j.tail<2>();
}

/// The derivative by J of normal^T J direction.
Jacobian offAxis(const Vector2& normal, const Vector2& direction)
{
  Jacobian result;
  result.head<2>() = direction.x() * normal;
  result.tail<2>() = direction.y() * normal;
  return result;
}

} // namespace

RelaxedTriangles::RelaxedTriangles(const Mesh& mesh, const std::vector<std::uint8_t>& integerVertex,
  const RelaxOptions& options, std::vector<FixedVec2>& uv)
  : mesh_(mesh), options_(options), uv_(uv), rotation_(mesh.origin.size(), 0),
    free_(mesh.vertexCount(), { 1, 1 }), references_(mesh.faceCount()),
    outgoing_(outgoingHalfEdges(mesh)), step_(mesh.vertexCount())
{
  lock(integerVertex);
  makeReferences();
  findInset();
}

void RelaxedTriangles::hold(Index v)
{
  free_[v] = { 0, 0 };
}

void RelaxedTriangles::lock(const std::vector<std::uint8_t>& integerVertex)
{
  for (Index v = 0; v < mesh_.vertexCount(); ++v)
  {
    if (integerVertex[v] != 0 || outgoing_[v] == kInvalidIndex)
    {
      free_[v] = { 0, 0 };
    }
  }
  for (Index v = 0; v < mesh_.vertexCount(); ++v)
  {
    pollNowAndThen(v);
    if (outgoing_[v] != kInvalidIndex)
    {
      placeCorners(v);
    }
  }
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    if (mesh_.isConstrained(h))
    {
      lockIsoline(h);
    }
  }
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    if (orientation(uv_[3 * f], uv_[3 * f + 1], uv_[3 * f + 2]) <= 0)
    {
      for (Index i = 0; i < 3; ++i)
      {
        hold(mesh_.origin[3 * f + i]);
      }
    }
  }
}

/// Walks round the vertex counterclockwise. Where the rotations do not close, or an edge has none, it stays.
void RelaxedTriangles::placeCorners(Index v)
{
  const Index start = outgoing_[v];
  for (Index h = start;;)
  {
    const Index across = Mesh::previous(h);
    const Index next = mesh_.twin[across];
    if (next == kInvalidIndex)
    {
      return;
    }
    bool residual = false;
    const int step = transitionOf(mesh_, uv_, across, 0, &residual).rotation;
    const int rotation = (step + rotation_[h]) & 3;
    if (residual || uv_[across] == uv_[h] || (next == start && rotation != 0))
    {
      hold(v);
    }
    if (next == start)
    {
      return;
    }
    rotation_[next] = static_cast<std::int8_t>(rotation);
    h = next;
  }
}

void RelaxedTriangles::lockIsoline(Index h)
{
  const FixedVec2 along = uv_[Mesh::next(h)] - uv_[h];
  for (const Index corner : { h, Mesh::next(h) })
  {
    const Index v = mesh_.origin[corner];
    if ((along.u != 0) == (along.v != 0))
    {
      hold(v); // not on an isoline, or without length
      continue;
    }
    const bool acrossV = (along.v == 0) == ((rotation_[corner] & 1) == 0);
    free_[v][acrossV ? 1 : 0] = 0;
  }
}

void RelaxedTriangles::findInset()
{
  if (options_.inset.empty())
  {
    return;
  }
  inset_.assign(mesh_.vertexCount(), {});
  for (Index h = 0; h < mesh_.halfEdgeCount(); ++h)
  {
    if (options_.inset[h] == 0)
    {
      continue;
    }
    const FixedVec2 along = uv_[Mesh::next(h)] - uv_[h];
    const auto sign = [](std::int64_t x) { return static_cast<std::int64_t>(x > 0) - (x < 0); };
    const FixedVec2 inside = rotate({ kOne / 2 * sign(along.u), kOne / 2 * sign(along.v) }, 1);
    for (const Index corner : { h, Mesh::next(h) })
    {
      inset_[mesh_.origin[corner]] = rotate(inside, -rotation_[corner]);
    }
  }
}

/// Of each face the length on the surface, over its size, that one unit of its component's map stands for.
std::vector<double> RelaxedTriangles::unitLengths() const
{
  const Index faces = mesh_.faceCount();
  std::vector<Index> component(faces, kInvalidIndex);
  std::vector<std::array<double, 2>> areas; // on the surface, mapped
  std::vector<Index> open;
  for (Index first = 0; first < faces; ++first)
  {
    if (component[first] != kInvalidIndex)
    {
      continue;
    }
    const Index id = static_cast<Index>(areas.size());
    areas.push_back({ 0, 0 });
    component[first] = id;
    open.assign(1, first);
    while (!open.empty())
    {
      const Index f = open.back();
      open.pop_back();
      pollNowAndThen(f);
      areas[id][0] += 2 * sizedArea(mesh_, f);
      areas[id][1] += 2 * mappedArea(uv_, f);
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        if (!mesh_.isBoundary(h) && component[Mesh::face(mesh_.twin[h])] == kInvalidIndex)
        {
          component[Mesh::face(mesh_.twin[h])] = id;
          open.push_back(Mesh::face(mesh_.twin[h]));
        }
      }
    }
  }
  std::vector<double> result(faces, 0);
  for (Index f = 0; f < faces; ++f)
  {
    const std::array<double, 2>& area = areas[component[f]];
    result[f] = area[0] > 0 && area[1] > 0 ? std::sqrt(area[0] / area[1]) : 0;
  }
  return result;
}

void RelaxedTriangles::makeReferences()
{
  const std::vector<double> unit = unitLengths();
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    if (!(unit[f] > 0))
    {
      for (Index i = 0; i < 3; ++i)
      {
        hold(mesh_.origin[3 * f + i]);
      }
      continue;
    }
    if (orientation(uv_[3 * f], uv_[3 * f + 1], uv_[3 * f + 2]) > 0)
    {
      const Eigen::Matrix2d shape = flattenFace(mesh_, f) / unit[f];
      references_[f] = { shape.inverse(), shape.determinant() / 2 };
    }
  }
  if (!options_.guides.empty())
  {
    makeDirections();
  }
}

void RelaxedTriangles::makeDirections()
{
  directions_.resize(mesh_.faceCount());
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    const Guide& guide = options_.guides[f];
    const Vector3 along = mesh_.edgeVector(3 * f);
    const Vector3 normal = along.cross(mesh_.edgeVector(3 * f + 1));
    if (!guide.isFree() && normal.norm() > 0)
    {
      const Vector2 inPlane(guide.direction.dot(along.normalized()),
        guide.direction.dot(normal.cross(along).normalized()));
      directions_[f] = { inPlane, Vector2::Zero(), kGuideStrengthOfMap * guide.weight };
    }
  }
  chooseAxes();
}

/// By how many quarter turns the guide's cross in the face across h lies further, in the map, than that of the face of
/// h: of its four directions the one that is nearest on the surface.
int RelaxedTriangles::turnsAcross(Index h) const
{
  const Index other = mesh_.twin[h];
  const auto against = [&](Index side)
  {
    const Index f = Mesh::face(side);
    const Eigen::Matrix2d shape = flattenFace(mesh_, f);
    const std::array<Vector2, 3> edges{ Vector2(shape.col(0)), Vector2(shape.col(1) - shape.col(0)),
      Vector2(-shape.col(1)) };
    const Vector2& edge = edges[side % 3];
    const Vector2& g = directions_[f].direction;
    return std::atan2(edge.x() * g.y() - edge.y() * g.x(), edge.dot(g));
  };
  // Seen from the other side, the edge runs the other way.
  const double turn = against(other) + kPi - against(h);
  return static_cast<int>(std::lround(turn / kRightAngle)) + transitionOf(mesh_, uv_, h).rotation;
}

/// Guides that hang together lie on one family of isolines, which turns with them: the one that needs less of a turn in
/// all. Triangle by triangle the nearer one would be the other family where a map is still 45 degrees off.
void RelaxedTriangles::chooseAxes()
{
  std::vector<std::int8_t> axis(mesh_.faceCount(), -1); // of the component's first face, carried on
  for (Index first = 0; first < mesh_.faceCount(); ++first)
  {
    if (axis[first] >= 0 || !(directions_[first].strength > 0))
    {
      continue;
    }
    axis[first] = 0;
    std::vector<Index> region{ first };
    std::array<double, 2> off{ 0, 0 }; // of the two families
    for (std::size_t i = 0; i < region.size(); ++i)
    {
      const Index f = region[i];
      if (references_[f].weight > 0)
      {
        const Vector2 image = imageOf(directions_[f].direction, jacobian(f, cornersOf(f)));
        const double weight = references_[f].weight * directions_[f].strength;
        for (int k = 0; k < 2; ++k)
        {
          const double component = image[1 - (axis[f] ^ k)];
          off[static_cast<std::size_t>(k)] += weight * component * component / image.squaredNorm();
        }
      }
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        const Index g = mesh_.isBoundary(h) ? kInvalidIndex : Mesh::face(mesh_.twin[h]);
        if (g != kInvalidIndex && axis[g] < 0 && directions_[g].strength > 0)
        {
          axis[g] = static_cast<std::int8_t>((axis[f] + turnsAcross(h)) & 1);
          region.push_back(g);
        }
      }
    }
    const int turned = off[1] < off[0] ? 1 : 0;
    for (const Index f : region)
    {
      directions_[f].normal = (axis[f] ^ turned) == 0 ? Vector2(0, 1) : Vector2(1, 0);
    }
  }
}

AxisEnergy RelaxedTriangles::axisEnergy(Index f) const
{
  return { directions_[f].strength, kGuideKneeOfMap };
}

Jacobian RelaxedTriangles::jacobian(Index f, const Corners& p) const
{
  const Vector2 a = toDouble(p[1] - p[0]);
  const Vector2 b = toDouble(p[2] - p[0]);
  const Eigen::Matrix2d& inverse = references_[f].inverse;
  Jacobian j;
  j.head<2>() = a * inverse(0, 0) + b * inverse(1, 0);
  j.tail<2>() = a * inverse(0, 1) + b * inverse(1, 1);
  return j;
}

double RelaxedTriangles::energy(Index f, const Corners& p) const
{
  const Jacobian j = jacobian(f, p);
  const double d = j[0] * j[3] - j[1] * j[2];
  if (!(d > 0))
  {
    return kInfinity;
  }
  double value = j.squaredNorm() * (1 + 1 / (d * d));
  if (!directions_.empty() && directions_[f].strength > 0)
  {
    value += axisEnergy(f).value(offAxis(directions_[f].normal, directions_[f].direction).dot(j));
  }
  return references_[f].weight * value;
}

void RelaxedTriangles::derive(Index f, Jacobian& gradient, Eigen::Matrix4d& hessian) const
{
  const Jacobian j = jacobian(f, cornersOf(f));
  const double d = j[0] * j[3] - j[1] * j[2];
  const double squared = j.squaredNorm();
  const double cube = 1 / (d * d * d);
  deriveByJacobian(j, { 1 + 1 / (d * d), -2 * squared * cube, -2 * cube, 6 * squared * cube / d },
    gradient, hessian);
  if (!directions_.empty() && directions_[f].strength > 0)
  {
    axisEnergy(f).addDerivatives(
      offAxis(directions_[f].normal, directions_[f].direction), j, gradient, hessian);
  }
  gradient *= references_[f].weight;
  hessian *= references_[f].weight;
}

Eigen::Matrix<double, 4, 2> RelaxedTriangles::cornerDerivative(Index h) const
{
  const Index corner = h % 3;
  const Eigen::Matrix2d& inverse = references_[h / 3].inverse;
  const Eigen::RowVector2d g = corner == 0 ? Eigen::RowVector2d(-inverse.row(0) - inverse.row(1))
                                           : Eigen::RowVector2d(inverse.row(corner - 1));
  Eigen::Matrix<double, 4, 2> result;
  for (int axis = 0; axis < 2; ++axis)
  {
    const FixedVec2 rotated =
      rotate(axis == 0 ? FixedVec2{ 1, 0 } : FixedVec2{ 0, 1 }, rotation_[h]);
    const Vector2 along(static_cast<double>(rotated.u), static_cast<double>(rotated.v));
    result.col(axis).head<2>() = g[0] * along;
    result.col(axis).tail<2>() = g[1] * along;
  }
  return result;
}

UntangleProblem RelaxedTriangles::problem() const
{
  UntangleProblem problem;
  std::vector<Eigen::Triplet<double>> triplets;
  std::vector<std::array<int, 2>> unknown(mesh_.vertexCount());
  int unknowns = 0;
  for (Index v = 0; v < mesh_.vertexCount(); ++v)
  {
    for (std::size_t axis = 0; axis < 2; ++axis)
    {
      unknown[v][axis] = free_[v][axis] != 0 ? unknowns++ : -1;
    }
  }
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    pollNowAndThen(f);
    if (!(references_[f].weight > 0))
    {
      continue;
    }
    problem.triangles.push_back({ 3 * f, 3 * f + 1, 3 * f + 2 });
    problem.inverseReference.push_back(references_[f].inverse);
    problem.weight.push_back(references_[f].weight);
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      for (std::size_t axis = 0; axis < 2; ++axis)
      {
        if (unknown[mesh_.origin[h]][axis] >= 0)
        {
          const CornerAxis along = cornerAxis(static_cast<int>(axis), rotation_[h]);
          triplets.emplace_back(
            static_cast<int>(2 * h) + along.coordinate, unknown[mesh_.origin[h]][axis], along.sign);
        }
      }
    }
  }
  problem.offset.setZero(2 * Eigen::Index(mesh_.halfEdgeCount()));
  problem.basis.resize(problem.offset.size(), unknowns);
  problem.basis.setFromTriplets(triplets.begin(), triplets.end());
  return problem;
}

void RelaxedTriangles::derivatives(
  std::vector<Jacobian>& gradients, std::vector<Eigen::Matrix4d>& hessians) const
{
  const std::vector<Index> faces =
    idsWhere(mesh_.faceCount(), [&](Index f) { return references_[f].weight > 0; });
  gradients.resize(faces.size());
  hessians.resize(faces.size());
  parallelForEach(faces.size(), kMediumChunk, options_.threads,
    [&](std::size_t i)
    {
      derive(faces[i], gradients[i], hessians[i]);
      for (Index h = 3 * faces[i]; h < 3 * faces[i] + 3 && !inset_.empty(); ++h)
      {
        gradients[i] += hessians[i] * (cornerDerivative(h) * toDouble(inset_[mesh_.origin[h]]));
      }
    });
}

/// Of all triangles that count.
double RelaxedTriangles::referenceArea() const
{
  return std::accumulate(references_.begin(), references_.end(), 0.0,
    [](double sum, const Reference& reference) { return sum + reference.weight; });
}

/// Sums over chunks, added in their order.
double RelaxedTriangles::totalEnergy(bool stepped) const
{
  const std::size_t faces = mesh_.faceCount();
  const std::vector<double> sums = parallelParts<double>(faces, kMediumChunk, options_.threads,
    [&](std::size_t begin, std::size_t end, double& part)
    {
      double sum = 0;
      for (std::size_t i = begin; i < end; ++i)
      {
        const Index f = static_cast<Index>(i);
        if (references_[f].weight > 0)
        {
          sum += energy(f, stepped ? steppedCorners(f) : cornersOf(f));
        }
      }
      part = sum;
    });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

std::vector<Index> RelaxedTriangles::starOf(Index v) const
{
  std::vector<Index> star;
  if (outgoing_[v] != kInvalidIndex)
  {
    forEachInFan(mesh_, outgoing_[v], [&](Index h) { star.push_back(h); });
  }
  return star;
}

double RelaxedTriangles::starEnergy(Index v, bool stepped) const
{
  double sum = 0;
  for (const Index h : starOf(v))
  {
    const Index f = Mesh::face(h);
    if (references_[f].weight > 0)
    {
      sum += energy(f, stepped ? steppedCorners(f) : cornersOf(f));
    }
  }
  return sum;
}

/// Whether the face stays positive all the way of the step, and does not shrink too far.
bool RelaxedTriangles::allows(Index f) const
{
  const Corners from = cornersOf(f);
  const Corners to = steppedCorners(f);
  if (!(references_[f].weight > 0) ||
    (from[1] - from[0] == to[1] - to[0] && from[2] - from[0] == to[2] - to[0]))
  {
    return true;
  }
  if (orientation(to[0], to[1], to[2]) <= 0)
  {
    return false;
  }
  // det(t) = before + linear t + square t^2 along the step.
  const Vector2 a = toDouble(from[1] - from[0]), b = toDouble(from[2] - from[0]);
  const Vector2 c = toDouble(to[1] - to[0]) - a, d = toDouble(to[2] - to[0]) - b;
  const double before = parallelogram(a, b);
  const double linear = parallelogram(a, d) + parallelogram(c, b);
  const double square = parallelogram(c, d);
  const double after = before + linear + square;
  const double isometric = 2 * references_[f].weight;
  if (after < kLeastShrink * before && after < kLeastShrink * isometric)
  {
    return false;
  }
  if (rise_ > 0)
  {
    const double risen = energy(f, to);
    if (risen > kCrushed * kIsometry * references_[f].weight && risen > rise_ * energy(f, from))
    {
      return false;
    }
  }
  const double lowest = square > 0 ? -linear / (2 * square) : 0;
  return !(lowest > 0 && lowest < 1) || before + lowest * (linear + lowest * square) > 0;
}

bool RelaxedTriangles::allowsAll() const
{
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    if (!allows(f))
    {
      return false;
    }
  }
  return true;
}

/// Halves the steps of the vertices of faces that do not allow theirs, each as often as it needs.
void RelaxedTriangles::shortenSteps()
{
  const std::size_t faces = mesh_.faceCount();
  std::vector<std::vector<Index>> refused((faces + kMediumChunk - 1) / kMediumChunk);
  std::vector<std::uint8_t> shortened(mesh_.vertexCount(), 0);
  for (int round = 0;; ++round)
  {
    parallelFor(faces, kMediumChunk, options_.threads,
      [&](std::size_t begin, std::size_t end)
      {
        std::vector<Index>& list = refused[begin / kMediumChunk];
        list.clear();
        for (std::size_t i = begin; i < end; ++i)
        {
          const Index f = static_cast<Index>(i);
          // Only what touches a step that was just shortened can have changed.
          const Index* v = &mesh_.origin[3 * i];
          if ((round == 0 || (shortened[v[0]] | shortened[v[1]] | shortened[v[2]]) != 0) &&
            !allows(f))
          {
            list.push_back(f);
          }
        }
      });
    std::fill(shortened.begin(), shortened.end(), std::uint8_t{ 0 });
    bool done = true;
    for (const std::vector<Index>& list : refused)
    {
      for (const Index f : list)
      {
        done = false;
        for (Index h = 3 * f; h < 3 * f + 3; ++h)
        {
          const Index v = mesh_.origin[h];
          if (shortened[v] == 0)
          {
            shortened[v] = 1;
            step_[v] =
              round < kHalvings ? FixedVec2{ step_[v].u / 2, step_[v].v / 2 } : FixedVec2{};
          }
        }
      }
    }
    if (done)
    {
      return;
    }
  }
}

void RelaxedTriangles::takeStep()
{
  parallelForEach(mesh_.halfEdgeCount(), kMediumChunk, options_.threads,
    [&](std::size_t h) { uv_[h] = uv_[h] + stepOf(static_cast<Index>(h)); });
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/RelaxMap.h"
#include "GridMap/Certificate.h"

#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "GridMap/MapShape.h"
#include "Mesh/Sizing.h"
#include "Mesh/Topology.h"
#include "Numerics/IsotropicEnergy.h"
#include "Numerics/NestedSolver.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>

namespace quadrille
{
namespace
{

constexpr std::size_t kFacesOfRelaxation = 1 << 12;
/// Energy of an isometry, |J|^2 + |J^-1|^2.
constexpr double kIsometry = 4;
/// A step may not shrink a triangle below this part of its determinant, unless it stays above the same part of an
/// isometry's.
constexpr double kLeastShrink = 0.1;
/// Where no such step lowers the energy, crushed triangles keep all others from moving: then none of them may rise by
/// more than this factor, less and less the shorter the step.
constexpr double kMostRise = 10;
/// How often the steps of single vertices are halved before they stay where they are.
constexpr int kHalvings = 12;
/// How often the whole step is halved before the descent ends.
constexpr int kBacktracking = 6;
/// Vertices of triangles above this multiple of an isometry's energy are relaxed one by one first: Newton's method on a
/// barrier needs a step for each factor of 4/3 that a determinant is to grow by, however few triangles need it.
constexpr double kCrushed = 8;
constexpr int kLocalSweeps = 60;
/// What a factorization takes, on scans: bytes a triangle, operations over the triangles to the power of 3/2. Of one
/// thread and steps as measured, see Documentation/Performance.md.
constexpr double kBytesPerFace = 1500;
constexpr double kOperationsPerRoot = 60;
constexpr double kOperationsPerSecond = 5e9;
constexpr double kUsualSteps = 4;
/// From here on these estimates are asked before the exact ones.
constexpr double kManyFaces = 3e6;
/// Half a quad.
constexpr std::int64_t kInset = kOne / 2;
/// Steps in which an inset boundary gets to its place, at most; where its vertices can take whole steps it is one.
constexpr int kInsetSteps = 40;
/// A step that brings it nearer by a smaller part of the way than this ends that.
constexpr double kLeastInset = 1e-3;
/// How often a whole step is halved before those of single vertices are shortened.
constexpr int kInsetHalvings = 2;
/// Strength of a guide of weight 1 against the energy, as in the map of the coarse level.
constexpr double kGuideStrengthOfMap = 100;

/// The linear part of a triangle: J = E inverseReference with the edges E.
struct Reference
{
  Eigen::Matrix2d inverse = Eigen::Matrix2d::Identity();
  double weight = 0; ///< 0: left out
};

/// The direction that is to stay on an axis: strength (normal^T J direction)^2.
struct FaceDirection
{
  Vector2 direction = Vector2::Zero();
  double strength = 0;
};

class MapRelaxation
{
public:
  MapRelaxation(const Mesh& mesh, const std::vector<std::uint8_t>& integerVertex,
    const RelaxOptions& options, std::vector<FixedVec2>& uv)
    : mesh_(mesh), options_(options), uv_(uv), rotation_(mesh.origin.size(), 0),
      free_(mesh.vertexCount(), { 1, 1 }), references_(mesh.faceCount()),
      outgoing_(outgoingHalfEdges(mesh)), step_(mesh.vertexCount())
  {
    lock(integerVertex);
    makeReferences();
    findInset();
  }

  RelaxResult run();

private:
  using Corners = std::array<FixedVec2, 3>;

  void lock(const std::vector<std::uint8_t>& integerVertex);
  void placeCorners(Index v);
  void lockIsoline(Index h);
  void hold(Index v);
  void findInset();
  bool moveInset(RelaxResult& result);
  bool solveStep(Eigen::VectorXd& direction);
  bool stepInset();
  double insetLeft() const;
  bool allowsAll() const;
  void makeReferences();
  void makeDirections();
  std::vector<double> unitLengths() const;

  FixedVec2 stepOf(Index h) const { return rotate(step_[mesh_.origin[h]], rotation_[h]); }
  Corners cornersOf(Index f) const { return { uv_[3 * f], uv_[3 * f + 1], uv_[3 * f + 2] }; }
  Corners steppedCorners(Index f) const
  {
    return { uv_[3 * f] + stepOf(3 * f), uv_[3 * f + 1] + stepOf(3 * f + 1),
      uv_[3 * f + 2] + stepOf(3 * f + 2) };
  }
  Jacobian jacobian(Index f, const Corners& p) const;
  double energy(Index f, const Corners& p) const;
  void derive(Index f, Jacobian& gradient, Eigen::Matrix4d& hessian) const;
  /// Derivatives of J by the displacements of a corner's vertex along its two axes.
  Eigen::Matrix<double, 4, 2> cornerDerivative(Index h) const;
  void element(Index f, NestedSolver::Matrix6& matrix, NestedSolver::Vector6& rightSide) const;
  double totalEnergy(bool stepped) const;
  bool allows(Index f) const;
  void shortenSteps();
  void takeStep();
  bool check(double bytes, double operations, RelaxResult& result) const;
  bool makeSolver(RelaxResult& result);
  bool newtonStep(double& current);
  void setStep(const Eigen::VectorXd& direction, double length);
  void relaxCrushed();
  bool relaxVertex(Index v);
  double starEnergy(Index v, bool stepped) const;

  const Mesh& mesh_;
  const RelaxOptions& options_;
  std::vector<FixedVec2>& uv_;
  std::vector<std::int8_t> rotation_; ///< #H: from the chart of the vertex to that of the corner
  std::vector<std::array<std::uint8_t, 2>> free_; ///< #V: whether it may move along its axes
  std::vector<Reference> references_;
  std::vector<FaceDirection> directions_; ///< empty or #F
  std::vector<Index> outgoing_;
  std::vector<FixedVec2> step_; ///< #V: candidate displacement, in the chart of the vertex
  std::vector<FixedVec2>
    inset_; ///< empty or #V: what vertices have yet to move, along axes that are not free
  std::unique_ptr<NestedSolver> solver_;
  double rise_ = 0; ///< by which a step may raise the energy of a crushed triangle; 0: any
  double area_ = 0;
  std::size_t held_ = 0;
};

void MapRelaxation::hold(Index v)
{
  held_ += free_[v][0] != 0 || free_[v][1] != 0 ? 1 : 0;
  free_[v] = { 0, 0 };
}

void MapRelaxation::lock(const std::vector<std::uint8_t>& integerVertex)
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
void MapRelaxation::placeCorners(Index v)
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

void MapRelaxation::lockIsoline(Index h)
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

void MapRelaxation::findInset()
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
    const FixedVec2 inside = rotate({ kInset * sign(along.u), kInset * sign(along.v) }, 1);
    for (const Index corner : { h, Mesh::next(h) })
    {
      inset_[mesh_.origin[corner]] = rotate(inside, -rotation_[corner]);
    }
  }
}

/// The sum of the ways that are left, in quads.
double MapRelaxation::insetLeft() const
{
  double sum = 0;
  for (const FixedVec2& left : inset_)
  {
    sum += toDouble(left).norm();
  }
  return sum;
}

bool MapRelaxation::allowsAll() const
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

/// The step of Newton's method, with the least shift that has one; false where none has.
bool MapRelaxation::solveStep(Eigen::VectorXd& direction)
{
  bool solved = false;
  for (double shift = 1e-9; shift < 1e3 && !solved; shift *= 1000)
  {
    solved = solver_->solve([this](Index f, NestedSolver::Matrix6& m, NestedSolver::Vector6& b)
      { element(f, m, b); },
      shift, options_.threads, direction);
  }
  return solved && direction.allFinite();
}

/// One step towards the place of the inset boundary, with what is free in its wake. False where nothing moves.
bool MapRelaxation::stepInset()
{
  Eigen::VectorXd direction;
  if (solver_->unknowns() > 0 && !solveStep(direction))
  {
    return false;
  }
  double length = 1;
  setStep(direction, length);
  for (int halving = 0; halving < kInsetHalvings && !allowsAll(); ++halving)
  {
    length /= 2;
    setStep(direction, length);
  }
  shortenSteps();
  takeStep();
  for (Index v = 0; v < mesh_.vertexCount(); ++v)
  {
    if (inset_[v] != FixedVec2{})
    {
      // The other axis is free, or does not move.
      inset_[v] = { inset_[v].u == 0 ? 0 : inset_[v].u - step_[v].u,
        inset_[v].v == 0 ? 0 : inset_[v].v - step_[v].v };
    }
  }
  return true;
}

/// False, with the status, where the boundary does not get to its place.
bool MapRelaxation::moveInset(RelaxResult& result)
{
  double left = insetLeft();
  for (int step = 0; left > 0 && step < kInsetSteps; ++step)
  {
    report(options_.progress, 0, "moving the boundary by half a quad");
    if (!stepInset())
    {
      break;
    }
    const double before = left;
    left = insetLeft();
    if (!(before - left > kLeastInset * before))
    {
      break;
    }
  }
  if (!(left > 0))
  {
    inset_.clear();
    return true;
  }
  Index farthest = 0;
  for (Index v = 0; v < mesh_.vertexCount(); ++v)
  {
    farthest = toDouble(inset_[v]).norm() > toDouble(inset_[farthest]).norm() ? v : farthest;
  }
  result.status = { StatusCode::NotConverged,
    "the boundary near " + placeText(mesh_.position[farthest]) +
      " cannot move by half a quad between irregular vertices, features and other boundaries" };
  return false;
}

/// Of each face the length on the surface, over its size, that one unit of its component's map stands for.
std::vector<double> MapRelaxation::unitLengths() const
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
      const Vector2 a = toDouble(uv_[3 * f + 1] - uv_[3 * f]);
      const Vector2 b = toDouble(uv_[3 * f + 2] - uv_[3 * f]);
      areas[id][0] += 2 * sizedArea(mesh_, f);
      areas[id][1] += a.x() * b.y() - a.y() * b.x();
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

void MapRelaxation::makeReferences()
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
      area_ += references_[f].weight;
    }
  }
  if (!options_.guides.empty())
  {
    makeDirections();
  }
}

void MapRelaxation::makeDirections()
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
      directions_[f] = { inPlane, kGuideStrengthOfMap * guide.weight };
    }
  }
}

Jacobian MapRelaxation::jacobian(Index f, const Corners& p) const
{
  const Vector2 a = toDouble(p[1] - p[0]);
  const Vector2 b = toDouble(p[2] - p[0]);
  const Eigen::Matrix2d& inverse = references_[f].inverse;
  Jacobian j;
  j.head<2>() = a * inverse(0, 0) + b * inverse(1, 0);
  j.tail<2>() = a * inverse(0, 1) + b * inverse(1, 1);
  return j;
}

/// The derivative by J of the component of J direction off its nearest axis.
Jacobian offAxis(const Jacobian& j, const Vector2& direction)
{
  const Vector2 image = direction.x() * j.head<2>() + direction.y() * j.tail<2>();
  const Vector2 normal = std::abs(image.x()) >= std::abs(image.y()) ? Vector2(0, 1) : Vector2(1, 0);
  Jacobian result;
  result.head<2>() = direction.x() * normal;
  result.tail<2>() = direction.y() * normal;
  return result;
}

double MapRelaxation::energy(Index f, const Corners& p) const
{
  const Jacobian j = jacobian(f, p);
  const double d = j[0] * j[3] - j[1] * j[2];
  if (!(d > 0))
  {
    return std::numeric_limits<double>::infinity();
  }
  double value = j.squaredNorm() * (1 + 1 / (d * d));
  if (!directions_.empty() && directions_[f].strength > 0)
  {
    const double off = offAxis(j, directions_[f].direction).dot(j);
    value += directions_[f].strength * off * off;
  }
  return references_[f].weight * value;
}

void MapRelaxation::derive(Index f, Jacobian& gradient, Eigen::Matrix4d& hessian) const
{
  const Jacobian j = jacobian(f, cornersOf(f));
  const double d = j[0] * j[3] - j[1] * j[2];
  const double squared = j.squaredNorm();
  const double cube = 1 / (d * d * d);
  deriveByJacobian(j, { 1 + 1 / (d * d), -2 * squared * cube, -2 * cube, 6 * squared * cube / d },
    gradient, hessian);
  if (!directions_.empty() && directions_[f].strength > 0)
  {
    const Jacobian off = offAxis(j, directions_[f].direction);
    gradient += 2 * directions_[f].strength * off.dot(j) * off;
    hessian.noalias() += 2 * directions_[f].strength * off * off.transpose();
  }
  gradient *= references_[f].weight;
  hessian *= references_[f].weight;
}

Eigen::Matrix<double, 4, 2> MapRelaxation::cornerDerivative(Index h) const
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

void MapRelaxation::element(
  Index f, NestedSolver::Matrix6& matrix, NestedSolver::Vector6& rightSide) const
{
  if (!(references_[f].weight > 0))
  {
    matrix.setZero();
    rightSide.setZero();
    return;
  }
  Jacobian gradient;
  Eigen::Matrix4d hessian;
  derive(f, gradient, hessian);
  Eigen::Matrix<double, 4, 6> derivative = Eigen::Matrix<double, 4, 6>::Zero();
  Eigen::Index column = 0;
  for (Index h = 3 * f; h < 3 * f + 3; ++h)
  {
    const Eigen::Matrix<double, 4, 2> corner = cornerDerivative(h);
    for (int axis = 0; axis < 2; ++axis)
    {
      if (free_[mesh_.origin[h]][static_cast<std::size_t>(axis)] != 0)
      {
        derivative.col(column++) = corner.col(axis);
      }
    }
  }
  matrix.noalias() = derivative.transpose() * (hessian * derivative);
  if (!inset_.empty())
  {
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      gradient += hessian * (cornerDerivative(h) * toDouble(inset_[mesh_.origin[h]]));
    }
  }
  rightSide.noalias() = -(derivative.transpose() * gradient);
}

/// Sums over chunks, added in their order.
double MapRelaxation::totalEnergy(bool stepped) const
{
  const std::size_t faces = mesh_.faceCount();
  std::vector<double> sums((faces + kFacesOfRelaxation - 1) / kFacesOfRelaxation, 0);
  parallelFor(faces, kFacesOfRelaxation, options_.threads,
    [&](std::size_t begin, std::size_t end)
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
      sums[begin / kFacesOfRelaxation] = sum;
    });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// Whether the face stays positive all the way of the step, and does not shrink too far.
bool MapRelaxation::allows(Index f) const
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
  const auto cross = [](const Vector2& x, const Vector2& y)
  { return x.x() * y.y() - x.y() * y.x(); };
  const double before = cross(a, b);
  const double linear = cross(a, d) + cross(c, b);
  const double square = cross(c, d);
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

/// Halves the steps of the vertices of faces that do not allow theirs, each as often as it needs.
void MapRelaxation::shortenSteps()
{
  const std::size_t faces = mesh_.faceCount();
  std::vector<std::vector<Index>> refused((faces + kFacesOfRelaxation - 1) / kFacesOfRelaxation);
  std::vector<std::uint8_t> shortened(mesh_.vertexCount(), 0);
  for (int round = 0;; ++round)
  {
    parallelFor(faces, kFacesOfRelaxation, options_.threads,
      [&](std::size_t begin, std::size_t end)
      {
        std::vector<Index>& list = refused[begin / kFacesOfRelaxation];
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

void MapRelaxation::takeStep()
{
  parallelFor(mesh_.halfEdgeCount(), kFacesOfRelaxation, options_.threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t h = begin; h < end; ++h)
      {
        uv_[h] = uv_[h] + stepOf(static_cast<Index>(h));
      }
    });
}

/// False where no step lowers the energy.
bool MapRelaxation::newtonStep(double& current)
{
  Eigen::VectorXd direction;
  if (!solveStep(direction))
  {
    return false;
  }
  // The first step that gains something worth while; else the best one.
  std::vector<FixedVec2> best;
  double bestEnergy = current;
  double length = 1;
  for (int halving = 0; halving < kBacktracking; ++halving, length /= 2)
  {
    for (const double rise : { 0.0, 1 + (kMostRise - 1) * length * length })
    {
      rise_ = rise;
      setStep(direction, length);
      shortenSteps();
      const double candidate = totalEnergy(true);
      if (candidate < bestEnergy)
      {
        bestEnergy = candidate;
        best = step_;
      }
      if (current - bestEnergy > options_.leastGain * current)
      {
        break;
      }
    }
    if (current - bestEnergy > options_.leastGain * current)
    {
      break;
    }
  }
  rise_ = 0;
  if (best.empty())
  {
    return false;
  }
  step_.swap(best);
  takeStep();
  current = bestEnergy;
  return true;
}

void MapRelaxation::setStep(const Eigen::VectorXd& direction, double length)
{
  Eigen::Index next = 0;
  for (Index v = 0; v < mesh_.vertexCount(); ++v)
  {
    Vector2 d(0, 0);
    for (std::size_t axis = 0; axis < 2; ++axis)
    {
      d[static_cast<Eigen::Index>(axis)] = free_[v][axis] != 0 ? length * direction[next++] : 0;
    }
    // A step of many quads is none; it would leave the range of exact determinants, too.
    step_[v] = d.norm() < 16 ? toFixed(d) : toFixed(Vector2(d.normalized() * 16));
    if (!inset_.empty())
    {
      step_[v] = step_[v] + toFixed(Vector2(length * toDouble(inset_[v])));
    }
  }
}

double MapRelaxation::starEnergy(Index v, bool stepped) const
{
  double sum = 0;
  const Index start = outgoing_[v];
  for (Index h = start; h != kInvalidIndex;)
  {
    const Index f = Mesh::face(h);
    if (references_[f].weight > 0)
    {
      sum += energy(f, stepped ? steppedCorners(f) : cornersOf(f));
    }
    h = mesh_.rotateCounterclockwise(h);
    if (h == start)
    {
      break;
    }
  }
  return sum;
}

/// One Newton step of one vertex; step_ is zero before and after.
bool MapRelaxation::relaxVertex(Index v)
{
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Vector2 rightSide = Vector2::Zero();
  const Index start = outgoing_[v];
  const auto forStar = [&](const auto& visit)
  {
    for (Index h = start; h != kInvalidIndex;)
    {
      if (!visit(h))
      {
        return false;
      }
      h = mesh_.rotateCounterclockwise(h);
      if (h == start)
      {
        break;
      }
    }
    return true;
  };
  forStar(
    [&](Index h)
    {
      if (references_[Mesh::face(h)].weight > 0)
      {
        Jacobian gradient;
        Eigen::Matrix4d hessian;
        derive(Mesh::face(h), gradient, hessian);
        const Eigen::Matrix<double, 4, 2> derivative = cornerDerivative(h);
        matrix += derivative.transpose() * hessian * derivative;
        rightSide -= derivative.transpose() * gradient;
      }
      return true;
    });
  for (Eigen::Index axis = 0; axis < 2; ++axis)
  {
    if (free_[v][static_cast<std::size_t>(axis)] == 0)
    {
      matrix(axis, 1 - axis) = matrix(1 - axis, axis) = 0;
      matrix(axis, axis) = 1;
      rightSide[axis] = 0;
    }
  }
  const double determinant = matrix.determinant();
  if (!(determinant > 0))
  {
    return false;
  }
  const Vector2 direction = matrix.inverse() * rightSide;
  const double before = starEnergy(v, false);
  bool moved = false;
  for (double length = 1; length > 1e-3 && !moved; length /= 2)
  {
    step_[v] = toFixed(Vector2(length * direction));
    moved = direction.norm() < 16 && forStar([&](Index h) { return allows(Mesh::face(h)); }) &&
      starEnergy(v, true) < before;
  }
  if (moved)
  {
    forStar(
      [&](Index h)
      {
        uv_[h] = uv_[h] + stepOf(h);
        return true;
      });
  }
  step_[v] = {};
  return moved;
}

/// Vertices of crushed triangles and their neighbours, one by one in the order of their ids.
void MapRelaxation::relaxCrushed()
{
  for (int sweep = 0; sweep < kLocalSweeps; ++sweep)
  {
    std::vector<Index> vertices;
    for (Index f = 0; f < mesh_.faceCount(); ++f)
    {
      pollNowAndThen(f);
      if (references_[f].weight > 0 &&
        energy(f, cornersOf(f)) > kCrushed * kIsometry * references_[f].weight)
      {
        for (Index i = 0; i < 3; ++i)
        {
          vertices.push_back(mesh_.origin[3 * f + i]);
        }
      }
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    bool moved = false;
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
      pollNowAndThen(i, 256);
      const Index v = vertices[i];
      if (free_[v][0] != 0 || free_[v][1] != 0)
      {
        moved |= relaxVertex(v);
      }
    }
    if (!moved)
    {
      return;
    }
  }
}

/// False, with the status, where a factorization of this size is too large.
bool MapRelaxation::check(double bytes, double operations, RelaxResult& result) const
{
  result.bytes = bytes;
  if (bytes <= options_.maximumBytes && operations <= options_.maximumOperations)
  {
    return true;
  }
  std::ostringstream text;
  text << "about " << std::ceil(1e-6 * bytes) << " MB and "
       << std::ceil(kUsualSteps * operations / kOperationsPerSecond)
       << " s would be needed for a level of " << mesh_.faceCount() << " triangles, and "
       << (bytes > options_.maximumBytes ? "so much memory is not free"
                                         : "that is more than the limit")
       << "; the intermediate level takes less";
  result.status = { StatusCode::TooLarge, text.str() };
  return false;
}

/// False where it would take too much.
bool MapRelaxation::makeSolver(RelaxResult& result)
{
  // The dissection of many millions of triangles alone takes memory and time.
  const double faces = mesh_.faceCount();
  if (faces > kManyFaces &&
    !check(kBytesPerFace * faces, kOperationsPerRoot * faces * std::sqrt(faces), result))
  {
    return false;
  }
  report(options_.progress, 0, "preparing to lessen the distortion");
  std::vector<std::uint8_t> unknowns(mesh_.vertexCount());
  for (Index v = 0; v < mesh_.vertexCount(); ++v)
  {
    unknowns[v] = static_cast<std::uint8_t>(free_[v][0] + free_[v][1]);
  }
  std::vector<std::array<Index, 3>> triangles(mesh_.faceCount());
  for (Index f = 0; f < mesh_.faceCount(); ++f)
  {
    triangles[f] = { mesh_.origin[3 * f], mesh_.origin[3 * f + 1], mesh_.origin[3 * f + 2] };
  }
  solver_ = std::make_unique<NestedSolver>(mesh_.position, unknowns, triangles);
  result.bytes = solver_->bytes();
  return check(solver_->bytes(), solver_->operations(), result);
}

RelaxResult MapRelaxation::run()
{
  RelaxResult result;
  result.heldVertices = held_;
  const double scale = area_ > 0 ? 1 / (kIsometry * area_) : 0;
  double current = totalEnergy(false);
  result.before = result.after = scale * current;
  if (options_.maximumSteps > 0 && !makeSolver(result))
  {
    return result;
  }
  if (!inset_.empty())
  {
    if (!moveInset(result))
    {
      return result;
    }
    current = totalEnergy(false);
    result.before = scale * current;
  }
  relaxCrushed();
  current = totalEnergy(false);
  while (result.steps < options_.maximumSteps && solver_->unknowns() > 0)
  {
    report(options_.progress, static_cast<double>(result.steps) / options_.maximumSteps,
      "lessening the distortion");
    const double before = current;
    if (!newtonStep(current))
    {
      break;
    }
    ++result.steps;
    if (before - current < options_.leastGain * before)
    {
      break;
    }
  }
  result.after = scale * current;
  return result;
}

} // namespace

RelaxResult relaxMap(const Mesh& mesh, const std::vector<std::uint8_t>& integerVertex,
  const RelaxOptions& options, std::vector<FixedVec2>& uv)
{
  if (uv.size() != mesh.origin.size() || integerVertex.size() != mesh.position.size() ||
    (!options.guides.empty() && options.guides.size() != mesh.faceCount()) ||
    (!options.inset.empty() && (options.inset.size() != uv.size() || options.maximumSteps < 1)))
  {
    throw InvalidInput("relaxing a map: the sizes of mesh, map, integer vertices, guides and inset "
                       "boundary disagree");
  }
  return MapRelaxation(mesh, integerVertex, options, uv).run();
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "GridMap/RelaxMap.h"

#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Base/PlaceText.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "GridMap/MapCheck.h"
#include "GridMap/RelaxedTriangles.h"
#include "Numerics/ReducedTriangles.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <vector>

namespace quadrille
{
namespace
{

constexpr int kLocalSweeps = 60;
/// Multiplications of a factorization, at most: about 40 s on one thread, a surface of about two million triangles.
constexpr double kMostOperations = 2e11;
/// How often a whole step is halved before those of single vertices are shortened.
constexpr int kInsetHalvings = 2;

class MapRelaxation : RelaxedTriangles
{
public:
  MapRelaxation(const Mesh& mesh, const std::vector<std::uint8_t>& integerVertex,
    const RelaxOptions& options, std::vector<FixedVec2>& uv)
    : RelaxedTriangles(mesh, integerVertex, options, uv)
  {
  }

  RelaxResult run();

private:
  double insetLeft() const;
  bool moveInset(RelaxResult& result);
  bool solveStep(Eigen::VectorXd& direction);
  bool stepInset();
  bool check(double bytes, double operations, RelaxResult& result) const;
  bool makeSolver(RelaxResult& result);
  bool newtonStep(double& current);
  void setStep(const Eigen::VectorXd& direction, double length);
  void relaxCrushed();
  bool relaxVertex(Index v);

  std::unique_ptr<ReducedTriangles> system_;
};

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

/// The step of Newton's method; false where there is none.
bool MapRelaxation::solveStep(Eigen::VectorXd& direction)
{
  std::vector<Jacobian> gradients;
  std::vector<Eigen::Matrix4d> hessians;
  derivatives(gradients, hessians);
  system_->assemble(gradients, hessians);
  return system_->newtonStep(kRounding, direction);
}

/// One step towards the place of the inset boundary, with what is free in its wake. False where nothing moves.
bool MapRelaxation::stepInset()
{
  Eigen::VectorXd direction;
  if (system_->unknowns() > 0 && !solveStep(direction))
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
  // At most; where its vertices can take whole steps it is one.
  constexpr int kInsetSteps = 40;
  // A step that brings it nearer by a smaller part of the way than this is the last one.
  constexpr double kLeastInset = 1e-3;
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

/// False where no step lowers the energy.
bool MapRelaxation::newtonStep(double& current)
{
  Eigen::VectorXd direction;
  if (!solveStep(direction))
  {
    return false;
  }
  // How often the whole step is halved before the descent ends.
  constexpr int kBacktracking = 6;
  // Where no such step lowers the energy, crushed triangles keep all others from moving: then none of them may rise by
  // more than this factor, less and less the shorter the step.
  constexpr double kMostRise = 10;
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

/// One Newton step of one vertex; step_ is zero before and after.
bool MapRelaxation::relaxVertex(Index v)
{
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Vector2 rightSide = Vector2::Zero();
  const std::vector<Index> star = starOf(v);
  for (const Index h : star)
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
  }
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
    moved = direction.norm() < 16 &&
      std::all_of(star.begin(), star.end(), [&](Index h) { return allows(Mesh::face(h)); }) &&
      starEnergy(v, true) < before;
  }
  for (std::size_t i = 0; moved && i < star.size(); ++i)
  {
    uv_[star[i]] = uv_[star[i]] + stepOf(star[i]);
  }
  step_[v] = {};
  return moved;
}

/// Vertices of crushed triangles and their neighbours, one by one in the order of their ids.
void MapRelaxation::relaxCrushed()
{
  for (int sweep = 0; sweep < kLocalSweeps; ++sweep)
  {
    const std::vector<Index> vertices = cornerVertices(mesh_,
      idsWhere(mesh_.faceCount(),
        [&](Index f)
        {
          pollNowAndThen(f);
          return references_[f].weight > 0 &&
            energy(f, cornersOf(f)) > kCrushed * kIsometry * references_[f].weight;
        }));
    bool moved = false;
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
      pollNowAndThen(i, kHeavyChunk);
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
  if (bytes <= options_.maximumBytes && operations <= kMostOperations)
  {
    return true;
  }
  // Of one thread: four steps with 5e9 operations a second, as measured, see Documentation/Performance.md.
  constexpr double kSecondsOfOperation = 0.8e-9;
  std::ostringstream text;
  text << "about " << std::ceil(1e-6 * bytes) << " MB and "
       << std::ceil(kSecondsOfOperation * operations) << " s would be needed for a level of "
       << mesh_.faceCount() << " triangles, and "
       << (bytes > options_.maximumBytes ? "so much memory is not free"
                                         : "that is more than the limit")
       << "; the intermediate level takes less";
  result.status = { StatusCode::TooLarge, text.str() };
  return false;
}

/// False where it would take too much.
bool MapRelaxation::makeSolver(RelaxResult& result)
{
  // What Newton steps take, on scans: bytes a triangle, those of them that are not the factorization's, and operations
  // over the triangles to the power of 3/2, see Documentation/Performance.md.
  constexpr double kBytesPerFace = 2000;
  constexpr double kBytesOfTriangle = 900;
  constexpr double kOperationsPerRoot = 60;
  // From here on these estimates are asked before the exact ones: the ordering of many millions of triangles alone
  // takes memory and time.
  constexpr double kManyFaces = 3e6;
  const double faces = mesh_.faceCount();
  if (faces > kManyFaces &&
    !check(kBytesPerFace * faces, kOperationsPerRoot * faces * std::sqrt(faces), result))
  {
    return false;
  }
  report(options_.progress, 0, "preparing to lessen the distortion");
  system_ = std::make_unique<ReducedTriangles>(problem());
  system_->analyze();
  const SparseCholesky& solver = system_->solver();
  return check(solver.factorBytes() + kBytesOfTriangle * faces, solver.factorFlops() / 2, result);
}

RelaxResult MapRelaxation::run()
{
  RelaxResult result;
  const double area = referenceArea();
  const double scale = area > 0 ? 1 / (kIsometry * area) : 0;
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
  while (result.steps < options_.maximumSteps && system_->unknowns() > 0)
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
  refuseIf(uv.size() != mesh.origin.size() || integerVertex.size() != mesh.position.size() ||
      (!options.guides.empty() && options.guides.size() != mesh.faceCount()) ||
      (!options.inset.empty() && (options.inset.size() != uv.size() || options.maximumSteps < 1)),
    "relaxing a map: the sizes of mesh, map, integer vertices, guides and inset "
    "boundary disagree");
  return MapRelaxation(mesh, integerVertex, options, uv).run();
}

} // namespace quadrille

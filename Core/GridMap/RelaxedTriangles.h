// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The triangles of a map that is relaxed (see GridMap/RelaxMap.h): which vertices may move along which axes, the
/// energy with its derivatives, and the steps that triangles allow.
#pragma once

#include "Base/FixedPoint.h"
#include "GridMap/RelaxMap.h"
#include "Mesh/Mesh.h"
#include "Numerics/IsotropicEnergy.h"
#include "Numerics/ReducedTriangles.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille
{

/// Energy of an isometry, |J|^2 + |J^-1|^2.
constexpr double kIsometry = 4;
/// Vertices of triangles above this multiple of an isometry's energy are relaxed one by one first: Newton's method on a
/// barrier needs a step for each factor of 4/3 that a determinant is to grow by, however few triangles need it.
constexpr double kCrushed = 8;

class RelaxedTriangles
{
protected:
  using Corners = std::array<FixedVec2, 3>;

  /// The linear part of a triangle: J = E inverseReference with the edges E.
  struct Reference
  {
    Eigen::Matrix2d inverse = Eigen::Matrix2d::Identity();
    double weight = 0; ///< 0: left out
  };

  /// The direction that is to stay on an axis: see AxisEnergy.
  struct FaceDirection
  {
    Vector2 direction = Vector2::Zero();
    Vector2 normal = Vector2::Zero(); ///< of the axis that it is to stay on
    double strength = 0;
  };

  RelaxedTriangles(const Mesh& mesh, const std::vector<std::uint8_t>& integerVertex,
    const RelaxOptions& options, std::vector<FixedVec2>& uv);

  FixedVec2 stepOf(Index h) const { return rotate(step_[mesh_.origin[h]], rotation_[h]); }
  Corners cornersOf(Index f) const { return { uv_[3 * f], uv_[3 * f + 1], uv_[3 * f + 2] }; }
  Corners steppedCorners(Index f) const
  {
    return { uv_[3 * f] + stepOf(3 * f), uv_[3 * f + 1] + stepOf(3 * f + 1),
      uv_[3 * f + 2] + stepOf(3 * f + 2) };
  }
  double energy(Index f, const Corners& p) const;
  void derive(Index f, Jacobian& gradient, Eigen::Matrix4d& hessian) const;
  /// Derivatives of J by the displacements of a corner's vertex along its two axes.
  Eigen::Matrix<double, 4, 2> cornerDerivative(Index h) const;
  /// The displacements of the vertices as unknowns, along the axes that are free, vertex after vertex. Triangles are
  /// those that count, in their order.
  UntangleProblem problem() const;
  /// Derivatives of the energy of these triangles by their Jacobians, where those of `inset_` have moved.
  void derivatives(std::vector<Jacobian>& gradients, std::vector<Eigen::Matrix4d>& hessians) const;
  double referenceArea() const;
  double totalEnergy(bool stepped) const;
  /// The half-edges that leave a vertex, counterclockwise.
  std::vector<Index> starOf(Index v) const;
  double starEnergy(Index v, bool stepped) const;
  bool allows(Index f) const;
  bool allowsAll() const;
  void shortenSteps();
  void takeStep();

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
    inset_;         ///< empty or #V: what vertices have yet to move, along axes that are not free
  double rise_ = 0; ///< by which a step may raise the energy of a crushed triangle; 0: any

private:
  void lock(const std::vector<std::uint8_t>& integerVertex);
  void placeCorners(Index v);
  void lockIsoline(Index h);
  void hold(Index v);
  void findInset();
  void makeReferences();
  void makeDirections();
  void chooseAxes();
  int turnsAcross(Index h) const;
  std::vector<double> unitLengths() const;
  AxisEnergy axisEnergy(Index f) const;
  Jacobian jacobian(Index f, const Corners& p) const;
};

} // namespace quadrille

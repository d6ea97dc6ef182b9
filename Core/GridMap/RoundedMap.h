// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Integer-grid maps by rounding: the Poisson solution of a field, whose integers (translations of transitions,
/// places of integer vertices, isolines) are then fixed one at a time [Bommes et al. 2009] or all at once
/// [Kalberer et al. 2007]. What has to be whole is so exactly; nothing keeps triangles from being inverted.
#pragma once

#include "Base/Error.h"
#include "Base/FixedPoint.h"
#include "GridMap/SeamlessSpace.h"
#include "Numerics/IntegerLattice.h"
#include "Numerics/IntegerRounding.h"
#include "Numerics/SparseCholesky.h"

#include <optional>
#include <vector>

namespace quadrille
{

class RoundedMap
{
public:
  /// Everything that does not depend on scale and order: the space, the Poisson solution, the lattice of the integers
  /// and what they have to do with each other (their Schur complement). edgeLength as in SeamlessOptions.
  RoundedMap(const Mesh& mesh, const CrossField& field, double edgeLength);

  /// Not ok where the equations need more than 63 bits, or have no unique solution; make() must not be called then.
  const Status& status() const { return status_; }

  /// #H: the map with whole translations, isolines and integer vertices. The Poisson solution is scaled to an area of
  /// targetQuads (0: as edgeLength has it) before it is rounded, which changes the area again.
  std::vector<FixedVec2> make(double targetQuads, RoundingOrder order) const;

private:
  void collectForms(const CrossField& field);
  bool solvePoisson();
  void relateIntegers();
  std::vector<FixedVec2> unfold(
    const Eigen::VectorXd& y, const std::vector<std::int64_t>& coordinates) const;

  const Mesh& mesh_;
  std::vector<std::uint8_t> integerVertex_;
  SeamlessSpace space_;
  Status status_;
  std::vector<Index>
    form_; ///< per variable of the space: its form; kFree, or kZero where it is always 0
  std::vector<ExactBasis::Row> forms_;
  std::vector<std::uint8_t>
    derived_; ///< #forms: translations, which are to follow from places if possible
  IntegerLattice lattice_;
  SparseCholesky poisson_;
  Eigen::VectorXd solution_;                ///< of the Poisson equation
  Eigen::SparseMatrix<double> coordinates_; ///< #unknowns x #integers, a column a coordinate
  Eigen::MatrixXd schur_;                   ///< #integers x #integers
};

} // namespace quadrille

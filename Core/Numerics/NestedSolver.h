// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Positive definite systems that are sums over the triangles of a mesh, for meshes of hundreds of thousands of
/// vertices:
/// nested dissection [George 1973] by the positions of the vertices and a multifrontal Cholesky factorization [Duff and
/// Reid 1983].
/// No sparse matrix is built: each triangle is asked for its part when its front is factorized.
#pragma once

#include "Base/Types.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace quadrille
{

class NestedSolver
{
public:
  /// What triangle t adds: the leading rows and columns belong to the unknowns of its corners, corner after corner.
  /// Only the lower triangle of the matrix is read. Called from several threads at once.
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Element = std::function<void(Index t, Matrix6& matrix, Vector6& rightSide)>;

  /// Ordering and sizes. position: #V, only for the dissection. unknowns: #V, 0 to 2 a vertex; they are numbered vertex
  /// after vertex.
  /// Every vertex with unknowns must be in a triangle. Throws InvalidInput for sizes that disagree. Looks out for a
  /// stop.
  NestedSolver(const std::vector<Vector3>& position, const std::vector<std::uint8_t>& unknowns,
    const std::vector<std::array<Index, 3>>& triangles);

  Eigen::Index unknowns() const { return static_cast<Eigen::Index>(offset_.back()); }
  /// Memory of a factorization on one thread.
  double bytes() const { return bytes_; }
  /// Multiplications of a factorization.
  double operations() const { return operations_; }

  /// Solves (sum of matrices + shift * identity) x = sum of right sides. False, and x unchanged, when the matrix is not
  /// positive definite. The same bytes for any number of threads (0: all). Looks out for a stop.
  bool solve(const Element& element, double shift, int threads, Eigen::VectorXd& x);

private:
  /// A separator, or a leaf, of the dissection. Vertices are named by their place in the elimination.
  struct Front
  {
    Index first = 0, end = 0;     ///< vertices that are eliminated here
    std::vector<Index> border;    ///< vertices of later fronts that these depend on, ascending
    std::vector<Index> triangles; ///< whose first vertex is eliminated here
    std::array<int, 2> children{ -1, -1 };
    int firstFront = 0;            ///< the subtree is [firstFront, this]
    std::size_t own = 0, rest = 0; ///< unknowns: eliminated here, of the border
    std::vector<double>
      left; ///< (own + rest + 1) by own, by columns; the last row is the right side
    std::vector<double> right; ///< (rest + 1) by rest: what is left for the parent
  };
  struct Dissection;

  void collectTriangles(const std::vector<std::uint8_t>& unknowns);
  void findBorders();
  void measure();
  bool factorize(Front& front, const Element& element, double shift);
  bool factorizeAll(const Element& element, double shift, int threads);
  std::vector<double> substituteBack() const;
  void addTriangles(Front& front, const Element& element) const;
  void addChild(Front& front, Front& child) const;
  double& entry(Front& front, std::size_t row, std::size_t column) const;
  std::size_t indexIn(const Front& front, Index vertex) const;
  std::size_t count(Index vertex) const { return offset_[vertex + 1] - offset_[vertex]; }

  std::vector<std::array<Index, 3>>
    triangles_;                           ///< elimination places; kInvalidIndex without unknowns
  std::vector<Index> vertexAt_;           ///< elimination place -> vertex
  std::vector<std::size_t> offset_;       ///< unknowns before this place; one more than places
  std::vector<std::size_t> firstUnknown_; ///< of the vertex at the place, in the caller's numbering
  std::vector<Front> fronts_;             ///< children before parents
  std::vector<int> roots_; ///< of subtrees that are factorized in parallel, ascending
  double bytes_ = 0, operations_ = 0;
};

} // namespace quadrille

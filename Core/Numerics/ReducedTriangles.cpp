// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/ReducedTriangles.h"

#include "Base/Parallel.h"
#include "Base/Progress.h"
#include "Base/Refuse.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace quadrille
{
namespace
{

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

void checkSizes(const UntangleProblem& problem)
{
  const std::size_t count = problem.triangles.size();
  refuseIf(problem.basis.rows() != problem.offset.size() || problem.offset.size() % 2 != 0 ||
      problem.inverseReference.size() != count || problem.weight.size() != count,
    "untangling: basis, offset, triangles, references and weights disagree in size");
  const std::size_t points = static_cast<std::size_t>(problem.offset.size() / 2);
  for (std::size_t t = 0; t < count; ++t)
  {
    for (const Index point : problem.triangles[t])
    {
      refuseIf(point >= points, "untangling: triangle ", t, " names point ", point,
        ", which does not exist");
    }
  }
}

/// The derivative of J by coordinate `row` of corner `corner`.
Jacobian cornerDerivative(const Eigen::Matrix2d& inverseReference, int corner, int row)
{
  const Eigen::RowVector2d gradient = corner == 0
    ? Eigen::RowVector2d(-inverseReference.row(0) - inverseReference.row(1))
    : Eigen::RowVector2d(inverseReference.row(corner - 1));
  Jacobian result = Jacobian::Zero();
  result[row] = gradient[0];
  result[2 + row] = gradient[1];
  return result;
}

} // namespace

ReducedTriangles::ReducedTriangles(const UntangleProblem& problem)
{
  checkSizes(problem);
  hessian_.resize(problem.basis.cols(), problem.basis.cols());
  collectUnknowns(problem);
  buildPattern();
}

void ReducedTriangles::collectUnknowns(const UntangleProblem& problem)
{
  const RowMatrix basis = problem.basis;
  const std::size_t count = problem.triangles.size();
  begin_.assign(1, 0);
  constant_.assign(count, Jacobian::Zero());
  std::vector<std::pair<int, Jacobian>> terms;
  for (std::size_t t = 0; t < count; ++t)
  {
    pollNowAndThen(t, kHeavyChunk);
    terms.clear();
    for (int i = 0; i < 6; ++i)
    {
      const Jacobian derivative = cornerDerivative(problem.inverseReference[t], i / 2, i % 2);
      const Eigen::Index coordinate = 2 * Eigen::Index(problem.triangles[t][i / 2]) + i % 2;
      constant_[t] += problem.offset[coordinate] * derivative;
      for (RowMatrix::InnerIterator entry(basis, coordinate); entry; ++entry)
      {
        terms.emplace_back(static_cast<int>(entry.col()), entry.value() * derivative);
      }
    }
    std::stable_sort(
      terms.begin(), terms.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& term : terms)
    {
      if (unknown_.size() > begin_[t] && unknown_.back() == term.first)
      {
        matrix_.back() += term.second;
      }
      else
      {
        unknown_.push_back(term.first);
        matrix_.push_back(term.second);
      }
    }
    begin_.push_back(unknown_.size());
  }
}

void ReducedTriangles::buildPattern()
{
  const Eigen::Index count = hessian_.cols();
  // Where each unknown stands among those of the triangles, by unknowns, and where those of the triangle end.
  std::vector<std::size_t> placeBegin(count + 1, 0), place(unknown_.size()), end(unknown_.size());
  for (const int u : unknown_)
  {
    ++placeBegin[u + 1];
  }
  std::partial_sum(placeBegin.begin(), placeBegin.end(), placeBegin.begin());
  std::vector<std::size_t> next(placeBegin.begin(), placeBegin.end() - 1);
  for (std::size_t t = 0; t < triangles(); ++t)
  {
    pollNowAndThen(t, kHeavyChunk);
    for (std::size_t a = begin_[t]; a < begin_[t + 1]; ++a)
    {
      place[next[unknown_[a]]++] = a;
      end[a] = begin_[t + 1];
    }
  }
  std::vector<std::vector<int>> columns(count);
  std::vector<int> start(count + 1, 0);
  std::vector<int> seenBy(count, -1);
  for (int j = 0; j < count; ++j)
  {
    pollNowAndThen(static_cast<std::size_t>(j), kHeavyChunk);
    std::vector<int>& column = columns[j];
    column.push_back(j);
    for (std::size_t i = placeBegin[j]; i < placeBegin[j + 1]; ++i)
    {
      for (std::size_t b = place[i] + 1; b < end[place[i]]; ++b)
      {
        if (std::exchange(seenBy[unknown_[b]], j) != j)
        {
          column.push_back(unknown_[b]);
        }
      }
    }
    std::sort(column.begin(), column.end());
    start[j + 1] = start[j] + static_cast<int>(column.size());
  }
  hessian_.resizeNonZeros(start[count]);
  std::copy(start.begin(), start.end(), hessian_.outerIndexPtr());
  diagonal_.assign(start.begin(), start.end() - 1);
  for (Eigen::Index j = 0; j < count; ++j)
  {
    std::copy(columns[j].begin(), columns[j].end(), hessian_.innerIndexPtr() + start[j]);
  }

  slotBegin_.assign(1, 0);
  for (std::size_t t = 0; t < triangles(); ++t)
  {
    pollNowAndThen(t, kHeavyChunk);
    for (std::size_t a = begin_[t]; a < begin_[t + 1]; ++a)
    {
      const std::vector<int>& column = columns[unknown_[a]];
      auto position = column.begin();
      for (std::size_t b = a; b < begin_[t + 1]; ++b)
      {
        position = std::lower_bound(position, column.end(), unknown_[b]);
        slot_.push_back(start[unknown_[a]] + static_cast<int>(position - column.begin()));
      }
    }
    slotBegin_.push_back(slot_.size());
  }
}

void ReducedTriangles::jacobians(const Eigen::VectorXd& y, std::vector<Jacobian>& result) const
{
  result.resize(triangles());
  for (std::size_t t = 0; t < triangles(); ++t)
  {
    pollNowAndThen(t, kHeavyChunk);
    Jacobian jacobian = constant_[t];
    for (std::size_t a = begin_[t]; a < begin_[t + 1]; ++a)
    {
      jacobian += y[unknown_[a]] * matrix_[a];
    }
    result[t] = jacobian;
  }
}

void ReducedTriangles::assemble(
  const std::vector<Jacobian>& gradients, const std::vector<Eigen::Matrix4d>& hessians)
{
  gradient_.setZero(unknowns());
  double* values = hessian_.valuePtr();
  std::fill(values, values + hessian_.nonZeros(), 0.0);
  for (std::size_t t = 0; t < triangles(); ++t)
  {
    pollNowAndThen(t, kHeavyChunk);
    const int* slot = slot_.data() + slotBegin_[t];
    for (std::size_t a = begin_[t]; a < begin_[t + 1]; ++a)
    {
      gradient_[unknown_[a]] += matrix_[a].dot(gradients[t]);
      const Jacobian image = hessians[t] * matrix_[a];
      for (std::size_t b = a; b < begin_[t + 1]; ++b)
      {
        values[*slot++] += image.dot(matrix_[b]);
      }
    }
  }
}

void ReducedTriangles::analyze()
{
  if (!analyzed_ && unknowns() > 0)
  {
    solver_.analyze(hessian_);
    analyzed_ = true;
  }
}

bool ReducedTriangles::newtonStep(double regularization, Eigen::VectorXd& step)
{
  if (unknowns() == 0)
  {
    step.resize(0);
    return true;
  }
  analyze();
  double mean = 0;
  for (const int entry : diagonal_)
  {
    mean += hessian_.valuePtr()[entry] / static_cast<double>(unknowns());
  }
  const double scale = mean > 0 ? mean : 1.0;
  for (double shift = regularization; shift < 10; shift = std::max(shift * 100, 1e-12))
  {
    factorFlops_ += solver_.factorFlops();
    if (solver_.factorize(hessian_, shift * scale))
    {
      step = -solver_.solve(gradient_);
      if (step.allFinite())
      {
        return true;
      }
    }
  }
  return false;
}

void assembleFit(const UntangleProblem& problem, ReducedTriangles& system)
{
  std::vector<Jacobian> gradients;
  system.jacobians(Eigen::VectorXd::Zero(system.unknowns()), gradients);
  std::vector<Eigen::Matrix4d> hessians(gradients.size());
  for (std::size_t t = 0; t < gradients.size(); ++t)
  {
    gradients[t] = problem.weight[t] * (gradients[t] - Jacobian(1, 0, 0, 1));
    hessians[t] = problem.weight[t] * Eigen::Matrix4d::Identity();
  }
  system.assemble(gradients, hessians);
}

} // namespace quadrille

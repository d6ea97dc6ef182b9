// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/IntegerRounding.h"

#include "Base/Progress.h"
#include "Base/Refuse.h"
#include "Base/Types.h"

#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

/// Above this a double does not tell whole numbers apart.
constexpr double kLargestValue = 1e15;

/// Forms are moved to the front in the order in which they are rounded; the columns of what is rounded are those of the
/// Cholesky factor, the rest is the Schur complement that tells how the other forms follow.
class Rounding
{
public:
  Rounding(const Eigen::MatrixXd& schur, const Eigen::VectorXd& x,
    const std::vector<std::uint8_t>& last, RoundingOrder order)
    : matrix_(schur), x_(x), last_(last), order_(order), step_(x.size()), form_(x.size()),
      value_(x.size())
  {
    for (Eigen::Index i = 0; i < x.size(); ++i)
    {
      form_[static_cast<std::size_t>(i)] = i;
      plain_ += last[static_cast<std::size_t>(i)] == 0 ? 1 : 0;
    }
  }

  RoundedForms run()
  {
    Eigen::VectorXd wanted = x_; // at the beginning of the batch, by the form's own number
    for (Eigen::Index i = 0; i < x_.size(); ++i)
    {
      poll();
      if (i == plain_)
      {
        for (Eigen::Index j = i; j < x_.size(); ++j)
        {
          wanted[form(j)] = x_[j];
        }
      }
      const Eigen::Index chosen = choose(i);
      moveTo(i, chosen);
      fix(i, order_ == RoundingOrder::OneAtATime ? x_[i] : wanted[form(i)]);
    }
    return finish();
  }

private:
  Eigen::Index form(Eigen::Index i) const { return form_[static_cast<std::size_t>(i)]; }
  bool isLast(Eigen::Index i) const { return last_[static_cast<std::size_t>(form(i))] != 0; }

  /// Of the same distance, the one with the lowest number.
  Eigen::Index choose(Eigen::Index begin) const
  {
    Eigen::Index best = -1;
    double bestDistance = kInfinity;
    for (Eigen::Index j = begin; j < x_.size(); ++j)
    {
      if (isLast(j) != (begin >= plain_))
      {
        continue;
      }
      const double distance =
        order_ == RoundingOrder::OneAtATime ? std::abs(x_[j] - std::round(x_[j])) : 0.0;
      if (best < 0 || distance < bestDistance || (distance == bestDistance && form(j) < form(best)))
      {
        best = j;
        bestDistance = distance;
      }
    }
    return best;
  }

  void moveTo(Eigen::Index i, Eigen::Index j)
  {
    if (i != j)
    {
      matrix_.row(i).swap(matrix_.row(j));
      matrix_.col(i).swap(matrix_.col(j));
      std::swap(x_[i], x_[j]);
      std::swap(form_[static_cast<std::size_t>(i)], form_[static_cast<std::size_t>(j)]);
    }
  }

  void fix(Eigen::Index i, double wanted)
  {
    const double pivot = matrix_(i, i);
    refuseIf(!(pivot > 0) || !(std::abs(wanted) < kLargestValue),
      "rounding: the forms depend on each other, or their values are too large");
    const Eigen::Index rest = x_.size() - i - 1;
    const double whole = std::round(wanted);
    value_[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(whole);
    const double root = std::sqrt(pivot);
    step_[i] = (whole - x_[i]) / root;
    matrix_(i, i) = root;
    matrix_.col(i).tail(rest) /= root;
    x_[i] = whole;
    x_.tail(rest) += step_[i] * matrix_.col(i).tail(rest);
    matrix_.bottomRightCorner(rest, rest).noalias() -=
      matrix_.col(i).tail(rest) * matrix_.col(i).tail(rest).transpose();
  }

  /// With schur = L L^T the steps are L^-1 of the change of all forms.
  RoundedForms finish() const
  {
    const Eigen::VectorXd ordered = matrix_.triangularView<Eigen::Lower>().transpose().solve(step_);
    RoundedForms result;
    result.value.resize(value_.size());
    result.multiplier.resize(x_.size());
    for (Eigen::Index i = 0; i < x_.size(); ++i)
    {
      result.value[static_cast<std::size_t>(form(i))] = value_[static_cast<std::size_t>(i)];
      result.multiplier[form(i)] = ordered[i];
    }
    return result;
  }

  Eigen::MatrixXd matrix_;
  Eigen::VectorXd x_;
  const std::vector<std::uint8_t>& last_;
  RoundingOrder order_;
  Eigen::VectorXd step_;            ///< by place
  std::vector<Eigen::Index> form_;  ///< by place
  std::vector<std::int64_t> value_; ///< by place
  Eigen::Index plain_ = 0;
};

} // namespace

RoundedForms roundForms(const Eigen::MatrixXd& schur, const Eigen::VectorXd& x,
  const std::vector<std::uint8_t>& last, RoundingOrder order)
{
  refuseIf(schur.rows() != x.size() || schur.cols() != x.size() ||
      last.size() != static_cast<std::size_t>(x.size()),
    "rounding: matrix, values and flags disagree in size");
  return Rounding(schur, x, last, order).run();
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Numerics/LocalProblem.h"

#include "Base/Refuse.h"

#include <algorithm>
#include <cstddef>

namespace quadrille
{
namespace
{

using Entries = Eigen::SparseMatrix<double>::InnerIterator;

bool movesNear(
  const UntangleProblem& whole, Eigen::Index unknown, const std::vector<std::uint8_t>& isNear)
{
  for (Entries entry(whole.basis, unknown); entry; ++entry)
  {
    if (isNear[static_cast<std::size_t>(entry.row() / 2)] != 0)
    {
      return true;
    }
  }
  return false;
}

} // namespace

Eigen::VectorXd LocalProblem::put(const Eigen::VectorXd& local, Eigen::VectorXd y) const
{
  for (std::size_t i = 0; i < unknowns.size(); ++i)
  {
    y[unknowns[i]] = local[static_cast<Eigen::Index>(i)];
  }
  return y;
}

LocalProblem localProblem(
  const UntangleProblem& whole, const Eigen::VectorXd& y, const std::vector<std::uint8_t>& isNear)
{
  refuseIf(y.size() != whole.basis.cols() ||
      2 * static_cast<Eigen::Index>(isNear.size()) != whole.basis.rows(),
    "local problem: unknowns or points have not the size of the whole problem");
  LocalProblem local;
  Eigen::VectorXd held = y;
  std::vector<std::uint8_t> isMoved(isNear.size(), 0);
  for (Eigen::Index unknown = 0; unknown < whole.basis.cols(); ++unknown)
  {
    if (!movesNear(whole, unknown, isNear))
    {
      continue;
    }
    local.unknowns.push_back(static_cast<Index>(unknown));
    held[unknown] = 0;
    for (Entries entry(whole.basis, unknown); entry; ++entry)
    {
      isMoved[static_cast<std::size_t>(entry.row() / 2)] = 1;
    }
  }
  std::vector<Index> pointOf(isNear.size(), kInvalidIndex), points;
  for (Index t = 0; t < whole.triangles.size(); ++t)
  {
    std::array<Index, 3> corners = whole.triangles[t];
    if (std::none_of(corners.begin(), corners.end(), [&](Index p) { return isMoved[p] != 0; }))
    {
      continue;
    }
    for (Index& p : corners)
    {
      if (pointOf[p] == kInvalidIndex)
      {
        pointOf[p] = static_cast<Index>(points.size());
        points.push_back(p);
      }
      p = pointOf[p];
    }
    local.triangles.push_back(t);
    local.problem.triangles.push_back(corners);
    local.problem.inverseReference.push_back(whole.inverseReference[t]);
    local.problem.weight.push_back(whole.weight[t]);
  }
  const Eigen::VectorXd place = whole.basis * held + whole.offset;
  const auto rows = 2 * static_cast<Eigen::Index>(points.size());
  local.problem.offset.resize(rows);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    local.problem.offset.segment<2>(2 * static_cast<Eigen::Index>(i)) =
      place.segment<2>(2 * static_cast<Eigen::Index>(points[i]));
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < local.unknowns.size(); ++i)
  {
    for (Entries entry(whole.basis, local.unknowns[i]); entry; ++entry)
    {
      const Index p = pointOf[static_cast<std::size_t>(entry.row() / 2)];
      if (p != kInvalidIndex)
      {
        entries.emplace_back(
          static_cast<int>(2 * p + entry.row() % 2), static_cast<int>(i), entry.value());
      }
    }
  }
  local.problem.basis.resize(rows, static_cast<Eigen::Index>(local.unknowns.size()));
  local.problem.basis.setFromTriplets(entries.begin(), entries.end());
  return local;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Weighted values on a line: what a measure is over a surface, each value with the area that has it.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace quadrille
{

class WeightedDistribution
{
public:
  WeightedDistribution() = default;
  /// Values and their weights, as many of one as of the other. Entries without a weight above 0 are left out. Throws
  /// InvalidInput where the sizes differ or a number is not finite.
  WeightedDistribution(const std::vector<double>& values, const std::vector<double>& weights);

  bool isEmpty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  /// The sum of the weights.
  double total() const { return total_; }
  /// Weighted; 0 where empty, as the following ones.
  double mean() const;
  double minimum() const;
  double maximum() const;
  /// The least value that has at least this part of the weight at or below it; part in [0, 1].
  double quantile(double part) const;
  /// The share of the weight in each bin: bin i holds values in [edges[i], edges[i + 1]); what is beyond the ends is
  /// in the first and the last bin, so that the shares add up to 1 (to 0 where empty). Throws InvalidInput unless there
  /// are two edges at least and they ascend.
  std::vector<double> histogram(const std::vector<double>& edges) const;

  /// Values, ascending, with their weights.
  const std::vector<std::pair<double, double>>& entries() const { return entries_; }

private:
  std::vector<std::pair<double, double>> entries_;
  double total_ = 0;
};

/// The first Wasserstein distance of two distributions, each with its total as 1: the area between the two cumulative
/// distribution functions, in units of the values; exact, not of histograms [Rubner et al. 1998]. 0 where both are
/// empty; throws InvalidInput where only one is.
double wassersteinDistance(const WeightedDistribution& a, const WeightedDistribution& b);

} // namespace quadrille

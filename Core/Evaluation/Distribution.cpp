// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/Distribution.h"

#include "Base/Refuse.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{

WeightedDistribution::WeightedDistribution(
  const std::vector<double>& values, const std::vector<double>& weights)
{
  refuseIf(values.size() != weights.size(), "distribution: there are ", values.size(),
    " values, but ", weights.size(), " weights");
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    refuseIf(!std::isfinite(values[i]) || !std::isfinite(weights[i]),
      "distribution: a value or a weight is not finite");
    if (weights[i] > 0)
    {
      entries_.emplace_back(values[i], weights[i]);
      total_ += weights[i];
    }
  }
  std::sort(entries_.begin(), entries_.end());
}

double WeightedDistribution::mean() const
{
  double sum = 0;
  for (const auto& [value, weight] : entries_)
  {
    sum += value * weight;
  }
  return isEmpty() ? 0 : sum / total_;
}

double WeightedDistribution::minimum() const
{
  return isEmpty() ? 0 : entries_.front().first;
}

double WeightedDistribution::maximum() const
{
  return isEmpty() ? 0 : entries_.back().first;
}

double WeightedDistribution::quantile(double part) const
{
  double below = 0;
  for (const auto& [value, weight] : entries_)
  {
    below += weight;
    if (below >= part * total_)
    {
      return value;
    }
  }
  return maximum();
}

std::vector<double> WeightedDistribution::histogram(const std::vector<double>& edges) const
{
  refuseIf(edges.size() < 2 || !std::is_sorted(edges.begin(), edges.end()),
    "histogram: it needs two edges of bins at least, and they have to ascend");
  std::vector<double> shares(edges.size() - 1, 0.0);
  for (const auto& [value, weight] : entries_)
  {
    const auto above = std::upper_bound(edges.begin(), edges.end(), value) - edges.begin();
    const auto bin =
      std::clamp<std::ptrdiff_t>(above - 1, 0, static_cast<std::ptrdiff_t>(shares.size()) - 1);
    shares[static_cast<std::size_t>(bin)] += weight / total_;
  }
  return shares;
}

double wassersteinDistance(const WeightedDistribution& a, const WeightedDistribution& b)
{
  refuseIf(
    a.isEmpty() != b.isEmpty(), "Wasserstein distance: one of the two distributions is empty");
  double sum = 0, last = 0, shareA = 0, shareB = 0;
  auto i = a.entries().begin();
  auto j = b.entries().begin();
  while (i != a.entries().end() || j != b.entries().end())
  {
    const bool fromA = j == b.entries().end() || (i != a.entries().end() && i->first <= j->first);
    const double value = fromA ? i->first : j->first;
    sum += std::abs(shareA - shareB) * (value - last);
    last = value;
    if (fromA)
    {
      shareA += i->second / a.total();
      ++i;
    }
    else
    {
      shareB += j->second / b.total();
      ++j;
    }
  }
  return sum;
}

} // namespace quadrille

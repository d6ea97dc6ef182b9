// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/PlaneBoundary.h"

#include "Base/Progress.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{

PlaneBoundary::PlaneBoundary(const MirrorHalf& half, const MirrorPlane& plane, double tolerance)
  : input_(half.input)
{
  inPlane_.reserve(input_.points.size());
  for (const Vector3& p : input_.points)
  {
    inPlane_.push_back(std::abs(plane.height(p)) <= tolerance ? 1 : 0);
  }
  findEdges();
}

std::vector<std::vector<Index>> PlaneBoundary::chains() const
{
  std::vector<std::uint8_t> hasBefore(input_.polygonPoints.size(), 0), done(hasBefore);
  for (const Index edge : inside_)
  {
    const std::optional<Index> next = after(edge);
    if (next)
    {
      hasBefore[*next] = 1;
    }
  }
  std::vector<std::vector<Index>> chains;
  for (const bool open : { true, false })
  {
    for (const Index first : inside_)
    {
      if (done[first] != 0 || (open && hasBefore[first] != 0))
      {
        continue;
      }
      chains.emplace_back();
      for (std::optional<Index> edge = first; edge && done[*edge] == 0; edge = after(*edge))
      {
        done[*edge] = 1;
        chains.back().push_back(*edge);
      }
    }
  }
  return chains;
}

std::vector<Index> PlaneBoundary::featuresAt() const
{
  std::vector<Index> count(input_.points.size(), 0);
  for (const auto& [ends, edge] : edgeBetween_)
  {
    const bool isFeature =
      !input_.featureEdges.empty() && (input_.featureEdges[edge / 3] >> edge % 3 & 1U) != 0;
    if (isFeature && ends.first < ends.second && twin(edge))
    {
      count[ends.first] += inPlane_[ends.first];
      count[ends.second] += inPlane_[ends.second];
    }
  }
  return count;
}

void PlaneBoundary::findEdges()
{
  for (Index edge = 0; edge < input_.polygonPoints.size(); ++edge)
  {
    const Index first = edge / 3 * 3;
    pollNowAndThen(edge);
    const bool touches =
      (inPlane_[from(first)] | inPlane_[from(first + 1)] | inPlane_[from(first + 2)]) != 0;
    if (touches)
    {
      edgeBetween_[{ from(edge), to(edge) }] = edge;
    }
  }
  for (const auto& [ends, edge] : edgeBetween_)
  {
    if (inPlane_[ends.first] != 0 && inPlane_[ends.second] != 0 && !twin(edge))
    {
      inside_.push_back(edge);
    }
  }
  std::sort(inside_.begin(), inside_.end());
}

std::optional<Index> PlaneBoundary::twin(Index edge) const
{
  const auto found = edgeBetween_.find({ to(edge), from(edge) });
  return found == edgeBetween_.end() ? std::nullopt : std::optional<Index>(found->second);
}

std::optional<Index> PlaneBoundary::after(Index edge) const
{
  Index next = Mesh::next(edge);
  for (std::optional<Index> across = twin(next); across; across = twin(next))
  {
    next = Mesh::next(*across);
  }
  return inPlane_[to(next)] != 0 ? std::optional<Index>(next) : std::nullopt;
}

} // namespace quadrille

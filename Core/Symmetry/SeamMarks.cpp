// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Symmetry/SeamMarks.h"

#include <algorithm>
#include <array>
#include <limits>

namespace quadrille
{

/// Places along a chain, but its ends, at which features end.
std::vector<std::size_t> SeamMarks::featureEnds(const BorderChain& chain) const
{
  std::vector<std::size_t> ends;
  for (std::size_t i = chain.closed ? 0 : 1; i < chain.edges.size(); ++i)
  {
    bool isEnd = false;
    Index h = Mesh::previous(chain.edges[i]);
    while (!cut_.isBoundary(h))
    {
      isEnd = isEnd || cut_.isFeature(h);
      h = Mesh::previous(cut_.twin[h]);
    }
    if (isEnd)
    {
      ends.push_back(i);
    }
  }
  return ends;
}

SeamMarks::Course SeamMarks::courseOf(const BorderChain& chain, bool backwards) const
{
  Course course{ &chain, backwards, { 0 }, 0 };
  for (const Index h : chain.edges)
  {
    course.arc.push_back(course.arc.back() + cut_.edgeVector(h).norm());
  }
  return course;
}

/// Features that end on both sides at each other's images, as they come along the courses: those that lie within
/// reach, with the least sum of distances, where leaving two of them alone costs as much as the reach.
std::vector<SeamMarks::Mark> SeamMarks::alignFeatures(const Course& first,
  const std::vector<std::size_t>& here, const Course& second,
  const std::vector<std::size_t>& there) const
{
  const std::size_t n = here.size(), m = there.size();
  const double alone = alignReach_ / 2;
  std::vector<double> cost((n + 1) * (m + 1), 0);
  const auto at = [m](std::size_t i, std::size_t j) { return i * (m + 1) + j; };
  const auto pairCost = [&](std::size_t i, std::size_t j)
  { return distance(first, here[i], second, there[j]); };
  for (std::size_t i = 0; i <= n; ++i)
  {
    for (std::size_t j = 0; j <= m; ++j)
    {
      double& best = cost[at(i, j)];
      best = alone * static_cast<double>(i + j);
      best = i > 0 ? std::min(best, cost[at(i - 1, j)] + alone) : best;
      best = j > 0 ? std::min(best, cost[at(i, j - 1)] + alone) : best;
      best =
        i > 0 && j > 0 ? std::min(best, cost[at(i - 1, j - 1)] + pairCost(i - 1, j - 1)) : best;
    }
  }
  std::vector<Mark> marks;
  for (std::size_t i = n, j = m; i > 0 && j > 0;)
  {
    if (cost[at(i, j)] == cost[at(i - 1, j - 1)] + pairCost(i - 1, j - 1))
    {
      marks.push_back({ first.at(here[--i]), second.at(there[--j]) });
    }
    else if (cost[at(i, j)] == cost[at(i - 1, j)] + alone)
    {
      --i;
    }
    else
    {
      --j;
    }
  }
  std::reverse(marks.begin(), marks.end());
  return marks;
}

/// Closed courses begin where features end at each other's images, else at a vertex and the place nearest to its
/// image.
void SeamMarks::beginClosed(Course& first, const std::vector<std::size_t>& here, Course& second,
  const std::vector<std::size_t>& there) const
{
  double nearest = alignReach_;
  first.begin = 0;
  bool found = false;
  for (const std::size_t i : here)
  {
    for (const std::size_t j : there)
    {
      const double apart = distance(first, i, second, j);
      if (apart <= nearest)
      {
        nearest = apart;
        found = true;
        first.begin = first.arc[i];
        second.begin = second.total() - second.arc[j];
      }
    }
  }
  if (!found)
  {
    second.begin =
      second.total() - nearestWay(second, rotation_.image(first.chain->place(cut_, 0)));
  }
  const auto wrapped = [](Course& course)
  { course.begin = course.begin >= course.total() ? 0 : course.begin; };
  wrapped(first);
  wrapped(second);
}

/// Of a place, along the chain.
double SeamMarks::nearestWay(const Course& course, const Vector3& p) const
{
  double nearest = kInfinity;
  double way = 0;
  for (std::size_t i = 0; i < course.chain->edges.size(); ++i)
  {
    const Vector3& from = course.chain->place(cut_, i);
    const Vector3 along = cut_.edgeVector(course.chain->edges[i]);
    const double length = std::max(along.squaredNorm(), std::numeric_limits<double>::min());
    const double share = std::clamp(along.dot(p - from) / length, 0.0, 1.0);
    const double apart = (from + share * along - p).norm();
    if (apart < nearest)
    {
      nearest = apart;
      way = course.arc[i] + share * along.norm();
    }
  }
  return way;
}

/// A mark for a feature that ends on one side only: on the other one between the same marks, as far along.
void SeamMarks::addLone(
  std::vector<Mark>& marks, double way, double Mark::*here, double Mark::*there)
{
  const auto after = std::find_if(
    marks.begin() + 1, marks.end(), [&](const Mark& mark) { return mark.*here >= way; });
  const Mark& before = *(after - 1);
  const double span = (*after).*here - before.*here;
  if (after == marks.end() || !(way > before.*here) || !(way < (*after).*here) || !(span > 0))
  {
    return; // there is a mark
  }
  Mark mark;
  mark.*here = way;
  mark.*there = before.*there + (way - before.*here) / span * ((*after).*there - before.*there);
  marks.insert(after, mark);
}

void SeamMarks::add(
  const BorderChain& firstChain, const BorderChain& secondChain, SurfacePart& wedge)
{
  Course first = courseOf(firstChain, false), second = courseOf(secondChain, true);
  std::vector<std::size_t> here = featureEnds(firstChain), there = featureEnds(secondChain);
  if (firstChain.closed)
  {
    beginClosed(first, here, second, there);
  }
  const auto sortAlong = [](const Course& course, std::vector<std::size_t>& ends)
  {
    std::sort(ends.begin(), ends.end(),
      [&](std::size_t a, std::size_t b) { return course.at(a) < course.at(b); });
  };
  sortAlong(first, here);
  sortAlong(second, there);
  std::vector<Mark> marks{ { 0, 0 } };
  std::size_t paired = 0;
  for (const Mark& mark : alignFeatures(first, here, second, there))
  {
    // Of closed courses the first one is where they begin.
    paired += mark.first > 0 && mark.second > 0 ? 0U : 1U;
    if (mark.first > 0 && mark.second > 0)
    {
      marks.push_back(mark);
    }
  }
  marks.push_back({ first.total(), second.total() });
  wedge.loneFeatures += here.size() + there.size() - 2 * (marks.size() - 2 + paired);
  for (const std::size_t i : here)
  {
    addLone(marks, first.at(i), &Mark::first, &Mark::second);
  }
  for (const std::size_t i : there)
  {
    addLone(marks, second.at(i), &Mark::second, &Mark::first);
  }
  std::vector<std::array<Vector3, 2>> places;
  places.reserve(marks.size());
  for (const Mark& mark : marks)
  {
    places.push_back({ markPlace(first, mark.first), markPlace(second, mark.second) });
  }
  for (std::size_t i = 0; i + 1 < places.size(); ++i)
  {
    wedge.input.seams.push_back({ places[i][0], places[i + 1][0], places[i][1], places[i + 1][1] });
  }
}

/// The vertex there, or one to be made.
Vector3 SeamMarks::markPlace(const Course& course, double way)
{
  double along = way + (course.chain->closed ? course.begin : 0);
  along -= course.chain->closed && along >= course.total() ? course.total() : 0;
  along = course.backwards ? course.total() - along : along;
  const auto after = std::upper_bound(course.arc.begin(), course.arc.end(), along);
  const std::size_t last = course.chain->edges.size() - 1;
  const std::size_t i = after == course.arc.begin()
    ? 0
    : std::min(last, static_cast<std::size_t>(after - course.arc.begin()) - 1);
  const double length = course.arc[i + 1] - course.arc[i];
  const double share = length > 0 ? (along - course.arc[i]) / length : 0;
  if (share * length <= tolerance_ || (1 - share) * length <= tolerance_)
  {
    return course.chain->place(cut_, share * length <= tolerance_ ? i : i + 1);
  }
  const Index h = course.chain->edges[i];
  Vector3 p = cut_.position[cut_.origin[h]] + share * cut_.edgeVector(h);
  splits_.push_back({ h, share, p });
  return p;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "DrawnLine.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

constexpr double kOutlineStep = 6; // median steps

double distance(const Pixel& a, const Pixel& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

Place difference(const Place& a, const Place& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

double dot(const Place& a, const Place& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double distance(const Place& a, const Place& b)
{
  const Place way = difference(a, b);
  return std::sqrt(dot(way, way));
}

double distanceToSegment(const Place& place, const Place& begin, const Place& end)
{
  const Place along = difference(end, begin);
  const Place from = difference(place, begin);
  const double squared = dot(along, along);
  const double share = squared > 0 ? std::clamp(dot(from, along) / squared, 0.0, 1.0) : 0;
  return distance(place,
    { begin[0] + share * along[0], begin[1] + share * along[1], begin[2] + share * along[2] });
}

/// 0 of none.
double medianOf(std::vector<double> numbers)
{
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return numbers.empty() ? 0 : *middle;
}

} // namespace

double lengthOf(const std::vector<Pixel>& path)
{
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
  {
    length += distance(path[i - 1], path[i]);
  }
  return length;
}

std::vector<Pixel> evenPath(const std::vector<Pixel>& path, double step)
{
  const double length = lengthOf(path);
  if (path.empty() || length <= 0)
  {
    return path.empty() ? path : std::vector<Pixel>{ path.front() };
  }
  const auto count = static_cast<std::size_t>(std::ceil(length / step));
  std::vector<Pixel> even{ path.front() };
  double passed = 0; // before the segment that ends at i
  std::size_t i = 1;
  for (std::size_t k = 1; k < count; ++k)
  {
    const double wanted = length * static_cast<double>(k) / static_cast<double>(count);
    while (i + 1 < path.size() && passed + distance(path[i - 1], path[i]) < wanted)
    {
      passed += distance(path[i - 1], path[i]);
      ++i;
    }
    const double segment = distance(path[i - 1], path[i]);
    const double share = segment > 0 ? std::min((wanted - passed) / segment, 1.0) : 0;
    even.push_back({ path[i - 1][0] + share * (path[i][0] - path[i - 1][0]),
      path[i - 1][1] + share * (path[i][1] - path[i - 1][1]) });
  }
  even.push_back(path.back());
  return even;
}

std::vector<Pixel> smoothPath(const std::vector<Pixel>& path, std::size_t reach, bool isClosed)
{
  const std::size_t size = path.size();
  std::vector<Pixel> smooth(size);
  for (std::size_t i = 0; i < size; ++i)
  {
    const std::size_t wide = std::min(reach, isClosed ? (size - 1) / 2 : std::min(i, size - 1 - i));
    for (std::size_t k = 0; k < 2 * wide + 1; ++k)
    {
      const Pixel& pixel = path[(i + size + k - wide) % size];
      smooth[i][0] += pixel[0] / static_cast<double>(2 * wide + 1);
      smooth[i][1] += pixel[1] / static_cast<double>(2 * wide + 1);
    }
  }
  return smooth;
}

bool isClosedPath(const std::vector<Pixel>& path, double near)
{
  constexpr double share = 6;
  return path.size() > 2 &&
    distance(path.front(), path.back()) < std::max(near, lengthOf(path) / share);
}

std::vector<Place> longestOnOneSheet(
  const std::vector<std::optional<Place>>& places, double far, std::size_t mostUnseen)
{
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    if (places[i])
    {
      seen.push_back(i);
    }
  }
  std::vector<double> steps;
  for (std::size_t i = 1; i < seen.size(); ++i)
  {
    steps.push_back(distance(*places[seen[i - 1]], *places[seen[i]]));
  }
  const double longestStep = std::max(far, kOutlineStep * medianOf(steps));
  std::vector<Place> longest;
  std::vector<Place> row;
  for (std::size_t i = 0; i < seen.size(); ++i)
  {
    if (i > 0 && (steps[i - 1] > longestStep || seen[i] - seen[i - 1] > mostUnseen + 1))
    {
      row.clear();
    }
    row.push_back(*places[seen[i]]);
    if (row.size() > longest.size())
    {
      longest = row;
    }
  }
  return longest;
}

std::vector<std::size_t> keptPlaces(const std::vector<Place>& places, double tolerance)
{
  std::vector<std::size_t> kept;
  if (places.empty())
  {
    return kept;
  }
  std::vector<bool> isKept(places.size(), false);
  isKept.front() = isKept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{ { 0, places.size() - 1 } };
  while (!open.empty())
  {
    const auto [begin, end] = open.back();
    open.pop_back();
    std::size_t farthest = begin;
    double most = tolerance;
    for (std::size_t i = begin + 1; i < end; ++i)
    {
      const double off = distanceToSegment(places[i], places[begin], places[end]);
      if (off > most)
      {
        most = off;
        farthest = i;
      }
    }
    if (farthest != begin)
    {
      isKept[farthest] = true;
      open.push_back({ begin, farthest });
      open.push_back({ farthest, end });
    }
  }
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    if (isKept[i])
    {
      kept.push_back(i);
    }
  }
  return kept;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/LineParts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace quadrille
{

namespace
{

constexpr int kMostStepsOfLine = 10000; ///< of a line
/// Over the length of an edge: what is nearer to it lies on it.
constexpr double kOnLine = 1e-9;

/// A part of an edge, as a way passes it.
struct Step
{
  Index h = kInvalidIndex;
  double from = 0, to = 1; ///< along the half-edge
};
using Way = std::vector<Step>;

/// Where a place lies on an edge.
std::optional<double> partAt(const Mesh& mesh, Index h, const Vector3& place)
{
  const Vector3 edge = mesh.edgeVector(h), way = place - mesh.position[mesh.origin[h]];
  const double squared = edge.squaredNorm();
  if (!(squared > 0))
  {
    return std::nullopt;
  }
  const double t = std::clamp(way.dot(edge) / squared, 0.0, 1.0);
  return (way - t * edge).squaredNorm() <= kOnLine * kOnLine * squared ? std::optional<double>(t)
                                                                       : std::nullopt;
}

/// From a place on a curve to the first of the ends, 0 or 1, behind it.
std::optional<std::size_t> walkTo(
  const Mesh& mesh, const std::array<Vector3, 2>& ends, Step step, Way& way)
{
  for (int i = 0; i < kMostStepsOfLine; ++i)
  {
    const bool forwards = step.to > step.from;
    std::optional<std::size_t> end;
    for (const std::size_t k : { 0, 1 })
    {
      const std::optional<double> t = partAt(mesh, step.h, ends[k]);
      if (t && (forwards ? *t > step.from && *t <= step.to : *t < step.from && *t >= step.to))
      {
        end = k;
        step.to = *t;
      }
    }
    way.push_back(step);
    if (end)
    {
      return end;
    }
    const Index vertex = forwards ? mesh.target(step.h) : mesh.origin[step.h];
    const std::optional<Index> next = continueCurve(mesh, step.h, forwards);
    if (!next)
    {
      return std::nullopt;
    }
    step = mesh.origin[*next] == vertex ? Step{ *next, 0, 1 } : Step{ *next, 1, 0 };
  }
  return std::nullopt;
}

Way reversed(Way way)
{
  std::reverse(way.begin(), way.end());
  for (Step& step : way)
  {
    std::swap(step.from, step.to);
  }
  return way;
}

/// From the first end to the second one.
std::optional<Way> wayBetween(const Mesh& mesh, Index h, const std::array<Vector3, 2>& ends)
{
  for (const std::size_t k : { 0, 1 })
  {
    const std::optional<double> t = partAt(mesh, h, ends[k]);
    for (const double to : { 1.0, 0.0 })
    {
      Way way;
      if (t && *t != to && walkTo(mesh, ends, { h, *t, to }, way) == 1 - k)
      {
        return k == 0 ? way : reversed(std::move(way));
      }
    }
  }
  Way there, back;
  const std::optional<std::size_t> end = walkTo(mesh, ends, { h, 0.5, 1 }, there);
  const std::optional<std::size_t> begin = walkTo(mesh, ends, { h, 0.5, 0 }, back);
  if (!end || !begin || *end == *begin)
  {
    return std::nullopt;
  }
  Way way = reversed(std::move(back));
  way.insert(way.end(), there.begin(), there.end());
  return *end == 1 ? way : reversed(std::move(way));
}

} // namespace

std::vector<CurvePoint> partLine(
  const Mesh& mesh, const QuadMesh& quads, const QuadLine& line, std::size_t parts)
{
  if (line.halfEdge == kInvalidIndex)
  {
    return {};
  }
  const std::optional<Way> way =
    wayBetween(mesh, line.halfEdge, { quads.points[line.a], quads.points[line.b] });
  if (!way)
  {
    return {};
  }
  const auto lengthOf = [&](const Step& step)
  { return std::abs(step.to - step.from) * mesh.edgeVector(step.h).norm(); };
  double all = 0;
  for (const Step& step : *way)
  {
    all += lengthOf(step);
  }
  std::vector<CurvePoint> points;
  double gone = 0;
  for (const Step& step : *way)
  {
    const double length = lengthOf(step);
    for (double at = all * static_cast<double>(points.size() + 1) / static_cast<double>(parts);
         points.size() + 1 < parts && at <= gone + length;
         at = all * static_cast<double>(points.size() + 1) / static_cast<double>(parts))
    {
      const double share = length > 0 ? (at - gone) / length : 0;
      points.push_back({ step.h, step.from + share * (step.to - step.from) });
    }
    gone += length;
  }
  return points.size() + 1 == parts ? points : std::vector<CurvePoint>{};
}

} // namespace quadrille

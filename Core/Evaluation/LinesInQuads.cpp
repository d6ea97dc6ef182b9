// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/LinesInQuads.h"

#include "Mesh/Distance.h"

#include <algorithm>
#include <limits>

namespace quadrille
{

namespace
{

/// In edges of quads: how far a line that ends at a feature or boundary may end from the place asked for.
constexpr double kReachInQuads = 3;
/// How far a closed line may lie from the curve: it is straight in the map, the curve need not be. The table tells how
/// far it does.
constexpr double kReachOfCycle = 6;

double meanQuadEdge(const QuadMesh& mesh)
{
  double sum = 0;
  for (const std::array<Index, 4>& quad : mesh.quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      sum += (mesh.points[quad[i]] - mesh.points[quad[(i + 1) % 4]]).norm();
    }
  }
  return mesh.quads.empty() ? 0 : sum / (4 * static_cast<double>(mesh.quads.size()));
}

bool isIrregular(const QuadMesh& mesh, Index p)
{
  return mesh.valence[p] != (mesh.onBoundary[p] != 0 ? 3 : 4);
}

} // namespace

bool isLine(const PlacedConstraint& constraint)
{
  return constraint.kind == ConstraintKind::Connection || constraint.kind == ConstraintKind::Cycle;
}

LinesInQuads::LinesInQuads(const QuadMesh& mesh)
  : mesh_(mesh), chains_(mesh), edgeLength_(meanQuadEdge(mesh))
{
}

std::vector<Vector3> LinesInQuads::chainOf(
  const PlacedConstraint& constraint, const std::vector<CurveOutcome>& outcomes) const
{
  return constraint.curve < outcomes.size() && !mesh_.quads.empty()
    ? chainOf(constraint, outcomes[constraint.curve])
    : std::vector<Vector3>{};
}

std::vector<Vector3> LinesInQuads::chainOf(
  const PlacedConstraint& constraint, const CurveOutcome& outcome) const
{
  const double reach = kReachInQuads * edgeLength_;
  std::vector<Index> chain;
  if (constraint.kind == ConstraintKind::Cycle)
  {
    chain =
      chains_.closedNear(std::vector<Vector3>(constraint.path.begin(), constraint.path.end() - 1),
        kReachOfCycle * edgeLength_);
  }
  else if (outcome.from != kInvalidIndex)
  {
    chain = between(outcome.start, outcome.end, reach);
  }
  std::vector<Vector3> points;
  points.reserve(chain.size());
  for (const Index p : chain)
  {
    points.push_back(mesh_.points[p]);
  }
  return points;
}

/// From irregular point to irregular point, or from one to a feature or boundary; a corner of these is a point, too.
std::vector<Index> LinesInQuads::between(
  const Vector3& start, const Vector3& end, double reach) const
{
  const auto candidates = [&](const Vector3& place)
  {
    std::vector<Index> points{ chains_.nearestPoint(place) };
    const std::optional<Index> irregular = chains_.nearestIrregular(place);
    if (irregular && (mesh_.points[*irregular] - place).norm() <= reach)
    {
      points.insert(points.begin(), *irregular);
    }
    return points;
  };
  for (const Index a : candidates(start))
  {
    for (const Index b : candidates(end))
    {
      std::vector<Index> chain = chains_.between(a, b);
      if (!chain.empty())
      {
        return chain;
      }
    }
  }
  for (const auto& [from, to] : { std::pair(start, end), std::pair(end, start) })
  {
    const Index a = candidates(from).front();
    std::vector<Index> chain =
      isIrregular(mesh_, a) ? chains_.toLine(a, to, reach) : std::vector<Index>{};
    if (!chain.empty())
    {
      return chain;
    }
  }
  return {};
}

std::pair<double, Vector3> farthestFrom(
  const std::vector<Vector3>& polyline, const std::vector<Vector3>& chain)
{
  std::pair<double, Vector3> worst{ -1, Vector3::Zero() };
  for (const Vector3& p : chain)
  {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < polyline.size(); ++i)
    {
      least = std::min(least, distanceToSegment(p, polyline[i], polyline[i + 1]));
    }
    worst = least > worst.first ? std::pair(least, p) : worst;
  }
  return worst;
}

} // namespace quadrille

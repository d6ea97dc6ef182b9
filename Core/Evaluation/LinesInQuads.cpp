// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Evaluation/LinesInQuads.h"

#include "Requests/GuidedPlaces.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace quadrille
{

namespace
{

/// A closed chain that is so many times as long as its line goes round more than once.
constexpr double kOnceRound = 1.9;
/// Places an edge length at which lines are compared.
constexpr double kLinePlacesAnEdge = 4;

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

double lengthOf(const std::vector<Vector3>& line)
{
  double length = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
  {
    length += (line[i + 1] - line[i]).norm();
  }
  return length;
}

/// Compares chains with a line.
class LineComparison
{
public:
  LineComparison(const std::vector<Vector3>& line, double edgeLength)
    : step_(edgeLength / kLinePlacesAnEdge), edgeLength_(edgeLength), places_(sampled(line)),
      segments_(line)
  {
  }

  double distance(const Vector3& place) const { return segments_.at(place).distance / edgeLength_; }

  void compare(LineInQuads& found) const
  {
    const std::pair<double, Vector3> to = farthest(sampled(found.chain), segments_);
    const std::pair<double, Vector3> back = farthest(places_, NearestSegments(found.chain));
    std::tie(found.distance, found.place) = to.first < back.first ? back : to;
    found.distance /= edgeLength_;
  }

private:
  /// Its points, and places between them at most a step apart.
  std::vector<Vector3> sampled(const std::vector<Vector3>& line) const
  {
    std::vector<Vector3> places;
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
    {
      const Vector3 along = line[i + 1] - line[i];
      const double parts = std::max(1.0, std::ceil(along.norm() / step_));
      for (double k = 0; k < parts; ++k)
      {
        places.push_back(line[i] + k / parts * along);
      }
    }
    places.push_back(line.back());
    return places;
  }

  static std::pair<double, Vector3> farthest(
    const std::vector<Vector3>& places, const NearestSegments& line)
  {
    std::pair<double, Vector3> worst{ -1, Vector3::Zero() };
    for (const Vector3& p : places)
    {
      const double distance = line.at(p).distance;
      worst = distance > worst.first ? std::pair(distance, p) : worst;
    }
    return worst;
  }

  double step_, edgeLength_;
  std::vector<Vector3> places_;
  NearestSegments segments_;
};

/// Takes what was found where it is better.
void keepBetter(std::optional<LineInQuads>& best, LineInQuads&& found)
{
  const auto rank = [](const LineInQuads& line) { return std::pair(!line.isMet(), line.distance); };
  if (found.distance <= kNearLine && (!best || rank(found) < rank(*best)))
  {
    best = std::move(found);
  }
}

} // namespace

bool isLine(const PlacedConstraint& constraint)
{
  return constraint.kind == ConstraintKind::Connection || constraint.kind == ConstraintKind::Cycle;
}

LinesInQuads::LinesInQuads(const QuadMesh& mesh, const NearestQuads& nearest)
  : mesh_(mesh), nearest_(nearest), chains_(mesh), edgeLength_(meanQuadEdge(mesh)),
    isEnd_(mesh.points.size(), 0)
{
  for (std::size_t p = 0; p < isEnd_.size(); ++p)
  {
    isEnd_[p] = mesh.onBoundary[p] != 0 || mesh.valence[p] != kRegularValence ? 1 : 0;
  }
  for (const QuadLine& line : mesh.lines)
  {
    isEnd_[line.a] = isEnd_[line.b] = 1;
  }
}

std::optional<LineInQuads> LinesInQuads::find(const PlacedConstraint& constraint) const
{
  return constraint.kind == ConstraintKind::Cycle ? findCycle(constraint.path)
                                                  : findConnection(constraint.path);
}

LineInQuads LinesInQuads::lineOf(const std::vector<Index>& chain) const
{
  LineInQuads line;
  line.points = chain;
  line.chain.reserve(chain.size());
  for (const Index p : chain)
  {
    line.chain.push_back(mesh_.points[p]);
  }
  return line;
}

std::optional<LineInQuads> LinesInQuads::findCycle(const std::vector<Vector3>& path) const
{
  const LineComparison line(path, edgeLength_);
  std::optional<LineInQuads> best;
  for (const std::vector<Index>& chain :
    chains_.closedNear(std::vector<Vector3>(path.begin(), path.end() - 1), kNearLine * edgeLength_))
  {
    LineInQuads found = lineOf(chain);
    if (lengthOf(found.chain) <= kOnceRound * lengthOf(path))
    {
      line.compare(found);
      keepBetter(best, std::move(found));
    }
  }
  return best;
}

std::optional<LineInQuads> LinesInQuads::findConnection(const std::vector<Vector3>& path) const
{
  const LineComparison line(path, edgeLength_);
  const NearestQuads::Place start = *nearest_.at(path.front());
  const NearestQuads::Place end = *nearest_.at(path.back());
  const QuadSide startSide = nearest_.sideOf(start), endSide = nearest_.sideOf(end);
  std::optional<LineInQuads> best;
  for (Index first = 0; first < mesh_.points.size(); ++first)
  {
    const double startOff = (mesh_.points[first] - path.front()).norm() / start.edgeLength;
    if (isEnd_[first] == 0 || !(startOff <= kReachOfEnds) || !startSide.has(first))
    {
      continue;
    }
    chains_.followAll(first,
      [&](const std::vector<Index>& chain)
      {
        const Vector3& last = mesh_.points[chain.back()];
        const double endOff = (last - path.back()).norm() / end.edgeLength;
        if (isEnd_[chain.back()] != 0 && endOff <= kReachOfEnds && endSide.has(chain.back()))
        {
          LineInQuads found = lineOf(chain);
          line.compare(found);
          found.ends = std::max(startOff, endOff);
          found.end = startOff > endOff ? mesh_.points[first] : last;
          keepBetter(best, std::move(found));
        }
        return chain.back() != first && line.distance(last) <= kNearLine;
      });
  }
  return best;
}

} // namespace quadrille

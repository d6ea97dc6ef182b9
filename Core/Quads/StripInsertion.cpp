// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/StripInsertion.h"

#include "Quads/QuadMesh.h"
#include "Quads/QuadTopology.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <queue>
#include <set>
#include <tuple>

namespace quadrille
{

namespace
{

/// Over that of a step straight on, of a path through an irregular point; a turn makes two of them.
constexpr double kIrregularCost = 10;

/// A point at the same place, on the other side of the strip.
void addCopy(QuadMesh& mesh, Index p, InsertedStrip& strip)
{
  strip.points.emplace_back(p, static_cast<Index>(mesh.points.size()));
  mesh.points.push_back(Vector3(mesh.points[p]));
  mesh.sourceFace.push_back(Index{ mesh.sourceFace[p] });
  mesh.sourceWeights.push_back(std::array<double, 3>(mesh.sourceWeights[p]));
}

/// Lines of a mesh by half-edges of quads, such that they keep their edges when points get copies.
std::vector<Index> halfEdgesOfLines(const QuadMesh& mesh)
{
  std::vector<std::tuple<Index, Index, Index>> edges;
  for (Index h = 0; h < 4 * mesh.quads.size(); ++h)
  {
    const Index a = mesh.origin(h), b = mesh.target(h);
    edges.emplace_back(std::min(a, b), std::max(a, b), h);
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Index> halfEdges;
  for (const QuadLine& line : mesh.lines)
  {
    const auto found = std::lower_bound(edges.begin(), edges.end(),
      std::make_tuple(std::min(line.a, line.b), std::max(line.a, line.b), Index{ 0 }));
    const bool isThere = found != edges.end() && std::get<0>(*found) == std::min(line.a, line.b) &&
      std::get<1>(*found) == std::max(line.a, line.b);
    halfEdges.push_back(isThere ? std::get<2>(*found) : kInvalidIndex);
  }
  return halfEdges;
}

class PathSearch
{
public:
  PathSearch(const QuadMesh& mesh)
    : mesh_(mesh), topology_(analyzeQuads(mesh.quads, mesh.points.size())),
      isLine_(4 * mesh.quads.size(), 0), cost_(4 * mesh.quads.size(), kInfinity),
      before_(4 * mesh.quads.size(), kInvalidIndex), start_(4 * mesh.quads.size(), kInvalidIndex)
  {
    for (const Index h : halfEdgesOfLines(mesh))
    {
      if (h != kInvalidIndex)
      {
        isLine_[h] = 1;
        if (topology_.twin[h] != kInvalidIndex)
        {
          isLine_[topology_.twin[h]] = 1;
        }
      }
    }
  }

  std::optional<QuadPath> find(const std::vector<std::pair<Index, double>>& starts,
    const std::function<std::optional<double>(Index, Index)>& endCost)
  {
    std::map<Index, double> startCost;
    for (const auto& [point, cost] : starts)
    {
      const auto known = startCost.emplace(point, cost).first;
      known->second = std::min(known->second, cost);
    }
    for (Index h = 0; h < 4 * mesh_.quads.size(); ++h)
    {
      const Index from = mesh_.origin(h);
      const auto start = startCost.find(from);
      if (topology_.onBoundary[from] != 0 && start != startCost.end())
      {
        reach(h, 1 + start->second, kInvalidIndex, from);
      }
    }
    double least = kInfinity;
    Index last = kInvalidIndex;
    while (!queue_.empty() && queue_.top().first < least)
    {
      const auto [cost, h] = queue_.top();
      queue_.pop();
      if (cost > cost_[h])
      {
        continue;
      }
      const Index at = mesh_.target(h);
      if (topology_.onBoundary[at] == 0)
      {
        goOn(h, cost);
        continue;
      }
      const std::optional<double> atEnd = at == start_[h] ? std::nullopt : endCost(start_[h], at);
      if (atEnd && cost + *atEnd < least && isSimple(h))
      {
        least = cost + *atEnd;
        last = h;
      }
    }
    if (last == kInvalidIndex)
    {
      return std::nullopt;
    }
    QuadPath path;
    for (Index h = last; h != kInvalidIndex; h = before_[h])
    {
      path.push_back(h);
    }
    std::reverse(path.begin(), path.end());
    return path;
  }

private:
  void reach(Index h, double cost, Index before, Index start)
  {
    if (topology_.twin[h] != kInvalidIndex && isLine_[h] == 0 && cost < cost_[h])
    {
      cost_[h] = cost;
      before_[h] = before;
      start_[h] = start;
      queue_.emplace(cost, h);
    }
  }

  /// From the target of h, clockwise from the leftmost edge.
  void goOn(Index h, double cost)
  {
    const int valence = topology_.valence[mesh_.target(h)];
    int turn = 1;
    for (Index g = nextInQuad(h); g != topology_.twin[h]; g = nextInQuad(topology_.twin[g]), ++turn)
    {
      const bool isStraight = 2 * turn == valence;
      reach(g,
        cost + 1 + (isStraight ? 0 : 2 * kIrregularCost) + (valence == 4 ? 0 : kIrregularCost), h,
        start_[h]);
    }
  }

  bool isSimple(Index last) const
  {
    std::set<Index> seen{ mesh_.target(last) };
    for (Index h = last; h != kInvalidIndex; h = before_[h])
    {
      if (!seen.insert(mesh_.origin(h)).second)
      {
        return false;
      }
    }
    return true;
  }

  struct Later
  {
    bool operator()(const std::pair<double, Index>& a, const std::pair<double, Index>& b) const
    {
      return a > b;
    }
  };

  const QuadMesh& mesh_;
  QuadTopology topology_;
  std::vector<std::uint8_t> isLine_;
  std::vector<double> cost_;
  std::vector<Index> before_, start_;
  std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, Later>
    queue_;
};

/// The corners at the points of a path that are on its right, by half-edges.
std::vector<std::vector<Index>> cornersOnTheRight(
  const QuadPath& path, const std::vector<Index>& twin)
{
  std::vector<std::vector<Index>> corners;
  for (std::size_t i = 0; i <= path.size(); ++i)
  {
    std::vector<Index>& at = corners.emplace_back();
    if (i == path.size())
    {
      // From the path on, counterclockwise to the boundary.
      for (Index k = twin[path.back()]; k != kInvalidIndex; k = twin[previousInQuad(k)])
      {
        at.push_back(k);
      }
      continue;
    }
    const Index incoming = i > 0 ? twin[path[i - 1]] : kInvalidIndex;
    for (Index k = nextInQuad(twin[path[i]]);; k = nextInQuad(twin[k]))
    {
      at.push_back(k);
      if (k == incoming || twin[k] == kInvalidIndex)
      {
        break;
      }
    }
  }
  return corners;
}

/// Of each point of the strip the ones beside it in quads that are not on it, in the order of the quads, once for each
/// edge of a quad.
std::map<Index, std::vector<Index>> pointsBeside(
  const InsertedStrip& strip, const std::vector<std::array<Index, 4>>& quads)
{
  std::set<Index> onStrip;
  for (const auto& [left, right] : strip.points)
  {
    onStrip.insert({ left, right });
  }
  std::map<Index, std::vector<Index>> beside;
  for (const std::array<Index, 4>& quad : quads)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      for (const std::size_t k : { (i + 1) % 4, (i + 3) % 4 })
      {
        if (onStrip.count(quad[i]) != 0 && onStrip.count(quad[k]) == 0)
        {
          beside[quad[i]].push_back(quad[k]);
        }
      }
    }
  }
  return beside;
}

} // namespace

std::optional<QuadPath> findStripPath(const QuadMesh& mesh,
  const std::vector<std::pair<Index, double>>& starts,
  const std::function<std::optional<double>(Index start, Index end)>& endCost)
{
  return PathSearch(mesh).find(starts, endCost);
}

std::optional<QuadPath> chordFrom(const std::vector<Index>& twin, Index boundaryHalfEdge)
{
  QuadPath chord;
  std::set<Index> seen;
  for (Index h = boundaryHalfEdge; h != kInvalidIndex; h = twin[oppositeInQuad(h)])
  {
    if (!seen.insert(h / 4).second)
    {
      return std::nullopt;
    }
    chord.push_back(h);
  }
  return chord;
}

std::map<Index, Vector3> waysApart(const InsertedStrip& strip, const QuadMesh& mesh)
{
  constexpr double share = 1.0 / 3;
  std::map<Index, Vector3> ways;
  for (const auto& [p, others] : pointsBeside(strip, mesh.quads))
  {
    Vector3 way = Vector3::Zero();
    for (const Index other : others)
    {
      way += share / static_cast<double>(others.size()) * (mesh.points[other] - mesh.points[p]);
    }
    ways.emplace(p, way);
  }
  return ways;
}

InsertedStrip splitChord(QuadMesh& mesh, const QuadPath& chord)
{
  const std::vector<Index> lineHalfEdges = halfEdgesOfLines(mesh);
  const std::vector<Index> twin = analyzeQuads(mesh.quads, mesh.points.size()).twin;
  InsertedStrip strip;
  for (const Index h : chord)
  {
    addCopy(mesh, mesh.origin(h), strip);
  }
  addCopy(mesh, mesh.target(oppositeInQuad(chord.back())), strip);
  // Crossed lines: one half stays where it was, the other one is new.
  std::vector<QuadLine> halves;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
  {
    const Index line = lineHalfEdges[l];
    for (std::size_t i = 0; i <= chord.size() && line != kInvalidIndex; ++i)
    {
      const Index crossed = i < chord.size() ? chord[i] : oppositeInQuad(chord.back());
      if (line == crossed || twin[line] == crossed)
      {
        const Index middle = strip.points[i].second;
        halves.push_back(
          { middle, mesh.lines[l].b, mesh.lines[l].halfEdge, mesh.lines[l].boundary });
        mesh.lines[l].b = middle;
      }
    }
  }
  mesh.lines.insert(mesh.lines.end(), halves.begin(), halves.end());
  //  d--m'--c
  //  |  |   |     one enters by a -> b
  //  a--m---b
  for (std::size_t i = 0; i < chord.size(); ++i)
  {
    const Index h = chord[i], q = h / 4;
    const Index a = mesh.origin(h), b = mesh.target(h);
    const Index c = mesh.origin(oppositeInQuad(h)), d = mesh.target(oppositeInQuad(h));
    const Index m = strip.points[i].second, next = strip.points[i + 1].second;
    mesh.quads[q] = { a, m, next, d };
    mesh.quads.push_back({ m, b, c, next });
    mesh.quadSourceFace.push_back(Index{ mesh.quadSourceFace[q] });
    mesh.quadSourceWeights[q] = { 0, 0, 0 };
    mesh.quadSourceWeights.push_back({ 0, 0, 0 });
  }
  setValences(mesh);
  return strip;
}

void removeChord(QuadMesh& mesh, const QuadPath& chord, const std::function<int(Index point)>& rank)
{
  std::vector<Index> becomes(mesh.points.size());
  std::iota(becomes.begin(), becomes.end(), Index{ 0 });
  std::vector<std::uint8_t> isOut(mesh.quads.size(), 0);
  for (std::size_t i = 0; i <= chord.size(); ++i)
  {
    const Index rung = i < chord.size() ? chord[i] : oppositeInQuad(chord.back());
    const Index a = mesh.origin(rung), b = mesh.target(rung);
    const Index kept = rank(b) > rank(a) ? b : a;
    if (rank(a) == rank(b))
    {
      mesh.points[kept] = (mesh.points[a] + mesh.points[b]) / 2;
    }
    becomes[kept == a ? b : a] = kept;
    isOut[rung / 4] = 1;
  }
  std::size_t count = 0;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
  {
    if (isOut[q] == 0)
    {
      const std::array<Index, 4>& quad = mesh.quads[q];
      mesh.quads[count] = { becomes[quad[0]], becomes[quad[1]], becomes[quad[2]],
        becomes[quad[3]] };
      mesh.quadSourceFace[count] = mesh.quadSourceFace[q];
      mesh.quadSourceWeights[count] = { 0, 0, 0 };
      ++count;
    }
  }
  mesh.quads.resize(count);
  mesh.quadSourceFace.resize(count);
  mesh.quadSourceWeights.resize(count);
  setValences(mesh);
}

InsertedStrip insertStrip(QuadMesh& mesh, const QuadPath& path)
{
  std::vector<Index> lineHalfEdges = halfEdgesOfLines(mesh);
  const std::vector<Index> twin = analyzeQuads(mesh.quads, mesh.points.size()).twin;
  const std::vector<std::vector<Index>> right = cornersOnTheRight(path, twin);
  InsertedStrip strip;
  for (std::size_t i = 0; i < right.size(); ++i)
  {
    addCopy(mesh, i < path.size() ? mesh.origin(path[i]) : mesh.target(path.back()), strip);
  }
  for (std::size_t i = 0; i < right.size(); ++i)
  {
    for (const Index corner : right[i])
    {
      mesh.quads[corner / 4][corner % 4] = strip.points[i].second;
    }
  }
  // A feature that is crossed has a line on the left of the path at that point.
  std::vector<Index> crossing(right.size(), kInvalidIndex);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
  {
    for (std::size_t i = 1; i + 1 < right.size(); ++i)
    {
      if (mesh.lines[l].a == strip.points[i].first || mesh.lines[l].b == strip.points[i].first)
      {
        crossing[i] = static_cast<Index>(l);
      }
    }
  }
  for (std::size_t i = 0; i < path.size(); ++i)
  {
    const auto [left, copy] = strip.points[i];
    const auto [nextLeft, nextCopy] = strip.points[i + 1];
    mesh.quads.push_back({ nextLeft, left, copy, nextCopy });
    mesh.quadSourceFace.push_back(Index{ mesh.quadSourceFace[path[i] / 4] });
    mesh.quadSourceWeights.push_back({ 0, 0, 0 });
  }
  for (std::size_t l = 0; l < lineHalfEdges.size(); ++l)
  {
    if (lineHalfEdges[l] != kInvalidIndex)
    {
      mesh.lines[l].a = mesh.origin(lineHalfEdges[l]);
      mesh.lines[l].b = mesh.target(lineHalfEdges[l]);
    }
  }
  for (std::size_t i = 0; i < right.size(); ++i)
  {
    const auto [left, copy] = strip.points[i];
    const bool isEnd = i == 0 || i + 1 == right.size();
    if (!isEnd && crossing[i] != kInvalidIndex)
    {
      mesh.lines.push_back({ left, copy, mesh.lines[crossing[i]].halfEdge, false });
    }
    else if (isEnd)
    {
      mesh.lines.push_back({ left, copy, kInvalidIndex, true });
    }
  }
  setValences(mesh);
  return strip;
}

} // namespace quadrille

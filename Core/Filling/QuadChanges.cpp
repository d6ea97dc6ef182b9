// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/QuadChanges.h"

#include "Quads/QuadMesh.h"

#include <algorithm>
#include <utility>

namespace quadrille
{

namespace
{

using Quad = QuadChanges::Quad;
using Edge = std::pair<Index, Index>;

constexpr Quad kNoQuad{ kInvalidIndex, kInvalidIndex, kInvalidIndex, kInvalidIndex };

Edge edgeOf(const Quad& quad, std::size_t i)
{
  return std::minmax(quad[i], quad[(i + 1) % 4]);
}

} // namespace

QuadChanges::QuadChanges(FaceQuads& mesh, Judge judge)
  : mesh_(mesh), judge_(std::move(judge)), topology_(analyzeQuads(mesh.quads, mesh.points.size())),
    isChanged_(mesh.quads.size(), 0), quadsAt_(halfEdgesAtPoints(mesh.quads, mesh.points.size()))
{
}

bool QuadChanges::tryAt(Index h)
{
  return tryCollapse(h) || tryRotateEdge(h) || tryInsert(h);
}

void QuadChanges::finish()
{
  eraseIf(mesh_.quads, [](const Quad& quad) { return quad == kNoQuad; });
}

bool QuadChanges::isFresh(Index v) const
{
  return std::all_of(
    quadsAt_.begin(v), quadsAt_.end(v), [this](Index h) { return isChanged_[h / 4] == 0; });
}

bool QuadChanges::areNeighbours(Index a, Index b) const
{
  return std::any_of(quadsAt_.begin(a), quadsAt_.end(a),
    [&](Index h) { return corner(nextInQuad(h)) == b || corner(previousInQuad(h)) == b; });
}

std::vector<QuadChanges::Count> QuadChanges::counts(const Change& change) const
{
  std::vector<std::pair<Index, int>> changes; // point, one quad less or more
  const auto note = [&](const Quad& quad, int more)
  {
    for (const Index v : quad)
    {
      changes.emplace_back(v, more);
    }
  };
  for (const Index q : change.old)
  {
    note(mesh_.quads[q], -1);
  }
  for (const Quad& quad : change.made)
  {
    note(quad, 1);
  }
  std::sort(changes.begin(), changes.end());
  std::vector<Count> counts;
  for (auto first = changes.begin(); first != changes.end();)
  {
    const Index v = first->first;
    const Index before = v < pointCount() ? quadsAt_.size(v) : 0;
    Count count{ v, before, before };
    for (; first != changes.end() && first->first == v; ++first)
    {
      count.after += static_cast<Index>(first->second);
    }
    if (count.after != count.before)
    {
      counts.push_back(count);
    }
  }
  return counts;
}

/// Is nothing changed yet around the quads, are the four points of each new one different, and all edges that were
/// none before new ones?
bool QuadChanges::mayBe(const Change& change) const
{
  std::vector<Edge> edges;
  for (const Index q : change.old)
  {
    const Quad& quad = mesh_.quads[q];
    if (!std::all_of(quad.begin(), quad.end(), [this](Index v) { return isFresh(v); }))
    {
      return false;
    }
    for (std::size_t i = 0; i < 4; ++i)
    {
      edges.push_back(edgeOf(quad, i));
    }
  }
  return std::all_of(change.made.begin(), change.made.end(),
    [&](const Quad& quad)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Edge edge = edgeOf(quad, i);
        if (std::count(quad.begin(), quad.end(), quad[i]) > 1 ||
          (!contains(edges, edge) && edge.second < pointCount() &&
            areNeighbours(edge.first, edge.second)))
        {
          return false;
        }
      }
      return true;
    });
}

bool QuadChanges::tryChange(std::vector<Index> old, std::vector<Quad> made)
{
  const auto isChanged = [this](Index q) { return isChanged_[q] != 0; };
  if (std::any_of(old.begin(), old.end(), isChanged))
  {
    return false;
  }
  Change change{ std::move(old), std::move(made), {} };
  change.counts = counts(change);
  const auto mayHave = [this](const Count& count)
  { return isPin(count.point) ? count.after >= 1 : count.after == 0 || count.after >= 3; };
  if (!std::all_of(change.counts.begin(), change.counts.end(), mayHave) || !mayBe(change) ||
    !judge_(change))
  {
    return false;
  }
  make(change);
  return true;
}

void QuadChanges::make(const Change& change)
{
  for (const Index q : change.old)
  {
    isChanged_[q] = 1;
  }
  change.make(mesh_.quads);
}

void QuadChanges::Change::make(std::vector<Quad>& quads) const
{
  for (std::size_t i = 0; i < std::max(old.size(), made.size()); ++i)
  {
    if (i >= old.size())
    {
      quads.push_back(made[i]);
    }
    else
    {
      quads[old[i]] = i < made.size() ? made[i] : kNoQuad;
    }
  }
}

bool QuadChanges::tryDoublet(Index v)
{
  if (isPin(v) || quadsAt_.size(v) != 2 || !isFresh(v))
  {
    return false;
  }
  const Index h = quadsAt_.begin(v)[0], g = quadsAt_.begin(v)[1];
  const Change change{ { h / 4, g / 4 },
    { { corner(nextInQuad(h)), corner(oppositeInQuad(h)), corner(previousInQuad(h)),
      corner(oppositeInQuad(g)) } },
    {} };
  if (!mayBe(change))
  {
    return false;
  }
  make(change);
  return true;
}

/// The quad of h goes, and so does the point where h begins: it becomes the opposite one.
bool QuadChanges::tryCollapse(Index h)
{
  if (isChanged_[h / 4] != 0 || isPin(corner(h)) || !isFresh(corner(h)))
  {
    return false;
  }
  const Index v = corner(h), kept = corner(oppositeInQuad(h));
  if (areNeighbours(v, kept))
  {
    return false;
  }
  std::vector<Index> old;
  std::vector<Quad> made;
  for (const Index* g = quadsAt_.begin(v); g != quadsAt_.end(v); ++g)
  {
    old.push_back(*g / 4);
    if (*g != h)
    {
      made.push_back(mesh_.quads[*g / 4]);
      made.back()[*g % 4] = kept;
    }
  }
  return tryChange(std::move(old), std::move(made));
}

/// The hexagon of the two quads at an edge, counterclockwise; the edge joins its points 0 and 3. None where one of
/// them is changed already.
std::optional<std::array<Index, 6>> QuadChanges::hexagonAt(Index h) const
{
  const Index g = topology_.twin[h];
  if (g == kInvalidIndex || g < h || isChanged_[h / 4] != 0 || isChanged_[g / 4] != 0)
  {
    return std::nullopt;
  }
  return std::array<Index, 6>{ corner(nextInQuad(h)), corner(oppositeInQuad(h)),
    corner(previousInQuad(h)), corner(h), corner(oppositeInQuad(g)), corner(previousInQuad(g)) };
}

/// The edge comes to join two other points of the hexagon.
bool QuadChanges::tryRotateEdge(Index h)
{
  const auto hexagon = hexagonAt(h);
  if (!hexagon)
  {
    return false;
  }
  const auto& r = *hexagon;
  const std::vector<Index> old{ h / 4, topology_.twin[h] / 4 };
  return tryChange(old, { { r[0], r[1], r[4], r[5] }, { r[1], r[2], r[3], r[4] } }) ||
    tryChange(old, { { r[5], r[0], r[1], r[2] }, { r[2], r[3], r[4], r[5] } });
}

/// Four quads in place of two, with two new points: two opposite points of the hexagon get another edge each, and no
/// other point one more or less.
bool QuadChanges::tryInsert(Index h)
{
  const auto hexagon = hexagonAt(h);
  if (!hexagon)
  {
    return false;
  }
  const auto& r = *hexagon;
  const std::vector<Index> old{ h / 4, topology_.twin[h] / 4 };
  const auto m = static_cast<Index>(mesh_.points.size()), n = m + 1;
  const auto insert = [&](Index atM, Index atN, const std::vector<Quad>& made)
  {
    addPoint(r, r[3], atM);
    addPoint(r, r[0], atN);
    const bool isDone = tryChange(old, made);
    resize(isDone ? n + 1 : m);
    return isDone;
  };
  return insert(r[5], r[2],
           { { r[4], r[5], m, r[3] }, { r[3], m, n, r[2] }, { r[5], r[0], n, m },
             { r[0], r[1], r[2], n } }) ||
    insert(r[1], r[4],
      { { r[1], r[2], r[3], m }, { m, r[3], r[4], n }, { r[0], r[1], m, n },
        { r[4], r[5], r[0], n } });
}

/// Half way from the middle of the hexagon to that of two of its points.
void QuadChanges::addPoint(const std::array<Index, 6>& hexagon, Index a, Index b)
{
  Vector3 sum = Vector3::Zero();
  for (const Index v : hexagon)
  {
    sum += mesh_.points[v];
  }
  mesh_.points.emplace_back(sum / 12 + (mesh_.points[a] + mesh_.points[b]) / 4);
  mesh_.normals.push_back((mesh_.normals[a] + mesh_.normals[b]).normalized());
  mesh_.fitting.push_back(4);
}

void QuadChanges::resize(std::size_t count)
{
  mesh_.points.resize(count);
  mesh_.normals.resize(count);
  mesh_.fitting.resize(count);
}

} // namespace quadrille

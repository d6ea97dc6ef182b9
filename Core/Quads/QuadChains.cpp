// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/QuadChains.h"

#include "Mesh/Distance.h"

#include <algorithm>
#include <limits>

namespace quadrille
{
namespace
{

constexpr int kRegularEdges = 4;

Index originInQuads(const QuadMesh& quads, Index h)
{
  return quads.quads[h / 4][h % 4];
}

double distanceToLoop(const std::vector<Vector3>& polyline, const Vector3& p)
{
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polyline.size(); ++i)
  {
    least = std::min(least, distanceToSegment(p, polyline[i], polyline[(i + 1) % polyline.size()]));
  }
  return least;
}

} // namespace

QuadChains::QuadChains(const QuadMesh& quads)
  : quads_(quads), twin_(4 * quads.quads.size(), kInvalidIndex),
    leaving_(quads.points.size(),
      [&](const auto& visit)
      {
        for (Index h = 0; h < 4 * quads.quads.size(); ++h)
        {
          visit(originInQuads(quads, h), h);
        }
      })
{
  for (Index h = 0; h < twin_.size(); ++h)
  {
    for (const Index* g = leaving_.begin(end(h)); g != leaving_.end(end(h)); ++g)
    {
      twin_[h] = end(*g) == originInQuads(quads, h) ? *g : twin_[h];
    }
  }
}

Index QuadChains::end(Index h) const
{
  return originInQuads(quads_, nextInQuad(h));
}

/// The half-edge that leaves the end of h with two quads between them on that side; none on a boundary.
std::optional<Index> QuadChains::straightOn(Index h, ChainSide side) const
{
  if (side == ChainSide::Left)
  {
    const Index across = twin_[nextInQuad(h)];
    return across == kInvalidIndex ? std::nullopt : std::optional<Index>(nextInQuad(across));
  }
  const Index back = twin_[h];
  const Index across = back == kInvalidIndex ? kInvalidIndex : twin_[previousInQuad(back)];
  const Index on = across == kInvalidIndex ? kInvalidIndex : twin_[previousInQuad(across)];
  return on == kInvalidIndex ? std::nullopt : std::optional<Index>(on);
}

bool QuadChains::isPassed(Index point) const
{
  return quads_.onBoundary[point] == 0 && quads_.valence[point] == kRegularEdges;
}

/// Goes along each chain that leaves a and calls visit(chain) at each of its points, which says whether to go on;
/// chains pass regular points only.
template <typename Visit>
void QuadChains::followAll(Index a, Visit visit) const
{
  for (const Index* first = leaving_.begin(a); first != leaving_.end(a); ++first)
  {
    std::vector<Index> chain{ a };
    std::optional<Index> h = *first;
    while (h && chain.size() <= quads_.points.size())
    {
      chain.push_back(end(*h));
      const bool goesOn = visit(chain) && isPassed(chain.back());
      h = goesOn ? straightOn(*h, ChainSide::Left) : std::nullopt;
    }
  }
}

std::vector<Index> QuadChains::between(Index a, Index b) const
{
  std::vector<Index> best;
  followAll(a,
    [&](const std::vector<Index>& chain)
    {
      const bool arrives = chain.back() == b;
      if (arrives && (best.empty() || chain.size() < best.size()))
      {
        best = chain;
      }
      return !arrives;
    });
  return best;
}

std::vector<Index> QuadChains::toLine(Index a, const Vector3& place, double distance) const
{
  std::vector<std::uint8_t> onLine(quads_.points.size(), 0);
  for (const QuadLine& line : quads_.lines)
  {
    onLine[line.a] = onLine[line.b] = 1;
  }
  std::vector<Index> first;
  followAll(a,
    [&](const std::vector<Index>& chain)
    {
      const bool arrives = onLine[chain.back()] != 0;
      if (arrives && first.empty() && (quads_.points[chain.back()] - place).norm() <= distance)
      {
        first = chain;
      }
      return !arrives;
    });
  return first;
}

/// Empty unless it comes back to where it began and passes points near the line alone. What it passes is marked: from
/// none of it another chain goes on that side.
std::vector<Index> QuadChains::closedFrom(Index first, ChainSide side,
  const std::vector<double>& away, double distance, std::vector<std::uint8_t>& passed) const
{
  std::vector<Index> chain{ originInQuads(quads_, first) };
  std::optional<Index> h = first;
  do
  {
    passed[*h] = 1;
    chain.push_back(end(*h));
    h = away[chain.back()] <= distance ? straightOn(*h, side) : std::nullopt;
  } while (h && passed[*h] == 0);
  return h == first ? chain : std::vector<Index>{};
}

std::vector<Index> QuadChains::closedNear(
  const std::vector<Vector3>& polyline, double distance) const
{
  std::vector<double> away(quads_.points.size());
  for (std::size_t p = 0; p < away.size(); ++p)
  {
    away[p] = distanceToLoop(polyline, quads_.points[p]);
  }
  // A short loop beside a part of the polyline is not what goes round it.
  const auto comesBy = [&](const std::vector<Index>& chain)
  {
    return std::all_of(polyline.begin(), polyline.end(),
      [&](const Vector3& corner)
      {
        return std::any_of(chain.begin(), chain.end(),
          [&](Index p) { return (quads_.points[p] - corner).norm() <= distance; });
      });
  };
  std::vector<Index> best;
  double least = std::numeric_limits<double>::infinity();
  for (const ChainSide side : { ChainSide::Left, ChainSide::Right })
  {
    std::vector<std::uint8_t> passed(twin_.size(), 0);
    for (Index h = 0; h < twin_.size(); ++h)
    {
      if (passed[h] != 0 || away[originInQuads(quads_, h)] > distance)
      {
        continue;
      }
      const std::vector<Index> chain = closedFrom(h, side, away, distance, passed);
      double sum = 0;
      for (const Index p : chain)
      {
        sum += away[p];
      }
      const double mean = chain.empty() ? least : sum / static_cast<double>(chain.size());
      if (mean < least && comesBy(chain))
      {
        least = mean;
        best = chain;
      }
    }
  }
  return best;
}

std::optional<Index> QuadChains::nearestIrregular(const Vector3& place) const
{
  std::optional<Index> best;
  for (Index p = 0; p < quads_.points.size(); ++p)
  {
    const bool isIrregular =
      quads_.valence[p] != kRegularEdges - (quads_.onBoundary[p] != 0 ? 1 : 0);
    if (isIrregular &&
      (!best ||
        (quads_.points[p] - place).squaredNorm() < (quads_.points[*best] - place).squaredNorm()))
    {
      best = p;
    }
  }
  return best;
}

Index QuadChains::nearestPoint(const Vector3& place) const
{
  Index best = 0;
  for (Index p = 1; p < quads_.points.size(); ++p)
  {
    best = (quads_.points[p] - place).squaredNorm() < (quads_.points[best] - place).squaredNorm()
      ? p
      : best;
  }
  return best;
}

} // namespace quadrille

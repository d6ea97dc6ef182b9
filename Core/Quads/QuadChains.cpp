// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/QuadChains.h"

#include "Mesh/Distance.h"
#include "Mesh/Requests.h"

#include <algorithm>
#include <utility>

namespace quadrille
{
namespace
{

double distanceToLoop(const std::vector<Vector3>& polyline, const Vector3& p)
{
  double least = kInfinity;
  for (std::size_t i = 0; i < polyline.size(); ++i)
  {
    least = std::min(least, distanceToSegment(p, polyline[i], polyline[(i + 1) % polyline.size()]));
  }
  return least;
}

} // namespace

QuadChains::QuadChains(const QuadMesh& quads)
  : quads_(quads), twin_(4 * quads.quads.size(), kInvalidIndex),
    leaving_(halfEdgesAtPoints(quads.quads, quads.points.size()))
{
  for (Index h = 0; h < twin_.size(); ++h)
  {
    for (const Index* g = leaving_.begin(end(h)); g != leaving_.end(end(h)); ++g)
    {
      twin_[h] = end(*g) == quads.origin(h) ? *g : twin_[h];
    }
  }
}

Index QuadChains::end(Index h) const
{
  return quads_.target(h);
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
  return quads_.onBoundary[point] == 0 && quads_.valence[point] == kRegularValence;
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

/// Empty unless it comes back to where it began and passes points near the line alone. What it passes is marked: from
/// none of it another chain goes on that side.
std::vector<Index> QuadChains::closedFrom(Index first, ChainSide side,
  const std::vector<double>& away, double distance, std::vector<std::uint8_t>& passed) const
{
  std::vector<Index> chain{ quads_.origin(first) };
  std::optional<Index> h = first;
  do
  {
    passed[*h] = 1;
    chain.push_back(end(*h));
    h = away[chain.back()] <= distance ? straightOn(*h, side) : std::nullopt;
  } while (h && passed[*h] == 0);
  return h == first ? chain : std::vector<Index>{};
}

std::vector<std::vector<Index>> QuadChains::closedNear(
  const std::vector<Vector3>& polyline, double distance) const
{
  std::vector<double> away(quads_.points.size());
  for (std::size_t p = 0; p < away.size(); ++p)
  {
    away[p] = distanceToLoop(polyline, quads_.points[p]);
  }
  std::vector<std::vector<Index>> chains;
  for (const ChainSide side : { ChainSide::Left, ChainSide::Right })
  {
    std::vector<std::uint8_t> passed(twin_.size(), 0);
    for (Index h = 0; h < twin_.size(); ++h)
    {
      if (passed[h] != 0 || away[quads_.origin(h)] > distance)
      {
        continue;
      }
      std::vector<Index> chain = closedFrom(h, side, away, distance, passed);
      if (!chain.empty())
      {
        chains.push_back(std::move(chain));
      }
    }
  }
  return chains;
}

} // namespace quadrille

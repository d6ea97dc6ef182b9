// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Extraction/PolygonSimplifier.h"

#include "Base/Lists.h"
#include "Base/TryCount.h"

#include <cmath>
#include <utility>

namespace quadrille
{

namespace
{

/// Where polygons cut the boundary short they stay within this, in quads.
constexpr double kPolygonTolerance = 0.1;

/// Do the segments ab and cd cross, each inside of the other?
bool cross(FixedVec2 a, FixedVec2 b, FixedVec2 c, FixedVec2 d)
{
  const int c1 = orientation(a, b, c), d1 = orientation(a, b, d);
  const int a1 = orientation(c, d, a), b1 = orientation(c, d, b);
  return c1 * d1 < 0 && a1 * b1 < 0;
}

class PolygonSimplifier
{
public:
  PolygonSimplifier(const std::vector<Stop>& stops, std::vector<std::uint8_t> wanted)
    : stops_(stops), kept_(std::move(wanted))
  {
    // A face lies in one cell, so that differences have few bits.
    for (const Stop& stop : stops)
    {
      const FixedVec2 d = stop.uv - stops.front().uv;
      place_.push_back({ d.u * kFine + stop.fine.u, d.v * kFine + stop.fine.v });
    }
  }

  /// Keeps one more stop between a kept one and the next; false where there is none.
  bool keepBetween(Index a, Index b)
  {
    const Index between = farthest(a, b);
    if (between != kInvalidIndex)
    {
      kept_[between] = 1;
    }
    return between != kInvalidIndex;
  }

  std::vector<Index> run()
  {
    keepWhereFlat();
    keepWhereFar();
    for (bool isFirst = true;; isFirst = false)
    {
      std::vector<Index> corners = keptStops();
      if (isSimple(corners))
      {
        countTryLed(Try::MoreCorners, isFirst ? 0 : 1);
        return corners;
      }
      if (!refine(corners))
      {
        return {};
      }
      countTry(Try::MoreCorners);
    }
  }

private:
  Index after(Index i) const { return i + 1 == stops_.size() ? 0 : i + 1; }

  std::vector<Index> keptStops() const
  {
    return idsWhere(stops_.size(), [&](Index i) { return kept_[i]; });
  }

  /// The stop strictly between a and b that is farthest from their line; none where there is none.
  Index farthest(Index a, Index b) const
  {
    Index best = kInvalidIndex;
    Int128 most = -1;
    for (Index i = after(a); i != b; i = after(i))
    {
      const FixedVec2 d = place_[i] - place_[a];
      Int128 distance = Int128{ d.u } * d.u + Int128{ d.v } * d.v;
      if (place_[a] != place_[b])
      {
        distance = determinant(place_[a], place_[b], place_[i]);
        distance = distance < 0 ? -distance : distance;
      }
      if (distance > most)
      {
        most = distance;
        best = i;
      }
    }
    return best;
  }

  /// A boundary that comes back to the isoline that it left must not be cut short to a part of it.
  void keepWhereFlat()
  {
    const std::vector<Index> corners = keptStops();
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      const Index a = corners[k];
      const Index b = corners[(k + 1) % corners.size()];
      const bool flat = corners.size() == 1 || onOneIsoline(stops_[a], stops_[b]);
      if (flat)
      {
        keepBetween(a, b);
      }
    }
  }

  /// Follows the boundary to within kPolygonTolerance [Douglas and Peucker 1973].
  void keepWhereFar()
  {
    std::vector<Index> corners = keptStops();
    if (corners.empty())
    {
      return;
    }
    std::vector<std::pair<Index, Index>> gaps;
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      gaps.emplace_back(corners[k], corners[(k + 1) % corners.size()]);
    }
    while (!gaps.empty())
    {
      const auto [a, b] = gaps.back();
      gaps.pop_back();
      const Index between = farthest(a, b);
      if (between != kInvalidIndex && distance(between, a, b) > kPolygonTolerance)
      {
        kept_[between] = 1;
        gaps.emplace_back(a, between);
        gaps.emplace_back(between, b);
      }
    }
  }

  /// Of a stop from the line through two others, or from both where they are one; in quads.
  double distance(Index i, Index a, Index b) const
  {
    const auto vector = [this](Index from, Index to) -> Vector2
    { return toDouble(place_[to] - place_[from]) / static_cast<double>(kFine); };
    const Vector2 line = vector(a, b), way = vector(a, i);
    const double length = line.norm();
    return length > 0 ? std::abs(line.x() * way.y() - line.y() * way.x()) / length : way.norm();
  }

  static bool onOneIsoline(const Stop& a, const Stop& b)
  {
    return (a.uv.u == b.uv.u && isInteger(a.uv.u) && a.fine.u == 0 && b.fine.u == 0) ||
      (a.uv.v == b.uv.v && isInteger(a.uv.v) && a.fine.v == 0 && b.fine.v == 0);
  }

  bool isSimple(const std::vector<Index>& corners) const
  {
    const std::size_t n = corners.size();
    if (n < 3)
    {
      return false;
    }
    Int128 area = 0;
    for (std::size_t i = 0; i + 2 < n; ++i)
    {
      area += determinant(uv(corners, 0), uv(corners, i + 1), uv(corners, i + 2));
    }
    if (area <= 0)
    {
      return false;
    }
    for (std::size_t i = 0; i < n; ++i)
    {
      for (std::size_t k = i + 2; k < n; ++k)
      {
        if ((k + 1) % n != i &&
          cross(uv(corners, i), uv(corners, i + 1), uv(corners, k), uv(corners, k + 1)))
        {
          return false;
        }
      }
    }
    return true;
  }

  FixedVec2 uv(const std::vector<Index>& corners, std::size_t i) const
  {
    return place_[corners[i % corners.size()]];
  }

  /// Keeps one more stop between any two; false when there is none.
  bool refine(const std::vector<Index>& corners)
  {
    bool any = false;
    if (corners.empty())
    {
      kept_[lowest()] = 1;
      return true;
    }
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      any = keepBetween(corners[k], corners[(k + 1) % corners.size()]) || any;
    }
    return any;
  }

  Index lowest() const
  {
    Index best = 0;
    for (Index i = 1; i < stops_.size(); ++i)
    {
      const auto key = [this](Index s) { return std::make_pair(place_[s].u, place_[s].v); };
      best = key(i) < key(best) ? i : best;
    }
    return best;
  }

  const std::vector<Stop>& stops_;
  std::vector<std::uint8_t> kept_;
  std::vector<FixedVec2> place_; ///< against the first stop, in the fine unit
};

} // namespace

std::vector<Index> simplePolygon(const std::vector<Stop>& stops, std::vector<std::uint8_t> wanted,
  const std::vector<std::pair<Index, Index>>& gaps)
{
  PolygonSimplifier simplifier(stops, std::move(wanted));
  for (const auto& [a, b] : gaps)
  {
    simplifier.keepBetween(a, b);
  }
  return simplifier.run();
}

} // namespace quadrille

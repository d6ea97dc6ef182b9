// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/QuadUntangling.h"

#include "Base/DisjointSets.h"
#include "Base/Parallel.h"
#include "Quads/QuadMoves.h"
#include "Quads/QuadShape.h"

#include <algorithm>
#include <cmath>

namespace quadrille
{
namespace
{

/// A sweep that lowers the badness of a place by less than this part is the last one.
constexpr double kLeastProgress = 0.01;
/// Corners with less than this area go on moving once no quad is bad.
constexpr double kMargin = 0.15;
/// Points whose corners all have more than this area stay.
constexpr double kGoodCorner = 0.6;
/// A move must not shorten the shortest edge at a point below this part of their mean.
constexpr double kShortUntangledEdge = 0.2;
/// A move has to lower the badness of the corners at the point by this part.
constexpr double kLeastBadnessGain = 1e-3;
/// Parts of the way to a corner of the quads at a point that are tried.
constexpr double kPartsOfWay[] = { 0.5, 0.2, 0.08, 0.03, 0.01 };

/// So far points may leave their places on the surface for the sake of bad quads, and of those that are inverted then;
/// in mean edge lengths of the quads round them.
constexpr double kFarthestOff[] = { 0.15, 0.3 };
/// A corner of this sine is good enough for a quad that needs it: it counts as a whole unit of area.
constexpr double kSineOfUnit = 1.0 / 3;

/// Areas of the parallelograms at the four corners, negative where the quad is inverted.
std::array<double, 4> cornerAreas(const std::array<Vector3, 4>& p)
{
  const Vector3 normal = centreNormal(p).normalized();
  std::array<double, 4> areas{};
  for (std::size_t i = 0; i < 4; ++i)
  {
    areas[i] = normal.dot((p[i] - p[(i + 3) % 4]).cross(p[(i + 1) % 4] - p[i]));
  }
  return areas;
}

/// Sines of the angles at the four corners, negative where the quad is inverted, 0 beside an edge without length.
std::array<double, 4> cornerSines(const std::array<Vector3, 4>& p)
{
  std::array<double, 4> sines = cornerAreas(p);
  for (std::size_t i = 0; i < 4; ++i)
  {
    const double scale = (p[i] - p[(i + 3) % 4]).norm() * (p[(i + 1) % 4] - p[i]).norm();
    sines[i] = scale > 0 ? sines[i] / scale : 0;
  }
  return sines;
}

/// How much a corner counts that has this area in units of the quads there: the worst ones count above all.
double badness(double area)
{
  constexpr double kSteepness = 6;
  constexpr double kLinear = -20; // the tangent beyond, so that nothing overflows
  const double bounded = std::exp(-kSteepness * std::max(area, kLinear));
  return bounded * (1 + kSteepness * std::max(0.0, kLinear - area));
}

class Untangling
{
public:
  Untangling(const Mesh& mesh, QuadMesh& quads, const UntanglingOptions& options)
    : quads_(quads), options_(options), moves_(mesh, quads, options.fixedVertices),
      scale_(quads.points.size(), 0), unit_(quads.quads.size(), 0), changed_(quads.quads.size(), 0),
      tried_(quads.points.size(), 0)
  {
  }

  /// Points round quads move.
  void run(const std::vector<Index>& quads) { mendAll(separate(pointsRound(quads))); }

  /// Points round quads leave the surface, and go farther from it round those that are inverted then.
  void loosen(std::vector<Index> quads)
  {
    isLoose_ = true;
    anchor_ = quads_.points;
    for (const double off : kFarthestOff)
    {
      farthestOff_ = off;
      mendAll(separate(pointsRound(quads)));
      quads = invertedQuads(quads_.points, quads_.quads);
    }
  }

private:
  /// Points that may move, and all quads at them; both ascending. Places share no quad, so they can be mended at the
  /// same time.
  struct Place
  {
    std::vector<Index> points, quads;
  };

  void mendAll(const std::vector<Place>& places)
  {
    parallelForEach(places.size(), 1, options_.threads, [&](std::size_t i) { mend(places[i]); });
  }

  template <typename Visitor>
  void forQuadsAt(Index p, const Visitor& visit) const
  {
    std::for_each(moves_.incidentQuads().begin(p), moves_.incidentQuads().end(p), visit);
  }

  /// The movable points of these quads and of a ring round them, ascending.
  std::vector<Index> pointsRound(const std::vector<Index>& quads) const
  {
    std::vector<std::uint8_t> near(quads_.points.size(), 0);
    std::vector<Index> front = quads;
    std::vector<Index> points;
    for (int ring = 0; ring < 2; ++ring)
    {
      std::vector<Index> next;
      for (const Index q : front)
      {
        for (const Index p : quads_.quads[q])
        {
          if (near[p] == 0)
          {
            near[p] = 1;
            forQuadsAt(p, [&](Index beyond) { next.push_back(beyond); });
            if (mayMove(p))
            {
              points.push_back(p);
            }
          }
        }
      }
      front = std::move(next);
    }
    std::sort(points.begin(), points.end());
    return points;
  }

  bool mayMove(Index p) const
  {
    const QuadMoves::Freedom freedom = moves_.freedom(p);
    if (isLoose_)
    {
      return freedom != QuadMoves::Freedom::Held && quads_.onBoundary[p] == 0;
    }
    return freedom > QuadMoves::Freedom::Fixed;
  }

  std::vector<Place> separate(const std::vector<Index>& points) const
  {
    std::vector<std::pair<Index, Index>> quadsAt; // quad and number of a point at it
    for (Index i = 0; i < points.size(); ++i)
    {
      forQuadsAt(points[i], [&](Index q) { quadsAt.emplace_back(q, i); });
    }
    std::sort(quadsAt.begin(), quadsAt.end());
    DisjointSets sets(points.size(), 1);
    for (std::size_t k = 1; k < quadsAt.size(); ++k)
    {
      if (quadsAt[k].first == quadsAt[k - 1].first)
      {
        sets.join(quadsAt[k].second, quadsAt[k - 1].second);
      }
    }
    std::vector<Index> number(points.size(), kInvalidIndex);
    std::vector<Place> places;
    for (Index i = 0; i < points.size(); ++i)
    {
      Index& place = number[sets.find(i)];
      if (place == kInvalidIndex)
      {
        place = static_cast<Index>(places.size());
        places.emplace_back();
      }
      places[place].points.push_back(points[i]);
    }
    for (std::size_t k = 0; k < quadsAt.size(); ++k)
    {
      if (k == 0 || quadsAt[k].first != quadsAt[k - 1].first)
      {
        places[number[sets.find(quadsAt[k].second)]].quads.push_back(quadsAt[k].first);
      }
    }
    return places;
  }

  std::array<double, 4> areasInUnits(Index q, const std::array<Vector3, 4>& corners) const
  {
    std::array<double, 4> areas = isLoose_ ? cornerSines(corners) : cornerAreas(corners);
    const bool outwards = moves_.facesOutwards(q, corners);
    for (double& area : areas)
    {
      area /= isLoose_ ? kSineOfUnit : unit_[q];
      area = outwards ? area : -2 - area; // all are positive where a quad is inverted as a whole
    }
    return areas;
  }

  /// How good the quads of a place are.
  struct State
  {
    QuadScore score;         ///< worst: the least area of a corner, in units
    std::size_t inwards = 0; ///< quads inverted as a whole
    double badness = 0;      ///< of all corners
    std::vector<SurfacePoint> points;
    std::vector<Vector3> positions;

    bool betterThan(const State& other) const
    {
      return inwards <= other.inwards && score.betterThan(other.score);
    }
  };

  State stateOf(const Place& place) const
  {
    State state;
    for (const Index q : place.quads)
    {
      const std::array<Vector3, 4> corners = cornersOf(quads_.points, quads_.quads[q]);
      state.score.inverted += isInverted(corners) ? 1 : 0;
      state.score.bad += scaledJacobian(corners) < kLeastShape ? 1 : 0;
      state.inwards += moves_.facesOutwards(q, corners) ? 0 : 1;
      for (const double area : areasInUnits(q, corners))
      {
        state.score.worst = std::min(state.score.worst, area);
        state.badness += badness(area);
      }
    }
    for (const Index p : place.points)
    {
      state.points.push_back(moves_.place(p));
      state.positions.push_back(moves_.position(p));
    }
    return state;
  }

  /// Sweeps over the points of a place; they end up where the quads were best.
  void mend(const Place& place)
  {
    measureUnits(place);
    const State before = stateOf(place);
    State best = before;
    std::uint32_t time = 1;
    double left = before.badness;
    while (best.score.bad > 0 || best.score.worst < kMargin)
    {
      for (const Index p : place.points)
      {
        improve(p, ++time);
      }
      State moved = stateOf(place);
      const bool last = !(moved.badness < (1 - kLeastProgress) * left);
      left = moved.badness;
      if (moved.betterThan(best))
      {
        best = std::move(moved);
      }
      if (last)
      {
        break;
      }
    }
    const State& result = best.score.hasFewerThan(before.score) ? best : before;
    for (std::size_t i = 0; i < place.points.size(); ++i)
    {
      moves_.move(place.points[i], result.points[i], result.positions[i]);
    }
  }

  /// Areas at corners are compared with the mean area of the quads round a quad, so that quads may be long and thin as
  /// long as they are so together: near a tip or in a slit that cannot be otherwise.
  void measureUnits(const Place& place)
  {
    const auto area = [&](Index q)
    { return 0.25 * centreNormal(cornersOf(quads_.points, quads_.quads[q])).norm(); };
    for (const Index q : place.quads)
    {
      unit_[q] = 0;
      changed_[q] = 1;
    }
    double length = 0;
    for (const Index q : place.quads)
    {
      const std::array<Vector3, 4> corners = cornersOf(quads_.points, quads_.quads[q]);
      for (std::size_t i = 0; i < 4; ++i)
      {
        length += (corners[(i + 1) % 4] - corners[i]).norm();
      }
    }
    for (const Index p : place.points)
    {
      scale_[p] = length / (4 * static_cast<double>(place.quads.size()));
      tried_[p] = 0;
      double sum = 0;
      forQuadsAt(p, [&](Index q) { sum += area(q); });
      const double mean = sum / moves_.incidentQuads().size(p);
      forQuadsAt(p, [&](Index q) { unit_[q] = std::max(unit_[q], mean); });
    }
  }

  struct Move
  {
    SurfacePoint place;
    Vector3 position;
    double badness = 0; ///< of the quads at the point
  };

  /// time: of this look at the point; rises from call to call.
  void improve(Index p, std::uint32_t time)
  {
    bool changed = false;
    forQuadsAt(p, [&](Index q) { changed = changed || changed_[q] > tried_[p]; });
    if (!changed)
    {
      return;
    }
    tried_[p] = time;
    const double before = badnessAt(p, moves_.position(p));
    if (before < badness(kGoodCorner))
    {
      return;
    }
    const Move best = bestMove(p, before);
    if (best.badness < (1 - kLeastBadnessGain) * before)
    {
      moves_.move(p, best.place, best.position);
      forQuadsAt(p, [&](Index q) { changed_[q] = time + 1; });
    }
  }

  /// Along the ways to the other corners of the quads at the point and back: these scale with quads that are long and
  /// thin. The first length that helps.
  Move bestMove(Index p, double before) const
  {
    Move best{ moves_.place(p), moves_.position(p), before };
    const QuadMoves::EdgeLengths lengths = moves_.edgeLengths(p, moves_.position(p));
    const std::vector<Vector3> ways = isLoose_ ? axesAt(p) : waysFrom(p);
    for (const double step : kPartsOfWay)
    {
      for (const Vector3& way : ways)
      {
        tryMove(p, step * way, lengths, best);
        tryMove(p, -step * way, lengths, best);
      }
      if (best.badness < (1 - kLeastBadnessGain) * before)
      {
        break;
      }
    }
    return best;
  }

  /// Over the surface and off it, as far as a point may leave its place.
  std::vector<Vector3> axesAt(Index p) const
  {
    const Vector3 normal = moves_.normalAt(p);
    const Vector3 tangent = moves_.tangentAt(p);
    const double far = farthestOff_ * scale_[p];
    return { far * tangent, far * normal.cross(tangent), far * normal };
  }

  std::vector<Vector3> waysFrom(Index p) const
  {
    std::vector<Index> corners;
    forQuadsAt(p,
      [&](Index q)
      {
        for (const Index c : quads_.quads[q])
        {
          if (c != p && std::find(corners.begin(), corners.end(), c) == corners.end())
          {
            corners.push_back(c);
          }
        }
      });
    std::vector<Vector3> ways;
    ways.reserve(corners.size());
    for (const Index c : corners)
    {
      ways.push_back(moves_.position(c) - moves_.position(p));
    }
    return ways;
  }

  /// Keeps the move in `best` when it is better than what is there.
  void tryMove(
    Index p, const Vector3& displacement, const QuadMoves::EdgeLengths& before, Move& best) const
  {
    const std::optional<SurfacePoint> place =
      isLoose_ ? moves_.place(p) : moves_.target(p, displacement);
    if (!place)
    {
      return;
    }
    const Vector3 position = isLoose_ ? nearAnchor(p, moves_.position(p) + displacement)
                                      : positionOf(moves_.mesh(), *place);
    const QuadMoves::EdgeLengths after = moves_.edgeLengths(p, position);
    if (!isLoose_ && after.shortest < kShortUntangledEdge * after.mean &&
      after.shortest < before.shortest)
    {
      return;
    }
    const double there = badnessAt(p, position);
    if (there < best.badness)
    {
      best = { *place, position, there };
    }
  }

  Vector3 nearAnchor(Index p, const Vector3& position) const
  {
    const Vector3 way = position - anchor_[p];
    const double far = farthestOff_ * scale_[p];
    return way.norm() > far ? Vector3(anchor_[p] + far / way.norm() * way) : position;
  }

  double badnessAt(Index p, const Vector3& position) const
  {
    double sum = 0;
    forQuadsAt(p,
      [&](Index q)
      {
        const std::array<Vector3, 4> corners = moves_.cornersWith(q, p, position);
        for (const double area : areasInUnits(q, corners))
        {
          sum += badness(area);
        }
      });
    return sum;
  }

  QuadMesh& quads_;
  const UntanglingOptions& options_;
  QuadMoves moves_;
  bool isLoose_ = false;
  double farthestOff_ = 0;
  std::vector<Vector3> anchor_; ///< per point: its place on the surface, once points may leave it
  std::vector<double>
    scale_; ///< per point that may move: mean edge length of the quads of its place
  std::vector<double> unit_; ///< per quad: area that those of its corners are held against
  std::vector<std::uint32_t> changed_; ///< per quad: when one of its points moved
  std::vector<std::uint32_t> tried_;   ///< per point: when it was looked at
};

} // namespace

std::size_t untangleQuads(const Mesh& mesh, QuadMesh& quads, const UntanglingOptions& options)
{
  const std::vector<Index> bad = badQuads(quads.points, quads.quads);
  if (bad.empty())
  {
    return 0; // inverted ones are bad
  }
  Untangling(mesh, quads, options).run(bad);
  return invertedQuads(quads.points, quads.quads).size();
}

void loosenQuads(const Mesh& mesh, QuadMesh& quads, const UntanglingOptions& options)
{
  std::vector<Index> bad = badQuads(quads.points, quads.quads);
  if (!bad.empty())
  {
    Untangling(mesh, quads, options).loosen(std::move(bad));
  }
}

} // namespace quadrille

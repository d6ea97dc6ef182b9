// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quads/QuadSmoothing.h"

#include "Base/Angles.h"
#include "Base/Parallel.h"
#include "Base/Refuse.h"
#include "Quads/QuadMoves.h"
#include "Quads/QuadShape.h"

#include <cmath>
#include <utility>

namespace quadrille
{
namespace
{

/// A move must not shorten the shortest edge at a point below this part of their mean: the scaled
/// Jacobian does not see lengths.
constexpr double kShortQuadEdge = 0.35;
/// Below this a quad is worth a search in all directions.
constexpr double kBadShape = 0.4;

/// Edges of the quads no farther off their curve than this part of their length are near enough.
constexpr double kCloseToCurve = 0.08;
/// For the sake of a curve or a guide shapes may become as bad as this.
constexpr double kShapeAsAsked = 0.3;
/// A slide has to lessen the distance of the edges from their curve to this part.
constexpr double kLeastGainOnCurve = 0.97;
/// Parts of the way to the next point of a curve, backwards and forwards, that are tried.
constexpr double kPartsOfSpan[] = { 0.6, 0.4, 0.25, 0.12, 0.05 };

class Smoother
{
public:
  Smoother(const Mesh& mesh, QuadMesh& quads, const SmoothingOptions& options)
    : quads_(quads), options_(options), moves_(mesh, quads, options.fixedVertices),
      incident_(moves_.incidentQuads())
  {
    colour();
    findGuides();
  }

  SmoothingResult run()
  {
    SmoothingResult result;
    for (int step = 0; step < options_.steps; ++step)
    {
      report(options_.progress, static_cast<double>(step) / options_.steps, "smoothing");
      const std::size_t moves = sweep();
      result.moves += moves;
      if (moves == 0)
      {
        break;
      }
    }
    return result;
  }

private:
  struct Quality
  {
    double worst = kInfinity;
    double sum = 0;

    bool betterThan(const Quality& other) const
    {
      if (worst < other.worst)
      {
        return false;
      }
      return sum > other.sum + 1e-6 || (other.worst < kBadShape && worst > other.worst + 1e-6);
    }
  };

  struct Move
  {
    SurfacePoint place;
    Vector3 position;
    Quality quality;
  };

  /// A point of a curve slides for the sake of shape only where the curve goes straight on in the quad mesh.
  bool mayMove(Index p) const
  {
    return moves_.freedom(p) == QuadMoves::Freedom::Surface ||
      (moves_.freedom(p) == QuadMoves::Freedom::Curve && moves_.isRegularOnCurve(p));
  }

  /// Colours so that two points of a quad never have the same one.
  void colour()
  {
    const Index points = static_cast<Index>(quads_.points.size());
    std::vector<Index> colourOf(points, kInvalidIndex);
    std::vector<Index> usedBy; // per colour the last point that saw it
    for (Index p = 0; p < points; ++p)
    {
      for (const Index* q = incident_.begin(p); q != incident_.end(p); ++q)
      {
        for (const Index n : quads_.quads[*q])
        {
          if (colourOf[n] != kInvalidIndex)
          {
            usedBy[colourOf[n]] = p;
          }
        }
      }
      Index c = 0;
      while (c < usedBy.size() && usedBy[c] == p)
      {
        ++c;
      }
      if (c == usedBy.size())
      {
        usedBy.push_back(kInvalidIndex);
        classes_.emplace_back();
      }
      colourOf[p] = c;
      if (moves_.freedom(p) > QuadMoves::Freedom::Fixed)
      {
        classes_[c].push_back(p);
      }
    }
  }

  std::size_t sweep()
  {
    std::size_t moves = 0;
    for (const std::vector<Index>& points : classes_)
    {
      std::vector<std::uint8_t> moved(points.size(), 0);
      parallelForEach(points.size(), kHeavyChunk, options_.threads,
        [&](std::size_t i) { moved[i] = improve(points[i]) ? 1 : 0; });
      moves += static_cast<std::size_t>(std::count(moved.begin(), moved.end(), 1));
    }
    return moves;
  }

  bool improve(Index p)
  {
    const bool follows = moves_.freedom(p) == QuadMoves::Freedom::Curve && followCurve(p);
    return (mayMove(p) && improveShape(p)) || follows;
  }

  /// Slides p to where the two edges of its curve lie nearest to the curve.
  bool followCurve(Index p)
  {
    const std::optional<QuadMoves::Spans> spans = moves_.spansAt(p, moves_.place(p));
    if (!spans)
    {
      return false;
    }
    const double before = deviationOf(*spans);
    if (before < closeTo(*spans))
    {
      return false;
    }
    const Quality quality = qualityAt(p, quads_.points[p]);
    double least = kLeastGainOnCurve * before;
    std::optional<SurfacePoint> best;
    const auto trySlide = [&](double length)
    {
      const std::optional<SurfacePoint> place = moves_.slide(p, length);
      const std::optional<QuadMoves::Spans> there =
        place ? moves_.spansAt(p, *place) : std::nullopt;
      if (!there || !(deviationOf(*there) < least))
      {
        return;
      }
      const Vector3 position = positionOf(moves_.mesh(), *place);
      const Quality after = qualityAt(p, position);
      if (!shrinksShortEdge(p, position) &&
        (after.worst >= kShapeAsAsked || after.betterThan(quality)))
      {
        least = deviationOf(*there);
        best = place;
      }
    };
    for (const double part : kPartsOfSpan)
    {
      trySlide(-part * (*spans)[0].length);
      trySlide(part * (*spans)[1].length);
    }
    if (best)
    {
      moves_.move(p, *best, positionOf(moves_.mesh(), *best));
    }
    return best.has_value();
  }

  static double deviationOf(const QuadMoves::Spans& spans)
  {
    return std::max(spans[0].deviation, spans[1].deviation);
  }

  /// What is near enough to the curve.
  static double closeTo(const QuadMoves::Spans& spans)
  {
    return kCloseToCurve * (spans[0].length + spans[1].length) / 2;
  }

  bool improveShape(Index p)
  {
    const Quality before = qualityAt(p, quads_.points[p]);
    if (before.worst > options_.goodShape)
    {
      return false;
    }
    const bool bad = before.worst < kBadShape;
    const QuadMoves::EdgeLengths lengths = moves_.edgeLengths(p, quads_.points[p]);
    const double reach = 0.5 * (bad ? lengths.mean : lengths.shortest);
    Move best{ moves_.place(p), quads_.points[p], before };
    tryWantedPlaces(p, reach, best);
    if (bad)
    {
      tryAllDirections(p, reach, best);
    }
    if (!best.quality.betterThan(before))
    {
      return false;
    }
    moves_.move(p, best.place, best.position);
    return true;
  }

  /// Towards the average of the neighbours, and to where the quads would be parallelograms.
  void tryWantedPlaces(Index p, double reach, Move& best) const
  {
    const Vector3 here = quads_.points[p];
    const Vector3 average = averageOfNeighbours(p) - here;
    const Vector3 parallelogram = parallelogramCorner(p) - here;
    for (const Vector3& wanted : { average, parallelogram, Vector3((average + parallelogram) / 2) })
    {
      const double length = wanted.norm();
      const double scale = length > reach ? reach / length : 1.0;
      for (const double factor : { 1.0, 0.5, 0.25 })
      {
        tryMove(p, factor * scale * wanted, best);
      }
    }
  }

  void tryAllDirections(Index p, double reach, Move& best) const
  {
    const Vector3 x = moves_.tangentAt(p);
    const Vector3 y = moves_.normalAt(p).cross(x);
    for (const double factor : { 1.0, 0.3, 0.1, 0.03 })
    {
      for (int i = 0; i < 8; ++i)
      {
        const double angle = i * kPi / 4;
        tryMove(p, factor * reach * (std::cos(angle) * x + std::sin(angle) * y), best);
      }
    }
  }

  /// Keeps the move in `best` when it is better than what is there.
  void tryMove(Index p, const Vector3& displacement, Move& best) const
  {
    const std::optional<SurfacePoint> place = moves_.target(p, displacement);
    if (!place)
    {
      return;
    }
    const Vector3 position = positionOf(moves_.mesh(), *place);
    if (shrinksShortEdge(p, position))
    {
      return;
    }
    const Quality quality = qualityAt(p, position);
    if (quality.betterThan(best.quality) &&
      (best.quality.worst < kShapeAsAsked ||
        (!leavesCurve(p, *place) && !leavesGuide(p, position))))
    {
      best = { *place, position, quality };
    }
  }

  /// Would the edges of p on its curve lie farther off the curve than now, and not close to it?
  bool leavesCurve(Index p, const SurfacePoint& place) const
  {
    if (moves_.freedom(p) != QuadMoves::Freedom::Curve)
    {
      return false;
    }
    const std::optional<QuadMoves::Spans> now = moves_.spansAt(p, moves_.place(p));
    const std::optional<QuadMoves::Spans> there = moves_.spansAt(p, place);
    if (!now || !there)
    {
      return now.has_value();
    }
    return deviationOf(*there) > std::max(deviationOf(*now), closeTo(*now));
  }

  /// The guides of the faces that points lie in.
  void findGuides()
  {
    const std::vector<FaceGuide>& guides = options_.guides;
    guideOf_.assign(guides.empty() ? 0 : quads_.points.size(), nullptr);
    for (std::size_t p = 0; p < guideOf_.size(); ++p)
    {
      const Index face = quads_.sourceFace[p];
      const auto found = std::lower_bound(guides.begin(), guides.end(), face,
        [](const FaceGuide& guide, Index f) { return guide.face < f; });
      guideOf_[p] = found != guides.end() && found->face == face ? &found->guide : nullptr;
    }
  }

  /// Would an edge of p that runs along its guide turn farther off it than now?
  bool leavesGuide(Index p, const Vector3& position) const
  {
    if (guideOf_.empty() || guideOf_[p] == nullptr)
    {
      return false;
    }
    const auto [backwards, forwards] = alongGuide(p, quads_.points[p]);
    const auto [backwardsThere, forwardsThere] = alongGuide(p, position);
    return backwardsThere > backwards + kRoundingOfSingle ||
      forwardsThere < forwards - kRoundingOfSingle;
  }

  /// Cosines between the guide of p and the edges that run along it, backwards and forwards.
  std::pair<double, double> alongGuide(Index p, const Vector3& position) const
  {
    const Vector3 normal = moves_.normalAt(p);
    const Vector3& guide = guideOf_[p]->direction;
    const Vector3 along = (guide - normal * normal.dot(guide)).stableNormalized();
    double least = 0, most = 0;
    moves_.forEachNeighbour(p,
      [&](const Vector3& x)
      {
        const Vector3 edge = x - position;
        const double cosine = (edge - normal * normal.dot(edge)).stableNormalized().dot(along);
        least = std::min(least, cosine);
        most = std::max(most, cosine);
      });
    return { least, most };
  }

  Quality qualityAt(Index p, const Vector3& position) const
  {
    Quality quality;
    for (const Index* q = incident_.begin(p); q != incident_.end(p); ++q)
    {
      const std::array<Vector3, 4> corners = moves_.cornersWith(*q, p, position);
      const double shape = scaledJacobian(corners);
      // A quad that turns over passes through a bow tie of -1 and gets worse from there.
      const double value = moves_.facesOutwards(*q, corners) ? shape : -2 - shape;
      quality.worst = std::min(quality.worst, value);
      quality.sum += value;
    }
    return quality;
  }

  Vector3 averageOfNeighbours(Index p) const
  {
    Vector3 sum = Vector3::Zero();
    int count = 0;
    moves_.forEachNeighbour(p,
      [&](const Vector3& x)
      {
        sum += x;
        ++count;
      });
    return sum / std::max(count, 1);
  }

  Vector3 parallelogramCorner(Index p) const
  {
    Vector3 sum = Vector3::Zero();
    for (const Index* q = incident_.begin(p); q != incident_.end(p); ++q)
    {
      const std::array<Index, 4>& c = quads_.quads[*q];
      const std::size_t i = static_cast<std::size_t>(std::find(c.begin(), c.end(), p) - c.begin());
      sum += quads_.points[c[(i + 1) % 4]] + quads_.points[c[(i + 3) % 4]] -
        quads_.points[c[(i + 2) % 4]];
    }
    return sum / incident_.size(p);
  }

  bool shrinksShortEdge(Index p, const Vector3& position) const
  {
    const QuadMoves::EdgeLengths after = moves_.edgeLengths(p, position);
    return after.shortest < kShortQuadEdge * after.mean &&
      after.shortest < moves_.edgeLengths(p, quads_.points[p]).shortest;
  }

  QuadMesh& quads_;
  const SmoothingOptions& options_;
  QuadMoves moves_;
  const PointLists& incident_;              ///< per point its quads
  std::vector<std::vector<Index>> classes_; ///< movable points per colour
  std::vector<const Guide*> guideOf_; ///< per point, null: none; empty where nothing is guided
};

} // namespace

SmoothingResult smoothQuads(const Mesh& mesh, QuadMesh& quads, const SmoothingOptions& options)
{
  refuseIf(options.steps < 0, "smoothing: the number of steps is negative");
  if (options.steps == 0 || quads.quads.empty())
  {
    return {};
  }
  return Smoother(mesh, quads, options).run();
}

} // namespace quadrille

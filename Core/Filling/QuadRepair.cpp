// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/QuadRepair.h"

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Filling/LineParts.h"
#include "Filling/QuadChanges.h"
#include "Filling/QuadPatches.h"
#include "Quads/QuadShape.h"
#include "Quads/QuadUntangling.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace quadrille
{

namespace
{

/// Rounds of changes everywhere, each with moves of points after it.
constexpr int kRoundsOfRepair = 4;
/// Sweeps after a change, before it is judged.
constexpr int kSweepsOfRepair = 3;
/// Where the worst quad has this shape then, nothing better is looked for.
constexpr double kGoodEnough = 0.3;

using Quad = QuadChanges::Quad;

class QuadRepair
{
public:
  QuadRepair(const Mesh& mesh, QuadMesh& quads, const std::vector<Index>& fixedVertices)
    : patches_(mesh, quads, fixedVertices)
  {
  }

  /// Whether anything was changed.
  bool run(const std::vector<Index>& bad)
  {
    bool any = false;
    for (const Index q : bad)
    {
      poll();
      const bool isChanged = mendAt(q) || splitLineAt(q);
      any = any || isChanged;
    }
    if (any)
    {
      patches_.finish();
    }
    return any;
  }

private:
  /// Edges between pins must not be there already outside of the patch, and what stays keeps its quads.
  bool mayBe(const QuadPatch& patch, const QuadChanges::Change& change) const
  {
    const auto stays = [&](const QuadChanges::Count& count)
    { return count.point < patch.points.size() && patches_.stays(patch.points[count.point]); };
    if (std::any_of(change.counts.begin(), change.counts.end(), stays))
    {
      return false;
    }
    std::set<std::pair<Index, Index>> before;
    for (const Index q : change.old)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        before.insert(std::minmax(patch.own.quads[q][i], patch.own.quads[q][(i + 1) % 4]));
      }
    }
    for (const Quad& quad : change.made)
    {
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Index a = quad[i], b = quad[(i + 1) % 4];
        if (a < patch.own.pinCount && b < patch.own.pinCount &&
          before.count(std::minmax(a, b)) == 0 &&
          patches_.areJoined(patch.points[a], patch.points[b]))
        {
          return false;
        }
      }
    }
    return true;
  }

  /// By the best change in the patch round a quad, or by moves alone where they do.
  bool mendAt(Index q)
  {
    const std::optional<QuadPatch> patch = patches_.around(q);
    if (!patch)
    {
      return false;
    }
    FaceQuads best = patch->own;
    relaxQuads(best, *patch->ground, kSweepsOfRepair);
    QuadScore reached = scoreOf(best);
    bool isDone = reached.bad == 0;
    FaceQuads tried = patch->own; // gets new points while they are tried
    QuadChanges changes(tried,
      [&](const QuadChanges::Change& change)
      {
        if (isDone || !mayBe(*patch, change))
        {
          return false;
        }
        FaceQuads other = tried;
        change.make(other.quads);
        const std::vector<Quad> withGaps = other.quads;
        eraseIf(other.quads, [](const Quad& quad) { return quad[0] == kInvalidIndex; });
        relaxQuads(other, *patch->ground, kSweepsOfRepair);
        const QuadScore score = scoreOf(other);
        if (score.betterThan(reached))
        {
          reached = score;
          other.quads = withGaps;
          best = std::move(other);
          isDone = reached.worst > kGoodEnough;
        }
        return false;
      });
    for (Index h = 0; h < 4 * patch->changeable && !isDone; ++h)
    {
      changes.tryAt(h);
    }
    if (!reached.hasFewerThan(scoreOf(patch->own)))
    {
      return false;
    }
    patches_.write(*patch, best);
    return true;
  }

  /// A quad between lines alone can only get more edges: one of its lines becomes three, and the quads on both sides
  /// become four each.
  ///
  ///    d --------- c
  ///    | \       / |
  ///    |  x --- y  |
  ///    |  |     |  |
  ///    a--m-----n--b     the line from a to b, of which this is one side
  bool splitLineAt(Index q)
  {
    QuadMesh& quads = patches_.quads();
    const std::size_t pointCount = quads.points.size();
    std::optional<Split> best;
    for (Index i = 0; i < 4; ++i)
    {
      std::optional<Split> split = trySplit(q, i);
      if (split && (!best || split->gain.second.betterThan(best->gain.second)))
      {
        best = std::move(split);
      }
      resizePoints(pointCount);
    }
    if (!best)
    {
      return false;
    }
    addPoints(best->points);
    for (const Side& side : best->sides)
    {
      patches_.write(side.patch, side.made);
    }
    const QuadLine line = quads.lines[best->line];
    const std::array<Index, 4> ends{ line.a, static_cast<Index>(pointCount),
      static_cast<Index>(pointCount + 1), line.b };
    for (std::size_t part = 0; part < 3; ++part)
    {
      QuadLine& made = part == 0 ? quads.lines[best->line] : quads.lines.emplace_back();
      made = { ends[part], ends[part + 1], best->points[std::min<std::size_t>(part, 1)].h,
        line.boundary };
    }
    return true;
  }

  struct Side
  {
    QuadPatch patch;
    FaceQuads made;
  };
  struct Split
  {
    std::size_t line = 0;
    std::vector<CurvePoint> points; ///< two, from the line's first point on
    std::vector<Side> sides;
    std::pair<QuadScore, QuadScore> gain; ///< before, after
  };

  void addPoints(const std::vector<CurvePoint>& points)
  {
    QuadMesh& quads = patches_.quads();
    for (const CurvePoint& point : points)
    {
      const SurfacePoint place = point.onSurface();
      quads.points.push_back(positionOf(patches_.mesh(), place));
      quads.sourceFace.push_back(place.face);
      quads.sourceWeights.push_back(place.weights);
    }
  }

  void resizePoints(std::size_t count)
  {
    QuadMesh& quads = patches_.quads();
    quads.points.resize(count);
    quads.sourceFace.resize(count);
    quads.sourceWeights.resize(count);
  }

  /// Where fewer quads are bad with it; the two new points are the last ones then.
  std::optional<Split> trySplit(Index q, Index i)
  {
    QuadMesh& quads = patches_.quads();
    const Quad quad = quads.quads[q];
    if (quad[0] == kInvalidIndex)
    {
      return std::nullopt;
    }
    const Index a = quad[i], b = quad[(i + 1) % 4];
    const std::optional<std::size_t> line = patches_.lineBetween(a, b);
    if (!line)
    {
      return std::nullopt;
    }
    Split split;
    split.line = *line;
    split.points = partLine(patches_.mesh(), quads, quads.lines[*line], 3);
    if (split.points.empty())
    {
      return std::nullopt;
    }
    const auto m = static_cast<Index>(quads.points.size()), n = m + 1;
    addPoints(split.points);
    const bool isForwards = quads.lines[*line].a == a;
    const Index twin = patches_.twin()[4 * q + i];
    split.sides.reserve(2);
    const bool isOne = addSide(4 * q + i, isForwards ? m : n, isForwards ? n : m, split) &&
      (twin == kInvalidIndex || addSide(twin, isForwards ? n : m, isForwards ? m : n, split));
    return isOne && areApart(split.sides) && split.gain.second.hasFewerThan(split.gain.first)
      ? std::optional<Split>(std::move(split))
      : std::nullopt;
  }

  static bool areApart(const std::vector<Side>& sides)
  {
    const auto isInFirst = [&](Index q) { return contains(sides[0].patch.quads, q); };
    return sides.size() < 2 ||
      std::none_of(sides[1].patch.quads.begin(), sides[1].patch.quads.end(), isInFirst);
  }

  /// m, n: the new points, from the beginning of half-edge h on.
  bool addSide(Index h, Index m, Index n, Split& split) const
  {
    std::optional<QuadPatch> patch = patches_.around(h / 4, { m, n });
    if (!patch)
    {
      return false;
    }
    FaceQuads made = patch->own;
    const Quad quad = made.quads[0]; // of h
    const Index a = quad[h % 4], b = quad[(h + 1) % 4], c = quad[(h + 2) % 4],
                d = quad[(h + 3) % 4];
    if (patches_.stays(patch->points[c]) || patches_.stays(patch->points[d]))
    {
      return false;
    }
    const bool isFirst = patch->points[0] == m;
    const Index ownM = isFirst ? 0 : 1, ownN = isFirst ? 1 : 0;
    const auto x = static_cast<Index>(made.points.size()), y = x + 1;
    for (const auto& [near, far, beside] : { std::array{ d, c, ownM }, std::array{ c, d, ownN } })
    {
      made.points.emplace_back(
        (made.points[near] * 2 + made.points[far]) / 6 + made.points[beside] / 2);
      made.normals.push_back((made.normals[near] + made.normals[beside]).normalized());
      made.fitting.push_back(4);
    }
    made.quads[0] = { a, ownM, x, d };
    made.quads.push_back({ ownM, ownN, y, x });
    made.quads.push_back({ ownN, b, c, y });
    made.quads.push_back({ d, x, y, c });
    relaxQuads(made, *patch->ground, 2 * kSweepsOfRepair);
    split.gain.first.add(scoreOf(patch->own));
    split.gain.second.add(scoreOf(made));
    split.sides.push_back({ std::move(*patch), std::move(made) });
    return true;
  }

  QuadPatches patches_;
};

} // namespace

void repairQuads(
  const Mesh& mesh, QuadMesh& quads, const std::vector<Index>& fixedVertices, int threads)
{
  const auto badQuads = [&quads]
  {
    return idsWhere(quads.quads.size(),
      [&](Index q)
      { return scaledJacobian(cornersOf(quads.points, quads.quads[q])) < kLeastShape; });
  };
  std::vector<Index> bad = badQuads();
  for (int round = 0; round < kRoundsOfRepair && !bad.empty() && quads.polygonOffsets.empty();
       ++round)
  {
    if (!QuadRepair(mesh, quads, fixedVertices).run(bad))
    {
      break;
    }
    untangleQuads(mesh, quads, { fixedVertices, threads });
    bad = badQuads();
  }
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/QuadRepair.h"

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Filling/QuadChanges.h"
#include "Filling/QuadPatches.h"
#include "Quads/QuadShape.h"
#include "Quads/QuadUntangling.h"

#include <algorithm>
#include <iterator>
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
  QuadRepair(const Mesh& mesh, QuadMesh& quads, const QuadRepairOptions& options)
    : patches_(mesh, quads, options.fixedVertices)
  {
    if (options.keptChains)
    {
      patches_.keep(options.keptChains(quads));
    }
  }

  /// Whether anything was changed.
  bool run(const std::vector<Index>& bad)
  {
    bool any = false;
    for (const Index q : bad)
    {
      poll();
      const bool isMended = mendAt(q);
      countTry(Try::OtherEdges);
      countTryLed(Try::OtherEdges, isMended ? 1 : 0);
      any = any || isMended;
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
    const QuadScore before = scoreOf(patch->own);
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
    if (!reached.hasFewerThan(before))
    {
      return false;
    }
    patches_.write(*patch, best);
    return true;
  }

  QuadPatches patches_;
};

} // namespace

void repairQuads(const Mesh& mesh, QuadMesh& quads, const QuadRepairOptions& options)
{
  // The worst first: what is changed for one is not changed for another in the same round.
  const auto worstFirst = [&quads]
  {
    std::vector<std::pair<double, Index>> found;
    for (const Index q : badQuads(quads.points, quads.quads))
    {
      found.emplace_back(scaledJacobian(cornersOf(quads.points, quads.quads[q])), q);
    }
    std::sort(found.begin(), found.end());
    std::vector<Index> bad;
    std::transform(found.begin(), found.end(), std::back_inserter(bad),
      [](const std::pair<double, Index>& one) { return one.second; });
    return bad;
  };
  std::vector<Index> bad = worstFirst();
  for (int round = 0; round < kRoundsOfRepair && !bad.empty() && quads.polygonOffsets.empty();
       ++round)
  {
    if (!QuadRepair(mesh, quads, options).run(bad))
    {
      break;
    }
    untangleQuads(mesh, quads, { options.fixedVertices, options.threads });
    bad = worstFirst();
  }
}

} // namespace quadrille

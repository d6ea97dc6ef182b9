// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/QuadRepair.h"

#include "Base/Lists.h"
#include "Base/Progress.h"
#include "Filling/FaceGround.h"
#include "Filling/QuadChanges.h"
#include "Filling/QuadRelaxation.h"
#include "Quads/QuadShape.h"
#include "Quads/QuadTopology.h"
#include "Quads/QuadUntangling.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace quadrille
{

namespace
{

/// Rounds of changes everywhere, each with moves of points after it.
constexpr int kMostRounds = 4;
/// Rings of quads round an inverted one that changes are tried in, and whose points may move.
constexpr int kRingsOfChanges = 1, kRingsThatMove = 2;
/// Sweeps after a change, before it is judged.
constexpr int kSweeps = 3;
/// Quads with a smaller scaled Jacobian are mended as those that are inverted.
constexpr double kLeastShape = 0.1;
/// Where the worst quad has this shape then, nothing better is looked for.
constexpr double kGoodEnough = 0.3;

class QuadRepair
{
public:
  QuadRepair(const Mesh& mesh, QuadMesh& quads, const std::vector<Index>& fixedVertices)
    : mesh_(mesh), quads_(quads), topology_(analyzeQuads(quads.quads, quads.points.size())),
      quadsAt_(quads.points.size(),
        [&quads](const auto& visit)
        {
          for (Index c = 0; c < 4 * quads.quads.size(); ++c)
          {
            visit(quads.quads[c / 4][c % 4], c / 4);
          }
        }),
      stays_(quads.points.size(), 0), onLine_(topology_.onBoundary),
      isTouched_(quads.quads.size(), 0)
  {
    for (const QuadLine& line : quads.lines)
    {
      lines_.insert(std::minmax(line.a, line.b));
      onLine_[line.a] = 1;
      onLine_[line.b] = 1;
    }
    for (Index p = 0; p < quads.points.size() && !fixedVertices.empty(); ++p)
    {
      const std::optional<Index> corner = meshCorner(quads, p);
      stays_[p] = corner &&
          std::binary_search(fixedVertices.begin(), fixedVertices.end(), mesh.origin[*corner])
        ? 1
        : 0;
    }
  }

  /// Whether anything was changed.
  bool run(const std::vector<Index>& inverted)
  {
    bool any = false;
    for (const Index q : inverted)
    {
      poll();
      any |= mendAt(q);
    }
    if (any)
    {
      dropUnused();
    }
    return any;
  }

private:
  using Quad = QuadChanges::Quad;

  /// Quads between lines, the nearest first, with own points.
  struct Patch
  {
    std::vector<Index> quads;
    std::size_t changeable = 0; ///< so many of them, the first ones, may change
    std::vector<Index> points;  ///< pins first
    FaceQuads own;
  };

  struct Score
  {
    std::size_t inverted = 0, bad = 0; ///< bad ones are inverted, too
    double worst = 1;
    bool hasFewerThan(const Score& other) const
    {
      return inverted < other.inverted || (inverted == other.inverted && bad < other.bad);
    }
    bool betterThan(const Score& other) const
    {
      return hasFewerThan(other) ||
        (inverted == other.inverted && bad == other.bad && worst > other.worst);
    }
  };

  static Score scoreOf(const FaceQuads& mesh)
  {
    Score score;
    for (const Quad& quad : mesh.quads)
    {
      if (quad[0] != kInvalidIndex)
      {
        const double shape =
          std::min(shapeOfQuad(mesh, quad), scaledJacobian(cornersOf(mesh.points, quad)));
        score.inverted += shape > 0 ? 0 : 1;
        score.bad += shape < kLeastShape ? 1 : 0;
        score.worst = std::min(score.worst, shape);
      }
    }
    return score;
  }

  /// In rings round a quad, without crossing lines. False where one of them was changed already.
  bool collect(Index first, Patch& patch) const
  {
    if (isTouched_[first] != 0)
    {
      return false;
    }
    std::set<Index> known{ first };
    patch.quads = { first };
    std::size_t begin = 0;
    bool isFresh = true;
    for (int ring = 1; isFresh && ring <= kRingsThatMove; ++ring)
    {
      const std::size_t end = patch.quads.size();
      const auto add = [&](Index q)
      {
        if (known.insert(q).second)
        {
          patch.quads.push_back(q);
          isFresh = isFresh && isTouched_[q] == 0;
        }
      };
      for (; begin < end; ++begin)
      {
        for (Index h = 4 * patch.quads[begin]; h < 4 * patch.quads[begin] + 4; ++h)
        {
          const Index a = quads_.quads[h / 4][h % 4], b = quads_.quads[h / 4][nextInQuad(h) % 4];
          const Index twin = topology_.twin[h];
          if (twin != kInvalidIndex && lines_.count(std::minmax(a, b)) == 0)
          {
            add(twin / 4);
          }
          if (onLine_[a] == 0)
          {
            std::for_each(quadsAt_.begin(a), quadsAt_.end(a), add);
          }
        }
      }
      patch.changeable = ring == kRingsOfChanges ? patch.quads.size() : patch.changeable;
    }
    return isFresh;
  }

  /// The triangles below the quads, and round them as far as these are wide, without crossing features.
  std::vector<Index> trianglesBelow(const Patch& patch) const
  {
    Eigen::AlignedBox3d box;
    for (const Index q : patch.quads)
    {
      for (const Index p : quads_.quads[q])
      {
        box.extend(quads_.points[p]);
      }
    }
    const Vector3 margin = Vector3::Constant(0.5 * box.diagonal().norm());
    box = Eigen::AlignedBox3d(box.min() - margin, box.max() + margin);
    std::vector<Index> found;
    std::set<Index> known;
    const auto add = [&](Index f)
    {
      Eigen::AlignedBox3d triangle;
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        triangle.extend(mesh_.position[mesh_.origin[h]]);
      }
      if (box.intersects(triangle) && known.insert(f).second)
      {
        found.push_back(f);
      }
    };
    for (const Index q : patch.quads)
    {
      add(quads_.quadSourceFace[q]);
    }
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      for (Index h = 3 * found[i]; h < 3 * found[i] + 3; ++h)
      {
        if (!mesh_.isConstrained(h))
        {
          add(Mesh::face(mesh_.twin[h]));
        }
      }
    }
    return found;
  }

  static Mesh meshOf(const Mesh& mesh, const std::vector<Index>& triangles)
  {
    Mesh part;
    std::map<Index, Index> own;
    for (const Index f : triangles)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        const auto [found, isNew] =
          own.emplace(mesh.origin[h], static_cast<Index>(part.position.size()));
        if (isNew)
        {
          part.position.push_back(Vector3(mesh.position[mesh.origin[h]]));
        }
        part.origin.push_back(Index{ found->second });
        part.twin.push_back(Index{ kInvalidIndex });
        part.flags.push_back(0);
      }
    }
    return part;
  }

  void number(const FaceGround& ground, Patch& patch) const
  {
    const std::set<Index> within(patch.quads.begin(), patch.quads.end());
    const auto isPin = [&](Index p)
    {
      return onLine_[p] != 0 || stays_[p] != 0 ||
        std::any_of(
          quadsAt_.begin(p), quadsAt_.end(p), [&](Index q) { return within.count(q) == 0; });
    };
    std::map<Index, Index> own;
    for (const bool pins : { true, false })
    {
      for (const Index q : patch.quads)
      {
        for (const Index p : quads_.quads[q])
        {
          if (isPin(p) == pins && own.emplace(p, static_cast<Index>(patch.points.size())).second)
          {
            const auto spot = ground.at(quads_.points[p], Vector3::Zero(), quads_.points[p]);
            patch.points.push_back(p);
            patch.own.points.push_back(quads_.points[p]);
            patch.own.normals.push_back(spot->normal);
            patch.own.fitting.push_back(4);
          }
        }
      }
      patch.own.pinCount = pins ? static_cast<Index>(patch.points.size()) : patch.own.pinCount;
    }
    for (const Index q : patch.quads)
    {
      const Quad& quad = quads_.quads[q];
      patch.own.quads.push_back({ own[quad[0]], own[quad[1]], own[quad[2]], own[quad[3]] });
    }
  }

  /// Edges between pins must not be there already outside of the patch, and what stays keeps its quads.
  bool mayBe(const Patch& patch, const QuadChanges::Change& change) const
  {
    const auto stays = [&](const QuadChanges::Count& count)
    { return count.point < patch.points.size() && stays_[patch.points[count.point]] != 0; };
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
          before.count(std::minmax(a, b)) == 0 && areJoined(patch.points[a], patch.points[b]))
        {
          return false;
        }
      }
    }
    return true;
  }

  bool areJoined(Index a, Index b) const
  {
    return std::any_of(quadsAt_.begin(a), quadsAt_.end(a),
      [&](Index q)
      {
        const Quad& quad = quads_.quads[q];
        const auto at = std::find(quad.begin(), quad.end(), a) - quad.begin();
        return quad[(at + 1) % 4] == b || quad[(at + 3) % 4] == b;
      });
  }

  bool mendAt(Index q)
  {
    Patch patch;
    if (!collect(q, patch))
    {
      return false;
    }
    const std::vector<Index> triangles = trianglesBelow(patch);
    if (triangles.empty())
    {
      return false;
    }
    const Mesh below = meshOf(mesh_, triangles);
    const FaceGround ground(below);
    number(ground, patch);
    FaceQuads best = patch.own;
    relaxQuads(best, ground, kSweeps);
    const Score before = scoreOf(best);
    Score reached = before;
    if (before.bad == 0)
    {
      write(patch, best, triangles, ground);
      return true;
    }
    bool isDone = false;
    FaceQuads tried = patch.own; // gets new points while they are tried
    QuadChanges changes(tried,
      [&](const QuadChanges::Change& change)
      {
        if (isDone || !mayBe(patch, change))
        {
          return false;
        }
        FaceQuads other = tried;
        change.make(other.quads);
        const std::vector<Quad> withGaps = other.quads;
        eraseIf(other.quads, [](const Quad& quad) { return quad[0] == kInvalidIndex; });
        relaxQuads(other, ground, kSweeps);
        const Score score = scoreOf(other);
        if (score.betterThan(reached))
        {
          reached = score;
          other.quads = withGaps;
          best = std::move(other);
          isDone = reached.worst > kGoodEnough;
        }
        return false;
      });
    for (Index h = 0; h < 4 * patch.quads.size() && !isDone; ++h)
    {
      if (h / 4 < patch.changeable)
      {
        changes.tryAt(h);
      }
    }
    if (!reached.hasFewerThan(scoreOf(patch.own)))
    {
      return false;
    }
    write(patch, best, triangles, ground);
    return true;
  }

  void write(const Patch& patch, const FaceQuads& made, const std::vector<Index>& triangles,
    const FaceGround& ground)
  {
    for (const Index q : patch.quads)
    {
      isTouched_[q] = 1;
    }
    std::vector<Index> ids = patch.points;
    for (std::size_t v = made.pinCount; v < made.points.size(); ++v)
    {
      const auto facing = ground.at(made.points[v], made.normals[v], made.points[v]);
      const FaceGround::Spot spot =
        facing ? *facing : *ground.at(made.points[v], Vector3::Zero(), made.points[v]);
      if (v >= ids.size())
      {
        ids.push_back(static_cast<Index>(quads_.points.size()));
        quads_.points.emplace_back();
        quads_.sourceFace.emplace_back();
        quads_.sourceWeights.emplace_back();
      }
      quads_.points[ids[v]] = spot.point;
      quads_.sourceFace[ids[v]] = triangles[spot.face];
      quads_.sourceWeights[ids[v]] = spot.weights;
    }
    for (std::size_t i = 0; i < made.quads.size(); ++i)
    {
      const Quad& quad = made.quads[i];
      if (i < patch.quads.size() && quad == patch.own.quads[i])
      {
        continue;
      }
      Quad there = quad;
      Vector3 middle = Vector3::Zero();
      for (Index& p : there)
      {
        p = p == kInvalidIndex ? p : ids[p];
        middle += p == kInvalidIndex ? Vector3::Zero() : Vector3(quads_.points[p] / 4);
      }
      if (i >= patch.quads.size())
      {
        quads_.quads.emplace_back();
        quads_.quadSourceFace.emplace_back();
        quads_.quadSourceWeights.emplace_back();
      }
      const std::size_t q = i < patch.quads.size() ? patch.quads[i] : quads_.quads.size() - 1;
      quads_.quads[q] = there;
      quads_.quadSourceFace[q] = triangles[ground.at(middle, Vector3::Zero(), middle)->face];
      quads_.quadSourceWeights[q] = {};
    }
  }

  /// Quads that have gone, and points that have none any more.
  void dropUnused()
  {
    const auto keep = [](auto& list, const std::vector<Index>& kept)
    {
      for (std::size_t i = 0; i < kept.size(); ++i)
      {
        list[i] = list[kept[i]];
      }
      list.resize(kept.size());
    };
    const std::vector<Index> kept =
      idsWhere(quads_.quads.size(), [&](Index q) { return quads_.quads[q][0] != kInvalidIndex; });
    keep(quads_.quads, kept);
    keep(quads_.quadSourceFace, kept);
    keep(quads_.quadSourceWeights, kept);
    std::vector<Index> newId(quads_.points.size(), kInvalidIndex);
    for (const Quad& quad : quads_.quads)
    {
      for (const Index p : quad)
      {
        newId[p] = 0;
      }
    }
    const std::vector<Index> points =
      idsWhere(newId.size(), [&](Index p) { return newId[p] != kInvalidIndex; });
    for (Index i = 0; i < points.size(); ++i)
    {
      newId[points[i]] = i;
    }
    keep(quads_.points, points);
    keep(quads_.sourceFace, points);
    keep(quads_.sourceWeights, points);
    for (Quad& quad : quads_.quads)
    {
      for (Index& p : quad)
      {
        p = newId[p];
      }
    }
    for (QuadLine& line : quads_.lines)
    {
      line.a = newId[line.a];
      line.b = newId[line.b];
    }
    QuadTopology topology = analyzeQuads(quads_.quads, quads_.points.size());
    quads_.valence = std::move(topology.valence);
    quads_.onBoundary = std::move(topology.onBoundary);
  }

  const Mesh& mesh_;
  QuadMesh& quads_;
  QuadTopology topology_;
  Grouped<> quadsAt_; ///< per point
  std::vector<std::uint8_t> stays_, onLine_;
  std::vector<std::uint8_t> isTouched_; ///< per quad: by a change
  std::set<std::pair<Index, Index>> lines_;
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
  for (int round = 0; round < kMostRounds && !bad.empty() && quads.polygonOffsets.empty(); ++round)
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

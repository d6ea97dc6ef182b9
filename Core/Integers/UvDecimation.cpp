// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Integers/UvDecimation.h"

#include "Base/Lists.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace quadrille
{

namespace
{

/// Stars up to this size go first: large stars cost more and leave worse triangles behind.
constexpr std::size_t kSmallStar = 8;

class Decimator
{
public:
  Decimator(UvMesh& mesh, UvEditor& editor, std::vector<std::uint8_t>& keep)
    : mesh_(mesh), editor_(editor), keep_(keep)
  {
  }

  void run()
  {
    keepStraightEdges();
    std::vector<Index> all(mesh_.origin.size());
    std::iota(all.begin(), all.end(), Index{ 0 });
    makeDelaunay(all);
    std::size_t limit = kSmallStar;
    while (true)
    {
      if (removeIndependent(limit) > 0)
      {
        limit = kSmallStar;
      }
      else if (limit == kSmallStar)
      {
        limit = mesh_.origin.size();
      }
      else
      {
        break;
      }
    }
    for (Index v = 0; v < keep_.size(); ++v)
    {
      keep_[v] = mesh_.outgoing[v] != kInvalidIndex;
    }
  }

private:
  void keepStraightEdges()
  {
    for (Index h = 0; h < mesh_.origin.size(); ++h)
    {
      if (keep_[mesh_.origin[h]] && keep_[mesh_.target(h)])
      {
        mesh_.flags[h] |= kUvKept;
      }
    }
  }

  double cotangentOpposite(Index h) const
  {
    const FixedVec2 c = mesh_.uv[Mesh::previous(h)];
    const Vector2 a = toDouble(mesh_.uv[h] - c), b = toDouble(mesh_.uv[Mesh::next(h)] - c);
    return a.dot(b) / (a.x() * b.y() - a.y() * b.x());
  }

  bool wantsFlip(Index h) const
  {
    return !mesh_.isFixed(h) &&
      cotangentOpposite(h) + cotangentOpposite(mesh_.twin[h]) < -kRounding && editor_.canFlip(h);
  }

  void makeDelaunay(const std::vector<Index>& slots)
  {
    std::vector<Index> stack =
      elementsWhere(slots, [&](Index slot) { return mesh_.alive[Mesh::face(slot)] != 0; });
    // Each flip lowers the Delaunay energy by more than rounding; the budget is for what theory missed.
    flipWhere(
      mesh_, std::move(stack), 64 * mesh_.origin.size() + 1000,
      [&](Index h) { return wantsFlip(h); }, [&](Index h) { editor_.flip(h); });
  }

  /// One round over vertices whose stars do not touch, so that stars stay small.
  std::size_t removeIndependent(std::size_t starLimit)
  {
    std::vector<std::uint8_t> touched(keep_.size(), 0);
    std::size_t removed = 0;
    for (Index v = 0; v < keep_.size(); ++v)
    {
      if (keep_[v] || touched[v] || mesh_.outgoing[v] == kInvalidIndex)
      {
        continue;
      }
      const std::vector<Index> star = mesh_.star(v);
      if (star.size() > starLimit)
      {
        continue;
      }
      for (const Index h : star)
      {
        touched[mesh_.target(h)] = 1;
        touched[mesh_.origin[Mesh::previous(h)]] = 1;
      }
      const std::size_t before = editor_.recordCount();
      removed += removeVertex(v) ? 1 : 0;
      makeDelaunay(editor_.slotsSince(before));
    }
    return removed;
  }

  bool touchesItself(const std::vector<Index>& star, Index v) const
  {
    return std::any_of(star.begin(), star.end(),
      [&](Index h) { return mesh_.target(h) == v || mesh_.origin[Mesh::previous(h)] == v; });
  }

  bool removeVertex(Index v)
  {
    std::vector<Index> star = mesh_.star(v);
    if (touchesItself(star, v))
    {
      return false;
    }
    const bool boundary = mesh_.twin[star.front()] == kInvalidIndex;
    const bool curve =
      boundary || std::any_of(star.begin(), star.end(), [&](Index h) { return mesh_.isFixed(h); });
    while (true)
    {
      if (const auto line = lineToRemoveOn(star, boundary, curve))
      {
        editor_.removeOnLine(*line);
        return true;
      }
      if (!curve && star.size() == 3)
      {
        editor_.removeInside(star.front());
        return true;
      }
      const Index ear = bestEar(star);
      if (ear == kInvalidIndex)
      {
        return false;
      }
      editor_.flip(ear);
      star = mesh_.star(v);
    }
  }

  /// The half-edge along which v may be dropped from a straight line, if its star is down to that.
  std::optional<Index> lineToRemoveOn(
    const std::vector<Index>& star, bool boundary, bool curve) const
  {
    if (boundary)
    {
      return star.size() == 2 ? std::optional<Index>(star.front()) : std::nullopt;
    }
    if (star.size() != 4)
    {
      return std::nullopt;
    }
    for (int i = 0; i < 2; ++i)
    {
      if (curve ? mesh_.isFixed(star[i]) && mesh_.isFixed(star[i + 2]) : isStraight(star, i))
      {
        return star[i];
      }
    }
    return std::nullopt;
  }

  /// Whether half-edges i and i + 2 of the star continue each other.
  bool isStraight(const std::vector<Index>& star, int i) const
  {
    const Index between = star[i + 1];
    const FixedVec2 far = mesh_.vector(star[i]);
    // From the chart of the second face to that of the first.
    const Transition back = mesh_.transition(between);
    const FixedVec2 here = mesh_.uv[star[i]];
    const FixedVec2 other = back.apply(mesh_.uv[Mesh::previous(between)]) - here;
    return Int128{ far.u } * other.v == Int128{ far.v } * other.u;
  }

  /// Of the star's edges that a flip takes away, the one that leaves the best triangle outside the star.
  Index bestEar(const std::vector<Index>& star) const
  {
    Index best = kInvalidIndex;
    double bestQuality = 0;
    for (const Index h : star)
    {
      if (!editor_.canFlip(h))
      {
        continue;
      }
      const double quality = earQuality(h);
      if (quality > bestQuality)
      {
        bestQuality = quality;
        best = h;
      }
    }
    return best;
  }

  /// Quality of the triangle (x, c, d) that flipping h = v -> x cuts off.
  double earQuality(Index h) const
  {
    const Index g = mesh_.twin[h];
    const Vector2 x = toDouble(mesh_.uv[g]);
    const Vector2 c = toDouble(mesh_.transition(h).apply(mesh_.uv[Mesh::previous(h)]));
    const Vector2 d = toDouble(mesh_.uv[Mesh::previous(g)]);
    const Vector2 p = c - x, q = d - x;
    return (p.x() * q.y() - p.y() * q.x()) /
      (p.squaredNorm() + q.squaredNorm() + (d - c).squaredNorm());
  }

  UvMesh& mesh_;
  UvEditor& editor_;
  std::vector<std::uint8_t>& keep_;
};

} // namespace

void decimateInUv(UvMesh& mesh, UvEditor& editor, std::vector<std::uint8_t>& keep)
{
  Decimator(mesh, editor, keep).run();
}

} // namespace quadrille

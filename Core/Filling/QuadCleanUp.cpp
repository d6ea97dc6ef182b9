// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Filling/QuadCleanUp.h"

#include "Base/Lists.h"
#include "Filling/QuadRelaxation.h"
#include "Quads/QuadMesh.h"
#include "Quads/QuadTopology.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace quadrille
{

namespace
{

/// Passes over all quads; faces that are not done after so many hardly change any more.
constexpr int kCleanUpPasses = 20;
/// Sweeps of smoothing after each pass, and at the end.
constexpr int kSweeps = 2, kLastSweeps = 10;
/// A change of the connectivity may make quads worse than they are down to this shape (see quadShape) only: smoothing
/// raises it again.
constexpr double kSoundChange = 0.1;

using Quad = std::array<Index, 4>;
using Edge = std::pair<Index, Index>;

Edge edgeOf(const Quad& quad, std::size_t i)
{
  return std::minmax(quad[i], quad[(i + 1) % 4]);
}

class QuadChanges
{
public:
  explicit QuadChanges(FaceQuads& mesh)
    : mesh_(mesh), topology_(analyzeQuads(mesh.quads, mesh.points.size())),
      isChanged_(mesh.quads.size(), 0), quadsAt_(mesh.points.size(),
                                          [&mesh](const auto& visit)
                                          {
                                            for (Index h = 0; h < 4 * mesh.quads.size(); ++h)
                                            {
                                              visit(mesh.quads[h / 4][h % 4], h);
                                            }
                                          })
  {
  }

  /// One pass over all quads; whether something was changed.
  bool run()
  {
    bool any = false;
    for (Index v = mesh_.pinCount; v < oldPointCount(); ++v)
    {
      any |= tryDoublet(v);
    }
    for (Index h = 0; h < isChanged_.size() * 4; ++h)
    {
      any |= tryCollapse(h) || tryRotateEdge(h) || tryInsert(h);
    }
    eraseIf(mesh_.quads, [](const Quad& quad) { return quad[0] == kInvalidIndex; });
    return any;
  }

private:
  bool isPin(Index v) const { return v < mesh_.pinCount; }
  Index quadCount(Index v) const { return quadsAt_.size(v); }

  Index corner(Index h) const { return mesh_.quads[h / 4][h % 4]; }

  bool isFresh(Index v) const
  {
    return std::all_of(
      quadsAt_.begin(v), quadsAt_.end(v), [this](Index h) { return isChanged_[h / 4] == 0; });
  }

  bool areNeighbours(Index a, Index b) const
  {
    return std::any_of(quadsAt_.begin(a), quadsAt_.end(a),
      [&](Index h) { return corner(nextInQuad(h)) == b || corner(previousInQuad(h)) == b; });
  }

  double worstShape(const std::vector<Quad>& quads) const
  {
    double worst = 1;
    for (const Quad& quad : quads)
    {
      worst = std::min(worst, shapeOfQuad(mesh_, quad));
    }
    return worst;
  }

  /// How far off angles are by the number of quads, as if each had the same share.
  double misfit(Index v, Index count) const
  {
    const double off = count == 0 ? 0 : std::log(count / mesh_.fitting[v]);
    return off * off;
  }

  bool fits(Index v, Index count) const { return isPin(v) ? count >= 1 : count == 0 || count >= 3; }

  /// Replaces quads by others with the same boundary, where angles come to fit better; there may be new points among
  /// theirs.
  bool improve(const std::vector<Index>& old, const std::vector<Quad>& made)
  {
    return isBetter(old, made) && mayReplace(old, made) &&
      worstShape(made) >= std::min(kSoundChange, worstShape(quadsOf(old))) && replace(old, made);
  }

  bool isBetter(const std::vector<Index>& old, const std::vector<Quad>& made) const
  {
    std::vector<std::pair<Index, int>> changes; // point, one quad less or more
    const auto note = [&](const Quad& quad, int change)
    {
      for (const Index v : quad)
      {
        changes.emplace_back(v, change);
      }
    };
    for (const Index q : old)
    {
      if (isChanged_[q] != 0)
      {
        return false;
      }
      note(mesh_.quads[q], -1);
    }
    for (const Quad& quad : made)
    {
      note(quad, 1);
    }
    std::sort(changes.begin(), changes.end());
    double gain = 0;
    for (auto first = changes.begin(); first != changes.end();)
    {
      const Index v = first->first, before = v < oldPointCount() ? quadCount(v) : 0;
      Index after = before;
      for (; first != changes.end() && first->first == v; ++first)
      {
        after += static_cast<Index>(first->second);
      }
      if (after != before)
      {
        if (!fits(v, after))
        {
          return false;
        }
        gain += misfit(v, before) - misfit(v, after);
      }
    }
    return gain > 1e-6;
  }

  std::vector<Quad> quadsOf(const std::vector<Index>& ids) const
  {
    std::vector<Quad> quads;
    quads.reserve(ids.size());
    for (const Index q : ids)
    {
      quads.push_back(mesh_.quads[q]);
    }
    return quads;
  }

  std::size_t oldPointCount() const { return topology_.valence.size(); }

  /// Is nothing changed yet around the quads, are the four points of each new one different, and all edges that were
  /// none before new ones?
  bool mayReplace(const std::vector<Index>& old, const std::vector<Quad>& made) const
  {
    std::vector<Edge> edges;
    for (const Index q : old)
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
    return std::all_of(made.begin(), made.end(),
      [&](const Quad& quad)
      {
        for (std::size_t i = 0; i < 4; ++i)
        {
          const Edge edge = edgeOf(quad, i);
          if (std::count(quad.begin(), quad.end(), quad[i]) > 1 ||
            (!contains(edges, edge) && edge.second < oldPointCount() &&
              areNeighbours(edge.first, edge.second)))
          {
            return false;
          }
        }
        return true;
      });
  }

  bool replace(const std::vector<Index>& old, const std::vector<Quad>& made)
  {
    for (std::size_t i = 0; i < std::max(old.size(), made.size()); ++i)
    {
      if (i >= old.size())
      {
        mesh_.quads.push_back(made[i]);
        continue;
      }
      isChanged_[old[i]] = 1;
      mesh_.quads[old[i]] = i < made.size()
        ? made[i]
        : Quad{ kInvalidIndex, kInvalidIndex, kInvalidIndex, kInvalidIndex };
    }
    return true;
  }

  /// A point with two quads: they become one.
  bool tryDoublet(Index v)
  {
    if (quadCount(v) != 2 || !isFresh(v))
    {
      return false;
    }
    const Index h = quadsAt_.begin(v)[0], g = quadsAt_.begin(v)[1];
    const std::vector<Index> old{ h / 4, g / 4 };
    const std::vector<Quad> made{ { corner(nextInQuad(h)), corner(oppositeInQuad(h)),
      corner(previousInQuad(h)), corner(oppositeInQuad(g)) } };
    return mayReplace(old, made) && replace(old, made);
  }

  /// The quad of h goes, and so does the point where h begins: it becomes the opposite one.
  bool tryCollapse(Index h)
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
    return improve(old, made);
  }

  /// The hexagon of the two quads at an edge, counterclockwise; the edge joins its points 0 and 3. None where one of
  /// them is changed already.
  std::optional<std::array<Index, 6>> hexagonAt(Index h) const
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
  bool tryRotateEdge(Index h)
  {
    const auto hexagon = hexagonAt(h);
    if (!hexagon)
    {
      return false;
    }
    const auto& r = *hexagon;
    const std::vector<Index> old{ h / 4, topology_.twin[h] / 4 };
    return improve(old, { { r[0], r[1], r[4], r[5] }, { r[1], r[2], r[3], r[4] } }) ||
      improve(old, { { r[5], r[0], r[1], r[2] }, { r[2], r[3], r[4], r[5] } });
  }

  /// Four quads in place of two, with two new points: two opposite points of the hexagon get another edge each, and no
  /// other point one more or less.
  bool tryInsert(Index h)
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
      const bool isDone = improve(old, made);
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
  void addPoint(const std::array<Index, 6>& hexagon, Index a, Index b)
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

  void resize(std::size_t count)
  {
    mesh_.points.resize(count);
    mesh_.normals.resize(count);
    mesh_.fitting.resize(count);
  }

  FaceQuads& mesh_;
  QuadTopology topology_;
  std::vector<std::uint8_t> isChanged_; ///< per quad of before
  Grouped<> quadsAt_;                   ///< per point the half-edges that leave it
};

} // namespace

void cleanUpQuads(FaceQuads& mesh, const FaceGround& ground)
{
  bool any = true;
  for (int pass = 0; any && pass < kCleanUpPasses; ++pass)
  {
    relaxQuads(mesh, ground, kSweeps);
    any = QuadChanges(mesh).run();
  }
  relaxQuads(mesh, ground, kLastSweeps);
}

} // namespace quadrille

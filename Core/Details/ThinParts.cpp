// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Details/ThinParts.h"

#include "Base/Progress.h"
#include "Base/TryCount.h"
#include "Details/PartingLoops.h"
#include "Mesh/AskedVertices.h"
#include "Mesh/ContentHash.h"
#include "Mesh/Sizing.h"
#include "Mesh/SpaceFillingOrder.h"
#include "Mesh/SurfaceEdit.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace quadrille
{

namespace
{

/// The least height of a part over the length of its loop: what is flatter is a bump.
constexpr double kLeastRise = 0.125;
/// How far from the loop, over its length, the tip and the vertex outside are if they can be.
constexpr double kFarOverLength = 1.1;
/// Faces that the search for parts looks at over those of the mesh. Where there are no necks it is one.
constexpr std::size_t kMostWork = 100;

std::vector<Index> outgoingOf(const Mesh& mesh)
{
  std::vector<Index> outgoing(mesh.vertexCount(), kInvalidIndex);
  for (Index h = 0; h < mesh.halfEdgeCount(); ++h)
  {
    if (mesh.origin[h] != kInvalidIndex)
    {
      outgoing[mesh.origin[h]] = h;
    }
  }
  return outgoing;
}

/// Three half-edges round the triangle a, b, c, which is no face: a to b, b to c, c to a.
using Ring = std::array<Index, 3>;

class PartSearch
{
public:
  PartSearch(const Mesh& mesh, const ThinPartLimits& limits)
    : mesh_(mesh), longest_(std::max(limits.loopOfDisc, limits.loopOfLarge)), limits_(limits),
      area_(sizedArea(mesh)), outgoing_(outgoingOf(mesh)),
      marked_(mesh.vertexCount(), kInvalidIndex), seen_(mesh.faceCount(), 0)
  {
  }

  std::vector<ThinPart> run()
  {
    for (Index a = 0; a < mesh_.vertexCount(); ++a)
    {
      pollNowAndThen(a);
      lookAt(a);
    }
    std::vector<ThinPart> parts = outerDiscs();
    addNecks(parts);
    return parts;
  }

private:
  struct Found
  {
    ThinPart part;
    std::vector<Index> faces;
  };

  /// The half-edge of the same edge that leaves v.
  Index from(Index v, Index h) const { return mesh_.origin[h] == v ? h : mesh_.twin[h]; }

  /// Triangles of which a is the lowest vertex.
  void lookAt(Index a)
  {
    if (outgoing_[a] == kInvalidIndex)
    {
      return;
    }
    forEachEdgeInFan(mesh_, outgoing_[a], [&](Index h) { marked_[mesh_.otherEnd(h, a)] = h; });
    forEachEdgeInFan(mesh_, outgoing_[a],
      [&](Index ab)
      {
        const Index b = mesh_.otherEnd(ab, a);
        if (b < a || sizedLength(mesh_, ab) > longest_)
        {
          return;
        }
        forEachEdgeInFan(mesh_, outgoing_[b],
          [&](Index bc)
          {
            const Index c = mesh_.otherEnd(bc, b);
            if (c > b && marked_[c] != kInvalidIndex)
            {
              look({ from(a, ab), from(b, bc), from(c, marked_[c]) });
            }
          });
      });
    forEachEdgeInFan(
      mesh_, outgoing_[a], [&](Index h) { marked_[mesh_.otherEnd(h, a)] = kInvalidIndex; });
  }

  void look(const Ring& ring)
  {
    const auto isBound = [&](Index h) { return h == kInvalidIndex || mesh_.isBoundary(h); };
    if (std::any_of(ring.begin(), ring.end(), isBound) ||
      Mesh::face(ring[0]) == Mesh::face(ring[1]) ||
      Mesh::face(mesh_.twin[ring[0]]) == Mesh::face(mesh_.twin[ring[1]]))
    {
      return;
    }
    Found found;
    ThinPart& part = found.part;
    for (std::size_t i = 0; i < ring.size(); ++i)
    {
      part.loop[i] = mesh_.origin[ring[i]];
      part.length += sizedLength(mesh_, ring[i]);
      part.girth += mesh_.edgeVector(ring[i]).norm();
    }
    if (part.length < longest_ && hasSides(ring, found) && isThin(found))
    {
      found_.push_back(std::move(found));
    }
  }

  /// Finds the side with fewer faces, if there are two, and it is a disc or large. Both grow side by side, so that a
  /// small one costs little. Its faces are those seen by search_.
  bool hasSides(const Ring& ring, Found& found)
  {
    std::array<std::vector<Index>, 2> sides{ std::vector<Index>{ Mesh::face(ring[0]) },
      std::vector<Index>{ Mesh::face(mesh_.twin[ring[0]]) } };
    search_ += 2;
    seen_[sides[0].front()] = search_;
    seen_[sides[1].front()] = search_ + 1;
    std::size_t at = 0;
    while (at < sides[0].size() && at < sides[1].size())
    {
      work_ += 2;
      if (work_ > kMostWork * mesh_.faceCount() || !grow(ring, sides[0], at, search_) ||
        !grow(ring, sides[1], at, search_ + 1))
      {
        return false;
      }
      ++at;
    }
    const std::size_t smaller = at < sides[0].size() ? 1 : 0;
    inside_ = search_ + static_cast<std::uint32_t>(smaller);
    found.faces = std::move(sides[smaller]);
    for (const Index f : found.faces)
    {
      found.part.area += sizedArea(mesh_, f);
    }
    found.part.isLarge = found.part.area >= limits_.largeArea;
    return found.part.isLarge
      ? found.part.length < limits_.loopOfLarge && area_ - found.part.area >= limits_.largeArea
      : isDisc(found.faces);
  }

  /// By the neighbours of one face; false where one of them is of the other side.
  bool grow(const Ring& ring, std::vector<Index>& side, std::size_t at, std::uint32_t mark)
  {
    const std::uint32_t other = mark == search_ ? search_ + 1 : search_;
    for (Index h = 3 * side[at]; h < 3 * side[at] + 3; ++h)
    {
      const bool isOfRing = std::any_of(
        ring.begin(), ring.end(), [&](Index g) { return h == g || h == mesh_.twin[g]; });
      if (isOfRing || mesh_.isBoundary(h))
      {
        continue;
      }
      const Index beyond = Mesh::face(mesh_.twin[h]);
      if (seen_[beyond] == other)
      {
        return false;
      }
      if (seen_[beyond] != mark)
      {
        seen_[beyond] = mark;
        side.push_back(beyond);
      }
    }
    return true;
  }

  bool isDisc(const std::vector<Index>& faces) const
  {
    std::unordered_set<Index> corners;
    for (const Index f : faces)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        corners.insert(mesh_.origin[h]);
        if (mesh_.isBoundary(h))
        {
          return false;
        }
      }
    }
    return 2 * (corners.size() + faces.size()) == 3 * faces.size() + 3 + 2;
  }

  /// Finds the tip and a vertex outside, as far away as the loop is long if there are any.
  bool isThin(Found& found) const
  {
    ThinPart& part = found.part;
    std::unordered_map<Index, double> distance;
    NearFirst near;
    for (const Index v : part.loop)
    {
      distance[v] = 0;
      near.push({ 0, v });
    }
    while (
      !near.empty() && (part.height < kFarOverLength * part.girth || part.outside == kInvalidIndex))
    {
      const auto [d, v] = near.top();
      near.pop();
      if (d > distance.at(v))
      {
        continue;
      }
      const bool isInside = seen_[Mesh::face(outgoing_[v])] == inside_;
      if (d > 0 && isInside && part.height < kFarOverLength * part.girth)
      {
        part.tip = v;
        part.height = d;
      }
      if (d >= kFarOverLength * part.girth)
      {
        part.outside = isInside || part.outside != kInvalidIndex ? part.outside : v;
        continue;
      }
      forEachEdgeInFan(mesh_, outgoing_[v],
        [&, at = d, v = v](Index h)
        {
          const Index w = mesh_.otherEnd(h, v);
          const double there = at + mesh_.edgeVector(h).norm();
          const auto known = distance.find(w);
          if (known == distance.end() || there < known->second)
          {
            distance[w] = there;
            near.push({ there, w });
          }
        });
    }
    return part.outside != kInvalidIndex && part.tip != kInvalidIndex &&
      part.height >= kLeastRise * part.girth;
  }

  /// The large or the small ones of those found.
  template <typename Before>
  std::vector<const Found*> sortedDiscs(bool large, const Before& before) const
  {
    std::vector<const Found*> order;
    for (const Found& found : found_)
    {
      if (found.part.isLarge == large)
      {
        order.push_back(&found);
      }
    }
    std::stable_sort(order.begin(), order.end(), before);
    return order;
  }

  std::vector<ThinPart> outerDiscs() const
  {
    const std::vector<const Found*> order = sortedDiscs(
      false, [](const Found* a, const Found* b) { return a->faces.size() > b->faces.size(); });
    std::vector<std::uint8_t> taken(mesh_.faceCount(), 0);
    std::vector<ThinPart> parts;
    for (const Found* found : order)
    {
      const auto isTaken = [&](Index f) { return taken[f] != 0; };
      if (std::none_of(found->faces.begin(), found->faces.end(), isTaken))
      {
        for (const Index f : found->faces)
        {
          taken[f] = 1;
        }
        parts.push_back(found->part);
      }
    }
    return parts;
  }

  /// Two with nearly the same areas may be on one neck, and what is between them would be a part too small.
  void addNecks(std::vector<ThinPart>& parts) const
  {
    const std::vector<const Found*> order = sortedDiscs(
      true, [](const Found* a, const Found* b) { return a->part.length < b->part.length; });
    std::vector<double> areas;
    for (const Found* found : order)
    {
      const double own = found->part.area;
      const auto isNear = [&](double area)
      {
        return std::abs(area - own) < limits_.largeArea ||
          std::abs(area_ - area - own) < limits_.largeArea;
      };
      if (std::none_of(areas.begin(), areas.end(), isNear))
      {
        areas.push_back(own);
        parts.push_back(found->part);
      }
    }
  }

  const Mesh& mesh_;
  double longest_;
  ThinPartLimits limits_;
  double area_;
  std::vector<Index> outgoing_;
  std::vector<Index> marked_;       ///< #V; a half-edge of the edge to the vertex that is looked at
  std::vector<std::uint32_t> seen_; ///< #F; by which search, and on which side
  std::uint32_t search_ = 0, inside_ = 0;
  std::size_t work_ = 0;
  std::vector<Found> found_;
};

class PartCutting
{
public:
  PartCutting(PreparedSurface& surface, double mostArea)
    : surface_(surface), mesh_(surface.mesh), mostArea_(mostArea),
      outgoing_(outgoingOf(surface.mesh)), used_(surface.mesh.vertexCount(), 0)
  {
  }

  bool cut(const ThinPart& part, double longer)
  {
    bool isThrough = false;
    const std::vector<Index> loop = cutOf(part, longer, isThrough);
    if (loop.size() < 3)
    {
      return false;
    }
    if (part.isLarge)
    {
      countTryLed(Try::ThreeCorners, isThrough ? 1 : 0);
      cutInTwo(loop);
      return true;
    }
    const std::optional<std::vector<Index>> faces =
      discBehind(loop, Mesh::face(outgoing_[part.tip]));
    if (!faces)
    {
      return false;
    }
    countTryLed(Try::ThreeCorners, isThrough ? 1 : 0);
    take(*faces, loop);
    return true;
  }

private:
  /// With what is taken out on the left or on the right. Through the three corners where nothing else does.
  std::vector<Index> cutOf(const ThinPart& part, double longer, bool& isThrough) const
  {
    const auto isUsed = [&](Index v) { return used_[v] != 0; };
    PartingLoops loops(mesh_, outgoing_);
    if (isUsed(part.tip) || isUsed(part.outside) ||
      std::any_of(part.loop.begin(), part.loop.end(), isUsed) ||
      !loops.setApart(part.tip, part.outside))
    {
      return {};
    }
    // A loop may be as long as this part of the way to the tip and back: a longer one may go there and round the tip.
    constexpr double kLoopOfHeight = 1.9;
    double bound = std::min(longer * part.girth, kLoopOfHeight * part.height);
    std::vector<Index> best;
    for (const Index root : part.loop)
    {
      std::vector<Index> loop = loops.shortest(root, bound);
      if (!loop.empty())
      {
        best = std::move(loop);
      }
    }
    isThrough = best.empty();
    if (isThrough)
    {
      countTry(Try::ThreeCorners);
      best = loops.through(part.loop, longer * part.girth);
    }
    if (std::any_of(best.begin(), best.end(), [&](Index h) { return isUsed(mesh_.origin[h]); }))
    {
      return {};
    }
    return best;
  }

  std::optional<std::vector<Index>> discBehind(const std::vector<Index>& loop, Index first) const
  {
    std::unordered_set<Index> edges, seen{ first }, corners;
    for (const Index h : loop)
    {
      edges.insert(h);
      edges.insert(mesh_.twin[h]);
    }
    std::vector<Index> faces{ first };
    double area = 0;
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
      area += mesh_.faceArea(faces[i]);
      if (faces.size() > kMostFacesNear || area > mostArea_)
      {
        return std::nullopt;
      }
      for (Index h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h)
      {
        const bool isEdge = edges.count(h) != 0;
        if (mesh_.isBoundary(h) || (mesh_.flags[h] & kRequestedFeature) != 0 ||
          used_[mesh_.origin[h]] != 0 || isAskedFor(surface_, mesh_.origin[h]))
        {
          return std::nullopt;
        }
        corners.insert(mesh_.origin[h]);
        if (!isEdge && seen.insert(Mesh::face(mesh_.twin[h])).second)
        {
          faces.push_back(Mesh::face(mesh_.twin[h]));
        }
      }
    }
    const std::size_t doubled = 3 * faces.size() + loop.size();
    if (2 * (corners.size() + faces.size()) != doubled + 2)
    {
      return std::nullopt;
    }
    return faces;
  }

  void take(const std::vector<Index>& faces, std::vector<Index> run)
  {
    const std::unordered_set<Index> inside(faces.begin(), faces.end());
    if (inside.count(Mesh::face(run.front())) != 0)
    {
      std::reverse(run.begin(), run.end());
      std::transform(run.begin(), run.end(), run.begin(), [&](Index h) { return mesh_.twin[h]; });
    }
    Vector3 middle = Vector3::Zero();
    for (const Index h : run)
    {
      middle += mesh_.position[mesh_.origin[h]] / static_cast<double>(run.size());
    }
    for (const Index f : faces)
    {
      for (Index h = 3 * f; h < 3 * f + 3; ++h)
      {
        used_[mesh_.origin[h]] = 1;
      }
      surface_.area -= mesh_.faceArea(f);
    }
    for (const Index f : faces)
    {
      removeFace(surface_, f);
    }
    const Index first = mesh_.halfEdgeCount();
    fillWithFan(surface_, run, middle);
    addCaps(first);
  }

  void cutInTwo(const std::vector<Index>& loop)
  {
    for (const Index h : loop)
    {
      used_[mesh_.origin[h]] = 1;
    }
    const Index first = mesh_.halfEdgeCount();
    cutAndClose(surface_, loop);
    ++surface_.components;
    addCaps(first);
  }

  void addCaps(Index first)
  {
    used_.resize(mesh_.vertexCount(), 1);
    outgoing_.resize(mesh_.vertexCount(), kInvalidIndex);
    for (Index h = first; h < mesh_.halfEdgeCount(); ++h)
    {
      outgoing_[mesh_.origin[h]] = h;
      if (h % 3 == 0)
      {
        surface_.area += mesh_.edgeVector(h).cross(mesh_.edgeVector(h + 1)).norm() / 2;
      }
    }
  }

  PreparedSurface& surface_;
  Mesh& mesh_;
  double mostArea_;
  std::vector<Index> outgoing_;
  std::vector<std::uint8_t> used_; ///< #V; of a part that is gone, or of its cap
};

} // namespace

std::vector<ThinPart> findThinParts(const Mesh& mesh, const ThinPartLimits& limits)
{
  return PartSearch(mesh, limits).run();
}

std::vector<std::size_t> cutThinParts(
  PreparedSurface& surface, const std::vector<ThinPart>& parts, double longer, double mostArea)
{
  std::vector<std::size_t> done;
  PartCutting cutting(surface, mostArea);
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    poll();
    if (cutting.cut(parts[i], longer))
    {
      done.push_back(i);
    }
  }
  if (!done.empty())
  {
    orderSurface(surface, 1);
    surface.hash = contentHash(surface.mesh, 1);
  }
  return done;
}

} // namespace quadrille

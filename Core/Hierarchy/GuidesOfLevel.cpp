// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Hierarchy/GuidesOfLevel.h"

#include "Base/Parallel.h"
#include "Mesh/Distance.h"
#include "Mesh/FaceSpread.h"
#include "Mesh/Topology.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

namespace quadrille
{

namespace
{

/// A walk to the face below a point ends when so many steps have brought it no nearer.
constexpr int kVainSteps = 24;
/// What is thinner than this to each side, over `reach`, leads as much beside it as well: quads do not turn by
/// a line of triangles much smaller than they are.
constexpr double kHalfWidth = 3;

/// Finds the fine face below a point near some fine vertices by walking over the surface, so that a sheet close by is
/// never taken for it.
class FaceFinder
{
public:
  FaceFinder(const Mesh& mesh, const std::vector<Index>& outgoing)
    : mesh_(mesh), outgoing_(outgoing)
  {
  }

  Index find(const Vector3& point, const Vector3& normal, const std::array<Index, 3>& vertices)
  {
    seen_.clear();
    queue_ = {};
    for (const Index v : vertices)
    {
      visitFan(v, point, normal);
    }
    Entry best = queue_.top();
    int vain = 0;
    while (!queue_.empty() && vain < kVainSteps)
    {
      const Entry entry = queue_.top();
      queue_.pop();
      vain = entry < best ? 0 : vain + 1;
      best = std::min(best, entry);
      for (Index h = 3 * entry.second; h < 3 * entry.second + 3; ++h)
      {
        if (!mesh_.isBoundary(h))
        {
          visit(Mesh::face(mesh_.twin[h]), point, normal);
        }
      }
    }
    return best.second;
  }

private:
  using Entry = std::pair<double, Index>;

  void visitFan(Index v, const Vector3& point, const Vector3& normal)
  {
    forEachInFan(mesh_, outgoing_[v], [&](Index h) { visit(Mesh::face(h), point, normal); });
  }
  void visit(Index f, const Vector3& point, const Vector3& normal)
  {
    if (std::find(seen_.begin(), seen_.end(), f) == seen_.end())
    {
      seen_.push_back(f);
      // Faces that look the other way lie behind a fold or a sharp edge.
      const bool away = mesh_.doubleAreaNormal(f).dot(normal) < 0;
      queue_.push({ (away ? 4 : 1) * distanceToFace(mesh_, f, point), f });
    }
  }

  const Mesh& mesh_;
  const std::vector<Index>& outgoing_;
  std::vector<Index> seen_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue_;
};

/// Lets faces spread within `reach` of their middles; for each face of the mesh the place of its source among them.
template <typename Predicate>
std::vector<Index> spread(
  const Mesh& mesh, const std::vector<Index>& source, double reach, const Predicate& mayCross)
{
  std::vector<SpreadStart> starts;
  starts.reserve(source.size());
  for (const Index f : source)
  {
    starts.push_back({ f, mesh.middleOfFace(f), reach });
  }
  return spreadOverFaces(mesh, starts, mayCross);
}

/// The box of all guided faces, a little larger.
Eigen::AlignedBox3d boxOf(const Mesh& mesh, const std::vector<FaceGuide>& guides, double margin)
{
  Eigen::AlignedBox3d box;
  for (const FaceGuide& guide : guides)
  {
    for (Index h = 3 * guide.face; h < 3 * guide.face + 3; ++h)
    {
      box.extend(mesh.position[mesh.origin[h]]);
    }
  }
  return { box.min() - Vector3::Constant(margin), box.max() + Vector3::Constant(margin) };
}

/// Brings guides from the finest level to another one.
class GuideProjection
{
public:
  GuideProjection(const Mesh& fine, const Level& level, const std::vector<FaceGuide>& guides)
    : fine_(fine), level_(level), guides_(guides), guideOf_(fine.faceCount(), kInvalidIndex),
      below_(level.mesh.faceCount(), kInvalidIndex), result_(level.mesh.faceCount())
  {
    for (Index i = 0; i < guides.size(); ++i)
    {
      guideOf_[guides[i].face] = i;
    }
  }

  std::vector<Guide> run(double reach, int threads)
  {
    findFacesBelow(6 * reach, threads);
    for (Index f = 0; f < below_.size(); ++f)
    {
      if (below_[f] != kInvalidIndex && guideOf_[below_[f]] != kInvalidIndex)
      {
        adopt(f, guides_[guideOf_[below_[f]]]);
      }
    }
    const auto beyondGuides = [&](Index h) { return !isGuided(acrossOf(h)); };
    adoptFrom(missedFaces(reach), reach, beyondGuides);
    adoptFrom(thinFaces(kHalfWidth * reach), kHalfWidth * reach,
      [&](Index h) { return beyondGuides(h) && !fine_.isConstrained(h); });
    const bool any = std::any_of(
      result_.begin(), result_.end(), [](const Guide& guide) { return !guide.isFree(); });
    return any ? std::move(result_) : std::vector<Guide>();
  }

private:
  /// The fine face at the middle of each face of the level, where guides are near.
  void findFacesBelow(double margin, int threads)
  {
    const std::vector<Index> outgoing = outgoingHalfEdges(fine_);
    const Eigen::AlignedBox3d box = boxOf(fine_, guides_, margin);
    const Mesh& mesh = level_.mesh;
    parallelFor(mesh.faceCount(), kHeavyChunk, threads,
      [&](std::size_t begin, std::size_t end)
      {
        FaceFinder finder(fine_, outgoing);
        for (Index f = static_cast<Index>(begin); f < static_cast<Index>(end); ++f)
        {
          const Vector3 middle = mesh.middleOfFace(f);
          const auto vertex = [&](Index i) { return level_.fineVertex[mesh.origin[3 * f + i]]; };
          if (box.contains(middle))
          {
            below_[f] =
              finder.find(middle, mesh.doubleAreaNormal(f), { vertex(0), vertex(1), vertex(2) });
          }
        }
      });
  }

  void adopt(Index f, const FaceGuide& source)
  {
    const Eigen::Quaterniond rotation = Eigen::Quaterniond::FromTwoVectors(
      fine_.doubleAreaNormal(source.face), level_.mesh.doubleAreaNormal(f));
    result_[f] = { (rotation * source.guide.direction).normalized(), source.guide.weight };
  }

  bool isGuided(Index f) const { return guideOf_[f] != kInvalidIndex; }
  Index acrossOf(Index h) const { return Mesh::face(fine_.twin[h]); }

  /// Faces that are free take the guide of the nearest of some guided fine faces, within the reach.
  template <typename Predicate>
  void adoptFrom(const std::vector<Index>& sources, double reach, const Predicate& mayCross)
  {
    if (sources.empty())
    {
      return;
    }
    const std::vector<Index> near = spread(fine_, sources, reach, mayCross);
    for (Index f = 0; f < below_.size(); ++f)
    {
      if (result_[f].isFree() && below_[f] != kInvalidIndex && near[below_[f]] != kInvalidIndex)
      {
        adopt(f, guides_[guideOf_[sources[near[below_[f]]]]]);
      }
    }
  }

  /// Guided fine faces that others do not reach within the distance through guided faces.
  std::vector<Index> guidedBeyond(const std::vector<Index>& source, double reach) const
  {
    const std::vector<Index> reached =
      spread(fine_, source, reach, [&](Index h) { return isGuided(acrossOf(h)); });
    std::vector<Index> beyond;
    for (const FaceGuide& guide : guides_)
    {
      if (reached[guide.face] == kInvalidIndex)
      {
        beyond.push_back(guide.face);
      }
    }
    return beyond;
  }

  /// Guided fine faces in parts of regions that have no place farther than `halfWidth` from their border, as strokes.
  std::vector<Index> thinFaces(double halfWidth) const
  {
    std::vector<Index> outside;
    for (const FaceGuide& guide : guides_)
    {
      for (Index h = 3 * guide.face; h < 3 * guide.face + 3; ++h)
      {
        if (!fine_.isBoundary(h) && !isGuided(acrossOf(h)))
        {
          outside.push_back(acrossOf(h));
        }
      }
    }
    const std::vector<Index> inside = guidedBeyond(outside, halfWidth);
    return guidedBeyond(inside, 2 * halfWidth);
  }

  /// Guided fine faces farther than `cover` from all middles of triangles that took a guide.
  std::vector<Index> missedFaces(double cover) const
  {
    std::vector<Index> seen;
    for (Index f = 0; f < below_.size(); ++f)
    {
      if (!result_[f].isFree())
      {
        seen.push_back(below_[f]);
      }
    }
    return guidedBeyond(seen, cover);
  }

  const Mesh& fine_;
  const Level& level_;
  const std::vector<FaceGuide>& guides_;
  std::vector<Index> guideOf_; // #F of the finest level
  std::vector<Index> below_;   // #F of the level; kInvalidIndex far from all guides
  std::vector<Guide> result_;
};

} // namespace

std::vector<Guide> guidesOfLevel(const Mesh& fine, const Level& level,
  const std::vector<FaceGuide>& fineGuides, double reach, int threads)
{
  return fineGuides.empty() ? std::vector<Guide>()
                            : GuideProjection(fine, level, fineGuides).run(reach, threads);
}

} // namespace quadrille

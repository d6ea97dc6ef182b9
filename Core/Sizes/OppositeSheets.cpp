// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Rays against a tree of boxes. The faces of a surface lie along a space-filling curve, so a tree over runs of them
/// needs no sorting.
#include "Sizes/OppositeSheets.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadrille
{
namespace
{

/// Faces in a leaf, and children of a node.
constexpr Index kBranches = 8;
const double kLeastOpposition = std::cos(kPi / 4);

struct SurfaceRay
{
  Vector3 from, direction;
};

/// Where the ray enters the box, or infinity where it misses it.
double entryOf(const Eigen::AlignedBox3f& box, const SurfaceRay& ray)
{
  double enter = 0, leave = kInfinity;
  for (int i = 0; i < 3; ++i)
  {
    const double low = box.min()[i] - ray.from[i], high = box.max()[i] - ray.from[i];
    if (ray.direction[i] == 0)
    {
      if (low > 0 || high < 0)
      {
        return kInfinity;
      }
      continue;
    }
    const double a = low / ray.direction[i], b = high / ray.direction[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : kInfinity;
}

class SheetTree
{
public:
  SheetTree(const Mesh& mesh, int threads) : mesh_(mesh)
  {
    makeLevel(mesh.faceCount(), threads, [&](Index f) { return boxOfFace(f); });
    while (levels_.back().size() > 1)
    {
      const std::vector<Eigen::AlignedBox3f> below = levels_.back();
      makeLevel(below.size(), threads, [&](Index i) { return below[i]; });
    }
  }

  /// The distance from `ray.from` to the first face that `isOpposite`, if it is below `nearest`; else that.
  template <typename Predicate>
  double firstHit(const SurfaceRay& ray, double nearest, const Predicate& isOpposite) const
  {
    visit(levels_.size() - 1, 0, ray, nearest, isOpposite);
    return nearest;
  }

private:
  /// A little larger than the face: its corners are rounded to single precision.
  Eigen::AlignedBox3f boxOfFace(Index f) const
  {
    Eigen::AlignedBox3f box;
    for (Index h = 3 * f; h < 3 * f + 3; ++h)
    {
      const Vector3& p = mesh_.position[mesh_.origin[h]];
      const Vector3 margin = Vector3::Constant(1e-6 * p.cwiseAbs().maxCoeff());
      box.extend((p - margin).cast<float>());
      box.extend((p + margin).cast<float>());
    }
    return box;
  }

  template <typename BoxOf>
  void makeLevel(std::size_t children, int threads, const BoxOf& boxOf)
  {
    std::vector<Eigen::AlignedBox3f> level((children + kBranches - 1) / kBranches);
    parallelForEach(level.size(), kMediumChunk, threads,
      [&](std::size_t i)
      {
        const std::size_t last = std::min(children, (i + 1) * kBranches);
        for (std::size_t child = i * kBranches; child < last; ++child)
        {
          level[i].extend(boxOf(static_cast<Index>(child)));
        }
      });
    levels_.push_back(std::move(level));
  }

  template <typename Predicate>
  void visit(std::size_t level, Index node, const SurfaceRay& ray, double& nearest,
    const Predicate& isOpposite) const
  {
    if (!(entryOf(levels_[level][node], ray) < nearest))
    {
      return;
    }
    const std::size_t children = level > 0 ? levels_[level - 1].size() : mesh_.faceCount();
    const auto last = static_cast<Index>(std::min(children, std::size_t{ node + 1 } * kBranches));
    for (Index child = node * kBranches; child < last; ++child)
    {
      if (level > 0)
      {
        visit(level - 1, child, ray, nearest, isOpposite);
      }
      else if (isOpposite(child))
      {
        nearest = std::min(nearest, hit(child, ray));
      }
    }
  }

  /// Along the ray to the face; infinite where it misses.
  double hit(Index f, const SurfaceRay& ray) const
  {
    const Vector3 a = mesh_.edgeVector(3 * f);
    const Vector3 b = -mesh_.edgeVector(3 * f + 2);
    const Vector3 normal = a.cross(b);
    const double slope = normal.dot(ray.direction);
    const Vector3 to = mesh_.position[mesh_.origin[3 * f]] - ray.from;
    const double distance = slope != 0 ? normal.dot(to) / slope : -1;
    const Vector3 p = distance * ray.direction - to;
    const double scale = normal.squaredNorm();
    const double u = normal.dot(p.cross(b)), v = normal.dot(a.cross(p));
    return distance > 0 && u >= 0 && v >= 0 && u + v <= scale ? distance : kInfinity;
  }

  const Mesh& mesh_;
  std::vector<std::vector<Eigen::AlignedBox3f>> levels_; ///< from the leaves on
};

/// Along the patch's normal either way.
double distanceFrom(
  const Mesh& mesh, const SheetTree& tree, const SurfacePatch& patch, double reach)
{
  const auto isOpposite = [&](Index f)
  {
    const Vector3 normal = mesh.doubleAreaNormal(f);
    return normal.dot(patch.normal) < -kLeastOpposition * normal.norm();
  };
  const Vector3 p = mesh.middleOfFace(patch.face);
  double nearest = reach;
  for (const double side : { -1.0, 1.0 })
  {
    nearest = tree.firstHit({ p, side * patch.normal }, nearest, isOpposite);
  }
  return nearest < reach ? nearest : kInfinity;
}

} // namespace

std::vector<float> distancesToOpposite(
  const Mesh& mesh, const SurfacePatches& patches, double reach, int threads)
{
  const SheetTree tree(mesh, threads);
  std::vector<float> single(patches.patches.size(), std::numeric_limits<float>::infinity());
  parallelForEach(single.size(), kHeavyChunk, threads,
    [&](std::size_t i)
    {
      if (!patches.patches[i].normal.isZero(0))
      {
        single[i] = static_cast<float>(distanceFrom(mesh, tree, patches.patches[i], reach));
      }
    });
  std::vector<float> result(single.size());
  parallelFor(single.size(), kHeavyChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<float> values;
      for (std::size_t i = begin; i < end; ++i)
      {
        values.assign(1, single[i]);
        for (Index k = patches.first[i]; k < patches.first[i + 1]; ++k)
        {
          values.push_back(single[patches.neighbours[k]]);
        }
        result[i] = middleOf(values);
      }
    });
  return result;
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Rays against a tree of boxes.
#include "Sizes/OppositeSheets.h"

#include "Base/Angles.h"
#include "Base/Lists.h"
#include "Base/Parallel.h"
#include "Mesh/BoxTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace quadrille
{
namespace
{

const double kLeastOpposition = std::cos(kPi / 4);

struct SurfaceRay
{
  Vector3 from, direction;
};

/// Where the ray enters the box, or infinity where it misses it.
double entryOf(const BoxTree::Box& box, const SurfaceRay& ray)
{
  double enter = 0, leave = kInfinity;
  for (int i = 0; i < 3; ++i)
  {
    const double low = box.low[i] - ray.from[i], high = box.high[i] - ray.from[i];
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
    std::vector<BoxTree::Box> boxes(mesh.faceCount());
    parallelForEach(boxes.size(), kMediumChunk, threads,
      [&](std::size_t f) { boxes[f] = boxOfFace(static_cast<Index>(f)); });
    tree_ = BoxTree(boxes, threads);
  }

  /// The distance from `ray.from` to the first face that `isOpposite`, if it is below `nearest`; else that.
  template <typename Predicate>
  double firstHit(const SurfaceRay& ray, double nearest, const Predicate& isOpposite) const
  {
    tree_.visitWhere([&](const BoxTree::Box& box) { return entryOf(box, ray) < nearest; },
      [&](Index f) { nearest = isOpposite(f) ? std::min(nearest, hit(f, ray)) : nearest; });
    return nearest;
  }

private:
  /// A little larger than the face, as rays are rounded.
  BoxTree::Box boxOfFace(Index f) const
  {
    const std::array<Vector3, 3> p{ mesh_.position[mesh_.origin[3 * f]],
      mesh_.position[mesh_.origin[3 * f + 1]], mesh_.position[mesh_.origin[3 * f + 2]] };
    BoxTree::Box box{ p[0].cwiseMin(p[1]).cwiseMin(p[2]), p[0].cwiseMax(p[1]).cwiseMax(p[2]) };
    const Vector3 margin =
      kRounding * box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs()).maxCoeff() * Vector3::Ones();
    return { box.low - margin, box.high + margin };
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
  BoxTree tree_; ///< of the faces
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
  std::vector<float> single(patches.patches.size(), kInfinityOfSingle);
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

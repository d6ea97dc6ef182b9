// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where places on flat parts lie that were triangulated anew.
#pragma once

#include "Mesh/NearestTriangle.h"
#include "Mesh/Surface.h"

#include <array>
#include <memory>
#include <vector>

namespace quadrille
{

/// By how much, over the diagonal of the bounding box, four points of a plane leave it where their coordinates were
/// rounded to single precision.
constexpr double kFlatHeight = 0x1p-21;
/// Barycentric coordinates in a triangle, with 0 for those that are rounding.
std::array<double, 3> withoutRounding(std::array<double, 3> weights);

/// A surface as it was before edges of its flat parts were flipped, and its triangles there. Triangles keep neither
/// their places in the array of faces nor their sources when the surface is ordered, so places are looked for in space.
class FlatSources
{
public:
  /// faces: those of `before` that were flipped or split.
  FlatSources(PreparedSurface before, std::vector<Index> faces);

  /// 1 for the first flips of a surface, 2 for those of what these have made, and so on.
  Index level() const { return level_; }
  /// The flips before these; null: none.
  const std::shared_ptr<const FlatSources>& before() const { return before_.beforeFlips; }
  /// The same flips after others of the same surface. Levels above `shared` are those of its own, and rise by `shift`.
  std::shared_ptr<const FlatSources> movedOnto(
    std::shared_ptr<const FlatSources> before, Index shared, Index shift) const;
  /// Source of the place with these barycentric coordinates in a face of this level, or an earlier one.
  SourceLocation locate(const FlippedFace& face, const std::array<double, 3>& weights) const;

  /// What a face of this level comes from: the triangle under its centroid, and its corners in the plane of that.
  struct Source
  {
    Index polygon = kInvalidIndex;
    std::array<Index, 3> points{};
    std::array<std::array<double, 3>, 3> cornerWeights{};
  };
  Source sourceOf(const FlippedFace& face) const;
  /// A triangle of the input.
  struct Triangle
  {
    Index polygon = kInvalidIndex;
    std::array<Index, 3> points{};
  };
  /// Those of the flat parts, of all levels, each once.
  std::vector<Triangle> triangles() const;
  std::size_t bytes() const;

private:
  NearestTriangle::Place under(const FlippedFace& face, const std::array<double, 3>& weights) const;

  PreparedSurface before_;
  std::vector<Index> faces_; ///< of before_, by triangle of tree_
  NearestTriangle tree_;
  Index level_;
};

} // namespace quadrille

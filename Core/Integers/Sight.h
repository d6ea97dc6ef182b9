// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What is seen of a map from one of its vertices.
#pragma once

#include "Base/FixedPoint.h"
#include "Integers/UvMesh.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

/// Straight lines from one vertex to another, seen through the faces between them.
class Sight
{
public:
  Sight(const UvMesh& map, Index from, Index to, double maximumLength);

  struct Line
  {
    Index start = kInvalidIndex, end = kInvalidIndex; ///< corners
    std::vector<Index> crossed;
    FixedVec2 vector; ///< in the chart of the first face
  };
  const std::vector<Line>& lines() const { return lines_; }

private:
  /// What is seen between two directions, right and left, from a place in the chart of a face.
  struct View
  {
    FixedVec2 eye, right, left;
  };

  static Int128 cross(FixedVec2 a, FixedVec2 b);

  /// Through the half-edge `out` of the face that the view is in.
  void meet(Index out, const View& view);

  bool isFar(Index h, FixedVec2 eye) const;

  static constexpr std::size_t kMostCurveSteps = 200000;

  const UvMesh& map_;
  Index to_;
  double maximumLength_;
  Index first_ = kInvalidIndex;
  std::vector<Index> crossed_;
  int rotation_ = 0;
  std::size_t steps_ = 0;
  std::vector<Line> lines_;
};

} // namespace quadrille

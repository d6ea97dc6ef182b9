// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where the quads of a wedge get a vertex on both of its sides: at the ends of features and of cuts. Between these are
/// the seams.
#pragma once

#include "Symmetry/CutBorder.h"
#include "Symmetry/PlaneCut.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

/// Of chains that are each other's images.
class SeamMarks
{
public:
  /// A vertex to be made.
  struct Split
  {
    Index halfEdge = kInvalidIndex; ///< of the wedge
    double share = 0;
    Vector3 place;
  };

  /// cut: the mesh of the wedge. reach: between features and images of those on the other side.
  SeamMarks(const Mesh& cut, const Isometry& rotation, double tolerance, double reach)
    : cut_(cut), rotation_(rotation), tolerance_(tolerance), alignReach_(reach)
  {
  }

  /// Adds the seams between a chain in the first half plane and one in the second; counts features of one side only.
  /// Where a feature ends on one side its image ends on the other one, or there is at least a vertex of the quads.
  void add(const BorderChain& firstChain, const BorderChain& secondChain, SurfacePart& wedge);

  const std::vector<Split>& splits() const { return splits_; }

private:
  /// The chain from a place on, in the second half plane against the order of the boundary.
  struct Course
  {
    const BorderChain* chain = nullptr;
    bool backwards = false;
    std::vector<double>
      arc;            ///< per place along the chain: its way from the beginning, in chain order
    double begin = 0; ///< of a closed one

    double total() const { return arc.back(); }
    /// Of place i of the chain, as the course runs.
    double at(std::size_t i) const
    {
      double way = backwards ? total() - arc[i] : arc[i];
      way -= chain->closed ? begin : 0;
      return way < 0 ? way + total() : way;
    }
  };

  /// Where the quads get a vertex on both sides: the ways along the two courses.
  struct Mark
  {
    double first = 0, second = 0;
  };

  std::vector<std::size_t> featureEnds(const BorderChain& chain) const;
  Course courseOf(const BorderChain& chain, bool backwards) const;
  std::vector<Mark> alignFeatures(const Course& first, const std::vector<std::size_t>& here,
    const Course& second, const std::vector<std::size_t>& there) const;
  void beginClosed(Course& first, const std::vector<std::size_t>& here, Course& second,
    const std::vector<std::size_t>& there) const;
  double nearestWay(const Course& course, const Vector3& p) const;
  static void addLone(
    std::vector<Mark>& marks, double way, double Mark::*here, double Mark::*there);
  Vector3 markPlace(const Course& course, double way);

  /// From the image of a place of the first chain to one of the second.
  double distance(const Course& first, std::size_t i, const Course& second, std::size_t j) const
  {
    return (rotation_.image(first.chain->place(cut_, i)) - second.chain->place(cut_, j)).norm();
  }

  const Mesh& cut_;
  const Isometry& rotation_;
  double tolerance_, alignReach_;
  std::vector<Split> splits_;
};

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Where the quads of a wedge get a vertex on both of its sides: at the ends of features and of cuts. Between these are
/// the seams.
#pragma once

#include "Mesh/Mesh.h"
#include "Symmetry/RotationAxis.h"
#include "Symmetry/RotationCut.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

/// A run of the boundary in one of the half planes.
struct WedgeChain
{
  std::vector<Index> edges; ///< half-edges, in the order of the boundary
  bool closed = false;
  double length = 0;
  Vector3 middle = Vector3::Zero(); ///< mean over the length

  Index vertex(const Mesh& cut, std::size_t i) const
  {
    const std::size_t count = edges.size();
    return i < count ? cut.origin[edges[i]] : cut.target(edges[count - 1]);
  }
  const Vector3& place(const Mesh& cut, std::size_t i) const
  {
    return cut.position[vertex(cut, i)];
  }
};

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
  SeamMarks(const Mesh& cut, const RotationAxis& axis, int order, double tolerance, double reach)
    : cut_(cut), axis_(axis), order_(order), tolerance_(tolerance), alignReach_(reach)
  {
  }

  /// Adds the seams between a chain in the first half plane and one in the second; counts features of one side only.
  /// Where a feature ends on one side its image ends on the other one, or there is at least a vertex of the quads.
  void add(const WedgeChain& firstChain, const WedgeChain& secondChain, SurfaceWedge& wedge);

  const std::vector<Split>& splits() const { return splits_; }

private:
  /// The chain from a place on, in the second half plane against the order of the boundary.
  struct Course
  {
    const WedgeChain* chain = nullptr;
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

  std::vector<std::size_t> featureEnds(const WedgeChain& chain) const;
  Course courseOf(const WedgeChain& chain, bool backwards) const;
  std::vector<Mark> alignFeatures(const Course& first, const std::vector<std::size_t>& here,
    const Course& second, const std::vector<std::size_t>& there) const;
  void beginClosed(Course& first, const std::vector<std::size_t>& here, Course& second,
    const std::vector<std::size_t>& there) const;
  double nearestWay(const Course& course, const Vector3& p) const;
  static void addLone(
    std::vector<Mark>& marks, double way, double Mark::*here, double Mark::*there);
  Vector3 markPlace(const Course& course, double way);

  const Vector3& place(const WedgeChain& chain, std::size_t i) const
  {
    return chain.place(cut_, i);
  }
  Vector3 imageOf(const Vector3& p) const { return axis_.image(p, 1, order_); }

  const Mesh& cut_;
  const RotationAxis& axis_;
  int order_;
  double tolerance_, alignReach_;
  std::vector<Split> splits_;
};

} // namespace quadrille

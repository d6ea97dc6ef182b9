// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Exact integer min-cost flow by successive shortest paths [Ahuja, Magnanti, Orlin 1993, Section 9.7].
/// Documentation/Design/Libraries.md compares it with LEMON.
#pragma once

#include "Base/Lists.h"
#include "Base/Types.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace quadrille
{

/// Units of cost that the longest way gets where ways are lengths: far finer than what is said of a length.
constexpr double kUnitsOfLongest = 1 << 24;

/// Supplies are sent to demands along arcs at the least total cost. A convex piecewise linear cost is
/// a bundle of parallel arcs with growing costs. Integers only, ties by id: the same result on every run.
///
/// Made for few supplies on many arcs: each search grows from one supply and ends at the nearest open
/// demand, so its work is local. A node through which all would go may be made the ground: it gives and
/// takes without limit, and no search has to pass it.
class MinCostFlow
{
public:
  explicit MinCostFlow(Index nodeCount);

  /// Returns the arc's id. capacity >= 0; the cost may be negative. Throws InvalidInput otherwise,
  /// and for a node out of range.
  Index addArc(Index from, Index to, std::int64_t capacity, std::int64_t cost);

  /// Adds to the node's supply; negative amounts are demands.
  void addSupply(Index node, std::int64_t amount);

  /// Makes the node the ground; then every other supply and demand has to be met.
  void setGround(Index node);

  struct Result
  {
    std::int64_t cost = 0;
    std::int64_t unrouted = 0; ///< supply (with a ground: also demand) that is left; 0 on success
  };
  /// Once per object.
  Result solve();

  /// After solve(): 0..capacity.
  std::int64_t flow(Index arc) const;

  /// After solve(): supply (> 0) or demand (< 0) left at the node.
  std::int64_t remaining(Index node) const { return excess_[node]; }

private:
  // Residual arc 2 a is arc a, 2 a + 1 its reverse.
  struct ResidualArc
  {
    Index to;
    std::int64_t capacity;
    std::int64_t cost;
  };

  void saturateNegativeArcs();
  // Searches run along arcs from a supply, or against them from a demand.
  enum class Direction
  {
    Forward,
    Backward
  };
  bool isGoal(Index node, Direction direction) const;
  Index findNearest(Index start, Direction direction);
  void settle(Index node, Direction direction);
  void augment(Index start, Index goal);
  void route(Direction direction);

  std::vector<ResidualArc> arcs_;
  std::vector<std::int64_t> excess_;
  Index ground_ = kInvalidIndex;
  std::vector<std::int64_t> potential_;
  std::vector<std::int64_t> distance_;
  std::vector<Index> entry_; // residual arc by which the search reached the node
  std::vector<std::uint8_t> settled_;
  std::vector<Index> touched_;
  std::vector<std::pair<std::int64_t, Index>> heap_; // distance and node, least on top
  Grouped<> outgoing_;                               // residual arcs by tail node
};

} // namespace quadrille

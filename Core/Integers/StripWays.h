// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which shifts can be part of a strip at all (see IntegerMap.h): a search that finds none looks at all that it
/// reaches, and nearly all searches for improvements find none. A strip is a cycle of the graph of (half-edge entered,
/// vector carried) with one more node for what is outside, so all of it lies in one strongly connected component
/// [Tarjan 1972], and one walk over the graph tells for all shifts.
#pragma once

#include "Integers/IntegerMap.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille
{

class StripWays
{
public:
  /// The map must outlive the ways.
  explicit StripWays(const IntegerMap& map) : map_(map) {}

  /// Ways for vectors of this length, in steps of kGrain a quad, that break no triangle and in which no edge costs
  /// mostCost or more.
  void find(std::int64_t length, double mostCost);
  /// To be called when the map changes.
  void forget() { component_.clear(); }
  /// False where no strip that costs at most `cost` and keeps all triangles sound has shift(h, e), which has to cost
  /// less itself; true where the ways do not tell.
  bool mayHave(Index h, FixedVec2 e, double cost) const;
  /// How many states find() looks at: each takes about a third of a step of a search.
  std::size_t states() const { return 12 * map_.faces().size(); }

private:
  /// A state on the way of the walk, and which of its next ones come later.
  struct Entered
  {
    Index state = 0;
    std::array<Index, 2> next{};
    Index count = 0, done = 0;
  };

  Index outside() const { return 4 * static_cast<Index>(map_.mesh().origin.size()); }
  void findEntries();
  Entered entered(Index state) const;
  Index nextOf(const Entered& from, Index i) const
  {
    return from.state == outside() ? entries_[i] : from.next[i];
  }
  void enter(Index state);
  void walkFrom(Index root);
  void leave();

  const IntegerMap& map_;
  std::int64_t length_ = 0;
  double mostCost_ = 0;
  std::vector<Index> entries_;   ///< states that come in over the boundary
  std::vector<Index> component_; ///< by state; kInvalidIndex: none yet
  std::vector<Index> size_;      ///< of components
  std::vector<Index> order_;  ///< by state, in which the walk came to them; kInvalidIndex: not yet
  std::vector<Index> lowest_; ///< by state, the first one on its way that it leads back to
  std::vector<Index> open_;   ///< states without a component, in the order of the walk
  std::vector<Entered> way_;
  Index clock_ = 0;
};

} // namespace quadrille

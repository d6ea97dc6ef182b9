// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which shifts can be part of a strip at all (see IntegerMap.h): a search that finds none looks at all that it
/// reaches, and nearly all searches for improvements find none. A strip is a cycle of the graph of (half-edge entered,
/// vector carried) with one more node for what is outside, so all of it lies in one strongly connected component, and
/// one walk over the graph tells for all shifts.
#pragma once

#include "Base/StrongComponents.h"
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
  void forget() { components_ = {}; }
  /// False where no strip that costs at most `cost` and keeps all triangles sound has shift(h, e), which has to cost
  /// less itself; true where the ways do not tell.
  bool mayHave(Index h, FixedVec2 e, double cost) const;
  /// How many states find() looks at: each takes about a third of a step of a search.
  std::size_t states() const { return 12 * map_.faces().size(); }

private:
  /// What a state leads to: that outside all entries, any other two states at most.
  struct Next
  {
    const std::vector<Index>* entries = nullptr;
    std::array<Index, 2> states{};
    Index count = 0;

    Index size() const { return count; }
    Index operator[](Index i) const { return entries != nullptr ? (*entries)[i] : states[i]; }
  };

  Index outside() const { return 4 * static_cast<Index>(map_.mesh().origin.size()); }
  void findEntries();
  Next nextOf(Index state) const;

  const IntegerMap& map_;
  std::int64_t length_ = 0;
  double mostCost_ = 0;
  std::vector<Index> entries_; ///< states that come in over the boundary
  StrongComponents<Next> components_;
};

} // namespace quadrille

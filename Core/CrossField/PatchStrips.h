// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Whether curves between patches can have quads along them. A strip of quads that comes into a patch over one side
/// leaves it over one that runs the other way in the map. Where a patch has irregular vertices, or a loop of its
/// boundary turns, it may leave over any. A side that no strip closes over has no length in any map with these turns,
/// however it is computed. Nor do the equations of patches tell any more, as each side is in two of them at most, with
/// the signs 1 and -1.
///
///     +---<---+        a strip comes in over the side below, which runs along u with the patch on its left,
///     |   :   |        and leaves over the one above, which runs against u
///     +--->---+
///
/// A strip is a cycle of the graph of (patch, direction of the side that was crossed), with one node more for all where
/// it may go on anywhere, and for what is outside. So all of it lies in one strongly connected component.
#pragma once

#include "Base/Lists.h"
#include "Base/StrongComponents.h"
#include "CrossField/PatchSides.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille
{

class PatchStrips
{
public:
  explicit PatchStrips(PatchSides& sides) : sides_(sides), mesh_(sides.input().mesh) {}

  /// The number of sides without a strip, with turns as they are.
  std::size_t find();
  /// After find(), which gave `without`: moves turns until there is none or no single move lessens their number, those
  /// first that make the turns of corners least unnatural. Returns the number.
  std::size_t lessen(std::size_t without);
  /// The patches of sides without a strip, as find() left it.
  std::vector<Index> patchesWithout() const;

private:
  /// Nodes that the arcs of a node lead to.
  struct NextNodes
  {
    const Index* first = nullptr;
    Index count = 0;

    Index size() const { return count; }
    Index operator[](Index i) const { return first[i]; }
  };

  std::size_t lessenOnce(std::size_t without);
  Index nodeOf(Index h, int turned) const;
  Index nodeBeyond(Index h) const;
  template <typename Visit>
  void forArcs(const Visit& visit) const;
  NextNodes nextOf(Index node) const { return { next_.begin(node), next_.size(node) }; }
  bool hasStrip(Index h) const;
  std::vector<std::uint8_t> reached() const;

  PatchSides& sides_;
  const Mesh& mesh_;
  Grouped<> next_; ///< nodes that arcs lead to, by those that they come from
  StrongComponents<NextNodes> components_;
};

} // namespace quadrille

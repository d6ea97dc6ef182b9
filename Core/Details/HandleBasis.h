// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which handles the classes of loops go round.
#pragma once

#include "Details/LoopSearch.h"

#include <utility>
#include <vector>

namespace quadrille
{

/// A symplectic Gram-Schmidt process in Z/2: pairs of classes that cross each other and nothing else, and open classes
/// that cross nothing. Each of both stands for a handle.
class HandleBasis
{
public:
  using Class = LoopSearch::Class;

  /// bits: 2 for each handle of the surface.
  explicit HandleBasis(std::size_t bits);

  /// Handles that the classes so far go round.
  std::size_t size() const { return open_.size() + pairs_.size(); }

  /// True when the class goes round a handle that those before do not. `crossings`: LoopSearch::crossings of it.
  bool insert(Class loop, const Class& crossings);

private:
  void makePair(const std::vector<Index>& crossed, Class&& loop);
  bool insertOpen(Class&& loop);

  std::vector<Class> open_; ///< no two with the same lowest bit
  std::vector<std::pair<Class, Class>> pairs_;
  std::vector<std::size_t> withLowestBit_; ///< by bit: which of open_
};

} // namespace quadrille

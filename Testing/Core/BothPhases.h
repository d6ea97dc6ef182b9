// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Hierarchies in one call.
#pragma once

#include "Hierarchy/Hierarchy.h"

namespace quadrille::test
{

/// Both phases; vertices to keep come back after phase 1 where they are a local change, as runs have it.
inline Hierarchy buildHierarchy(
  const Mesh& fine, std::uint64_t fineHash, const HierarchyOptions& options)
{
  HierarchyOptions phase1 = options;
  if (isLocalChange(fine, fine.sizing, options.keepVertices.size()))
  {
    phase1.keepVertices.clear();
  }
  Redecimation levels(fine, fineHash, phase1);
  levels.update(options);
  return levels.take();
}

} // namespace quadrille::test

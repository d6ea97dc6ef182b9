// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A failure stays where it is: where a surface of several connected components has no quads, those that have failed
/// are runs of their own, each with all that is tried, and the rest is another.
#pragma once

#include "Mesh/SurfaceParts.h"
#include "Pipeline/History.h"
#include "Pipeline/SizedSurface.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

/// Some components of a sized surface.
struct SizedPart
{
  SizedSurface sized; ///< with its share of the quads; what the whole tells is not told again
  double share = 0;   ///< of the whole's area over its sizes
  std::vector<Index> curves; ///< which of the whole's are on it
};

/// share: of the whole's area over its sizes.
SizedPart partOf(const SizedSurface& whole, ComponentPart part, double share);

/// Whether the last attempt has failed where the surface can be divided, and not at a limit of the user.
bool isDivided(const SizedSurface& sized, const History& history);

/// failed: vertices of the surface in the components that have failed, each of which becomes a part, in the order of
/// their lowest faces; the others are one part, the last one. Where it is not known which have failed, two parts of
/// about half of the area.
std::vector<SizedPart> divide(
  const SizedSurface& whole, const std::vector<Index>& failed, int threads);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Irregular vertices that let quads have the sizes that are asked for. The smoothest field has few of them, and then
/// the number of quads side by side cannot change.
///
/// Given the turns at all vertices there is, up to a constant, one conformal factor that makes the surface flat but for
/// them. In the metric of the sizes it is the logarithm of what quads of a conformal map have over the size asked for;
/// here linear in the turns [Ben-Chen et al. 2008]. Choosing where turns go so that it is small is the placement of
/// cones [Soliman et al. 2018], here in whole quarter turns and greedily.
#pragma once

#include "CrossField/CrossField.h"
#include "CrossField/FieldTopology.h"

#include <vector>

namespace quadrille
{

struct SizeConeOptions
{
  /// At places: sizes are 1 elsewhere. An irregular vertex is worth it for a few quads there, not for a share of the
  /// surface, and turns move between vertices of other sizes alone.
  SizeWish sizes = SizeWish::Everywhere;
  double quads = 1; ///< of the whole surface, where sizes are asked for at places
};

/// The root mean square over the surface of the logarithm of expected over wanted size, for the turns of a field (per
/// fan).
double sizeError(const Mesh& mesh, const FieldTopology& topology, const std::vector<int>& turns);

/// Target valences (#V, 0: free) with which the error becomes smaller: quarter turns move between inner vertices as
/// long as each further irregular vertex is worth it. turns: per fan, of a field. asked: empty or #V, targets that
/// stay. Empty when nothing would change. A direct solve for each of at most some hundred vertices.
std::vector<int> valencesForSizes(const Mesh& mesh, const FieldTopology& topology,
  const std::vector<int>& turns, const std::vector<int>& asked,
  const SizeConeOptions& options = {});

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Vertices that cannot be taken out of a surface, as something was asked for there.
#pragma once

#include "Mesh/Surface.h"

#include <algorithm>

namespace quadrille
{

/// Whether a valence or the turns of a sector are asked for at the vertex; both lists are ascending by vertex.
inline bool isAskedFor(const PreparedSurface& surface, Index v)
{
  const auto names = [v](const auto& requests)
  {
    const auto at = std::lower_bound(requests.begin(), requests.end(), v,
      [](const auto& request, Index vertex) { return request.vertex < vertex; });
    return at != requests.end() && at->vertex == v;
  };
  return names(surface.valenceRequests) || names(surface.sectorRequests);
}

} // namespace quadrille

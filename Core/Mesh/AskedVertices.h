// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Vertices that cannot be taken out of a surface, as something was asked for there.
#pragma once

#include "Mesh/Surface.h"

#include <algorithm>
#include <vector>

namespace quadrille
{

/// What is asked for at the vertex; null: nothing. The list is ascending by vertex.
template <typename Request>
const Request* requestAt(const std::vector<Request>& requests, Index v)
{
  const auto at = std::lower_bound(requests.begin(), requests.end(), v,
    [](const Request& request, Index vertex) { return request.vertex < vertex; });
  return at != requests.end() && at->vertex == v ? &*at : nullptr;
}

/// Whether a valence or the turns of a sector are asked for at the vertex.
inline bool isAskedFor(const PreparedSurface& surface, Index v)
{
  return requestAt(surface.valenceRequests, v) != nullptr ||
    requestAt(surface.sectorRequests, v) != nullptr;
}

} // namespace quadrille

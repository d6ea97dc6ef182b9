// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Handles of a surface that are short round, and boundary loops that are: what quads of a given size cannot resolve.
#pragma once

#include "Mesh/Mesh.h"

#include <optional>
#include <vector>

namespace quadrille
{

/// A closed loop without repeated vertices. Where the mesh has sizes, lengths are over the size there, here and below.
struct HandleLoop
{
  std::vector<Index>
    vertices; ///< in order; neighbours share an edge, or lie opposite each other across one
  double length = 0;
};

struct HandleReport
{
  std::size_t handles = 0; ///< genus, the sum over all components; boundary loops count as closed
  std::vector<HandleLoop>
    loops; ///< one for each handle that is shorter round than the limit, shortest first
  /// Of all loops, where that is below the limit; else one that no start on itself makes shorter. None without handles.
  std::optional<HandleLoop> shortest;
  bool complete = true; ///< false: the work came to its end, there may be more short loops
};

/// Handles that are shorter round, or through, than `limit` (units of the mesh, > 0). The number of loops is the
/// largest number of loops among all that are shorter and on which the surface can be cut open without falling apart; a
/// handle that is short both ways counts once, by its shorter loop. Lengths are those of paths along edges and straight
/// across pairs of triangles: up to 4 % above the shortest curve on even triangulations. Linear where there is no
/// handle; bounded by counts of steps, so that the same mesh has the same loops. The mesh passes validate(). Throws
/// InvalidInput unless the limit is positive.
HandleReport findHandles(const Mesh& mesh, double limit);
/// The same loops alone.
std::vector<HandleLoop> findShortHandles(const Mesh& mesh, double limit);

struct BoundaryReport
{
  std::size_t loops = 0;
  std::size_t shortLoops = 0;       ///< shorter than the limit
  double shortest = 0;              ///< length; 0 without boundary
  Vector3 place = Vector3::Zero();  ///< a vertex of the shortest
  std::vector<HandleLoop> tooShort; ///< those shorter than the limit, by their lowest half-edge
};

/// Lengths of the boundary loops. Linear.
BoundaryReport measureBoundary(const Mesh& mesh, double limit);

} // namespace quadrille

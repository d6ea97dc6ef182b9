// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A surface in parts of whole connected components, and such parts as one surface again.
#pragma once

#include "Mesh/Surface.h"

#include <cstddef>
#include <vector>

namespace quadrille
{

/// Some components of a surface as a surface of their own: elements keep their order, and what was asked for there
/// comes along. Facets, notice and the diagonal are those of the whole; nothing was repaired yet, no valence is unused.
struct ComponentPart
{
  PreparedSurface surface;
  std::vector<Index> curves; ///< which of the whole's they are
};

/// partOfFace: #F, below `parts`, the same all over a component; each part has a face. What lies at a place is asked of
/// the part with the nearest triangle. Linear, but for requests at places. threads: 0: all.
std::vector<ComponentPart> splitSurface(const PreparedSurface& whole,
  const std::vector<Index>& partOfFace, std::size_t parts, int threads);

/// Appends the elements of a part that may have been changed since, with what is asked of them and what was repaired;
/// the hash is not that of the whole then. Requests at places, by polygon and for the whole stay those of `all`.
void appendSurface(const PreparedSurface& part, PreparedSurface& all);

/// The same of meshes.
void appendMesh(const Mesh& part, Mesh& all);

/// The whole without elements, for parts to be appended.
PreparedSurface withoutElements(const PreparedSurface& whole);

/// Triangles of a mesh as one of their own; joined as they are there, sizes as there, no flags.
struct TrianglesOfMesh
{
  Mesh mesh;
  std::vector<Index> vertices; ///< which of the whole mesh's these are
};
TrianglesOfMesh partOf(const Mesh& whole, const std::vector<Index>& triangles);

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Which vertices of the coarse mesh quantization has to look at: those that need integers, those that topology
/// needs, and those of triangles that the integers alone can crush, whatever re-embedding does.
#pragma once

#include "Integers/UvMesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

struct LockedVertices
{
  std::vector<std::uint8_t> keep;    ///< #V flags: stays in the decimated mesh
  std::vector<std::uint8_t> integer; ///< #V flags: lies at a whole point; implies keep
};

/// needed: #V flags of the vertices that have to lie at whole points. extra: more vertices to keep.
/// Kept besides these: one of every component and of every smooth closed curve without any; the corners of triangles
/// whose three corners all have the same coordinate locked (by an integer vertex or a curve) and lie within a few
/// quads, because such a triangle is degenerate as soon as the three isolines coincide; and a vertex all
/// of whose neighbours are kept, because its star may get an empty kernel.
LockedVertices lockedVertices(const Mesh& mesh, const UvMesh& map,
  const std::vector<std::uint8_t>& needed, const std::vector<Index>& extra);

} // namespace quadrille

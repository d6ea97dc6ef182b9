// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A mesh with a field, taken apart into connected components: no equation of a map joins two of them, so each is
/// solved by itself, and one that has no map costs the others nothing.
#pragma once

#include "CrossField/CrossField.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

struct MeshPart
{
  Mesh mesh;
  CrossField field;          ///< without status and failedAt
  std::vector<Index> vertex; ///< of the whole mesh, per vertex of the part; ascending
  std::vector<Index>
    face; ///< of the whole mesh, per face of the part; ascending, corners in the same order
};

/// The components by their lowest face. The field must have the size of the mesh.
std::vector<MeshPart> splitIntoParts(const Mesh& mesh, const CrossField& field);

} // namespace quadrille

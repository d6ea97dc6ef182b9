// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A map put aside in a quarter of its memory while another one is made.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"

#include <vector>

namespace quadrille
{

/// The corners of a vertex have the same uv except where the map is cut, so that one value a vertex and the corners
/// that differ from it say all: 8 bytes a face and 20 for each such corner, in place of 48.
class PackedMap
{
public:
  PackedMap() = default;
  /// uv: #H of the mesh; throws InvalidInput for another size.
  PackedMap(const Mesh& mesh, const std::vector<FixedVec2>& uv);

  /// The same uv again. `mesh` must be the one that it was packed with; throws InvalidInput for another size.
  std::vector<FixedVec2> unpack(const Mesh& mesh) const;

  std::size_t bytes() const;

private:
  std::vector<FixedVec2> vertex_; ///< #V
  std::vector<Index> corner_;     ///< that have another uv than their vertex
  std::vector<FixedVec2> uv_;     ///< of those
};

} // namespace quadrille

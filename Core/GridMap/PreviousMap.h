// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A map that was made before, to start from after a small edit: other directions, other valences, a coarse mesh that
/// differs in places. Nothing of it is trusted: it moves where Newton's method and the search for integers begin, and
/// the result has to pass the same certificate. It may differ from the result without it.
#pragma once

#include "Base/FixedPoint.h"
#include "CrossField/CrossField.h"
#include "Mesh/Mesh.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// What a map leaves behind for the next one.
struct PreviousMap
{
  Mesh mesh;
  std::vector<Index>
    vertexIds; ///< #V; the same vertex has the same id in the next mesh (Level::fineVertex)
  CrossField field;
  std::vector<FixedVec2> seamlessUv; ///< #H
  std::vector<FixedVec2> uv;         ///< #H; an integer-grid map along the field

  std::size_t bytes() const;
};

/// The previous map in the charts of a new field.
struct CarriedMap
{
  std::vector<FixedVec2> seamlessUv, uv; ///< #H of the new mesh, or empty when nothing is known
  /// #F: the face was there before, with the same corners, and is positive in both maps.
  std::vector<std::uint8_t> known;
  std::vector<double>
    fieldRotation; ///< #F, radians: by how much the field has rotated there, less than an eighth of a circle
  std::size_t knownFaces = 0;
  /// The mesh, its constrained edges, the turns and the quarter turns between its charts are the same: uv is a map
  /// along the new field, too.
  bool isMap = false;
};

/// Finds the faces of new meshes in a previous one.
class MapCarrier
{
public:
  /// `previous` must outlive this object. Throws InvalidInput when its arrays disagree in size.
  explicit MapCarrier(const PreviousMap& previous);

  /// vertexIds: #V of `mesh`. The mesh is connected.
  CarriedMap carry(
    const Mesh& mesh, const CrossField& field, const std::vector<Index>& vertexIds) const;

private:
  struct Entry
  {
    Index ids[3];
    Index halfEdge; ///< leaves ids[0]
  };
  std::vector<Index> cornersOf(const Mesh& mesh, const std::vector<Index>& vertexIds) const;
  bool isSameMesh(const Mesh& mesh, const std::vector<Index>& corner) const;
  bool joinCharts(const Mesh& mesh, const CrossField& field, const std::vector<Index>& corner,
    std::vector<int>& rotation) const;

  const PreviousMap& previous_;
  std::vector<Entry> entries_; ///< of the faces, the smallest id first, ascending
};

} // namespace quadrille

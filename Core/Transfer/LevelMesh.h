// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A patch of a mesh with its map, while half-edge collapses take vertices away and these come back.
#pragma once

#include "Base/FixedPoint.h"
#include "Mesh/Mesh.h"
#include "Transfer/PatchLevels.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace quadrille
{

/// The patch and the faces that touch it, with ids of its own.
class LevelMesh
{
public:
  struct Vertex
  {
    PatchFreedom freedom = PatchFreedom::Fixed;
    FixedVec2 place; ///< in its own chart
    Vector3 position;
    Index corner = kInvalidIndex; ///< one of its corners, or none once it is gone
    int turns = 0;
    bool isIrregular = false;
    bool goesLast = false;
  };

  LevelMesh(const Mesh& mesh, const std::vector<Index>& patch, const std::vector<PatchStar>& stars,
    const std::vector<int>& turns, const std::vector<FixedVec2>& uv);

  Index vertexCount() const { return static_cast<Index>(vertex_.size()); }
  Index faceCount() const { return static_cast<Index>(fineFace_.size()); }
  Index patchFaces() const { return patchFaces_; }       ///< they come first
  Index fineFace(Index f) const { return fineFace_[f]; } ///< of the mesh
  bool isGone(Index f) const { return gone_[f] != 0; }
  std::size_t inner() const { return inner_; } ///< vertices that may move

  const Vertex& vertex(Index v) const { return vertex_[v]; }
  void setPlace(Index v, FixedVec2 place) { vertex_[v].place = place; }

  FixedVec2 image(Index c) const
  {
    return rotate(vertex_[corner_[c].vertex].place, corner_[c].rotation) + corner_[c].offset;
  }
  /// A point of the chart of a corner's face in the own chart of its vertex.
  FixedVec2 toOwn(Index c, FixedVec2 p) const
  {
    return rotate(p - corner_[c].offset, 4 - corner_[c].rotation);
  }
  Index origin(Index h) const { return corner_[h].vertex; }
  Index target(Index h) const { return corner_[Mesh::next(h)].vertex; }
  Index twin(Index h) const { return twin_[h]; }
  bool isConstrained(Index h) const { return constrained_[h] != 0; }
  bool isPositive(Index f) const
  {
    return determinant(image(3 * f), image(3 * f + 1), image(3 * f + 2)) > 0;
  }

  /// Counterclockwise; where the fan is open from its boundary on.
  std::vector<Index> cornersAround(Index v) const;
  bool isClosed(Index v) const { return isClosedFan_[v] != 0; }
  std::vector<Index> neighbours(Index v) const;
  double shortestEdge(Index v) const; ///< squared

  /// The vertex that h leaves goes to the other end.
  void collapse(Index h);
  bool hasCollapses() const { return !collapses_.empty(); }
  /// Takes the last collapse back; returns the vertex that is there again, where it was when it went.
  Index undo();

private:
  /// The image of a vertex is rotation x + offset, x its place.
  struct Corner
  {
    Index vertex = kInvalidIndex;
    int rotation = 0;
    FixedVec2 offset;
  };
  /// A half-edge and what was there before a collapse.
  struct OldEdge
  {
    Index h = 0, twin = 0;
    std::uint8_t constrained = 0;
  };
  struct Collapse
  {
    Index vertex = 0, target = 0;
    Index left = kInvalidIndex, right = kInvalidIndex; ///< the faces that went
    std::vector<std::pair<Index, Corner>> corners;     ///< of those that stayed, as they were
    std::vector<std::pair<Index, Index>> cornerOf;     ///< of vertices
    std::vector<OldEdge> edges;
  };

  using Ids = std::vector<std::pair<Index, Index>>; ///< of the mesh, of the patch; ascending
  Ids takeStars(const Mesh& mesh, const std::vector<Index>& patch,
    const std::vector<PatchStar>& stars, const std::vector<int>& turns,
    const std::vector<FixedVec2>& uv);
  void takeFaces(const Mesh& mesh, const std::vector<int>& turns, const std::vector<FixedVec2>& uv,
    const Ids& faces, Ids& ids);
  void closeFans();

  std::vector<Index> fineFace_; ///< of the faces; those of the patch first
  Index patchFaces_ = 0;
  std::vector<Corner> corner_;
  std::vector<Index> twin_;
  std::vector<std::uint8_t> constrained_;
  std::vector<std::uint8_t> gone_; ///< faces
  std::vector<Vertex> vertex_;
  std::vector<std::uint8_t> isClosedFan_;
  std::vector<Collapse> collapses_;
  std::size_t inner_ = 0; ///< vertices that may move
};

} // namespace quadrille

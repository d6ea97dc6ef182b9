// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// A triangulation that lives in the parameter domain only: an exactly seamless map of a mesh that may be
/// re-triangulated without touching the surface. Vertices that the map passes straight through are removed,
/// edges are flipped, and every operation can be undone on another map with the same transitions' rotations.
///
/// It is a Delta-complex: two vertices may be joined by several edges and an edge may start and end at the
/// same vertex, as flat cone surfaces need (a torus can come down to one vertex and two triangles).
#pragma once

#include "Base/FixedPoint.h"
#include "CrossField/CrossField.h"
#include "Mesh/Mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille
{

/// Bits of UvMesh::flags.
enum UvEdgeFlag : std::uint8_t
{
  kUvConstrained = 1, ///< lies on an isoline: a feature or the boundary
  kUvKept = 2         ///< joins two kept vertices on the surface: straight in every map
};

/// Slots never move (see Hierarchy/DecimationLog.h); a removed face keeps dead slots.
struct UvMesh
{
  std::vector<Index> origin;         ///< #H
  std::vector<Index> twin;           ///< #H; kInvalidIndex on the boundary
  std::vector<std::int8_t> rotation; ///< #H; quarter turns of the transition of the half-edge, 0..3
  std::vector<std::uint8_t> flags;   ///< #H; UvEdgeFlag bits, equal on both sides
  std::vector<FixedVec2> uv;         ///< #H; corner in the chart of its face
  std::vector<Index> outgoing;       ///< #V; for a boundary vertex its boundary half-edge
  std::vector<std::uint8_t> alive;   ///< #F

  static UvMesh from(
    const Mesh& mesh, const CrossField& field, const std::vector<FixedVec2>& seamlessUv);

  Index target(Index h) const { return origin[Mesh::next(h)]; }
  /// The half-edge as a vector in the chart of its face.
  FixedVec2 vector(Index h) const { return uv[Mesh::next(h)] - uv[h]; }
  bool isFixed(Index h) const { return flags[h] != 0 || twin[h] == kInvalidIndex; }
  Int128 faceDeterminant(Index f) const
  {
    return determinant(uv[3 * f], uv[3 * f + 1], uv[3 * f + 2]);
  }
  /// From the chart of face(h) to that of its twin's face. Exact.
  Transition transition(Index h) const;
  /// Half-edges that leave v, counterclockwise; a boundary vertex begins with its boundary half-edge.
  std::vector<Index> star(Index v) const { return starFrom(outgoing[v]); }
  /// The same from a half-edge on; of a boundary vertex it is the one on the boundary.
  std::vector<Index> starFrom(Index first) const;
};

/// Flips the edges of the stack that want it, the last one first, and then those round them, at most `budget` times.
template <typename Wants, typename Flip>
void flipWhere(const UvMesh& mesh, std::vector<Index> stack, std::size_t budget, const Wants& wants,
  const Flip& flip)
{
  while (!stack.empty() && budget > 0)
  {
    const Index h = stack.back();
    stack.pop_back();
    if (wants(h))
    {
      const Index g = mesh.twin[h];
      flip(h);
      --budget;
      stack.insert(stack.end(), { h, Mesh::previous(h), g, Mesh::previous(g) });
    }
  }
}

/// One operation with what undoing it needs.
struct UvRecord
{
  enum class Kind : std::uint8_t
  {
    Flip,         ///< slot: the flipped half-edge h
    RemoveInside, ///< slot: the half-edge v -> x0 of the face that stays; three faces become one
    RemoveOnLine ///< slot: the half-edge v -> p of the face that stays; on each side two faces become one
  };
  Kind kind = Kind::Flip;
  Index slot = kInvalidIndex;
  Index otherSlot =
    kInvalidIndex; ///< RemoveOnLine with two sides: v -> r of the other face that stays
  Index vertex = kInvalidIndex; ///< the removed one
  /// In units of 2^-32. RemoveInside: weights of v at corners slot, next(slot), previous(slot).
  /// RemoveOnLine: [0] weight of p, [1] of r (corner slot after the removal).
  std::array<std::int64_t, 3> weights{};
  std::size_t firstState = 0, stateCount = 0;
};

/// Applies operations to a UvMesh and remembers them.
class UvEditor
{
public:
  explicit UvEditor(UvMesh& mesh) : mesh_(mesh) {}
  /// Of a copy of the mesh that `done` has edited, to undo that there.
  UvEditor(UvMesh& copy, const UvEditor& done)
    : mesh_(copy), records_(done.records_), states_(done.states_)
  {
  }

  /// Whether the edge may be flipped so that both new triangles have a positive determinant.
  bool canFlip(Index h) const;
  /// The two determinants that flipping h would give.
  std::array<Int128, 2> flippedDeterminants(Index h) const;
  void flip(Index h);
  /// h leaves a vertex of exactly three distinct faces.
  void removeInside(Index h);
  /// The vertex lies on the straight line r - v - p, h = v -> p, with two faces on each side that
  /// exists; the one on the left of v -> p must.
  void removeOnLine(Index h);

  std::size_t recordCount() const { return records_.size(); }
  const std::vector<UvRecord>& records() const { return records_; }
  /// Every slot that operations from `record` on have changed; dead ones and repetitions included.
  std::vector<Index> slotsSince(std::size_t record) const;

  /// Carries out what another editor has done to a mesh with the same edges, whatever the triangles are here; not to be
  /// undone.
  void repeat(const std::vector<UvRecord>& records);

  /// Undoes all but the first so many operations, last first, on the mesh's current uv, whatever that has become:
  /// removed vertices return at their weights, rounded once, and faces that return get charts with whole translations.
  /// Where an edge that is flipped back leaves a triangle that is not positive, a vertex there that is not held (#V
  /// flags) goes into the kernel of its star, the one that has returned last before others.
  void undoTo(std::size_t count, const std::vector<std::uint8_t>& held);

private:
  struct SlotState
  {
    Index slot, origin, twin;
    std::int8_t rotation;
    std::uint8_t flags;
  };
  /// An outer edge that moves from one slot to another; rotation takes the chart of the new slot's
  /// face to that of the old one's.
  struct Relocation
  {
    Index from, to;
    int rotation;
  };

  void save(Index slot);
  void saveFace(Index f);
  void begin(UvRecord::Kind kind, Index slot);
  void finish();
  void relocate(const std::array<Relocation, 2>& moves, std::size_t count);
  void saveMoved(Index slot);
  void moveOutgoing(Index vertex, Index from, Index to);
  void saveSide(Index h);
  void mergeSide(Index h);
  void bury(Index f);
  void restore(const UvRecord& record);
  void undoFlip(const UvRecord& record);
  void keepPositive(Index h, const std::vector<std::uint8_t>& held, Index returned);
  void undoRemoveInside(const UvRecord& record);
  void undoRemoveOnLine(const UvRecord& record);
  void reviveSide(Index h, FixedVec2 v, FixedVec2 r);

  UvMesh& mesh_;
  std::vector<UvRecord> records_;
  std::vector<SlotState> states_;
};

} // namespace quadrille

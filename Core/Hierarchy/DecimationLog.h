// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// The log of a decimation: what the replay needs to carry a map from the coarse to the finest mesh
/// [Ebke et al. 2016, Appendix B], in slots of the finest mesh.
///
/// Slots never move: a flip or a collapse rewrites which vertex a corner slot holds, and kills slots,
/// but a surviving face keeps its three slots. The replay keeps one fixed-point uv per corner slot and
/// derives every transition it needs from the uv on both sides of an edge, which is exact; hence a
/// record needs no transitions and no twins.
///
/// Flip of the edge between h = (a -> b) in face f = (a, b, c) and g = twin(h) in face g/3 = (b, a, d):
///
///         b                 b
///       / | \             / g \      only two corner slots change their vertex:
///      c f|h d    ->     c-----d       corner next(h): b -> d
///       \ | /             \ f /        corner next(g): a -> c
///         a                 a
///
/// f becomes (a, d, c) and g/3 becomes (b, c, d),
/// so the new diagonal is next(h) = (d -> c) with twin next(g) = (c -> d); the edge a -> d moves from slot
/// next(g) to slot h, the edge b -> c from slot next(h) to slot g.
///
/// Collapse of an interior vertex v with k faces onto its ring vertex b kills the two faces at the
/// edge v b and rewrites the corner of v to b in the k - 2 others; of a boundary vertex with k faces along its
/// boundary edge kills one face. The record names the corner slot of v in each of its k faces in counterclockwise order
/// and the weights of v with respect to three vertices of its ring (two for a constrained vertex, whose
/// third weight is zero).
#pragma once

#include "Base/Types.h"
#include "Hierarchy/LogRecords.h"

#include <cstdint>
#include <vector>

namespace quadrille
{

/// The records; see LogRecords.h for their byte layout.
class DecimationLog
{
public:
  /// Bytes as written to files and arrays: versioned, checksummed, bound to the mesh by fineHash.
  std::vector<std::uint8_t> serialize() const;
  /// Throws InvalidInput on truncated, damaged or foreign bytes (says which), and when the log was made
  /// for another mesh than the one with hash expectedHash.
  static DecimationLog deserialize(
    const std::vector<std::uint8_t>& bytes, std::uint64_t expectedHash);

  /// A state of the log that it can be cut back to.
  struct End
  {
    std::size_t rounds = 0, blocks = 0, collapses = 0, flips = 0;
  };
  End end() const { return { rounds.size(), blocks.size(), collapses, flips }; }
  void truncate(const End& end);
  /// Adds a round of one block, if it has any records.
  void append(BlockRecords records, std::size_t newCollapses, std::size_t newFlips);
  /// Adds all rounds of another log of the same mesh.
  void append(DecimationLog more);
  /// Bytes of all records.
  std::size_t recordBytes() const;

  std::uint64_t fineHash = 0;
  Index fineFaces = 0;
  std::size_t collapses = 0;
  std::size_t flips = 0;

  /// Rounds in order of the decimation; the replay runs them last to first. Blocks of one round touch
  /// disjoint sets of slots, so that they replay in parallel.
  struct Round
  {
    std::size_t firstBlock = 0;
    std::size_t blockCount = 0;
  };
  std::vector<Round> rounds;
  /// Each in memory of its own: all together are hundreds of megabytes for a large mesh, and are never copied.
  std::vector<BlockRecords> blocks;
  std::size_t intermediateRounds = 0; ///< the first rounds, that lead to the intermediate level
};

} // namespace quadrille

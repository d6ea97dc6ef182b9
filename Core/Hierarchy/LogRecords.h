// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Byte layout of the records of a decimation log, read from the end of a block to its beginning.
///
///     flip      h g                          | 0      9 bytes
///     collapse  slot[k] v w1 w2 i0 i1 i2 kind| k      4 k + 17 bytes
///
/// The last byte is the tag. Slots, weights and v, the id of the removed vertex, are little-endian 32 bit. It lies at
///     r[i0] + w1 (r[i1] - r[i0]) + w2 (r[i2] - r[i0]),   w in units of 2^-32, w <= 1/2 each,
/// with r the ring of v in counterclockwise order as the slots name it: slot j is the corner of v in face
/// (v, r[j], r[j+1]). For an interior vertex r[0] is the vertex it collapsed onto, so slots 0 and k-1 die;
/// a boundary vertex has k + 1 ring vertices and collapsed onto r[0] (slot 0 dies) or r[k] (slot k-1
/// dies). A vertex of a constrained curve has i2 = i0 and w2 = 0.
#pragma once

#include "Base/RingKernel.h"
#include "Base/Types.h"

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille
{

enum class CollapseKind : std::uint8_t
{
  Interior = 0,
  BoundaryFirst = 1, ///< onto r[0]
  BoundaryLast = 2   ///< onto r[k]
};

struct CollapseRecord
{
  int faces = 0; ///< k
  Index vertex = kInvalidIndex;
  CollapseKind kind = CollapseKind::Interior;
  bool onCurve = false;
  std::array<std::uint8_t, 3> ring{};
  std::array<std::uint32_t, 2> weight{};
  std::array<Index, kMaximumRing> slot{};

  int ringSize() const { return kind == CollapseKind::Interior ? faces : faces + 1; }
  /// Position in the ring of the vertex that v collapsed onto.
  int target() const { return kind == CollapseKind::BoundaryLast ? faces : 0; }
  /// The slots that survive are [firstSurvivor, lastSurvivor].
  int firstSurvivor() const { return kind == CollapseKind::BoundaryLast ? 0 : 1; }
  int lastSurvivor() const { return kind == CollapseKind::BoundaryFirst ? faces - 1 : faces - 2; }
};

inline void storeLittleEndian(std::uint8_t* bytes, std::uint32_t value)
{
  bytes[0] = static_cast<std::uint8_t>(value);
  bytes[1] = static_cast<std::uint8_t>(value >> 8);
  bytes[2] = static_cast<std::uint8_t>(value >> 16);
  bytes[3] = static_cast<std::uint8_t>(value >> 24);
}
inline std::uint32_t loadLittleEndian(const std::uint8_t* bytes)
{
  return std::uint32_t{ bytes[0] } | std::uint32_t{ bytes[1] } << 8 |
    std::uint32_t{ bytes[2] } << 16 | std::uint32_t{ bytes[3] } << 24;
}

constexpr std::size_t kFlipBytes = 9;
constexpr std::size_t collapseBytes(int faces)
{
  return 4 * static_cast<std::size_t>(faces) + 17;
}
/// Set in the kind byte of a vertex of a constrained curve.
constexpr std::uint8_t kOnCurveBit = 4;

/// The records of one block, in decimation order; readable backwards.
using BlockRecords = std::vector<std::uint8_t>;

/// Appends records to the log of one block.
class RecordWriter
{
public:
  void flip(Index h, Index g)
  {
    std::uint8_t* out = grow(kFlipBytes);
    storeLittleEndian(out, h);
    storeLittleEndian(out + 4, g);
    out[8] = 0;
    ++flips_;
  }
  void collapse(const CollapseRecord& record)
  {
    std::uint8_t* out = grow(collapseBytes(record.faces));
    for (int i = 0; i < record.faces; ++i, out += 4)
    {
      storeLittleEndian(out, record.slot[static_cast<std::size_t>(i)]);
    }
    storeLittleEndian(out, record.vertex);
    storeLittleEndian(out + 4, record.weight[0]);
    storeLittleEndian(out + 8, record.weight[1]);
    out[12] = record.ring[0];
    out[13] = record.ring[1];
    out[14] = record.ring[2];
    out[15] = static_cast<std::uint8_t>(
      static_cast<unsigned>(record.kind) | (record.onCurve ? unsigned{ kOnCurveBit } : 0U));
    out[16] = static_cast<std::uint8_t>(record.faces);
    ++collapses_;
  }

  const BlockRecords& bytes() const { return bytes_; }
  std::size_t flips() const { return flips_; }
  std::size_t collapses() const { return collapses_; }
  /// Begins anew in the same memory.
  void clear()
  {
    bytes_.clear();
    flips_ = collapses_ = 0;
  }

private:
  std::uint8_t* grow(std::size_t count)
  {
    const std::size_t begin = bytes_.size();
    bytes_.resize(begin + count);
    return bytes_.data() + begin;
  }
  BlockRecords bytes_;
  std::size_t flips_ = 0;
  std::size_t collapses_ = 0;
};

/// The vertex that the collapse record that ends at `end` removes.
inline Index removedVertex(const std::uint8_t* end)
{
  return loadLittleEndian(end - 17);
}

/// The collapse record that ends at `end`; its tag must not be zero. Does not check its content.
inline void readCollapse(const std::uint8_t* end, CollapseRecord& record)
{
  record.faces = end[-1];
  record.vertex = removedVertex(end);
  const unsigned kind = end[-2];
  record.kind = static_cast<CollapseKind>(kind & 3U);
  record.onCurve = (kind & kOnCurveBit) != 0;
  record.ring = { end[-5], end[-4], end[-3] };
  record.weight = { loadLittleEndian(end - 13), loadLittleEndian(end - 9) };
  const std::uint8_t* in = end - collapseBytes(record.faces);
  for (int i = 0; i < record.faces; ++i, in += 4)
  {
    record.slot[static_cast<std::size_t>(i)] = loadLittleEndian(in);
  }
}

/// Fetches nothing, see readBackwards.
struct NoFetch
{
  void operator()(Index) const {}
};

/// The beginning of the record that ends at `end`.
inline const std::uint8_t* recordBegin(const std::uint8_t* end)
{
  return end - (end[-1] == 0 ? kFlipBytes : collapseBytes(end[-1]));
}

/// Calls fetch(slot) for slots of the record that ends at `end`, without branches on its kind or size, which cannot be
/// predicted. Inlined, as fetch() has to be: GCC 12 takes a function of mere prefetches for one without effect.
template <typename Fetch>
[[gnu::always_inline]] inline void fetchRecord(const std::uint8_t* end, const Fetch& fetch)
{
  constexpr int kSlotsAhead = 6; // few records have more
  const std::uint8_t* const slots = recordBegin(end);
  const int count = end[-1] == 0 ? 2 : end[-1];
  for (int i = 0; i < kSlotsAhead; ++i)
  {
    fetch(loadLittleEndian(slots + 4 * (i < count ? i : count - 1)));
  }
}

/// Calls flip(h, g) or collapse(), with what was read in `record`, for each of the records in [begin, end), the last
/// one first. fetch(slot): brings what a slot has to the processor while the records before it are at work.
template <typename Flip, typename Collapse, typename Fetch = NoFetch>
void readBackwards(const std::uint8_t* begin, const std::uint8_t* end, CollapseRecord& record,
  const Flip& flip, const Collapse& collapse, const Fetch& fetch = {})
{
  constexpr int kRecordsAhead = 4; // they take about as long as the memory needs
  const std::uint8_t* ahead = end;
  for (int i = 0; i < kRecordsAhead && ahead > begin; ++i)
  {
    ahead = recordBegin(ahead);
  }
  while (end > begin)
  {
    if (ahead > begin)
    {
      fetchRecord(ahead, fetch);
      ahead = recordBegin(ahead);
    }
    if (end[-1] == 0)
    {
      flip(loadLittleEndian(end - 9), loadLittleEndian(end - 5));
      end -= kFlipBytes;
    }
    else
    {
      readCollapse(end, record);
      collapse();
      end -= collapseBytes(record.faces);
    }
  }
}
template <typename Flip, typename Collapse, typename Fetch = NoFetch>
void readBackwards(const BlockRecords& records, CollapseRecord& record, const Flip& flip,
  const Collapse& collapse, const Fetch& fetch = {})
{
  readBackwards(records.data(), records.data() + records.size(), record, flip, collapse, fetch);
}

/// Replaces every slot and every vertex in the records of a block.
template <typename NewSlot, typename NewVertex>
void renameRecords(BlockRecords& bytes, const NewSlot& newSlot, const NewVertex& newVertex)
{
  const auto rename = [](std::uint8_t* at, const auto& newName)
  { storeLittleEndian(at, newName(loadLittleEndian(at))); };
  std::size_t end = bytes.size();
  while (end > 0)
  {
    const int faces = bytes[end - 1];
    const int slots = faces == 0 ? 2 : faces;
    end -= faces == 0 ? kFlipBytes : collapseBytes(faces);
    std::uint8_t* at = bytes.data() + end;
    for (int i = 0; i < slots; ++i, at += 4)
    {
      rename(at, newSlot);
    }
    if (faces != 0)
    {
      rename(at, newVertex);
    }
  }
}

} // namespace quadrille

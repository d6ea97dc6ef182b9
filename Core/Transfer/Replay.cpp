// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/Replay.h"

#include "Base/ChartRotation.h"
#include "Base/Error.h"
#include "Base/Parallel.h"
#include "Hierarchy/LogRecords.h"
#include "Mesh/Mesh.h"
#include "Transfer/RingKernel.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

namespace quadrille
{

namespace
{

/// w (b - a) for w in units of 2^-32, rounded to the grid.
std::int64_t scaled(std::int64_t difference, std::uint32_t weight)
{
  return static_cast<std::int64_t>(
    (Int128{ difference } * weight + (std::int64_t{ 1 } << 31)) >> 32);
}
FixedVec2 scaled(FixedVec2 difference, std::uint32_t weight)
{
  return { scaled(difference.u, weight), scaled(difference.v, weight) };
}

/// Replays one block. All coordinates of a star are taken relative to the vertex that it had collapsed onto.
class BlockReplay
{
public:
  explicit BlockReplay(std::vector<FixedVec2>& uv) : uv_(uv) {}
  void run(const std::uint8_t* begin, const std::uint8_t* end);
  const ReplayCounts& counts() const { return counts_; }

private:
  void unflip(Index h, Index g);
  void uncollapse();
  void unfoldRing();
  FixedVec2 interpolate() const;
  FixedVec2 moveIntoKernel(FixedVec2 p);
  void writeStar(FixedVec2 p);
  FixedVec2& ring(int i) { return ring_[static_cast<std::size_t>(i)]; }
  Index slot(int i) const { return record_.slot[static_cast<std::size_t>(i)]; }

  std::vector<FixedVec2>& uv_;
  CollapseRecord record_;
  std::array<FixedVec2, kMaximumRing + 1> ring_;
  std::array<int, kMaximumRing>
    rotation_{}; ///< from the chart of each surviving face to the first one's
  ReplayCounts counts_;
};

/// How many records ahead uv is fetched: four take about as long as the memory needs.
constexpr int kRecordsAhead = 4;
/// How many of a record's slots are fetched; few have more.
constexpr int kSlotsAhead = 6;

/// The beginning of the record that ends at `end`.
const std::uint8_t* recordBegin(const std::uint8_t* end)
{
  return end - (end[-1] == 0 ? kFlipBytes : collapseBytes(end[-1]));
}

/// Fetches uv of the record that ends at `end`, without branches on its kind or size, which cannot be predicted.
/// Inlined, since GCC 12 takes a function of mere prefetches for one without effect and drops its calls.
[[gnu::always_inline]] inline void prefetchRecord(const FixedVec2* uv, const std::uint8_t* end)
{
#if defined(__GNUC__)
  const std::uint8_t* const slots = recordBegin(end);
  const int count = end[-1] == 0 ? 2 : end[-1];
  for (int i = 0; i < kSlotsAhead; ++i)
  {
    // The two lines that the 48 bytes of a face can lie on.
    const auto address = reinterpret_cast<std::uintptr_t>(uv) +
      sizeof(FixedVec2) * std::uintptr_t{ loadLittleEndian(slots + 4 * std::min(i, count - 1)) };
    __builtin_prefetch(reinterpret_cast<const void*>(address - 32), 1);
    __builtin_prefetch(reinterpret_cast<const void*>(address + 32), 1);
  }
#else
  static_cast<void>(uv);
  static_cast<void>(end);
#endif
}

void BlockReplay::run(const std::uint8_t* begin, const std::uint8_t* end)
{
  const std::uint8_t* ahead = end;
  for (int i = 0; i < kRecordsAhead && ahead > begin; ++i)
  {
    ahead = recordBegin(ahead);
  }
  while (end > begin)
  {
    if (ahead > begin)
    {
      prefetchRecord(uv_.data(), ahead);
      ahead = recordBegin(ahead);
    }
    if (end[-1] == 0)
    {
      unflip(loadLittleEndian(end - 9), loadLittleEndian(end - 5));
      end -= kFlipBytes;
    }
    else
    {
      readCollapse(end, record_);
      uncollapse();
      end -= collapseBytes(record_.faces);
    }
  }
}

void BlockReplay::unflip(Index h, Index g)
{
  // Before: f = (a, d, c), g/3 = (b, c, d). See the figure in DecimationLog.h.
  const Index nextH = Mesh::next(h);
  const Index nextG = Mesh::next(g);
  const FixedVec2 dInF = uv_[nextH];
  const FixedVec2 dInG = uv_[Mesh::previous(g)];
  const std::optional<int> rotation =
    rotationBetween(uv_[nextG] - dInG, uv_[Mesh::previous(h)] - dInF);
  counts_.lostTransitions += rotation ? 0U : 1U;
  uv_[nextH] = dInF + rotate(uv_[g] - dInG, rotation.value_or(0));
  uv_[nextG] = dInG + rotate(uv_[h] - dInF, 4 - rotation.value_or(0));
}

void BlockReplay::uncollapse()
{
  unfoldRing();
  FixedVec2 p = interpolate();
  const bool closed = record_.kind == CollapseKind::Interior;
  if (!starIsPositive(ring_.data(), record_.ringSize(), closed, p))
  {
    p = moveIntoKernel(p);
  }
  writeStar(p);
}

void BlockReplay::unfoldRing()
{
  const int first = record_.firstSurvivor();
  const int last = record_.lastSurvivor();
  int rotation = 0;
  ring(record_.target()) = {};
  for (int i = first; i <= last; ++i)
  {
    const Index corner = slot(i);
    const FixedVec2 base = uv_[corner];
    const FixedVec2 toNext = uv_[Mesh::next(corner)] - base;
    if (i > first)
    {
      // The spoke to ring vertex i is known from the face before.
      const Index before = slot(i - 1);
      const std::optional<int> further =
        rotationBetween(toNext, uv_[Mesh::previous(before)] - uv_[before]);
      counts_.lostTransitions += further ? 0U : 1U;
      rotation = (rotation + further.value_or(0)) & 3;
    }
    rotation_[static_cast<std::size_t>(i)] = rotation;
    ring(i) = rotate(toNext, rotation);
    if (i == last)
    {
      ring(i + 1) = rotate(uv_[Mesh::previous(corner)] - base, rotation);
    }
  }
}

FixedVec2 BlockReplay::interpolate() const
{
  const FixedVec2 base = ring_[record_.ring[0]];
  FixedVec2 p = base + scaled(ring_[record_.ring[1]] - base, record_.weight[0]);
  if (!record_.onCurve)
  {
    p = p + scaled(ring_[record_.ring[2]] - base, record_.weight[1]);
  }
  return p;
}

FixedVec2 BlockReplay::moveIntoKernel(FixedVec2 p)
{
  ++counts_.invertedStars;
  const bool closed = record_.kind == CollapseKind::Interior;
  const int count = record_.ringSize();
  const std::optional<FixedVec2> moved = record_.onCurve
    ? kernelPointOnSegment(
        ring_.data(), count, closed, ring_[record_.ring[0]], ring_[record_.ring[1]])
    : kernelPoint(ring_.data(), count, closed);
  if (!moved)
  {
    ++counts_.withoutKernel;
    return p;
  }
  ++counts_.movedToKernel;
  return *moved;
}

void BlockReplay::writeStar(FixedVec2 p)
{
  const int first = record_.firstSurvivor();
  const int last = record_.lastSurvivor();
  const FixedVec2 targetFirst = uv_[slot(first)];
  const FixedVec2 targetLast = uv_[slot(last)];
  for (int i = first; i <= last; ++i)
  {
    uv_[slot(i)] = uv_[slot(i)] + rotate(p, 4 - rotation_[static_cast<std::size_t>(i)]);
  }
  // The faces that come back take the chart of their neighbour in the star.
  if (first == 1)
  {
    uv_[slot(0)] = uv_[slot(1)];
    uv_[Mesh::next(slot(0))] = targetFirst;
    uv_[Mesh::previous(slot(0))] = uv_[Mesh::next(slot(1))];
  }
  if (last == record_.faces - 2)
  {
    const Index corner = slot(record_.faces - 1);
    uv_[corner] = uv_[slot(last)];
    uv_[Mesh::next(corner)] = uv_[Mesh::previous(slot(last))];
    uv_[Mesh::previous(corner)] = targetLast;
  }
}

} // namespace

void ReplayCounts::add(const ReplayCounts& other)
{
  invertedStars += other.invertedStars;
  movedToKernel += other.movedToKernel;
  withoutKernel += other.withoutKernel;
  lostTransitions += other.lostTransitions;
}

ReplayCounts replayLog(const DecimationLog& log, std::vector<FixedVec2>& uv, int threads,
  const ProgressCallback& progress)
{
  return replayRounds(log, { log.rounds.size(), 0 }, uv, threads, progress);
}

ReplayCounts replayRounds(const DecimationLog& log, const ReplayRange& range,
  std::vector<FixedVec2>& uv, int threads, const ProgressCallback& progress)
{
  if (range.to > range.from || range.from > log.rounds.size() ||
    uv.size() != 3 * std::size_t{ log.fineFaces })
  {
    throw InvalidInput("Rounds " + std::to_string(range.from) + " to " + std::to_string(range.to) +
      " of a decimation log of " + std::to_string(log.rounds.size()) + " rounds and " +
      std::to_string(log.fineFaces) + " faces cannot be replayed on " + std::to_string(uv.size()) +
      " corners.");
  }
  std::vector<ReplayCounts> counts(log.blocks.size());
  for (std::size_t i = range.from; i-- > range.to;)
  {
    const DecimationLog::Round& round = log.rounds[i];
    report(progress, double(range.from - i) / double(range.from - range.to + 1), "replay");
    parallelFor(round.blockCount, 1, threads,
      [&](std::size_t begin, std::size_t)
      {
        const std::size_t id = round.firstBlock + begin;
        BlockReplay block(uv);
        block.run(log.blocks[id].data(), log.blocks[id].data() + log.blocks[id].size());
        counts[id] = block.counts();
      });
  }
  ReplayCounts total;
  for (const ReplayCounts& count : counts)
  {
    total.add(count);
  }
  return total;
}

} // namespace quadrille

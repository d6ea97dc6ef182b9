// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Transfer/Replay.h"

#include "Base/ChartRotation.h"
#include "Base/Error.h"
#include "Base/Parallel.h"
#include "Base/RingKernel.h"
#include "Hierarchy/LogRecords.h"
#include "Mesh/Mesh.h"
#include "Transfer/StarReplay.h"

#include <optional>
#include <string>

namespace quadrille
{

namespace
{

/// Charts of fixed-point uv.
struct UvCharts
{
  using Point = FixedVec2;
  using Rotation = int; ///< quarter turns

  static Rotation none() { return 0; }
  Rotation between(FixedVec2 from, FixedVec2 to)
  {
    const std::optional<int> rotation = rotationBetween(from, to);
    lost += rotation ? 0U : 1U;
    return rotation.value_or(0);
  }
  static Rotation after(Rotation second, Rotation first) { return (second + first) & 3; }
  static FixedVec2 rotate(Rotation r, FixedVec2 p) { return quadrille::rotate(p, r); }
  static FixedVec2 rotateBack(Rotation r, FixedVec2 p) { return quadrille::rotate(p, 4 - r); }
  /// Rounded to the grid.
  static FixedVec2 scaled(FixedVec2 difference, std::uint32_t weight)
  {
    const auto round = [&](std::int64_t d)
    { return static_cast<std::int64_t>((Int128{ d } * weight + (std::int64_t{ 1 } << 31)) >> 32); };
    return { round(difference.u), round(difference.v) };
  }

  std::size_t lost = 0; ///< edges without a rotation
};

/// Replays one block.
class BlockReplay
{
public:
  explicit BlockReplay(std::vector<FixedVec2>& uv) : uv_(uv), star_(uv) {}
  void run(const BlockRecords& records);
  ReplayCounts counts() const
  {
    ReplayCounts counts = counts_;
    counts.lostTransitions = star_.charts().lost;
    return counts;
  }

private:
  void uncollapse();
  FixedVec2 moveIntoKernel(FixedVec2 p);

  const std::vector<FixedVec2>& uv_;
  StarReplay<UvCharts> star_;
  CollapseRecord record_;
  ReplayCounts counts_;
};

/// Fetches uv of the face of a slot.
struct FetchUv
{
  [[gnu::always_inline]] void operator()(Index slot) const
  {
#if defined(__GNUC__)
    // The two lines that the 48 bytes of a face can lie on.
    const auto address =
      reinterpret_cast<std::uintptr_t>(uv) + sizeof(FixedVec2) * std::uintptr_t{ slot };
    // NOLINTBEGIN(performance-no-int-to-ptr): nothing is read there
    __builtin_prefetch(reinterpret_cast<const void*>(address - 32), 1);
    __builtin_prefetch(reinterpret_cast<const void*>(address + 32), 1);
    // NOLINTEND(performance-no-int-to-ptr)
#else
    static_cast<void>(slot);
#endif
  }

  const FixedVec2* uv;
};

void BlockReplay::run(const BlockRecords& records)
{
  readBackwards(
    records, record_, [this](Index h, Index g) { star_.unflip(h, g); }, [this] { uncollapse(); },
    FetchUv{ uv_.data() });
}

void BlockReplay::uncollapse()
{
  FixedVec2 p = star_.unfold(record_);
  const bool closed = record_.kind == CollapseKind::Interior;
  if (!starIsPositive(star_.ring().data(), record_.ringSize(), closed, p))
  {
    p = moveIntoKernel(p);
  }
  star_.write(record_, p);
}

FixedVec2 BlockReplay::moveIntoKernel(FixedVec2 p)
{
  ++counts_.invertedStars;
  const bool closed = record_.kind == CollapseKind::Interior;
  const int count = record_.ringSize();
  const auto& ring = star_.ring();
  const std::optional<FixedVec2> moved = record_.onCurve
    ? kernelPointOnSegment(ring.data(), count, closed, ring[record_.ring[0]], ring[record_.ring[1]])
    : kernelPoint(ring.data(), count, closed);
  if (!moved)
  {
    ++counts_.withoutKernel;
    return p;
  }
  ++counts_.movedToKernel;
  return *moved;
}

} // namespace

void ReplayCounts::add(const ReplayCounts& other)
{
  invertedStars += other.invertedStars;
  movedToKernel += other.movedToKernel;
  withoutKernel += other.withoutKernel;
  lostTransitions += other.lostTransitions;
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
        block.run(log.blocks[id]);
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

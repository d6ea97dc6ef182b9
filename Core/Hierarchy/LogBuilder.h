// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Collects the rounds of a decimation into one log.
#pragma once

#include "Hierarchy/DecimationLog.h"
#include "Hierarchy/LogRecords.h"

#include <utility>
#include <vector>

namespace quadrille
{

class LogBuilder
{
public:
  /// What a block did: a copy of the records, of just their size.
  struct Block
  {
    Block() = default;
    explicit Block(const RecordWriter& writer)
      : records(writer.bytes()), collapses(writer.collapses()), flips(writer.flips())
    {
    }

    BlockRecords records;
    std::size_t collapses = 0;
    std::size_t flips = 0;
  };

  /// Adds a round of blocks; those without records are left out. Returns the number of vertices that it removed.
  std::size_t addRound(std::vector<Block> blocks)
  {
    DecimationLog::Round round;
    round.firstBlock = log_.blocks.size();
    std::size_t removed = 0;
    for (Block& block : blocks)
    {
      if (!block.records.empty())
      {
        log_.blocks.push_back(std::move(block.records));
        log_.flips += block.flips;
        removed += block.collapses;
      }
    }
    round.blockCount = log_.blocks.size() - round.firstBlock;
    log_.collapses += removed;
    if (round.blockCount > 0)
    {
      log_.rounds.push_back(round);
    }
    return removed;
  }

  /// What was added until now leads to the intermediate level.
  void endIntermediate() { log_.intermediateRounds = log_.rounds.size(); }

  DecimationLog finish() { return std::move(log_); }

private:
  DecimationLog log_;
};

} // namespace quadrille

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
  /// Adds a round from the logs of its blocks; blocks without records are left out. Returns the number of
  /// vertices that it removed.
  std::size_t addRound(std::vector<RecordWriter> blocks)
  {
    std::size_t removed = 0;
    DecimationLog::Round round;
    round.firstBlock = log_.blocks.size();
    for (const RecordWriter& block : blocks)
    {
      if (block.bytes().empty())
      {
        continue;
      }
      bytes_ += block.bytes().size();
      log_.blocks.push_back({ bytes_ - block.bytes().size(), bytes_ });
      log_.flips += block.flips();
      removed += block.collapses();
    }
    round.blockCount = log_.blocks.size() - round.firstBlock;
    log_.collapses += removed;
    if (round.blockCount > 0)
    {
      log_.rounds.push_back(round);
      pending_.push_back(std::move(blocks));
    }
    return removed;
  }

  /// What was added until now leads to the intermediate level.
  void endIntermediate() { log_.intermediateRounds = log_.rounds.size(); }

  /// The log, with room for `more` bytes of records.
  DecimationLog finish(std::size_t more)
  {
    // One allocation of the final size: the records of a large mesh are hundreds of megabytes.
    log_.records.reserve(bytes_ + more);
    for (std::vector<RecordWriter>& round : pending_)
    {
      for (const RecordWriter& block : round)
      {
        log_.records.insert(log_.records.end(), block.bytes().begin(), block.bytes().end());
      }
      round = {};
    }
    return std::move(log_);
  }

private:
  DecimationLog log_;
  std::vector<std::vector<RecordWriter>> pending_;
  std::size_t bytes_ = 0;
};

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What the stages of a run took.
#pragma once

#include "Base/Clock.h"

#include <cstddef>
#include <string>
#include <vector>

namespace quadrille
{

/// One stage of a run: names are read, repair, order, connectivity, phase1, phase2, field,
/// seamless, quantize, embed, replay, extract (the benchmark's columns), and refine, close, handles, metric, certify,
/// optimize, charts, retries.
struct StageRecord
{
  std::string stage;
  double seconds = 0;
  std::size_t elementsIn = 0;
  std::size_t elementsOut = 0;
};

/// The stages in the order of their first run. A stage that had to be repeated is one record, with the time of all its
/// runs and the sizes of the last one.
class StageRecords
{
public:
  void add(const std::string& stage, double seconds, std::size_t in, std::size_t out);
  void add(const std::vector<StageRecord>& later);
  void add(const StageRecords& later) { add(later.records_); }
  bool has(const std::string& stage) const;
  const std::vector<StageRecord>& all() const { return records_; }

private:
  std::vector<StageRecord> records_;
};

/// Stages of a part of a surface, to those of others: sizes are sums, too.
void addPart(const std::vector<StageRecord>& part, std::vector<StageRecord>& all);

/// Records of stages that follow each other.
class StageLaps
{
public:
  /// Closes the stage that began at the previous lap.
  void lap(const std::string& stage, std::size_t in, std::size_t out)
  {
    records.add(stage, watch_.lap(), in, out);
  }
  /// Stages that were recorded elsewhere since then.
  void add(const std::vector<StageRecord>& stages)
  {
    records.add(stages);
    watch_.lap();
  }

  StageRecords records;

private:
  Stopwatch watch_;
};

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/StageRecords.h"

#include <algorithm>

namespace quadrille
{

void StageRecords::add(const std::string& stage, double seconds, std::size_t in, std::size_t out)
{
  const auto known = std::find_if(records_.begin(), records_.end(),
    [&](const StageRecord& record) { return record.stage == stage; });
  if (known == records_.end())
  {
    records_.push_back({ stage, seconds, in, out });
  }
  else
  {
    *known = { stage, known->seconds + seconds, in, out };
  }
}

void StageRecords::add(const std::vector<StageRecord>& later)
{
  for (const StageRecord& record : later)
  {
    add(record.stage, record.seconds, record.elementsIn, record.elementsOut);
  }
}

void addPart(const std::vector<StageRecord>& part, std::vector<StageRecord>& all)
{
  for (const StageRecord& record : part)
  {
    const auto found = std::find_if(all.begin(), all.end(),
      [&](const StageRecord& other) { return other.stage == record.stage; });
    if (found == all.end())
    {
      all.push_back(record);
      continue;
    }
    found->seconds += record.seconds;
    found->elementsIn += record.elementsIn;
    found->elementsOut += record.elementsOut;
  }
}

bool StageRecords::has(const std::string& stage) const
{
  return std::any_of(records_.begin(), records_.end(),
    [&](const StageRecord& record) { return record.stage == stage; });
}

} // namespace quadrille

// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Pipeline/History.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace quadrille
{
void History::addMap(const Plan& plan, std::shared_ptr<MapAttempt> map)
{
  if (map->status.ok() || !map->failedFaces.empty())
  {
    failedFaces_ = map->failedFaces;
  }
  if (roundIsOver_)
  {
    beforeRound_ = steps_.size();
    roundIsOver_ = false;
  }
  steps_.emplace_back(plan.step);
  workOfLast_ = map->work + map->workOfCarrying + bound_.ofAttempt;
  work_ += workOfLast_;
  take(*map);
  if (!plan.made.empty())
  {
    ++all_.tries.taken[static_cast<std::size_t>(plan.made.back())];
  }
  last_ = { plan, std::move(map), nullptr };
  replays_ += hasMap() && last_.map->stages.has("replay") ? 1 : 0;
}

void History::addQuads(std::shared_ptr<const QuadAttempt> quads)
{
  roundIsOver_ = true;
  if (!hasMap() || !quads)
  {
    return;
  }
  last_.quads = std::move(quads);
  take(*last_.quads);
  failedFaces_ = { last_.quads->failedFaces, {} };
  if (last_.quads->status.ok() &&
    (!result_.quads || 2 * last_.quads->invertedQuads <= result_.quads->invertedQuads))
  {
    result_ = last_;
  }
}

void History::take(const AttemptLog& log)
{
  all_.stages.add(log.stages);
  all_.tries.addTaken(log.tries);
  all_.reused.insert(all_.reused.end(), log.reused.begin(), log.reused.end());
}

void History::packMaps(const Mesh& surface)
{
  for (const Attempt* attempt : { &last_, &result_ })
  {
    if (attempt->map)
    {
      attempt->map->pack(surface);
    }
  }
}

bool History::isSpent() const
{
  return attempts() + bound_.attemptsOfLastResort >= bound_.attempts ||
    work_ + (hasSomething() ? workOfLast_ / 2 : 0) >= bound_.work;
}

void History::beginLastResort()
{
  bound_.attemptsOfLastResort = 0;
  bound_.work = std::max(bound_.work, work_ + bound_.workOfLastResort);
}

std::size_t History::allowance() const
{
  if (!hasSomething())
  {
    return bound_.ofMap;
  }
  return bound_.work > work_ ? bound_.work - work_ : 0;
}

std::size_t History::inRound(const std::string& step) const
{
  const auto first = steps_.begin() + static_cast<std::ptrdiff_t>(beforeRound_);
  return static_cast<std::size_t>(std::count(first, steps_.end(), step));
}

TryCounts History::tries() const
{
  TryCounts all = all_.tries;
  if (!hasResult())
  {
    return all;
  }
  for (const Try step : result_.plan.made)
  {
    ++all.led[static_cast<std::size_t>(step)];
  }
  all.addLed(result_.map->tries);
  all.addLed(result_.quads->tries);
  return all;
}

double History::seconds() const
{
  return std::accumulate(all_.stages.all().begin(), all_.stages.all().end(), 0.0,
    [](double sum, const StageRecord& record) { return sum + record.seconds; });
}

StageRecords History::stages() const
{
  StageRecords own;
  const Attempt& chosen = result();
  if (chosen.map)
  {
    own.add(chosen.map->stages);
  }
  if (chosen.quads)
  {
    own.add(chosen.quads->stages);
  }
  StageRecords told;
  double others = 0;
  for (const StageRecord& record : all_.stages.all())
  {
    if (own.has(record.stage))
    {
      told.add(record.stage, record.seconds, 0, 0);
    }
    else
    {
      others += record.seconds;
    }
  }
  for (const StageRecord& record : own.all())
  {
    told.add(record.stage, 0, record.elementsIn, record.elementsOut);
  }
  if (others > 0)
  {
    told.add("retries", others, 0, 0);
  }
  return told;
}

} // namespace quadrille
